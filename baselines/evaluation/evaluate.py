"""Every controller, classical or learned, on the same episodes: estimates with bootstrap intervals over paired seeds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from gymnasium.vector import VectorEnv

from baselines.design.controller import Array, ControllerArgument, as_controller, name_of
from baselines.design.objects import instance
from baselines.evaluation.episodes import Episodes, Progress, checked_progress, checked_seeds, recorded_to_the_end, roll_out
from baselines.evaluation.fit import check_fit, made
from baselines.evaluation.loop import Environment
from baselines.evaluation.metrics import EpisodeMetrics, cost_without_control, finite, judged, measure, settling_band
from baselines.evaluation.statistics import Estimate, interval, paired_draws
from beamenv.configuration import Number, checked

WIDEST_BATCH = 1024


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Evaluation:
    """What one controller achieved on N seeds, and what happened without control on the same seeds."""

    name: str
    confidence: float
    """Of every interval, 0.95 unless asked otherwise."""
    relative_cost: Estimate
    """J divided by J without control: the ratio of the means, with an interval from resampling the seeds in pairs.

    A blade that fails under the controller alone makes it infinite; one that fails without control too counts as no better, and one
    that the controller saves is compared with ``uncontrolled``."""
    cost: Estimate
    """J, J s; infinite if a blade fails."""
    effort: Estimate
    """The actuators' share of J, J s."""
    settling_time: Estimate
    """s; an episode that does not settle counts with its whole length."""
    settled: Estimate
    """Share of episodes that do."""
    peak_tip: Estimate
    """m."""
    rms_tip: Estimate
    """m."""
    peak_voltage: Estimate
    """V."""
    rms_voltage: Estimate
    """V."""
    saturation: Estimate
    """Share of actuators and time at a drive limit."""
    metrics: EpisodeMetrics
    """Seed by seed."""
    uncontrolled: Array
    """(N,), J s: J without control, seed by seed. For a blade that fails, the cost of its last interval is charged until the end of
    the episode."""
    episodes: Episodes
    """What was recorded."""
    reference: Episodes
    """The same without control; hand it to the next ``evaluate`` on these seeds to save its time."""

    def __repr__(self) -> str:
        cost, seeds = self.cost, self.episodes.seeds
        return (
            f"Evaluation({self.name!r}: J {cost.value:.4g} [{cost.low:.4g}, {cost.high:.4g}] J s, "
            f"{self.relative_cost.value:.4g} of no control's, {len(seeds)} seeds {_abridged(seeds)})"
        )

    def estimates(self) -> dict[str, Estimate]:
        """Every estimate by name, the relative cost first."""
        return {name: value for name in self.__dataclass_fields__ if isinstance(value := getattr(self, name), Estimate)}

    def row(self) -> dict[str, float | str | None]:
        """One flat table row: name, then value, low and high of each estimate."""
        row: dict[str, float | str | None] = {"controller": self.name}
        for name, estimate in self.estimates().items():
            row |= {
                name: finite(estimate.value),
                f"{name}_low": finite(estimate.low),
                f"{name}_high": finite(estimate.high),
            }
        return row

    def to_dict(self) -> dict[str, Any]:
        """Everything but the time series, as JSON can hold it."""
        return {
            "controller": self.name,
            "confidence": self.confidence,
            "estimates": {
                name: {"value": finite(e.value), "low": finite(e.low), "high": finite(e.high)}
                for name, e in self.estimates().items()
            },
            "seeds": list(self.episodes.seeds),
            "per_seed": self.metrics.to_dict(),
            "uncontrolled": self.uncontrolled.tolist(),
        }

    @property
    def judged_cost(self) -> Array:
        """(N,), J s: J as it stands over ``uncontrolled``, equal to it where the blade fails without control too."""
        return judged(self.metrics.cost, self.uncontrolled, self.reference.failed)


def evaluate(
    controller: ControllerArgument,
    env: Environment | str,
    seeds: Sequence[int] = range(64),
    *,
    reference: Episodes | None = None,
    confidence: float = 0.95,
    progress: Progress | None = None,
) -> Evaluation:
    """Run a controller through one episode for each seed, and compare it with no control on the same episodes.

    - ``controller``: a controller of this package, an SB3 model or another object with SB3's ``predict``, or a plain function from
      the observations (N, p) of all blades to their actions (N, m). A controller that ``observes`` "state" gets the true state.
    - ``env``: an environment, a vector environment (with the wrappers that the controller needs), or an environment's id.
    - ``seeds``: random seeds of the episodes, all different.
    - ``reference``: the ``reference`` of an earlier evaluation on the same episodes, which saves the run without control.
    - ``confidence``: of the intervals, between 0 and 1.
    - ``progress(done, total)``: called whenever episodes of this controller have finished.

    Raises ValueError for what is no controller or does not fit the environment, for wrappers that change actions, for no seeds or
    equal ones, for a confidence outside (0, 1), for a ``reference`` of other episodes, and if nothing moves without control, since
    then there is no cost to compare with.
    """
    confidence, seeds = checked("confidence", confidence, Number(gt=0.0, lt=1.0)), _unlike(checked_seeds(seeds))
    controller, progress = as_controller(controller), checked_progress(progress)
    if isinstance(env, str):
        batch = made(env, max(1, min(len(seeds), WIDEST_BATCH)))
        try:
            return evaluate(controller, batch, seeds, reference=reference, confidence=confidence, progress=progress)
        finally:
            batch.close()
    check_fit(controller, env)
    _check_reference(reference, seeds)
    without = roll_out(_idle(env), env, seeds) if reference is None else reference
    uncontrolled = checked_uncontrolled(without)
    episodes = roll_out(controller, env, seeds, progress)
    _check_pairs(episodes, without)
    metrics = measure(episodes, settling_band(without))
    estimates = _estimates(metrics, judged(metrics.cost, uncontrolled, without.failed), uncontrolled, confidence)
    about = {"metrics": metrics, "uncontrolled": uncontrolled, "episodes": episodes, "reference": without}
    return Evaluation(name_of(controller), confidence, **about, **estimates)  # type: ignore[arg-type]


def _unlike(seeds: tuple[int, ...]) -> tuple[int, ...]:
    """The seeds; ``ValueError`` where one comes twice, for an interval takes its episodes to be independent."""
    if len(set(seeds)) < len(seeds):
        twice = next(seed for k, seed in enumerate(seeds) if seed in seeds[:k])
        raise ValueError(f"seeds has {twice} more than once, but must be unlike each other: equal ones are one episode.")
    return seeds


def checked_uncontrolled(reference: Episodes) -> Array:
    """J₀ (N,), J s; ``ValueError`` where no cost can be relative to it, for nothing moves, or without bounds."""
    cost = cost_without_control(reference)
    if not recorded_to_the_end(reference.cost):
        raise ValueError("reference has costs that are no numbers (NaN) before an episode's end: no cost is relative to them.")
    if not np.isfinite(cost).all():
        raise ValueError("scenario moves the blade without bounds, and J without control is infinite: no cost is relative to it.")
    if not cost.any():
        raise ValueError("scenario moves nothing, and J without control is zero: no cost is relative to it.")
    return cost


def _check_reference(reference: Any, seeds: tuple[int, ...]) -> None:
    if reference is None:
        return
    instance("reference", reference, Episodes, "None, or the reference of an evaluation of the same episodes")
    if reference.seeds != seeds:
        raise ValueError(f"reference has seeds {_abridged(reference.seeds)}, but the evaluation has {_abridged(seeds)}")


def _check_pairs(episodes: Episodes, reference: Episodes) -> None:
    """``ValueError`` unless both are of the same episodes, as far as their environments tell."""
    if episodes.conditions is not None:
        episodes.conditions.check(reference.conditions)
    for what, own, other in (
        ("control intervals of (s)", episodes.interval, reference.interval),
        ("control intervals in an episode", len(episodes.cost), len(reference.cost)),
    ):
        if own != other:
            raise ValueError(f"reference has {what} {other}, but the evaluation has {own}.")


def _estimates(metrics: EpisodeMetrics, cost: Array, uncontrolled: Array, confidence: float) -> dict[str, Estimate]:
    draws = paired_draws(len(cost))

    def estimate(values: Array, over: Array | None = None) -> Estimate:
        value, resampled = values.mean(), values[draws].mean(axis=1)
        if over is not None:
            below = over[draws].mean(axis=1)
            moving = below > 0.0  # an episode in which nothing moves may be drawn alone
            value, resampled = value / over.mean(), resampled[moving] / below[moving]
        return interval(value, resampled, confidence)

    each = {name: estimate(getattr(metrics, name)) for name in metrics.__dataclass_fields__}
    return {"relative_cost": estimate(cost, uncontrolled), **each}


def _idle(env: Environment) -> Callable[[Any], Array]:
    """No control where no plant is known: zero actions of the environment's shape."""
    shape = (env.single_action_space if isinstance(env, VectorEnv) else env.action_space).shape or ()
    return lambda observation: np.zeros((len(observation), *shape))


def _abridged(seeds: tuple[int, ...]) -> str:
    return str(seeds) if len(seeds) <= 4 else f"({seeds[0]}, {seeds[1]}, …, {seeds[-1]})"
