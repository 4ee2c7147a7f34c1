"""Gradients through batches of tensors against central differences: of the return, in the voltages of every instant."""

import numpy as np
import pytest

import beamenv

torch = pytest.importorskip("torch")

COUNT, STEPS = 3, 40
RISES = {"spin-up": 1e-3}
"""So large where the return is 10⁷ times what changes; elsewhere 10⁻⁶, with which no reading reaches its limit."""
SMALL = {"modes": 4, "truth_modes": 4, "beam": {"terms": 8}}
SCENARIOS = {
    "nominal": "nominal",
    "hysteresis": "hysteresis",
    "delay": "delay",
    "failure": "failure",
    "failure on the way": {"preset": "mid-failure", "failures": {"onset": [0.0, 0.01]}},
    "off-speed": {"preset": "off-speed", "plants": {"bank": 4}},
    "drift": {"preset": "drift", "plants": {"bank": 4}},
    "heat": {"preset": "heat", "plants": {"bank": 4, "drift_onset": [0.0, 0.01], "drift_duration": 0.01}},
    "spin-up": {"plants": {"spin_up": [100.0, 150.0]}},
}


def batch_of(scenario, **arguments):
    return beamenv.torch_vec(
        COUNT, device="cpu", dtype="float64", scenario=scenario, blade=SMALL, duration=0.05, differentiable=True, **arguments
    )


def gathered(envs, voltages):
    """(N,) what a blade has gathered of rewards and squared readings after voltages (T, N, m), from equal seeds."""
    envs.reset(seed=list(range(COUNT)))
    total = torch.zeros(COUNT, dtype=torch.float64)
    for each in voltages:
        readings, reward, *_ = envs.step(each)
        total = total + reward + 0.1 * (readings**2).sum(-1)
    return total


def voltages():
    return 0.1 * torch.randn(STEPS, COUNT, 4, generator=torch.Generator().manual_seed(3), dtype=torch.float64)


@pytest.mark.parametrize("name", SCENARIOS)
def test_gradients_are_those_of_central_differences(name):
    envs, held, rise = batch_of(SCENARIOS[name]), voltages().requires_grad_(), RISES.get(name, 1e-6)
    gathered(envs, held).sum().backward()
    for seed in range(3):
        towards = torch.randn(held.shape, generator=torch.Generator().manual_seed(seed), dtype=torch.float64)
        with torch.no_grad():
            both = [gathered(envs, held + sign * rise * towards).sum() for sign in (1.0, -1.0)]
        difference = (both[0] - both[1]) / (2.0 * rise)
        slope = (held.grad * towards).sum()
        np.testing.assert_allclose(slope.item(), difference.item(), rtol=1e-5)


def test_gradients_pass_over_many_steps_until_they_are_cut():
    envs, first = batch_of("nominal"), torch.full((COUNT, 4), 0.1, dtype=torch.float64, requires_grad=True)
    envs.reset(seed=0)
    envs.step(first)
    *_, info = envs.step(torch.zeros(COUNT, 4))
    assert torch.autograd.grad(info["energy"].sum(), first)[0].abs().min() > 0.0
    envs.detach()
    assert not envs.step(torch.zeros(COUNT, 4))[1].requires_grad


def test_nothing_passes_from_one_episode_to_the_next():
    envs = batch_of("nominal", max_episode_steps=2, autoreset_mode="SameStep")
    voltages = torch.full((COUNT, 4), 0.1, dtype=torch.float64, requires_grad=True)
    envs.reset(seed=0, options={"elapsed": np.array([0, 0, 1])})
    envs.step(voltages)  # the last blade begins anew
    _, reward, *_ = envs.step(torch.zeros(COUNT, 4))
    (slope,) = torch.autograd.grad(reward.sum(), voltages)
    assert slope[:2].abs().min() > 0.0
    assert not slope[2].any()


def test_without_being_asked_for_there_are_no_gradients():
    envs = beamenv.torch_vec(COUNT, device="cpu", blade=SMALL)
    envs.reset(seed=0)
    assert not envs.step(torch.zeros(COUNT, 4, requires_grad=True))[1].requires_grad
