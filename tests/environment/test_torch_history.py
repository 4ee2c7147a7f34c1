"""The history that is shown of a batch of tensors."""

import gymnasium
import numpy as np
import pytest

torch = pytest.importorskip("torch")

import beamenv  # noqa: E402 - of what may be missing
from beamenv import TorchSensorHistory, VectorSensorHistory  # noqa: E402

FAILING = {"duration": 0.02, "scenario": {"magnitude": [100.0, 8000.0], "onset": [0.0, 0.005]}}


def numbers(tensor):
    return tensor.numpy(force=True)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_it_is_that_of_the_batch_of_arrays(mode):
    given = {"num_envs": 5, "autoreset_mode": mode, "dtype": "float64", **FAILING}
    arrays = VectorSensorHistory(gymnasium.make_vec(beamenv.ENV_ID, **given), length=6)
    envs = TorchSensorHistory(beamenv.torch_vec(device="cpu", **given), length=6)
    assert envs.observation_space.shape == arrays.observation_space.shape
    seeds, over, ends = [3, 4, 5, 6, 7], np.zeros(5, dtype=bool), 0
    expected, shown = arrays.reset(seed=seeds)[0], envs.reset(seed=seeds)[0]
    np.testing.assert_allclose(numbers(shown), expected, atol=1e-7)
    for k in range(90):
        if mode == "Disabled" and over.any():
            options = {"reset_mask": over}
            expected, shown = arrays.reset(options=options)[0], envs.reset(options=options)[0]
            np.testing.assert_allclose(numbers(shown), expected, atol=1e-7)
        actions = np.random.default_rng(k).uniform(-1.0, 1.0, size=(5, 4))
        expected, _, terminated, truncated, told = arrays.step(actions)
        shown, _, *ended, info = envs.step(torch.as_tensor(actions))
        np.testing.assert_allclose(numbers(shown), expected, atol=1e-7)  # the arrays' has 32 bits
        over = terminated | truncated
        np.testing.assert_array_equal(numbers(ended[0] | ended[1]), over)
        ends += over.sum()
        for row in np.flatnonzero(told.get("_final_obs", [])):
            np.testing.assert_allclose(numbers(info["final_obs"][row]), told["final_obs"][row], atol=1e-7)
    assert ends >= 10


def test_what_is_shown_stays_as_it_was():
    envs = TorchSensorHistory(beamenv.torch_vec(2, device="cpu", autoreset_mode="SameStep", **FAILING), length=3)
    shown = [envs.reset(seed=0)[0]]
    copies = [shown[0].clone()]
    for _ in range(50):
        observation, *_, info = envs.step(torch.full((2, 4), 0.3))
        shown += [observation, info["final_obs"]]
        copies += [observation.clone(), info["final_obs"].clone()]
    assert all(torch.equal(*pair) for pair in zip(shown, copies, strict=True))


def test_the_graph_leads_back_through_the_past_until_it_is_cut():
    envs = TorchSensorHistory(beamenv.torch_vec(2, device="cpu", dtype="float64", differentiable=True, duration=0.05), length=4)
    envs.reset(seed=0)
    first = torch.zeros(2, 4, dtype=torch.float64, requires_grad=True)
    shown = [envs.step(first)[0], *(envs.step(torch.zeros_like(first))[0] for _ in range(2))]
    (passed,) = torch.autograd.grad(shown[-1][:, 12:16].sum(), first)  # the first voltages' place, two steps later
    torch.testing.assert_close(passed, torch.ones_like(passed))
    envs.detach()
    assert not envs.step(torch.zeros_like(first))[0].requires_grad


def test_it_goes_back_to_where_it_was():
    def made():
        return TorchSensorHistory(beamenv.torch_vec(3, device="cpu", autoreset_mode="SameStep", **FAILING), length=5)

    envs, again = made(), made()
    envs.reset(seed=1)
    for _ in range(30):
        envs.step(torch.full((3, 4), 0.2))
    states = envs.state_dict(), envs.unwrapped.state_dict()
    again.reset(seed=2)
    again.load_state_dict(states[0])
    again.unwrapped.load_state_dict(states[1])
    for _ in range(30):
        assert torch.equal(envs.step(torch.full((3, 4), -0.2))[0], again.step(torch.full((3, 4), -0.2))[0])
