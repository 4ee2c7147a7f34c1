"""Every controller, classical or learned, on the same episodes: estimates with bootstrap intervals over paired seeds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import VectorEnv

from baselines.design.controller import Array, ControllerArgument, as_controller, name_of
from baselines.evaluation.episodes import Episodes, Progress, checked_seeds, roll_out
from baselines.evaluation.loop import Environment
from baselines.evaluation.metrics import EpisodeMetrics, finite, measure, settling_band
from baselines.evaluation.statistics import Estimate, interval, paired_draws
from beamenv.configuration import Number, checked

WIDEST_BATCH = 1024


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Evaluation:
    """How one controller did on N seeds, beside no control on the same seeds."""

    name: str
    confidence: float
    """Of every interval, 0.95 unless asked otherwise."""
    relative_cost: Estimate
    """J over J without control: ratio of the means, its interval from seeds resampled in pairs."""
    cost: Estimate
    """J, J s."""
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
        }


def evaluate(
    controller: ControllerArgument,
    env: Environment | str,
    seeds: Sequence[int] = range(64),
    *,
    reference: Episodes | None = None,
    confidence: float = 0.95,
    progress: Progress | None = None,
) -> Evaluation:
    """Run a controller through one episode for each seed and compare it with no control on the very same episodes.

    ``controller`` is a law of this package, an SB3 model or anything else with SB3's ``predict``, or a plain function that is
    called with the observations (N, p) of all blades and returns their actions (N, m); a law that ``observes`` the "state" is given
    the true state. ``env`` is an environment, a vector environment (wrapped as the controller needs it) or the id of one.
    ``reference`` spares the run without control: the ``reference`` of an evaluation on the same seeds and environment.
    ``progress(done, total)`` is called as episodes of this controller finish. Raises ValueError for what is no
    controller, no seeds, a confidence outside (0, 1) or a reference with other seeds.
    """
    confidence, seeds = checked("confidence", confidence, Number(gt=0.0, lt=1.0)), checked_seeds(seeds)
    if isinstance(env, str):
        made: VectorEnv[Any, Any, Any] = gym.make_vec(env, num_envs=max(1, min(len(seeds), WIDEST_BATCH)))
        try:
            return evaluate(controller, made, seeds, reference=reference, confidence=confidence, progress=progress)
        finally:
            made.close()
    controller = as_controller(controller)
    episodes = roll_out(controller, env, seeds, progress)
    if reference is None:
        reference = roll_out(_idle(env), env, seeds)
    elif reference.seeds != episodes.seeds:
        raise ValueError(f"reference has seeds {_abridged(reference.seeds)}, but the evaluation has {_abridged(episodes.seeds)}")
    metrics = measure(episodes, settling_band(reference))
    estimates = _estimates(metrics, np.nansum(reference.cost, axis=0), confidence)
    return Evaluation(name_of(controller), confidence, metrics=metrics, episodes=episodes, reference=reference, **estimates)


def _estimates(metrics: EpisodeMetrics, reference_cost: Array, confidence: float) -> dict[str, Estimate]:
    draws = paired_draws(len(reference_cost))

    def estimate(values: Array, over: Array | None = None) -> Estimate:
        value, resampled = values.mean(), values[draws].mean(axis=1)
        if over is not None:
            value, resampled = value / over.mean(), resampled / over[draws].mean(axis=1)
        return interval(value, resampled, confidence)

    each = {name: estimate(getattr(metrics, name)) for name in metrics.__dataclass_fields__}
    return {"relative_cost": estimate(metrics.cost, reference_cost), **each}


def _idle(env: Environment) -> Callable[[Any], Array]:
    """No control where no plant is known: zero actions of the environment's shape."""
    shape = (env.single_action_space if isinstance(env, VectorEnv) else env.action_space).shape or ()
    return lambda observation: np.zeros((len(observation), *shape))


def _abridged(seeds: tuple[int, ...]) -> str:
    return str(seeds) if len(seeds) <= 4 else f"({seeds[0]}, {seeds[1]}, …, {seeds[-1]})"
