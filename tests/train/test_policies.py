"""Trained policies run by NumPy alone: the same numbers as in training, saved as weights only."""

from dataclasses import replace

import gymnasium
import numpy as np
import pytest
import torch

import beamenv
from baselines import evaluate
from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from train.controllers.policies import HistoryPolicy
from train.controllers.policy_files import load_policy, save_policy
from train.learning.through_plant.actors import ActorSettings, RecurrentActor


@pytest.fixture(scope="module")
def actor():
    torch.manual_seed(3)
    plant = build_plant(blade_config(overrides={"voltage_limits": (-500.0, 1500.0)}))
    actor = RecurrentActor(plant, ActorSettings(output_gain=3.0), 1)
    with torch.no_grad():
        actor.unit.out.bias.copy_(torch.tensor([[[0.3, -0.4, 0.0, 0.1]]]))
    return actor


@pytest.fixture(scope="module")
def recurrent(actor):
    return actor.policy(0)


@pytest.fixture(scope="module")
def windowed():
    generator, weights = np.random.default_rng(4), {}
    for layer, shape in enumerate(((16, 24), (16, 16), (4, 16))):
        weights[f"weight{layer}"] = generator.normal(0.0, 0.3, shape).astype(np.float32)
        weights[f"bias{layer}"] = generator.normal(0.0, 0.1, shape[0]).astype(np.float32)
    one = np.ones(4, np.float32)
    return HistoryPolicy("windowed", weights, {"input_gain": 2.0, "held": 1}, -one, one)


@pytest.fixture(params=["recurrent", "windowed"])
def policy(request):
    return request.getfixturevalue(request.param)


def readings(steps=12, count=3):
    return np.random.default_rng(1).uniform(-0.3, 0.3, (steps, count, 4))


def test_numpy_repeats_the_training_time_network(actor, recurrent):
    training, memory = actor.start(3), None
    for observed in readings(50):
        with torch.no_grad():
            voltages, training = actor(torch.as_tensor(observed, dtype=torch.float32), training)
        action, memory = recurrent.predict(observed, memory)
        np.testing.assert_allclose(action, voltages.numpy(), atol=2e-6)
    assert np.abs(action).max() > 0.05


def test_actions_keep_the_drive_limits(actor, recurrent):
    memory, lowest = None, 0.0
    for observed in readings(40):
        action, memory = recurrent.predict(np.sign(observed), memory)
        lowest = min(lowest, action.min())
    assert lowest == pytest.approx(-1.0 / 3.0)
    np.testing.assert_array_equal(memory[:, -4:], action)


def test_a_window_holds_readings_and_the_voltages_before_them(windowed):
    first, second = readings(2, 1).astype(np.float32)
    action, memory = windowed.predict(first)
    np.testing.assert_array_equal(memory[0, :24], [*np.zeros(16), *first[0], *np.zeros(4)])
    _, memory = windowed.predict(second, memory)
    np.testing.assert_array_equal(memory[0, :24], [*np.zeros(8), *first[0], *np.zeros(4), *second[0], *action[0]])


def test_voltages_are_held_between_decisions_while_the_window_moves_on(windowed):
    holding = replace(windowed, settings={**windowed.settings, "held": 3})
    memory, asked = None, []
    for observed in readings(7):
        action, memory = holding.predict(observed, memory)
        asked.append(action)
    for first in (0, 3):
        np.testing.assert_array_equal(asked[first], asked[first + 1])
        np.testing.assert_array_equal(asked[first], asked[first + 2])
    assert np.all(asked[3] != asked[2])
    assert np.all(asked[6] != asked[5])


def test_a_blade_alone_is_a_batch_of_one(policy):
    memory = alone = None
    for observed in readings():
        action, memory = policy.predict(observed, memory)
        one, alone = policy.predict(observed[0], alone)
        assert one.shape == (4,)
        np.testing.assert_allclose(one, action[0], atol=1e-6)


def test_an_episode_s_start_forgets(policy):
    memory = None
    for observed in readings():
        _, memory = policy.predict(observed, memory)
    observed = readings()[0]
    action, following = policy.predict(observed, memory, episode_start=np.array([True, False, True]))
    afresh, _ = policy.predict(observed)
    went_on, _ = policy.predict(observed, memory)
    np.testing.assert_array_equal(action[[0, 2]], afresh[[0, 2]])
    np.testing.assert_array_equal(action[1], went_on[1])
    np.testing.assert_array_equal(following[:, -4:], action)


def test_a_saved_policy_comes_back_and_acts_alike(policy, tmp_path):
    save_policy(policy, tmp_path / "agent")
    loaded = load_policy(tmp_path / "agent")
    assert (loaded.name, loaded.kind, dict(loaded.settings)) == (policy.name, policy.kind, dict(policy.settings))
    for observed in readings():
        np.testing.assert_array_equal(loaded.predict(observed)[0], policy.predict(observed)[0])


def test_a_rectified_and_squashed_network_is_torch_s():
    torch.manual_seed(0)
    network = torch.nn.Sequential(torch.nn.Linear(24, 8), torch.nn.ReLU(), torch.nn.Linear(8, 4), torch.nn.Tanh())
    weights = {}
    for index, layer in enumerate((network[0], network[2])):
        weights |= {f"weight{index}": layer.weight.detach().numpy(), f"bias{index}": layer.bias.detach().numpy()}
    settings = {"input_gain": 1.0, "held": 1, "activation": "relu", "squashed": True}
    one = np.ones(4, np.float32)
    policy, memory = HistoryPolicy("squashed", weights, settings, -one, one), None
    for observed in readings(5):
        action, memory = policy.predict(observed, memory)
        seen = np.hstack([memory[:, :20], memory[:, 20:24]])
        with torch.no_grad():
            np.testing.assert_allclose(action, network(torch.as_tensor(seen)).numpy(), atol=1e-6)


def test_an_overruled_action_is_not_remembered(recurrent):
    _, memory = recurrent.predict(readings()[0])
    held = np.full((3, 4), 0.25, np.float32)
    known = recurrent.knowing(memory, held)
    np.testing.assert_array_equal(known[:, -4:], held)
    np.testing.assert_array_equal(known[:, :-4], memory[:, :-4])


def test_an_agent_that_counts_in_drive_limits_is_refused_where_volts_are_wanted():
    weights = {"weight0": np.zeros((4, 24), np.float32), "bias0": np.zeros(4, np.float32)}
    idle = HistoryPolicy("idle", weights, {"input_gain": 1.0, "held": 1}, -np.ones(4, np.float32), np.ones(4, np.float32))
    plain, physical = (gymnasium.make(beamenv.ENV_ID, duration=0.02, physical_units=each) for each in (False, True))
    assert evaluate(idle, plain, range(2)).relative_cost.value == 1.0
    with pytest.raises(ValueError, match="^controller = idle is an agent for an environment without physical_units=True"):
        evaluate(idle, physical, range(2))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("x",), "observation is 'x', but must be an array of real numbers"),
        ((np.zeros((2, 2, 4)),), "observation has shape .2, 2, 4., but windowed takes"),
        ((np.zeros((2, 3)),), "observation has shape .2, 3., which is not what windowed was trained to read"),
        ((np.zeros((2, 4)), "x"), "state is 'x', but must be None, or what predict returned last"),
        ((np.zeros((2, 4)), np.zeros((3, 29), np.float32)), "state is .*, but must be None, or what predict returned last"),
        (
            (np.zeros((2, 4)), np.zeros((2, 29), np.float32), [True]),
            "episode_start is .*, but must be None, or 2 of True and False",
        ),
    ],
)
def test_what_a_policy_is_given_is_refused_as_a_law_does(windowed, arguments, words):
    with pytest.raises(ValueError, match=f"^{words}"):
        windowed.predict(*arguments)
