"""A state of a batch that was made otherwise is refused by one sentence, and nothing has changed."""

import gymnasium
import numpy as np
import pytest

import beamenv

SMALL = {"modes": 4, "truth_modes": 4, "beam": {"terms": 8}}
OTHERS = {"fewer blades": {"num_envs": 1}, "other numbers": {"dtype": "float64"}, "other electronics": {"scenario": "delay"}}


def made_of_arrays(**changes):
    return gymnasium.make_vec(beamenv.ENV_ID, **{"num_envs": 3, "dtype": "float32", "blade": SMALL, **changes})


def made_of_tensors(**changes):
    pytest.importorskip("torch")
    return beamenv.torch_vec(**{"num_envs": 3, "blade": SMALL, "device": "cpu", **changes})


def histories(kind):
    if kind is made_of_arrays:
        return beamenv.VectorSensorHistory
    from beamenv.envs.torch_history import TorchSensorHistory

    return TorchSensorHistory


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("kind", [made_of_arrays, made_of_tensors])
def test_the_state_of_another_batch_is_refused_whole(kind, other):
    envs, others, untouched = kind(), kind(**OTHERS[other]), kind()
    for seed, each in ((1, envs), (1, untouched), (2, others)):
        each.reset(seed=seed)
    with pytest.raises(ValueError, match=r"^state.* as of an equally made batch[.]$"):
        envs.unwrapped.load_state_dict(others.unwrapped.state_dict())
    actions = np.zeros((3, 4))
    for _ in range(3):
        assert np.array_equal(np.asarray(envs.step(actions)[0]), np.asarray(untouched.step(actions)[0]))


@pytest.mark.parametrize("kind", [made_of_arrays, made_of_tensors])
@pytest.mark.parametrize("state", [{}, 3, None, {"blades": 1}])
def test_what_is_no_state_is_refused(kind, state):
    envs = kind()
    envs.reset(seed=1)
    with pytest.raises(ValueError, match=r"^state is .*, but must be .*blades.*, as of an equally made batch[.]$"):
        envs.unwrapped.load_state_dict(state)


@pytest.mark.parametrize("kind", [made_of_arrays, made_of_tensors])
@pytest.mark.parametrize("count", [1, 2])
def test_the_windows_of_fewer_blades_are_refused(kind, count):
    wrapped = histories(kind)
    envs, others = wrapped(kind(), 3), wrapped(kind(num_envs=count), 3)
    envs.reset(seed=1)
    others.reset(seed=1)
    with pytest.raises(ValueError, match=r"^state\['window'\] is of shape .*, but must be of shape \(3, 24\)"):
        envs.load_state_dict(others.state_dict())


def test_a_state_goes_by_way_of_lists():
    envs = made_of_arrays(dtype="float64")
    envs.reset(seed=1)
    state = envs.unwrapped.state_dict()
    first = envs.step(np.zeros((3, 4)))[0]
    envs.unwrapped.load_state_dict({**state, "elapsed": state["elapsed"].tolist(), "over": state["over"].tolist()})
    assert np.array_equal(envs.step(np.zeros((3, 4)))[0], first)


def test_a_sparse_action_is_refused():
    torch = pytest.importorskip("torch")
    envs = made_of_tensors()
    envs.reset(seed=1)
    with pytest.raises(ValueError, match="^action is .*, but must be a dense tensor of real numbers[.]$"):
        envs.step(torch.zeros(3, 4).to_sparse())
