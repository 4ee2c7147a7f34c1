"""Episodes recorded through the Gymnasium API alone: any controller, one environment or a batch, paired by seed."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

import numpy as np
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from baselines.design.controller import Array, Controller, ControllerArgument, as_controller
from baselines.evaluation.conditions import Conditions, conditions, steps
from baselines.evaluation.fit import check_fit
from baselines.evaluation.loop import INFO, Environment, attribute, instants
from beamenv.configuration import Count, Number, Numbers, Refused, checked, shown

MOST_SEEDS = 10**6
SEEDS = Numbers(Count(0, 2**63 - 1), least=1, of="seeds")
NO_LOAD = {"load": {"case": "none"}}
"""Options of a reset: what is left is the tremor under white load and sensor noise."""
Progress = Callable[[int, int], None]


@dataclass(frozen=True, slots=True, eq=False)
class Episodes:
    """What N blades did over the T control intervals of a whole episode. After a blade has failed its entries are NaN."""

    seeds: tuple[int, ...]
    cost: Array
    """(T, N), J s: increments of J."""
    effort: Array
    """(T, N), J s: the actuators' share of them."""
    tip_displacement: Array
    """(T, N, q), m, at the end of each interval: lag and flap; for your own model, as many displacements as it has, or none."""
    load_response: Array
    """(T, N, q), m: the part of the displacement that the load case causes, without the tremor from white load and sensor noise:
    the tip displacement minus that of a second run on the same seed without the load case."""
    voltages: Array
    """(T, N, m), V: as asked for, within the drive limits; what delay, hysteresis or failure make of them is not recorded."""
    failed: NDArray[np.bool_]
    """(N,): the episode was terminated before its time limit."""
    voltage_limits: Array
    """(2, m), V."""
    interval: float
    """s."""
    conditions: Conditions | None = field(default=None, repr=False)
    """The further conditions of the episodes; None if the environment does not say."""

    def __post_init__(self) -> None:
        """``ValueError`` for series whose shapes are not those of N seeds, T control intervals and m voltages."""
        seeds, intervals, actuators = len(self.seeds), len(np.atleast_1d(self.cost)), np.shape(self.voltage_limits)[-1:]
        of_blades, points = (intervals, seeds), (*np.shape(self.tip_displacement), 2, 2, 2)[2]
        for name, shape in (
            ("cost", of_blades),
            ("effort", of_blades),
            ("tip_displacement", (*of_blades, points)),
            ("load_response", (*of_blades, points)),
            ("voltage_limits", (2, *actuators)),
            ("voltages", (*of_blades, *actuators)),
            ("failed", (seeds,)),
        ):
            series = getattr(self, name)
            if not isinstance(series, np.ndarray) or series.shape != shape or series.dtype.kind not in "bf":
                form = f"has shape {series.shape}" if isinstance(series, np.ndarray) else f"is {shown(series)}"
                raise ValueError(f"episodes.{name} {form}, but must be an array of numbers in shape {shape}.")
        if self.failed.dtype != np.bool_:
            raise Refused("episodes.failed", self.failed, "an array of True and False")
        checked("episodes.interval", self.interval, Number(gt=0.0, unit="s"))

    @property
    def time(self) -> Array:
        """(T,), s, since the reset."""
        return np.asarray(self.interval * np.arange(1, len(self.cost) + 1))


def checked_seeds(seeds: Any) -> tuple[int, ...]:
    """Seeds of episodes; ``ValueError`` unless they are a range or a list of one or more whole numbers, a million at most."""
    if isinstance(seeds, (range, list, tuple)) and seeds[MOST_SEEDS:]:
        raise Refused("seeds", seeds, f"a list of one or more seeds, at most {MOST_SEEDS}")
    checked_list: tuple[int, ...] = checked("seeds", list(seeds) if isinstance(seeds, range) else seeds, SEEDS)
    return checked_list


def checked_progress(progress: Any) -> Progress | None:
    """What is called as episodes finish, or None; ``ValueError`` for what cannot be called."""
    if progress is None or (callable(progress) and _takes_two(progress)):
        return progress
    raise Refused("progress", progress, "None, or a function of the number done and their total")


def _takes_two(function: Callable[..., Any]) -> bool:
    """Whether a function can be called with two arguments, as far as it tells."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # some that are written in C
        return True
    try:
        signature.bind(0, 0)
    except TypeError:
        return False
    return True


def roll_out(controller: ControllerArgument, env: Environment, seeds: Sequence[int], progress: Progress | None = None) -> Episodes:
    """Run one episode for each seed. Equal seeds mean equal loads and noise, so that controllers can be compared in pairs.

    ``controller`` is a controller of this package, anything with SB3's ``predict``, or a function from observations (N, p) to
    actions (N, m). Each seed is run twice, the second time for ``Episodes.load_response``. ``env`` is one environment or a batch,
    filled as often as it takes; it is reset but not closed. ``progress`` is called with the number of episodes done and their
    total. Raises ValueError for no seeds, for what is no controller, and for one that does not fit the environment.
    """
    controller, seeds, progress = as_controller(controller), checked_seeds(seeds), checked_progress(progress)
    check_fit(controller, env)
    width = env.num_envs if isinstance(env, VectorEnv) else 1
    parts: list[list[Array]] = []
    under: Conditions | None = None
    for first in range(0, len(seeds), width):
        batch = seeds[first : first + width]
        padded = batch + batch[-1:] * (width - len(batch))
        loaded, unloaded = (recorded(controller, env, padded, options) for options in (None, NO_LOAD))
        parts.append([series[:, : len(batch)] for series in (*loaded, unloaded[2])])
        known = conditions(env, len(batch))
        under = known if under is None or known is None else under.and_then(known)
        if progress is not None:
            progress(first + len(batch), len(seeds))
    return of_series(seeds, tuple(_side_by_side(series) for series in zip(*parts, strict=True)), env, under)


def of_series(seeds: tuple[int, ...], series: tuple[Array, ...], env: Environment, under: Conditions | None) -> Episodes:
    """Episodes of what was ``recorded`` of these seeds, and of the tip (T, N, q) without the load case behind it."""
    length = max(steps(env), *(len(each) for each in series))
    cost, effort, tip, voltages, failed, tremor = (_continued(each, length) for each in series)
    plant = attribute(env, "plant")[0]
    return Episodes(
        seeds=seeds,
        cost=cost,
        effort=effort,
        tip_displacement=tip,
        load_response=tip - tremor,
        voltages=voltages,
        failed=np.nansum(failed, axis=0) > 0,
        voltage_limits=plant.voltage_limits,
        interval=plant.control_interval,
        conditions=under,
    )


def recorded_to_the_end(series: Array) -> bool:
    """Whether a series (T, N) of each blade begins with a number and has no gaps: NaN only once its episode is over."""
    known = ~np.isnan(series)
    return bool(known[0].all() and not (known[1:] & ~known[:-1]).any())


def recorded(
    controller: Controller, env: Environment, seeds: tuple[int, ...], options: dict[str, Any] | None = None
) -> tuple[Array, ...]:
    """Cost, effort (T, N), tip (T, N, q), voltages (T, N, m) and failures (T, N) of one episode each, NaN once it is over."""
    steps = []
    for instant in islice(instants(controller, env, seeds, options), 1, None):
        recorded, running = (*(instant.info[name] for name in INFO), instant.failed), instant.running
        steps.append(tuple(np.where(running.reshape(-1, *[1] * (series.ndim - 1)), series, np.nan) for series in recorded))
    return tuple(np.stack(series) for series in zip(*steps, strict=True))


def _side_by_side(parts: Sequence[Array]) -> Array:
    """Records (T, N, …) beside each other along N, continued to the longest."""
    length = max(len(part) for part in parts)
    return np.concatenate([_continued(part, length) for part in parts], axis=1)


def _continued(part: Array, length: int) -> Array:
    """A record (T, N, …) continued with NaN."""
    return np.concatenate([part, np.full((length - len(part), *part.shape[1:]), np.nan)])
