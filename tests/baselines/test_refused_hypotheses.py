"""Hypotheses and laws of many models that cannot be."""

from dataclasses import replace

import numpy as np
import pytest

from baselines import Hypothesis, MultipleModel, lqg, multiple_model
from tests.baselines.hypotheses import OPEN, slower


@pytest.fixture(name="plant", scope="module")
def _plant(small_plant):
    return small_plant(**OPEN)


def test_instruments_that_differ_and_what_is_no_hypothesis_are_refused(plant, small_plant):
    one = Hypothesis(plant)
    other = small_plant()
    for given, words in (
        ([], "hypotheses is"),
        (one, "hypotheses is"),
        ([one, plant], "hypotheses is"),
        ([one, Hypothesis(other)], "hypotheses have plants that differ in sensor_full_scale"),
    ):
        with pytest.raises(ValueError, match=f"^{words}"):
            multiple_model(given)
    for named, words in (
        ({"fallback": 3}, "fallback is 3, but must be None or a LinearController"),
        ({"fallback": lqg(other)}, "fallback has another voltage_limits than the hypotheses"),
        ({"transition": [[0.5]]}, r"transition is \[\[0.5\]\], but must be probabilities"),
        ({"transition": np.eye(2)}, r"transition has shape \(2, 2\)"),
        ({"floor": 1.0}, "floor is 1.0"),
        ({"window": 0}, "window is 0"),
        ({"confidence": 1.0}, "confidence is 1.0"),
        ({"allowance": -1.0}, "allowance is -1.0"),
        ({"rate_weight": -1.0}, "rate_weight is -1.0"),
        ({"verify": 1}, "verify is 1"),
    ):
        with pytest.raises(ValueError, match=f"^{words}"):
            multiple_model([one], **named)
    with pytest.raises(ValueError, match="^hypotheses have other plants or loads"):
        multiple_model([one, Hypothesis(slower(plant))], transition=np.eye(2))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"plant": None}, "plant is None, but must be a beamenv.Plant"),
        ({"delay": -1}, "delay is -1"),
        ({"delay": 0.5}, "delay is 0.5"),
        ({"actuator_gain": [1.0, 2.0]}, r"actuator_gain is \[1.0, 2.0\], but must be a number from 0 to 1"),
        ({"sensor_gain": [1.0]}, r"sensor_gain = \[1.0\] must be a finite number, or 2 of them"),
        ({"sensor_bias": -0.1}, "sensor_bias is"),
        ({"load": 3}, "load is 3"),
        ({"deflection": np.inf}, "deflection is inf"),
        ({"prior": 0.0}, "prior is 0.0"),
        ({"holds_lost_readings": None}, "holds_lost_readings is None"),
    ],
)
def test_a_hypothesis_that_cannot_be_is_refused(plant, changes, words):
    with pytest.raises(ValueError, match=f"^{words}"):
        Hypothesis(**{"plant": plant, **changes})


def test_parts_of_a_multiple_model_law_that_do_not_fit_are_told(plant):
    law = multiple_model([Hypothesis(plant)])
    assert isinstance(law, MultipleModel)
    for changes, words in (
        ({"bank": None}, "bank is None"),
        ({"prior": [1.0, 2.0]}, r"prior has shape \(2,\)"),
        ({"state_gain": np.zeros((1, 2, 5))}, r"state_gain has shape \(1, 2, 5\)"),
    ):
        with pytest.raises(ValueError, match=f"^{words}"):
            replace(law, **changes)
