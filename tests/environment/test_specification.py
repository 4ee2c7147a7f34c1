"""What an environment tells of itself: its specification, as JSON, in fresh processes, and under wrappers that read it."""

import json
import subprocess
import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import AutoresetMode

import beamenv
from beamenv import PlacementWrapper

SHORT = {"duration": 0.01}  # 20 control intervals


@pytest.mark.parametrize(
    "arguments",
    [
        {"render_index": range(3)},
        {"render_index": np.array([0, 2]), "dtype": np.float64},
        {"speed": np.float64(150.0), "duration": np.array(0.02)},
        {"speed": np.longdouble(150.0), "blade": {"beam": {"ply_angles_deg": np.array([30, 20], dtype=np.longdouble)}}},
        {"blade": {"patches": {"actuators": np.array([0.3, 0.9])}}, "autoreset_mode": AutoresetMode.DISABLED},
        {"scenario": Path(beamenv.__file__).parent / "scenarios" / "named" / "delay.toml"},
        {"scenario": {"magnitude": np.array([1.0, 2.0]), "plants": {"bank": np.int64(2)}}},
    ],
)
def test_whatever_arguments_are_of_the_spec_is_json(arguments):
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, render_mode="rgb_array", **arguments)
    text = envs.spec.to_json()
    json.loads(text)
    again = gymnasium.make_vec(EnvSpec.from_json(text))
    assert again.unwrapped.task == envs.unwrapped.task
    assert again.spec.to_json() == text
    np.testing.assert_array_equal(again.reset(seed=3)[0], envs.reset(seed=3)[0])


def test_positions_of_patches_as_an_array_are_json():
    env = PlacementWrapper(gymnasium.make(beamenv.ENV_ID), actuators=np.array([0.3, 0.9]), sensors=(0.4, 1.0))
    again = gymnasium.make(EnvSpec.from_json(env.spec.to_json()))
    assert again.reset(seed=1)[1]["layout"] == env.reset(seed=1)[1]["layout"]


@pytest.mark.parametrize(("arguments", "steps"), [({}, 1000), ({"duration": 0.25}, 500), ({**SHORT, "max_episode_steps": 7}, 7)])
def test_the_spec_tells_how_long_an_episode_is(arguments, steps):
    env = gymnasium.make(beamenv.ENV_ID, **arguments)
    assert env.spec.max_episode_steps == steps
    assert gymnasium.make(EnvSpec.from_json(env.spec.to_json())).spec.max_episode_steps == steps
    assert gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **arguments).spec.max_episode_steps == steps
    longer = gymnasium.make(beamenv.ENV_ID, **{**SHORT, "max_episode_steps": 10**6}).unwrapped
    assert longer.spec.max_episode_steps == 20


def test_episodes_made_from_a_spec_may_be_longer_once_its_limit_is_lifted():
    spec = gymnasium.make(beamenv.ENV_ID, **SHORT).spec
    env = gymnasium.make(spec, duration=0.02, max_episode_steps=-1)
    env.reset(seed=1)
    steps = 1
    while not env.step(np.zeros(env.action_space.shape))[3]:
        steps += 1
    assert steps == env.spec.max_episode_steps == 40


def test_an_observation_of_time_ends_at_one():
    env = gymnasium.wrappers.TimeAwareObservation(gymnasium.make(beamenv.ENV_ID, **SHORT))
    env.reset(seed=0)
    truncated = False
    while not truncated:
        observation, _, _, truncated, _ = env.step(np.zeros(4))
    assert observation[-1] == 20


def test_a_fresh_process_knows_the_id_with_its_module_before_it(tmp_path):
    code = "import gymnasium; env = gymnasium.make('beamenv:beamenv/RotatingBeam-delay-v0'); print(env.reset(seed=0)[0].shape)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert run.stdout == "(4,)\n", run.stderr
