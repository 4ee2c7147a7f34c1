"""Training through the plant: exact gradients, and a policy that damps."""

import gymnasium
import numpy as np
import pytest
import torch

import beamenv
from baselines import evaluate
from beamenv.configuration import blade_config, build_plant
from beamenv.kernel import Operators, advance
from beamenv.plant import normalised
from beamenv.scenarios import scenario
from beamenv.simulation import Blades
from train.gradient import Actor, GradientSettings, Windows, train_gradient
from train.training import uncontrolled_cost


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


STEADY = {"preset": "step", "magnitude": (30.0, 30.0), "direction_deg": (90.0, 90.0), "onset": (0.0, 0.0)}


@pytest.mark.parametrize("bias", [0.0, 0.3])
def test_windows_cost_what_the_environment_s_blades_cost(plant, bias):
    """Without noise, under one load and a constant voltage, once every blade has begun an episode of its own."""
    certain, settings, steps = (
        scenario({**STEADY, "white_load": False, "sensor_noise": False}),
        GradientSettings(episodes=4, window=25),
        100,
    )
    actor = Actor(plant, settings)
    with torch.no_grad():
        actor.head.weight.zero_()
        actor.head.bias.fill_(bias)
        windows = Windows(plant, certain, steps, settings, np.random.default_rng(0))
        for _ in range(windows.count):
            windows.unroll(actor)
        cost = sum(float(windows.unroll(actor)[0]) for _ in range(windows.count))
    blades, generator = Blades(plant, certain, 2), np.random.default_rng(0)
    blades.begin(generator)
    held = np.full((2, 4), np.tanh(bias))
    expected = sum(blades.step(held, generator).cost_increment.mean() for _ in range(steps))
    assert cost == pytest.approx(expected, rel=1e-4)
    if bias == 0.0:
        assert cost == pytest.approx(uncontrolled_cost(plant, certain, steps, episodes=2), rel=1e-4)


def test_the_same_seed_and_clock_train_the_same_agent(plant, ticking):
    def train():
        with ticking(0.1):
            return train_gradient(plant, scenario(), 50, 1.0, 3, lambda progress: None, GradientSettings(episodes=8, window=25))

    first, second = train(), train()
    for name, weight in first.weights.items():
        np.testing.assert_array_equal(weight, second.weights[name])


def test_forty_steps_of_training_damp_the_blade(plant, ticking):
    seen = []
    with ticking(0.0625):
        policy = train_gradient(plant, scenario(), 1000, 5.0, 0, seen.append)
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=32)
    assert evaluate(policy, envs, range(32)).relative_cost.high < 0.9
    assert [progress.steps for progress in seen] == sorted({progress.steps for progress in seen})
    assert len(seen) == 40


def test_an_interrupted_training_gives_what_it_has(plant):
    def interrupt(progress):
        raise KeyboardInterrupt

    policy = train_gradient(plant, scenario(), 1000, 60.0, 0, interrupt)
    assert policy.predict(np.zeros(4))[0].shape == (4,)
