"""LQG for a blade that is not quite as its model says: detuned as far as a bank of modelling errors asks for, by one rule."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from baselines.analysis.stationary import stationary_cost
from baselines.design.linear import LinearController
from baselines.design.modelling_errors import FREQUENCY, SHAPE, modelling_errors
from baselines.design.objects import instance
from baselines.design.persistent_load import PersistentLoad
from baselines.laws.detuned_lqg import Detuning, detuned_lqg
from baselines.laws.detuning_search import LOST, TRIALS, coordinate_search, kept_detuning
from baselines.laws.lqg import sampled_with_loads
from baselines.laws.no_control import no_control
from beamenv.blade.build import Blade
from beamenv.blade.design import Design
from beamenv.blade.files import departures
from beamenv.plant.fingerprint import fingerprint
from beamenv.plant.plant import Plant
from beamenv.plant.spread import Spread, plants_within

VERSION = 1
"""Of the rule: a new number discards what was kept."""

PLANTS = 32
"""In the bank, beside the model itself."""

OF_MODELS = Spread(frequency=0.05, damping=0.5, actuator=0.1, sensor=0.1)
"""Within which the plants lie where the design is a model of one's own, of which no further mode is known."""

SHIPPED = Path(__file__).with_name("robust_lqg.csv")
"""What the rule chose for the design blades of the scenarios that ship, each with its key."""


def robust_lqg(design: Design) -> LinearController:
    """The ``detuned_lqg`` of the design's full plant with the least mean cost over that plant and a bank of ``modelling_errors``.

    The cost is the stationary one under the plants' white loads and a sustained load; a plant on which the loop is unstable counts
    as a hundred times the cost without control. Designs on many plants: Ackermann, IEEE Trans. Automatic Control 25, 1980;
    Vidyasagar, Automatica 37, 2001, for plants drawn at random. The controller knows nothing of any scenario. The search takes
    seconds and is made once for each design. Raises ``ValueError`` for what is no ``Design``.
    """
    design = instance("design", design, Design, "a beamenv.Design, such as env.unwrapped.task.design")
    if design.config is None:
        plant, key = design.full_plant, ((VERSION, PLANTS, TRIALS), repr(OF_MODELS), fingerprint(design.full_plant))
        others = plants_within(plant, OF_MODELS, PLANTS, seed=0)
        found = kept_detuning("robust-lqg", SHIPPED, key, lambda: _searched(plant, others)[0])
        return _law(plant, found)
    blade = Blade(design.config)
    return _law(blade.truth, kept_detuning("robust-lqg", SHIPPED, _depends_on(blade), lambda: searched_detuning(blade)[0]))


def searched_detuning(blade: Blade) -> tuple[Detuning, dict[Detuning, float]]:
    """The best of a coordinate search from the reference's weights on, and what each design that was tried costs, J / J₀."""
    return _searched(blade.truth, modelling_errors(blade, PLANTS))


def _searched(plant: Plant, others: list[Plant]) -> tuple[Detuning, dict[Detuning, float]]:
    return coordinate_search(mean_cost(plant, others), Detuning(), True, TRIALS)


def mean_cost(plant: Plant, others: list[Plant]) -> Callable[[Detuning], float]:
    """Of the law of a plant and a detuning: J / J₀ in the mean over the plant and the ``others``; infinite where there is none."""
    held = [sampled_with_loads(each, PersistentLoad()) for each in (plant, *others)]
    without = np.array([stationary_cost(each, no_control(plant)) for each in held])

    def cost(detuning: Detuning) -> float:
        try:
            law = _law(plant, detuning)
        except ValueError:
            return float("inf")
        return float(np.minimum([stationary_cost(each, law) for each in held] / without, LOST).mean())

    return cost


def _law(plant: Plant, detuning: Detuning) -> LinearController:
    return detuned_lqg(plant, detuning, PersistentLoad(), name="robust LQG")


def _depends_on(blade: Blade) -> tuple[Any, ...]:
    return (VERSION, PLANTS, TRIALS, FREQUENCY, SHAPE), departures(blade.config), fingerprint(blade.truth)
