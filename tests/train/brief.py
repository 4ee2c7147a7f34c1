"""Trainings of a moment: recipes, jobs, and how they are interrupted and looked at."""

import numpy as np

from train.learning.job import Job
from train.learning.recipe import parsed
from train.learning.session import Budget

SHORT = {"duration": 0.02}  # 40 control intervals


ROWS = "agent = {!r}\ntitle = 'Brief'\nupdates = 6\n[settings]\n"


CRITICS = "critic_units = 16\ncritic_first = 1\ncritic_steps = 2\ngradient_steps = 2\n"


GRADIENT = parsed(ROWS.format("gradient") + "episodes = 8\nwindow = 10\n[settings.actor_settings]\nunits = 6\n", "brief")


PPO = parsed(ROWS.format("ppo") + "blades = 8\nhistory = 3\nrollout = 4\nbatch = 32\nunits = 8\n", "brief")


SAC = parsed(
    ROWS.format("sac") + "blades = 8\nhistory = 3\nrollout = 4\nbatch = 16\nfirst = 32\nbuffer = 256\nunits = 8\n" + CRITICS,
    "brief",
)


TQC = parsed(
    ROWS.format("tqc") + "blades = 8\nhistory = 3\nrollout = 4\nbatch = 16\nfirst = 32\nbuffer = 64\nunits = 8\n" + CRITICS, "brief"
)


RECURRENT = parsed(ROWS.format("recurrent-ppo") + "blades = 8\nrollout = 4\nbatch = 32\nunits = 8\n", "brief")


def job(recipe, scenario="nominal", seed=0, updates=6):
    return Job(recipe.agent, recipe, scenario, seed, Budget(updates=updates), SHORT)


def ignore(progress):
    pass


def interrupted_after(updates):
    def report(progress):
        if progress.updates == updates:
            raise KeyboardInterrupt

    return report


def weights(folder):
    with np.load(folder / "weights.npz", allow_pickle=False) as arrays:
        return {name: arrays[name] for name in arrays.files}


def assert_same(first, second):
    assert set(first) == set(second)
    for name, weight in first.items():
        np.testing.assert_array_equal(weight, second[name])
