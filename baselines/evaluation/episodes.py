"""Episodes recorded through the Gymnasium API alone: any controller, one environment or a batch, paired by seed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from baselines.design.controller import Array, Controller, ControllerArgument, as_controller
from baselines.evaluation.loop import INFO, Environment, attribute, check_fit, instants
from beamenv.configuration import Count, Numbers, checked

SEEDS = Numbers(Count(0, 2**63 - 1), least=1, of="seeds")
_NO_LOAD = {"load": {"case": "none"}}
Progress = Callable[[int, int], None]


@dataclass(frozen=True, slots=True, eq=False)
class Episodes:
    """What N blades did over T control intervals; NaN after the end of a blade that failed early."""

    seeds: tuple[int, ...]
    cost: Array
    """(T, N), J s: increments of J."""
    effort: Array
    """(T, N), J s: the actuators' share of them."""
    tip_displacement: Array
    """(T, N, 2), m, at the end of each interval: lag, flap."""
    load_response: Array
    """(T, N, 2), m: the part of it that the load case caused, without the tremor under white load and sensor noise: the tip
    displacement less that of a second run on the same seed, in which the load case is absent."""
    voltages: Array
    """(T, N, m), V: as asked for, within the drive limits; what delay, hysteresis or failure make of them is not recorded."""
    failed: NDArray[np.bool_]
    """(N,): the episode was terminated before its time limit."""
    voltage_limits: Array
    """(2, m), V."""
    interval: float
    """s."""

    @property
    def time(self) -> Array:
        """(T,), s, since the reset."""
        return np.asarray(self.interval * np.arange(1, len(self.cost) + 1))


def checked_seeds(seeds: Any) -> tuple[int, ...]:
    """Seeds of episodes; ``ValueError`` unless they are a range or a list of one or more whole numbers."""
    checked_list: tuple[int, ...] = checked("seeds", list(seeds) if isinstance(seeds, range) else seeds, SEEDS)
    return checked_list


def roll_out(controller: ControllerArgument, env: Environment, seeds: Sequence[int], progress: Progress | None = None) -> Episodes:
    """One episode for each seed. Equal seeds mean equal loads and noise, so that controllers are compared in pairs.

    ``controller`` is a law of this package, anything with SB3's ``predict``, or a function from observations (N, p) to actions
    (N, m). Each seed is run twice, the second time for ``Episodes.load_response``. ``env`` is one environment or a batch, filled as
    often as it takes; it is reset but not closed. ``progress`` is called with the number of episodes done and their total.
    Raises ValueError for no seeds, or for what is no controller.
    """
    controller, seeds = as_controller(controller), checked_seeds(seeds)
    check_fit(controller, env)
    width = env.num_envs if isinstance(env, VectorEnv) else 1
    parts = []
    for first in range(0, len(seeds), width):
        batch = seeds[first : first + width]
        padded = batch + batch[-1:] * (width - len(batch))
        loaded, unloaded = (_run(controller, env, padded, options) for options in (None, _NO_LOAD))
        parts.append([series[:, : len(batch)] for series in (*loaded, unloaded[2])])
        if progress is not None:
            progress(first + len(batch), len(seeds))
    length = max(len(series) for part in parts for series in part)
    cost, effort, tip, voltages, failed, tremor = (_side_by_side(series, length) for series in zip(*parts, strict=True))
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
    )


def _run(controller: Controller, env: Environment, seeds: tuple[int, ...], options: dict[str, Any] | None) -> tuple[Array, ...]:
    """Cost, effort (T, N), tip (T, N, 2), voltages (T, N, m) and failures (T, N) of one episode each, NaN once it is over."""
    steps = []
    for instant in islice(instants(controller, env, seeds, options), 1, None):
        recorded, running = (*(instant.info[name] for name in INFO), instant.failed), instant.running
        steps.append(tuple(np.where(running.reshape(-1, *[1] * (series.ndim - 1)), series, np.nan) for series in recorded))
    return tuple(np.stack(series) for series in zip(*steps, strict=True))


def _side_by_side(parts: Sequence[Array], length: int) -> Array:
    """Records (T, N, …) beside each other along N, continued with NaN to the same length."""
    return np.concatenate(
        [np.concatenate([part, np.full((length - len(part), *part.shape[1:]), np.nan)]) for part in parts], axis=1
    )
