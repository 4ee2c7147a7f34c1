"""Controllers in the loop of the real environment, in physical units: Python's own, and what was exported of them."""

from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from beamenv.plant.plant import drive_limit
from train.controllers import belief_policy, lstm_policy, models_policy, policies
from train.controllers.models_policy import ModelsPolicy
from train.controllers.policies import Policy

STEPS = 2000
TOLERANCE = {"double": 1e-9, "single": 1e-4}  # of the drive's limit: what the issue allows


class _Double:
    """NumPy in which single precision is double."""

    float32 = np.float64

    def __getattr__(self, name):
        return getattr(np, name)


@contextmanager
def in_double_precision(controller):
    """The controller, in Python's double precision also where it is usually run in single."""
    if not isinstance(controller, Policy):
        yield replace(controller, single=False) if getattr(controller, "single", False) else controller
        return
    own = replace(controller, weights={name: each.astype(np.float64) for name, each in controller.weights.items()})
    if isinstance(controller, ModelsPolicy):
        own = replace(own, law=replace(controller.law, single=False))
    with pytest.MonkeyPatch.context() as patch:
        for module in (policies, belief_policy, lstm_policy, models_policy):
            patch.setattr(module, "np", _Double())
        yield own


def python_steps(controller, plant):
    """From a row of currents, A, with the rotor speed behind them if the controller reads it, to voltages, V."""
    memory, scale, drive = None, np.append(plant.sensor_full_scale, 1.0), drive_limit(plant)

    def step(measured):
        nonlocal memory
        action, memory = controller.predict((measured / scale[: len(measured)])[None], memory)
        return action[0] * drive

    return step


@lru_cache(maxsize=64)
def by_python(controller, plant, scenario, reads_speed, steps):
    """What is measured and the voltages of the controller in Python's double precision."""
    with in_double_precision(controller) as own:
        return in_a_loop(python_steps(own, plant), scenario, reads_speed, steps)


def in_a_loop(step, scenario, reads_speed=False, steps=STEPS, seed=1, **blade):
    """What is measured (k, p) and the voltages (k, m) of a controller's own episode."""
    duration = STEPS * 5e-4  # whatever part of it is run: a spin-up is as long as the episode
    env = gym.make(beamenv.ENV_ID, scenario=scenario, physical_units=True, duration=duration, dtype="float64", **blade)
    observation, _ = env.reset(seed=seed)
    measured, voltages = [], []
    for _ in range(steps):
        seen = np.append(observation, env.unwrapped.rotor_speed) if reads_speed else observation
        asked = np.asarray(step(seen), dtype=np.float64)
        measured.append(seen)
        voltages.append(asked)
        observation, _, terminated, _, _ = env.step(asked)
        assert not terminated
    env.close()
    return np.array(measured), np.array(voltages)
