"""Small blades, environments and laws that examples share: their plants take milliseconds."""

from functools import cache

import gymnasium as gym

import baselines
import beamenv
from beamenv.blade.presets import blade_config

BLADE = {"model": "thesis", "modes": 2, "beam": {"terms": 4}, "patches": {"actuators": 2, "sensors": 2}}
DURATION = 0.003


@cache
def config():
    return blade_config(overrides=BLADE)


@cache
def env():
    made = gym.make(beamenv.ENV_ID, blade=BLADE, duration=DURATION)
    made.reset(seed=1)
    return made


@cache
def envs():
    made = gym.make_vec(beamenv.ENV_ID, num_envs=2, blade=BLADE, duration=DURATION)
    made.reset(seed=1)
    return made


@cache
def plant():
    return env().unwrapped.design_plant


@cache
def design():
    return env().unwrapped.design


@cache
def law():
    return baselines.lqg(plant())


@cache
def still():
    return baselines.no_control(plant())
