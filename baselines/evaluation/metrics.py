"""What an episode is judged by, one number for each blade."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from baselines.design.controller import Array
from baselines.design.matrix import real_matrix
from baselines.design.objects import instance
from baselines.evaluation.episodes import Episodes

SETTLING_BAND = 0.05
"""Share of the uncontrolled peak within which a tip counts as settled."""

REST = 0.2
"""Share of an episode, its end, whose mean is taken for the position the tip settles to."""


EPISODES = "Episodes, such as roll_out returns"


@dataclass(frozen=True, slots=True, eq=False)
class EpisodeMetrics:
    """One array (N,) for each metric, an entry per blade. Metrics of the tip are NaN if the environment has no displacement."""

    cost: Array
    """J, J s: vibration energy and actuator effort integrated over the episode; infinite if the blade failed."""
    effort: Array
    """J s: the actuators' share of J, up to the failure if there was one."""
    settling_time: Array
    """s from the reset until the tip's response to the load case last leaves a band of 5 % of its uncontrolled peak about its
    final position, which is the deflection under a load that lasts. The whole episode if it does not settle, as under a harmonic
    load, or if the blade fails."""
    settled: Array
    """1 if it had settled when the last fifth of the episode began, else 0."""
    peak_tip: Array
    """m: greatest distance of the tip from where it rests without load. This and the following count up to a failure."""
    rms_tip: Array
    """m."""
    peak_voltage: Array
    """V, of any actuator."""
    rms_voltage: Array
    """V, over actuators and time."""
    saturation: Array
    """Share of actuators and time at a drive limit."""

    def to_dict(self) -> dict[str, list[float | None]]:
        """Lists that JSON can hold, None for what is infinite."""
        return {entry.name: [finite(value) for value in getattr(self, entry.name)] for entry in fields(self)}


def finite(value: float) -> float | None:
    """The number as JSON can hold it: None when it is not finite."""
    return float(value) if np.isfinite(value) else None


def measure(episodes: Episodes, band: Array) -> EpisodeMetrics:
    """Metrics of each blade; ``band`` (N,) in m as ``settling_band`` gives it."""
    instance("episodes", episodes, Episodes, EPISODES)
    band = real_matrix("band", band, episodes.failed.shape)
    distance = np.linalg.norm(episodes.tip_displacement, axis=-1)
    magnitude = np.abs(episodes.voltages)
    low, high = 0.999 * episodes.voltage_limits  # single precision and tanh come near a limit without touching it
    at_limit = np.where(np.isnan(magnitude), np.nan, (episodes.voltages >= high) | (episodes.voltages <= low))
    from_instant = np.where(episodes.failed, len(episodes.time), settled_from(_excursion(episodes), band))
    known = np.where(episodes.tip_displacement.shape[-1] > 0, 1.0, np.nan)  # nothing settles where no displacement is told
    settling_time = np.asarray(known * episodes.interval * from_instant, dtype=np.float64)
    return EpisodeMetrics(
        cost=np.where(episodes.failed, np.inf, np.nansum(episodes.cost, axis=0)),
        effort=np.nansum(episodes.effort, axis=0),
        settling_time=settling_time,
        settled=known * (settling_time <= (1.0 - REST) * episodes.time[-1]),
        peak_tip=known * np.nanmax(distance, axis=0),
        rms_tip=known * np.sqrt(np.nanmean(distance**2, axis=0)),
        peak_voltage=np.nanmax(magnitude, axis=(0, 2)),
        rms_voltage=np.sqrt(np.nanmean(magnitude**2, axis=(0, 2))),
        saturation=np.nanmean(at_limit, axis=(0, 2)),
    )


def cost_without_control(uncontrolled: Episodes) -> Array:
    """(N,), J s: J₀, what every J is relative to. A blade that fails is charged to the end of its episode as in its last interval.

    So J₀ stays a number, where J of a blade that fails under a controller is infinite. ``judged`` says how the two meet.
    """
    instance("uncontrolled", uncontrolled, Episodes, EPISODES)
    recorded = ~np.isnan(uncontrolled.cost)
    last = np.take_along_axis(uncontrolled.cost, recorded.sum(axis=0)[None] - 1, axis=0)[0]
    spent = np.nansum(uncontrolled.cost, axis=0)
    return np.where(uncontrolled.failed, spent + (~recorded).sum(axis=0) * last, spent)


def judged(cost: Array, without_control: Array, lost: NDArray[np.bool_]) -> Array:
    """J (…, N) as it stands over J₀ (N,): J₀ itself where a blade fails and is ``lost`` (N,) without control too.

    A blade that fails under a controller alone keeps its infinite J.
    """
    return np.where(np.isinf(cost) & lost, without_control, cost)


def settling_band(uncontrolled: Episodes) -> Array:
    """(N,), m: 5 % of the greatest distance of the tip's response to the load case from its final position, without control.

    A blade that fails has none: then of the greatest response up to its failure.
    """
    instance("uncontrolled", uncontrolled, Episodes, EPISODES)
    greatest = _excursion(uncontrolled).max(axis=0)
    response = np.nanmax(np.linalg.norm(uncontrolled.load_response, axis=-1), axis=0)
    return SETTLING_BAND * np.where(np.isfinite(greatest), greatest, response)


def _excursion(episodes: Episodes) -> Array:
    """(T, N), m: distance of the load response from its final position, the mean over the episode's last fifth."""
    final = episodes.load_response[int((1.0 - REST) * len(episodes.time)) :].mean(axis=0)
    return np.nan_to_num(np.linalg.norm(episodes.load_response - final, axis=-1), nan=np.inf)  # a blade that failed never settles


def settled_from(excursion: Array, band: Array | float) -> NDArray[np.intp]:
    """(…,): the first of T instants from which on an ``excursion`` (T, …) stays within its ``band`` (…,); T if it does not."""
    outside = excursion > band
    return np.where(outside.any(axis=0), len(outside) - np.argmax(outside[::-1], axis=0), 0)
