"""The noise-free response of a linear loop is what its ``predict`` does step by step, saturated or not."""

import numpy as np
import pytest

from baselines import PersistentLoad, clipped_lqg, lqg, lqr, no_control, positive_position_feedback, velocity_feedback
from baselines.analysis.response import linear_response
from beamenv.plant.plant import sample

LAWS = {
    "no control": no_control,
    "velocity feedback": velocity_feedback,
    "positive position feedback": positive_position_feedback,
    "LQR": lqr,
    "LQR with load estimate": lambda plant: lqr(plant, PersistentLoad()),
    "LQG": lqg,
    "LQG (thesis)": lambda plant: lqg(plant, "continuous"),
}


def loads(size, steps=80):
    """A step in lag, and later one in flap."""
    return size * np.column_stack([np.ones(steps), np.arange(steps) > steps // 2])


@pytest.mark.parametrize("size", [0.5, 300.0])
@pytest.mark.parametrize("name", LAWS)
def test_the_response_is_that_of_predict(small_plant, name, size):
    plant = small_plant()
    law, held = LAWS[name](plant), sample(plant)
    states, voltages = linear_response(held, law, loads(size))
    x, memory = np.zeros(6), None
    for step, load in enumerate(loads(size)):
        np.testing.assert_allclose(states[step], x, rtol=1e-8, atol=1e-9 * np.abs(states).max())
        action, memory = law.predict(x if law.observes == "state" else held.C @ x / plant.sensor_full_scale, memory)
        volts = action * law.instruments.voltage_scale
        np.testing.assert_allclose(voltages[step], volts, rtol=1e-8, atol=1e-9 * max(np.abs(voltages).max(), 1.0))
        x = held.A @ x + held.B @ volts + held.disturbance_input @ load
    if size > 1.0 and "LQ" in name:
        assert (np.isin(voltages, plant.voltage_limits)).any()


def test_under_a_load_that_stays_an_uncontrolled_blade_rests_where_statics_has_it(small_plant):
    plant = small_plant()
    held = sample(plant)
    states, _ = linear_response(held, no_control(plant), np.tile([1.0, 2.0], (30000, 1)))
    np.testing.assert_allclose(states[-1], -np.linalg.solve(plant.A, plant.disturbance_input @ [1.0, 2.0]), rtol=1e-5, atol=1e-8)


def test_a_law_that_is_not_linear_has_none(small_plant):
    plant = small_plant()
    with pytest.raises(ValueError, match=r"controller = LQG, clipping known \(ClippedLQG\) is not linear"):
        linear_response(sample(plant), clipped_lqg(plant), loads(1.0))
