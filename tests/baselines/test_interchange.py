"""Linear laws to and from state space: the same voltages, the same loop, and what cannot be one is refused in a sentence."""

import control
import numpy as np
import pytest
from scipy import signal

from baselines import Instruments, LinearController, closed_loop_poles, lqg, lqr, no_control, velocity_feedback
from beamenv.plant.plant import sample

LAWS = {
    "LQG": lqg,
    "LQG (thesis)": lambda plant: lqg(plant, "continuous"),
    "LQR": lqr,
    "velocity feedback": velocity_feedback,
}


def voltages(law, size, steps=40):
    """Asked for, one after the other, from random observations."""
    memory, asked = None, []
    for row in size * np.random.default_rng(2).normal(size=(steps, law.instruments.measurement_scale.size)):
        action, memory = law.predict(row, memory)
        asked.append(action)
    return np.array(asked)


def behind(law, plant):
    return {"plant": plant} if law.observes == "observation" else {"instruments": Instruments.of(plant, law.observes)}


@pytest.mark.parametrize("name", LAWS)
def test_a_law_comes_back_from_state_space_as_it_was_limits_included(small_plant, name):
    plant = small_plant()
    law = LAWS[name](plant)
    back = LinearController.from_state_space(law.to_control(), name=law.name, voltage_input=law.voltage_input, **behind(law, plant))
    for field in ("transition", "measurement_input", "voltage_input", "state_gain", "measurement_gain"):
        ours = getattr(law, field)
        np.testing.assert_allclose(getattr(back, field), ours, rtol=1e-9, atol=1e-9 * np.abs(ours).max(initial=0.0))
    for size in (0.002, 5.0):
        np.testing.assert_allclose(voltages(back, size), voltages(law, size), rtol=1e-8, atol=1e-10)


def test_without_the_voltage_applied_a_law_is_the_same_only_until_the_drive_saturates(small_plant):
    plant = small_plant()
    law = lqg(plant)
    back = LinearController.from_state_space(law.to_control(), plant=plant)
    np.testing.assert_allclose(voltages(back, 0.002), voltages(law, 0.002), rtol=1e-8, atol=1e-10)
    assert np.abs(voltages(back, 5.0) - voltages(law, 5.0)).max() > 0.1


def test_the_loop_that_python_control_closes_has_the_same_poles(small_plant):
    plant = small_plant()
    law, held = lqg(plant), sample(plant)
    blade = control.ss(held.A, held.B, held.C, held.D, dt=held.interval)
    loop = control.feedback(blade, law.to_control(), sign=1)
    poles = np.log(loop.poles().astype(complex)) / held.interval
    np.testing.assert_allclose(np.sort_complex(poles), np.sort_complex(closed_loop_poles(plant, law)), rtol=1e-7)


def test_the_response_of_python_control_is_that_of_predict(small_plant):
    plant = small_plant()
    law = lqg(plant)
    readings = 1e-8 * np.random.default_rng(5).normal(size=(2, 30))
    answered = control.forced_response(law.to_control(), None, readings).outputs
    memory, expected = None, []
    for reading in readings.T:
        action, memory = law.in_physical_units().predict(reading, memory)
        expected.append(action)
    np.testing.assert_allclose(answered.T, expected, rtol=1e-8, atol=1e-12)


def test_four_matrices_and_a_transfer_function_serve_as_well(small_plant, scalar_plant):
    static = LinearController.from_state_space(
        np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((2, 0)), -np.eye(2), plant=small_plant()
    )
    np.testing.assert_array_equal(static.measurement_gain, -np.eye(2))
    assert static.predict(np.zeros(2))[1] is None
    plant = scalar_plant()
    integrator = control.tf([1.0, 0.0], [1.0, -1.0], plant.control_interval)
    law = LinearController.from_state_space(integrator, plant=plant, name="sum", verify=False).in_physical_units()
    memory, total = None, []
    for reading in (1.0, 2.0, 3.0):
        action, memory = law.predict([reading], memory)
        total.append(action[0])
    np.testing.assert_allclose(total, [1.0, 3.0, 6.0])


CONTINUOUS = ([[-1.0]], [[1.0, 0.0]], [[1.0], [0.0]], np.zeros((2, 2)))


@pytest.mark.parametrize(
    ("system", "sentence"),
    [
        ([control.ss(*CONTINUOUS)], "dt = 0, but must be in discrete"),
        ([signal.StateSpace(*CONTINUOUS)], "dt = None, but must be in discrete"),
        ([control.ss([], [], [], np.eye(2), dt=1.0)], "dt = 1.0, but .* every 0.0005 s"),
        ([tuple(np.eye(2) for _ in range(4))], "A is .array.*, but must be .* or else one of four arguments A, B, C, D"),
        (
            [np.eye(2)],
            "A is array.*, but must be a discrete-time control.StateSpace where .* four arguments A, B, C, D",
        ),
        ([np.eye(2), np.eye(3), np.eye(2), np.eye(2)], r"B has shape \(3, 3\), but .* shape \(2, 2\)"),
        ([np.eye(2), np.eye(2), np.full((2, 2), np.nan), np.eye(2)], "C .* finite numbers"),
        ([np.eye(2), np.eye(2), "gain", np.eye(2)], "C = 'gain' must be a matrix of real numbers"),
    ],
)
def test_what_is_no_law_of_the_plant_is_refused(small_plant, system, sentence):
    with pytest.raises(ValueError, match=sentence):
        LinearController.from_state_space(*system, plant=small_plant())


def test_a_law_needs_one_set_of_instruments(small_plant):
    plant = small_plant()
    for arguments in ({}, {"plant": plant, "instruments": Instruments.of(plant)}):
        with pytest.raises(ValueError, match="exactly one of them"):
            LinearController.from_state_space(no_control(plant).to_control(), **arguments)
