"""What designers, laws and evaluation refuse, in one sentence each."""

import copy
import pickle

import gymnasium as gym
import numpy as np
import pytest
import torch

import beamenv
from baselines import Instruments, LinearController, evaluate, lqg, lqr, positive_position_feedback

N, M, P = 22, 4, 4
"""States, voltages, sensors of the thesis' blade."""


@pytest.fixture(scope="module")
def plant():
    return gym.make(beamenv.ENV_ID).unwrapped.plant


@pytest.mark.parametrize(
    "Q", [1j * np.eye(N), np.full((N, N), "1"), np.ma.masked_all((N, N)), [[1.0], [1.0, 2.0]], torch.eye(N).requires_grad_()]
)
def test_weights_that_would_lose_a_part_are_refused(plant, Q):
    for design in (lqr, lqg):
        with pytest.raises(ValueError, match="^Q = .* must be a matrix of real numbers[.]$") as told:
            design(plant, Q=Q)
        assert "\n" not in str(told.value)


@pytest.mark.parametrize("design", [lqr, lqg, positive_position_feedback, Instruments.of])
@pytest.mark.parametrize("given", [None, 3, gym.make(beamenv.ENV_ID)])
def test_what_is_no_plant_is_told(design, given):
    with pytest.raises(ValueError, match="^plant is .*, but must be a beamenv.Plant"):
        design(given)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"A": 0.5}, r"A has shape \(\), but must hold finite numbers in shape \(1, 1\)"),
        ({"A": [[1.0, 2.0], [3.0]]}, "A = .* must be a matrix of real numbers"),
        ({"A": [[1j]]}, "A = .* must be a matrix of real numbers"),
        ({"B": np.zeros((1, P + 1))}, r"B has shape \(1, 5\)"),
        ({"D": None}, "D = None must be a matrix of real numbers"),
        ({"plant": None, "instruments": 3}, "instruments is 3, but must be an Instruments"),
        ({"plant": 3}, "plant is 3, but must be a beamenv.Plant"),
    ],
)
def test_a_state_space_that_does_not_fit_is_told(plant, changes, words):
    fitting = {"A": [[0.5]], "B": np.ones((1, P)), "C": np.ones((M, 1)), "D": np.zeros((M, P)), "plant": plant}
    assert LinearController.from_state_space(**fitting).order == 1
    with pytest.raises(ValueError, match=f"^{words}"):
        LinearController.from_state_space(**{**fitting, **changes})


def test_a_system_that_control_does_not_know_is_told(plant):
    class Odd:
        dt = plant.control_interval

    with pytest.raises(ValueError, match="^A is a system that control.ss does not convert"):
        LinearController.from_state_space(Odd(), plant=plant)


def test_a_law_s_own_constructor_checks_its_matrices(plant):
    with pytest.raises(ValueError, match=r"^measurement_input has shape \(3, 4\), but must hold finite numbers in shape \(2, 4\)"):
        LinearController(
            "mine", Instruments.of(plant), np.eye(2), np.ones((3, P)), np.ones((2, M)), np.ones((M, 2)), np.ones((M, P))
        )
    listed = LinearController("mine", Instruments.of(plant), [[0.0]], [[0] * P], [[0] * M], [[0]] * M, np.zeros((M, P)).tolist())
    assert not listed.predict(np.ones(P))[0].any()


def test_a_law_and_its_instruments_cannot_be_written_to(plant):
    law = lqg(plant)
    for array in (law.state_gain, law.instruments.voltage_limits, pickle.loads(pickle.dumps(law.instruments)).voltage_scale):
        with pytest.raises(ValueError, match="read-only"):
            array *= 0.5  # noqa: PLW2901


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"observes": "speed"}, "observes is 'speed', but must be one of observation, state, observation and speed"),
        ({"interval": 0.0}, r"interval is 0.0, but must be a positive number \(s\)"),
        ({"voltage_limits": [[-1.0], [1.0]]}, r"voltage_limits has shape \(2, 1\), but must hold finite numbers in shape \(2, 2\)"),
        ({"voltage_scale": [1.0, np.nan]}, r"voltage_scale has shape \(2,\), but must hold finite numbers"),
    ],
)
def test_instruments_of_one_s_own_are_checked(changes, words):
    fitting = {"measurement_scale": [1.0], "voltage_scale": [1.0, 1.0], "voltage_limits": [[-1.0, -1.0], [1, 1]], "interval": 0.1}
    assert copy.deepcopy(Instruments(**fitting)).sizes == "observation (1), 2 voltages; 100 ms; -1 … 1 V; physical units"
    with pytest.raises(ValueError, match=f"^{words}"):
        Instruments(**{**fitting, **changes})


@pytest.mark.parametrize("seeds", [[], 3, "12", [1.5, 2], [True, False], [-1], iter([1, 2]), [None], {1, 2}])
def test_seeds_that_would_become_others_are_refused(seeds):
    with pytest.raises(ValueError, match="^seeds is .*, but must be a list of one or more seeds, each a whole number"):
        evaluate(np.negative, beamenv.ENV_ID, seeds=seeds)


@pytest.mark.parametrize("env", [None, 3, "CartPole-v1"])
def test_what_has_no_blade_is_no_environment_to_evaluate_in(env):
    with pytest.raises(ValueError, match="^env is .*, but must be an environment with a blade"):
        evaluate(np.negative, env, seeds=[1, 2])


@pytest.mark.parametrize("physical", [False, True])
def test_a_law_in_the_other_units_is_refused_and_not_measured(plant, physical):
    envs = gym.make_vec(beamenv.ENV_ID, num_envs=2, physical_units=physical, duration=0.005)
    law = lqg(plant)
    fitting, other = (law.in_physical_units(), law) if physical else (law, law.in_physical_units())
    assert evaluate(fitting, envs, seeds=[1, 2]).cost.value > 0.0
    with pytest.raises(ValueError, match="^controller = LQG is a law for an environment .* physical_units=True"):
        evaluate(other, envs, seeds=[1, 2])


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (lambda seen: seen * 1j, "action is .*, but must be an array of real numbers"),
        (lambda seen: np.full(seen.shape, "1"), "action is .*, but must be an array of real numbers"),
        (lambda seen: torch.as_tensor(seen).requires_grad_() * 1.0, "controller = function gives what is no array"),
        (lambda seen: seen[:, :2], r"action has shape \(2, 2\)"),
        (lambda seen: seen * np.nan, r"action\[0, 0\] is nan"),
    ],
)
def test_a_function_that_gives_no_voltages_is_told(function, words):
    with pytest.raises(ValueError, match=f"^{words}"):
        evaluate(function, beamenv.ENV_ID, seeds=[1, 2])
