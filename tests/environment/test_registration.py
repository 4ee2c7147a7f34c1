"""What Gymnasium asks of a registered environment."""

import doctest
import importlib
import inspect
import json
import subprocess
import sys
import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

import beamenv
from beamenv import BladeConfig, RotatingBeamEnv, RotatingBeamVectorEnv, Scenario, SensorHistory, blade_config


@pytest.mark.parametrize("preset", ["thesis", "chandra-chopra"])
def test_check_env_passes_without_a_warning(preset):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(beamenv.ENV_ID, preset=preset, render_mode="rgb_array").unwrapped)


def test_passive_checker_stays_silent_through_an_episode():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make(beamenv.ENV_ID, duration=0.01)
        env.action_space.seed(0)
        for _ in range(2):
            env.reset(seed=0)
            while not any(env.step(env.action_space.sample())[2:4]):
                pass


ARGUMENTS = [
    {},
    {"preset": "chandra-chopra", "speed": 80.0, "duration": 0.25, "physical_units": True},
    {"blade": {"damping_ratio": 0.02, "patches": {"actuators": 2}}, "design": {"patches": {"actuators": 2}}, "scenario": "pulse"},
    {
        "blade": blade_config(overrides={"beam": {"taper": 1.5}}),
        "design": BladeConfig(),
        "scenario": Scenario(magnitude=(1.0, 2.0)),
    },
]


@pytest.mark.parametrize("arguments", ARGUMENTS)
def test_spec_round_trips_through_json(arguments):
    env = gymnasium.make(beamenv.ENV_ID, **arguments)
    again = gymnasium.make(EnvSpec.from_json(env.spec.to_json()))
    assert again.unwrapped.task == env.unwrapped.task
    assert np.array_equal(again.reset(seed=1)[0], env.reset(seed=1)[0])


@pytest.mark.parametrize("mode", [AutoresetMode.SAME_STEP, "NextStep"])
@pytest.mark.parametrize("arguments", ARGUMENTS)
def test_spec_of_the_batch_round_trips_through_json(arguments, mode):
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, autoreset_mode=mode, **arguments)
    again = gymnasium.make_vec(EnvSpec.from_json(envs.spec.to_json()))
    assert again.num_envs == 3
    assert again.metadata == envs.metadata
    assert again.unwrapped.task == envs.unwrapped.task


def test_spec_round_trips_with_the_sensor_history_on_top():
    env = SensorHistory(gymnasium.make(beamenv.ENV_ID), length=5)
    again = gymnasium.make(EnvSpec.from_json(env.spec.to_json()))
    assert isinstance(again, SensorHistory)
    assert again.observation_space == env.observation_space


def test_native_batch_is_what_make_vec_makes():
    assert isinstance(gymnasium.make_vec(beamenv.ENV_ID, num_envs=2), RotatingBeamVectorEnv)
    assert isinstance(gymnasium.make(beamenv.ENV_ID).unwrapped, RotatingBeamEnv)


def test_importing_twice_registers_once():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        importlib.reload(beamenv)
    assert gymnasium.spec("beamenv/RotatingBeam-v0").entry_point == "beamenv.envs.single:RotatingBeamEnv"


def test_every_public_name_is_there():
    assert set(beamenv.__all__) <= set(dir(beamenv))
    assert all(getattr(beamenv, name) is not None for name in beamenv.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        beamenv.nonsense  # noqa: B018


@pytest.mark.parametrize("then", ["", "import gymnasium; gymnasium.make('beamenv/RotatingBeam-v0').reset()"])
def test_neither_import_nor_environment_loads_what_is_slow(then):
    code = f"""
import json, sys
import beamenv
{then}
print(json.dumps([name for name in ("torch", "matplotlib", "pygame", "control", "scipy.signal") if name in sys.modules]))
"""
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert json.loads(run.stdout) == []


@pytest.mark.parametrize("cls", [RotatingBeamEnv, RotatingBeamVectorEnv])
def test_every_argument_is_documented(cls):
    names = set(inspect.signature(cls).parameters)
    assert not [name for name in names if f"`{name}`" not in cls.__doc__ and f"``{name}``" not in cls.__doc__]


@pytest.mark.parametrize("module", ["beamenv.envs.single", "beamenv.envs.batch"])
def test_examples_in_the_docstrings_run(module):
    results = doctest.testmod(importlib.import_module(module))
    assert results.attempted > 0
    assert results.failed == 0
