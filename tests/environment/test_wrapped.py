"""What the wrappers may be put around."""

import gymnasium
import numpy as np
import pytest

import beamenv
from beamenv import PlacementWrapper, SensorHistory, VectorPlacementWrapper, VectorSensorHistory

SHORT = {"duration": 0.01}  # 20 control intervals


def single():
    return gymnasium.make(beamenv.ENV_ID, **SHORT)


def batch(**arguments):
    return gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **SHORT, **arguments)


WRAPPED = {
    "rescaled": lambda: gymnasium.wrappers.RescaleObservation(single(), np.float32(0.0), np.float32(1.0)),
    "stacked": lambda: gymnasium.wrappers.FrameStackObservation(single(), 4),
    "stacked and flat": lambda: gymnasium.wrappers.FlattenObservation(gymnasium.wrappers.FrameStackObservation(single(), 4)),
    "itself": lambda: SensorHistory(single()),
    "normalised": lambda: gymnasium.wrappers.NormalizeObservation(single()),
    "transformed": lambda: gymnasium.wrappers.TransformObservation(single(), lambda shown: 2.0 * shown, None),
    "late": lambda: gymnasium.wrappers.DelayObservation(single(), 2),
    "skipping": lambda: gymnasium.wrappers.MaxAndSkipObservation(single(), 2),
    "sticky": lambda: gymnasium.wrappers.StickyAction(single(), 0.5),
    "resetting itself": lambda: gymnasium.wrappers.Autoreset(single()),
    "with the time": lambda: gymnasium.wrappers.TimeAwareObservation(single()),
    "cart": lambda: gymnasium.make("CartPole-v1"),
    "nothing": lambda: None,
    "a class": lambda: beamenv.RotatingBeamEnv,
}


WRAPPED_BATCHES = {
    "rescaled": lambda: gymnasium.wrappers.vector.RescaleObservation(batch(), np.float32(0.0), np.float32(1.0)),
    "itself": lambda: VectorSensorHistory(batch()),
    "normalised": lambda: gymnasium.wrappers.vector.NormalizeObservation(batch()),
    "carts": lambda: gymnasium.make_vec("CartPole-v1", num_envs=2),
    "one by one": lambda: gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, vectorization_mode="sync"),
    "single": single,
    "nothing": lambda: "envs",
}


@pytest.mark.parametrize("wrapper", [SensorHistory, PlacementWrapper])
@pytest.mark.parametrize("within", WRAPPED)
def test_a_wrapper_is_put_around_blades_that_show_their_readings(within, wrapper):
    env = WRAPPED[within]()
    with pytest.raises(ValueError, match="^env is .*, but must be (an environment with a blade|one that shows)") as told:
        wrapper(env)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize("wrapper", [VectorSensorHistory, VectorPlacementWrapper])
@pytest.mark.parametrize("within", WRAPPED_BATCHES)
def test_a_wrapper_is_put_around_batches_that_show_their_readings(within, wrapper):
    envs = WRAPPED_BATCHES[within]()
    with pytest.raises(ValueError, match="^env is .*, but must be (a batch of blades|one that shows)"):
        wrapper(envs)


@pytest.mark.parametrize("wrapper", [VectorSensorHistory, VectorPlacementWrapper])
def test_a_batch_of_tensors_has_wrappers_of_its_own(wrapper):
    pytest.importorskip("torch")
    with pytest.raises(ValueError, match="^env is .*, but must be a batch of tensors, such as beamenv.torch_vec makes"):
        beamenv.TorchSensorHistory(batch())
    with pytest.raises(ValueError, match="^env is .*, but must be a batch of NumPy's arrays, such as gymnasium.make_vec makes"):
        wrapper(beamenv.torch_vec(2, device="cpu", **SHORT))


def test_patches_are_placed_once():
    with pytest.raises(ValueError, match="^env is .*, but must be one whose patches no other wrapper places"):
        PlacementWrapper(PlacementWrapper(single()))
    with pytest.raises(ValueError, match="^env is .*, but must be one whose patches no other wrapper places"):
        VectorPlacementWrapper(VectorPlacementWrapper(batch()))


def test_a_history_may_be_put_around_what_changes_only_actions_or_rewards():
    rescaled = gymnasium.wrappers.RescaleAction(single(), np.float32(0.0), np.float32(1.0))
    env = SensorHistory(gymnasium.wrappers.NormalizeReward(rescaled), 2)
    env.reset(seed=0)
    observation = env.step(np.full(4, 0.75, np.float32))[0]
    np.testing.assert_allclose(observation[-4:], 0.5)


def test_a_masked_reset_forgets_the_past_of_its_blades_alone():
    envs = VectorSensorHistory(batch(autoreset_mode="Disabled"), length=3)
    envs.reset(seed=[1, 2])
    for _ in range(4):
        before = envs.step(np.full((2, 4), 0.5))[0]
    after, _ = envs.reset(options={"reset_mask": np.array([True, False])})
    np.testing.assert_array_equal(after[1], before[1])
    assert not after[0, :16].any()
    assert envs.step(np.zeros((2, 4)))[0][0, 8:12].any()
