"""A small benchmark, and controllers that fail in one way each."""

import numpy as np

from train.controllers.policies import HistoryPolicy

SHORT = {"duration": 0.02}
SMALL = {"scenarios": ["nominal", "spillover"], "controllers": ["lqg-load"], "seeds": 3, "environment": SHORT}
LIMITS = (-np.ones(4, np.float32), np.ones(4, np.float32))
IDLE = HistoryPolicy(
    "idle", {"weight0": np.zeros((4, 24), np.float32), "bias0": np.zeros(4, np.float32)}, {"input_gain": 1.0, "held": 1}, *LIMITS
)


class Notes:
    """Remembers the cells that were measured, and stops after some of them."""

    def __init__(self, stop=10**6):
        self.cells, self.stop = [], stop

    def __call__(self, done, total, cell):
        self.cells.append(f"{cell.scenario}/{cell.controller}")
        if len(self.cells) == self.stop:
            raise KeyboardInterrupt


class Still:
    """Any object with predict: no voltage."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        return np.zeros((len(observation), 4)), state


class Wild(Still):
    """Feeds whatever vibrates."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        instant = state or 0
        return np.full((len(observation), 4), 1.0 if instant % 40 < 20 else -1.0), instant + 1


class Broken(Still):
    """Fails."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        raise ZeroDivisionError("the weights sum to zero")


class Narrow(Still):
    """Has too few voltages."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        return np.zeros((len(observation), 2)), state
