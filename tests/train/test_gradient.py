"""Training through the plant: exact gradients, and a policy that damps."""

import gymnasium
import numpy as np
import pytest
import torch

import beamenv
from baselines import evaluate
from beamenv.configuration import blade_config, build_plant
from beamenv.kernel import Operators, advance
from beamenv.scenarios import scenario
from beamenv.simulation import normalised
from train.gradient import Actor, GradientSettings, Windows, train_gradient


@pytest.fixture(scope="module")
def plant():
    return build_plant(blade_config())


def total_cost(operators, voltages, loads):
    """J of one blade from rest under voltages (T, m) and loads (T, 2)."""
    state, total = torch.zeros(operators.states, dtype=torch.float64), torch.zeros((), dtype=torch.float64)
    for each, load in zip(voltages, loads, strict=True):
        state, _, _, increment = advance(operators, torch.cat([state, each, load]))
        total = total + increment
    return total


def test_gradients_through_the_kernel_are_those_of_finite_differences(plant):
    operators = Operators.from_plant(normalised(plant)).convert(torch.as_tensor)
    generator = torch.Generator().manual_seed(0)
    voltages = torch.randn(6, 4, generator=generator, dtype=torch.float64, requires_grad=True)
    loads = 30.0 * torch.randn(6, 2, generator=generator, dtype=torch.float64)
    total_cost(operators, voltages, loads).backward()
    largest = float(voltages.grad.abs().max())
    for step, actuator in ((0, 0), (2, 3), (5, 1)):
        change = torch.zeros_like(voltages)
        change[step, actuator] = 1e-3
        with torch.no_grad():
            rise = total_cost(operators, voltages + change, loads) - total_cost(operators, voltages - change, loads)
        # J is quadratic in the voltages, so that central differences are exact but for rounding
        assert float(voltages.grad[step, actuator]) == pytest.approx(float(rise) / 2e-3, abs=1e-6 * largest)


def test_windows_follow_one_another_through_an_episode(plant):
    settings = GradientSettings(episodes=4, window=10)
    windows = Windows(plant, scenario("quiet"), 40, settings, np.random.default_rng(0))
    actor = Actor(plant, settings)
    assert windows.count == 4
    assert windows._phase.tolist() == [0, 1, 2, 3]
    windows.unroll(actor)
    assert windows._phase.tolist() == [1, 2, 3, 0]
    assert not windows._state.requires_grad


def test_five_seconds_of_training_damp_the_blade(plant):
    seen = []
    policy = train_gradient(plant, scenario(), 1000, 5.0, 0, seen.append)
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=32)
    assert evaluate(policy, envs, range(32)).relative_cost.high < 0.9
    assert [progress.steps for progress in seen] == sorted({progress.steps for progress in seen})
    assert seen[-1].elapsed < 7.0


def test_an_interrupted_training_gives_what_it_has(plant):
    def interrupt(progress):
        raise KeyboardInterrupt

    policy = train_gradient(plant, scenario(), 1000, 60.0, 0, interrupt)
    assert policy.predict(np.zeros(4))[0].shape == (4,)
