"""One bank of hypotheses for every scenario: what may be the case in any of those that rules may learn on."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import lru_cache

from baselines import Hypothesis, MultipleModel, multiple_model
from baselines.laws.detuned_lqg import CAUTIOUS, detuned_lqg
from beamenv.blade.build import Blade
from beamenv.blade.model_blade import ModelBlade
from beamenv.knowledge import Prior, on_training_bank
from beamenv.scenarios.named import NAMES, UNSEEN
from beamenv.scenarios.of_models import fits_models
from beamenv.scenarios.scenario import SCENARIOS
from train.controllers.hypotheses import BETWEEN, MOST, hypotheses_of, varies

SEEN: tuple[str, ...] = tuple(name for name in NAMES if name not in UNSEEN)
"""The scenarios whose files it is made of."""


def general_hypotheses(blade: Blade) -> list[Hypothesis]:
    """What may be the case with the blade in any of ``SEEN``, each as likely as any other: ``MOST`` at most, if there is room.

    All delays and faults of the scenarios where the plant is the blade's own; scenarios of other plants share the rest evenly. Two
    that differ in the deflection at the start alone are one. A reading that is shown again exactly may be a lost one in any.
    """
    seen = [name for name in SEEN if not isinstance(blade, ModelBlade) or fits_models(SCENARIOS[name])]
    told = [Prior(blade, blade, on_training_bank(SCENARIOS[name]), steps=1) for name in seen]
    own = _unlike(each for prior in told if not varies(prior) for each in hypotheses_of(prior))
    others = [prior for prior in told if varies(prior)]
    share = max(2, (MOST - len(own)) // max(len(others), 1))
    those = [*own, *(each for prior in others for each in hypotheses_of(prior, share))]
    return sorted(_unlike(those), key=lambda each: len(each.loads))


@lru_cache(maxsize=4)
def general_law(blade: Blade) -> MultipleModel:
    """The multiple-model law over them, and the cautious LQG where none of them fits; one for all that ask with an equal blade.

    It reckons in single precision, as the agents that add to it were trained.
    """
    fallback = detuned_lqg(blade.truth, CAUTIOUS, name="cautious LQG")
    return multiple_model(general_hypotheses(blade), fallback, rate_weight=BETWEEN).in_single_precision()


def _unlike(those: Iterable[Hypothesis]) -> list[Hypothesis]:
    found: dict[tuple[object, ...], Hypothesis] = {}
    for each in those:
        found.setdefault(_what(each), replace(each, holds_lost_readings=True, prior=1.0))
    return list(found.values())


def _what(each: Hypothesis) -> tuple[object, ...]:
    """Its plant and what is wrong with it, and the loads."""
    wrong = (each.actuator_gain, each.sensor_gain, each.sensor_bias)
    return id(each.plant), each.delay, *(array.tobytes() for array in wrong), each.loads
