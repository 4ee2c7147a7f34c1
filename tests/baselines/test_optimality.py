"""The proof that cost, noise and controller mean the same thing: measured in the environment, LQG costs its analytic optimum."""

from dataclasses import replace

import gymnasium
import numpy as np
import pytest

import beamenv  # noqa: F401
from baselines import (
    PersistentLoad,
    RotorHarmonics,
    h_infinity,
    lqg,
    lqr,
    no_control,
    positive_position_feedback,
    reference_lqg,
    rotor_lqg,
    stationary_cost,
    velocity_feedback,
)

EPISODES, DURATION, SETTLE = 256, 4.0, 1.0
SIGMAS = 4.0
"""Standard errors that a measured cost may be off: by chance one seed in 16,000 is, so that a failure means a fault."""

OTHERS = {
    "no control": no_control,
    "velocity feedback": velocity_feedback,
    "LQR": lqr,
    "the thesis' LQG": lambda plant: lqg(plant, "continuous"),
    "LQG with load estimate": lambda plant: lqg(plant, persistent_load=PersistentLoad()),
    "LQG with rotor harmonics": lambda plant: rotor_lqg(plant, RotorHarmonics(speed=200.0)),
    "H∞": h_infinity,
    "positive position feedback": positive_position_feedback,
}


def unlimited(model):
    """White noise only, and a drive that never saturates."""
    blade = {"voltage_limits": (-1e6, 1e6), "model": model}
    return gymnasium.make_vec(beamenv.ENV_ID, num_envs=EPISODES, scenario="white", duration=DURATION, blade=blade)


@pytest.fixture(name="envs", scope="module")
def _envs():
    """The thesis' world, whose true plant is the design's."""
    return unlimited("thesis")


@pytest.fixture(name="plant", scope="module")
def _plant(envs):
    return envs.unwrapped.plant


@pytest.fixture(name="others", scope="module")
def _others(plant):
    return {name: law(plant) for name, law in OTHERS.items()}


def mean_costs(law, envs, seed=0):
    """(EPISODES,), J: mean cost per second of each blade once its start is forgotten."""
    observation, _ = envs.reset(seed=seed)
    interval, memory, cost = envs.unwrapped.plant.control_interval, None, np.zeros(EPISODES)
    for step in range(round(DURATION / interval)):
        action, memory = law.predict(envs.unwrapped.state if law.observes == "state" else observation, memory)
        observation, _, failed, _, info = envs.step(action)
        assert np.abs(observation).max() < 1.0
        assert np.abs(info["volts"]).max() < 1e6
        assert not failed.any()
        cost += info["cost_increment"] * (step * interval >= SETTLE)
    return cost / (DURATION - SETTLE)


@pytest.mark.parametrize("model", ["thesis", "blade"])
def test_measured_cost_of_lqg_is_the_analytic_optimum(model):
    """On the very plant that it knows: the design's in the thesis' world, the whole truth, electronics and all, of the blade."""
    envs = unlimited(model)
    plant = envs.unwrapped.plant
    law = lqg(plant)
    costs = mean_costs(law, envs)
    error, optimum = costs.std(ddof=1) / np.sqrt(EPISODES), stationary_cost(plant, law)
    assert error < 0.01 * optimum
    assert abs(costs.mean() - optimum) < SIGMAS * error


def test_measured_cost_of_the_reference_is_the_analytic_one():
    """On the blade with all its modes and electronics, of which its memory holds a part."""
    envs = unlimited("blade")
    law = reference_lqg(envs.unwrapped.task.design.full_plant)
    costs = mean_costs(law, envs)
    expected = stationary_cost(envs.unwrapped.plant, law)
    assert expected < 1.01 * stationary_cost(envs.unwrapped.plant, lqg(envs.unwrapped.plant))
    assert abs(costs.mean() - expected) < SIGMAS * costs.std(ddof=1) / np.sqrt(EPISODES)


@pytest.mark.parametrize("name", OTHERS)
def test_measured_cost_of_other_laws_is_the_analytic_one(envs, plant, others, name):
    law = others[name]
    costs = mean_costs(law, envs)
    assert abs(costs.mean() - stationary_cost(plant, law)) < SIGMAS * costs.std(ddof=1) / np.sqrt(EPISODES)


def test_no_other_law_without_the_true_state_costs_less_than_lqg(plant, others):
    optimum = stationary_cost(plant, lqg(plant))
    assert stationary_cost(plant, others["LQR"]) < optimum
    for name in OTHERS.keys() - {"LQR"}:
        assert stationary_cost(plant, others[name]) > optimum, name


def test_no_other_gain_of_regulator_or_filter_costs_less_on_the_thesis_blade(plant):
    law = lqg(plant)
    optimum, random = stationary_cost(plant, law), np.random.default_rng(0)
    for size in np.repeat([0.003, 0.03, 0.3], 20):
        for gains in (("state_gain", "measurement_gain"), ("measurement_input",), ("transition", "voltage_input")):
            changed = {gain: getattr(law, gain) * (1.0 + size * random.normal(size=getattr(law, gain).shape)) for gain in gains}
            assert stationary_cost(plant, replace(law, **changed)) > optimum
