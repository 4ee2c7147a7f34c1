"""What ``predict`` is given: whatever no environment and no earlier call gives is refused in one sentence."""

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import lqg, lqr, mpc, no_control, positive_position_feedback, scheduled_lqg_for


@pytest.fixture(name="laws", scope="module")
def _laws():
    design = gymnasium.make(beamenv.ENV_ID, blade={"model": "thesis"}).unwrapped.design
    plant = design.plant
    made = (no_control(plant), lqg(plant), lqr(plant), mpc(plant), positive_position_feedback(plant))
    return [*made, scheduled_lqg_for(design.config, [190.0, 210.0])]


def asked(law, rows=2):
    return np.full((rows, law.instruments.measurement_scale.size), 0.01)


@pytest.mark.parametrize(
    "observation",
    [
        "x",
        None,
        {},
        [["a"]],
        [[1.0, 2.0], [3.0]],
        ["0.1"] * 4,
        [True] * 4,
        np.zeros(4, complex),
        [1j] * 4,
        object(),
        b"1234",
        np.array("x"),
    ],
)
def test_what_holds_no_numbers_is_no_observation(laws, observation):
    for law in laws:
        with pytest.raises(ValueError, match="^observation (is|has shape) ") as told:
            law.predict(observation)
        assert "\n" not in str(told.value)


@pytest.mark.parametrize("shape", [(), (0,), (3,), (2, 3), (2, 2, 4)])
def test_an_observation_of_another_shape_is_told_its_own(laws, shape):
    for law in laws:
        with pytest.raises(
            ValueError,
            match=f"^observation has shape .*, but {law.name}.* takes .* vectors of length".replace("(", r"\(").replace(")", r"\)"),
        ):
            law.predict(np.zeros(shape))


@pytest.mark.parametrize(
    "state", ["x", 3, {}, [], [[1.0]], np.zeros(3), np.zeros((2, 1)), np.zeros((3, 22)), np.full((2, 22), "1"), (1, 2)]
)
def test_a_state_that_no_predict_returned_is_refused(laws, state):
    for law in laws:
        with pytest.raises(ValueError, match="^state is .*, but must be None, or what predict returned last, numbers of shape"):
            law.predict(asked(law), state)


@pytest.mark.parametrize("starts", ["x", "ab", {}, 3, np.zeros(3), [1, 2, 3], [None, None], ["a", "b"], [[True]]])
def test_starts_that_are_not_one_a_blade_are_refused(laws, starts):
    for law in laws:
        memory = law.predict(asked(law))[1]
        if memory is not None:
            with pytest.raises(ValueError, match="^episode_start is .*, but must be None, or 2 of True and False, one a blade"):
                law.predict(asked(law), memory, starts)


def test_lists_single_precision_and_whole_numbers_are_numbers(laws):
    for law in laws:
        expected = law.predict(np.ones(asked(law).shape))[0]
        for given in (np.ones(asked(law).shape).tolist(), np.ones(asked(law).shape, np.float32), np.ones(asked(law).shape, int)):
            np.testing.assert_array_equal(law.predict(given)[0], expected)


def test_a_blade_that_begins_anew_forgets_and_the_other_does_not(laws):
    law = laws[1]
    _, memory = law.predict(asked(law))
    alone = law.predict(asked(law, 1)[0])[0]
    for starts in ([True, False], np.array([1, 0]), np.array([[1.0], [0.0]])):
        action = law.predict(asked(law), memory, starts)[0]
        np.testing.assert_allclose(action[0], alone, rtol=1e-12)
        assert not np.allclose(action[1], alone, rtol=1e-6)
