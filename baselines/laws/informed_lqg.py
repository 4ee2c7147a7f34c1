"""LQG for a scenario: one automatic rule chooses, on blades of the scenario's distribution, what its design is told."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from baselines.design.delay import MOST_LATE
from baselines.design.linear import LinearController
from baselines.design.objects import instance
from baselines.laws.detuned_lqg import Detuning, detuned_lqg
from baselines.laws.detuning_search import LOST, TRIALS, coordinate_search, kept_detuning
from baselines.laws.foreseen_load import foreseen_loads
from beamenv.blade.files import departures
from beamenv.blade.model_blade import ModelBlade
from beamenv.configuration.cache import departing
from beamenv.knowledge import Prior
from beamenv.plant.fingerprint import fingerprint
from beamenv.scenarios.scenario import Scenario

VERSION = 1
"""Of the rule: a new number discards what was kept."""

EPISODES = 64
"""Of tuning: on plants of the training bank, with the first seeds from ``beamenv.knowledge.TUNING`` on."""

SHIPPED = Path(__file__).with_name("informed_lqg.csv")
"""What the rule chose for the default blade in the scenarios that ship, each with its key."""


def informed_lqg(prior: Prior) -> LinearController:
    """The ``detuned_lqg`` of the plant that the scenario's plants vary about, with the ``Detuning`` of ``chosen_detuning``.

    Raises ``ValueError`` for what is no ``Prior``.
    """
    prior = instance("prior", prior, Prior, "a beamenv.Prior, such as env.unwrapped.task.prior")
    return _law(prior, chosen_detuning(prior))


def chosen_detuning(prior: Prior) -> Detuning:
    """What the rule chooses: as it shipped or was kept in the user's cache, or searched for now, which takes a minute or two."""
    return kept_detuning("informed-lqg", SHIPPED, _depends_on(prior), lambda: searched_detuning(prior)[0])


def searched_detuning(prior: Prior) -> tuple[Detuning, dict[Detuning, float]]:
    """The best of a coordinate search, and what each design that was tried costs, J / J₀ on the episodes of tuning.

    It starts from the mean delay of the scenario and the reference's weights, with loads foreseen where there are any.
    """
    loads = bool(_loads(prior))
    start = Detuning(delay=min(MOST_LATE, round(sum(prior.scenario.drive.delay) / 2.0)), foresees=loads)
    return coordinate_search(_cost(prior), start, loads, TRIALS)


def _loads(prior: Prior) -> tuple[Any, ...]:
    return foreseen_loads(prior.scenario, prior.blade.config.speed, prior.blade.truth.loads)


def _law(prior: Prior, detuning: Detuning) -> LinearController:
    return detuned_lqg(prior.blade.truth, detuning, *_loads(prior), name="informed LQG")


def _cost(prior: Prior) -> Callable[[Detuning], float]:
    """J / J₀ in the mean over the episodes of tuning; infinite where there is no such design."""
    without = _mean_cost(prior, None, 1.0)

    def cost(detuning: Detuning) -> float:
        try:
            return _mean_cost(prior, _law(prior, detuning), without) / without
        except ValueError:
            return float("inf")

    return cost


def _mean_cost(prior: Prior, law: LinearController | None, without: float) -> float:
    blades, generators = prior.blades(EPISODES), prior.generators(EPISODES)
    motion, memory, total = blades.begin(generators), None, np.zeros(EPISODES)
    idle, failed = np.zeros((EPISODES, prior.bank.plant.B.shape[1])), np.zeros(EPISODES, dtype=bool)
    for _ in range(prior.steps):
        action = idle
        if law is not None:
            action, memory = law.predict(motion.observation, memory)
        motion = blades.step(action, generators)
        failed |= motion.failed
        total += np.where(failed, 0.0, motion.cost_increment)
    return float(np.where(failed & (law is not None), LOST * without, total).mean())


def _depends_on(prior: Prior) -> tuple[Any, ...]:
    return (
        (VERSION, EPISODES, TRIALS, prior.steps),
        departing(prior.scenario.to_dict(), Scenario().to_dict()),
        prior.blade.identity if isinstance(prior.blade, ModelBlade) else departures(prior.blade.config),
        fingerprint(prior.blade.truth),
    )
