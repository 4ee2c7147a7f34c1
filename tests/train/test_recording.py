"""A recorded episode is the one that was evaluated, whatever the law sees."""

from itertools import islice

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from baselines import evaluate, lqg, lqr, no_control, scheduled_lqg_for
from baselines.evaluation.loop import instants
from beamenv.plant.plant import sample
from train.page import record


def test_a_recorded_episode_is_the_one_that_was_evaluated():
    arguments, seed = {"duration": 0.05}, 5
    env = gym.make(beamenv.ENV_ID, **arguments)
    law = lqg(env.unwrapped.plant)
    recording = record(law, env, seed)
    envs = gym.make_vec(beamenv.ENV_ID, num_envs=2, **arguments)
    episodes = evaluate(law, envs, [4, seed]).episodes
    np.testing.assert_allclose(recording.tip[1:], episodes.tip_displacement[:, 1], rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(recording.volts[1:], episodes.voltages[:, 1], rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(recording.time[1:], episodes.time)
    assert recording.cost == pytest.approx(episodes.cost[:, 1].sum(), rel=1e-6)
    np.testing.assert_allclose(recording.states @ env.unwrapped.plant.tip_displacement.T, recording.tip, atol=1e-12)
    env.close()
    envs.close()


@pytest.mark.parametrize(
    ("law", "scenario"),
    [
        (lambda task: lqr(task.design_plant), "spillover"),
        (lambda task: scheduled_lqg_for(task.design_config), "off-speed"),
        (lambda task: lambda readings: -0.1 * readings, "nominal"),
    ],
)
def test_laws_of_the_true_state_of_the_speed_and_plain_functions_are_recorded_as_they_are_evaluated(law, scenario):
    """In "spillover" the true state is longer than the one that the law was designed for."""
    arguments, seed = {"duration": 0.05, "scenario": scenario}, 5
    env = gym.make(beamenv.ENV_ID, **arguments)
    controller = law(env.unwrapped.task)
    recording = record(controller, env, seed)
    episodes = evaluate(controller, env, [seed]).episodes
    np.testing.assert_allclose(recording.tip[1:], episodes.tip_displacement[:, 0], rtol=1e-12, atol=0)
    np.testing.assert_allclose(recording.volts[1:], episodes.voltages[:, 0], rtol=1e-12, atol=0)
    assert np.abs(recording.volts).max() > 1.0


def test_the_recorded_cost_of_lqr_is_the_evaluated_one():
    """Exactly integrated: from the recorded states, with the loads left out of the scenario."""
    quiet = {"white_load": False, "sensor_noise": False}
    arguments = {"duration": 0.05, "scenario": quiet, "blade": {"model": "thesis"}}  # whose truth LQR knows
    env = gym.make(beamenv.ENV_ID, **arguments)
    plant = env.unwrapped.plant
    start = np.zeros(len(plant.A))
    start[0] = 0.05
    controller, options = lqr(plant), {"load": {"case": "none"}, "initial_state": start}
    recording, held = record(controller, env, 0, options), sample(plant)
    joined = np.hstack([recording.states[:-1], recording.volts[1:], np.zeros((len(recording.time) - 1, 2))])
    cost = np.einsum("ki,ij,kj->", joined, held.cost, joined)
    evaluated = sum(instant.info["cost_increment"][0] for instant in islice(instants(controller, env, [0], options), 1, None))
    assert cost == pytest.approx(evaluated, rel=1e-9)
    alone = record(no_control(plant), env, 0, options).states
    assert cost < plant.control_interval * 0.5 * (alone**2).sum()


def test_a_recording_ends_where_the_blade_fails():
    env = gym.make(beamenv.ENV_ID, duration=0.05)
    load = {"case": "step", "magnitude": 1e5, "onset": 0.01, "direction_deg": 90.0}
    recording = record(no_control(env.unwrapped.plant), env, 0, {"load": load})
    assert 0.01 < recording.time[-1] < 0.05
    assert recording.cost == np.inf
    env.close()
