"""What the page on the environment says in short, and what the tutorial says of fixed gains, is so."""

import inspect
import re
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from beamenv.envs.single import RotatingBeamEnv

PAGE = Path("docs/environment.md").read_text(encoding="utf-8")


def row(name):
    """A row of the table, and what it has in code's letters."""
    (line,) = re.findall(rf"^\| {name} \| (.*) \|$", PAGE, re.MULTILINE)
    return line, re.findall(r"`(\w+)`", line)


def test_the_table_has_the_arguments_spaces_and_info_of_the_environment():
    env = gym.make(beamenv.ENV_ID)
    env.reset(seed=0)
    *_, info = env.step(env.action_space.sample())
    assert {*row("arguments")[1]} == {*inspect.signature(RotatingBeamEnv.__init__).parameters} - {"self"}
    assert row("`info`")[1] == list(info)
    for name, space in (("observation", env.observation_space), ("action", env.action_space)):
        low, high = space.low[0], space.high[0]
        assert row(name)[0].startswith(f"`Box({low:.0f}, {high:.0f}, {space.shape}, {space.dtype})`")
    assert f"{env.unwrapped.plant.voltage_limits[1][0]:.0f} V" in row("action")[0]


@pytest.mark.parametrize("gain", [0.1, -0.1])
def test_one_gain_of_either_sign_at_all_patches_makes_the_blade_unstable(gain):
    plant = gym.make(beamenv.ENV_ID).unwrapped.design_plant
    feedback = gain * np.diag(plant.voltage_limits[1] / plant.sensor_full_scale)
    assert np.linalg.eigvals(plant.A).real.max() < 0.0
    assert np.linalg.eigvals(plant.A + plant.B @ feedback @ plant.C).real.max() > 10.0
