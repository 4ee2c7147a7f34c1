"""Environments of one blade share what it has built, and what no environment has any longer is forgotten."""

import gc
from weakref import ref

import gymnasium

import beamenv

OWN = {"speed": 123.0}


def test_equal_environments_share_their_task_and_their_blade():
    one, other = (gymnasium.make(beamenv.ENV_ID, blade=OWN).unwrapped.task for _ in range(2))
    longer = gymnasium.make(beamenv.ENV_ID, blade=OWN, duration=0.1).unwrapped.task
    assert one is other and longer is not one and longer.blade is one.blade


def test_a_blade_that_no_environment_has_is_forgotten_with_all_that_it_has_built(kept_blades):
    env = gymnasium.make(beamenv.ENV_ID, blade={"speed": 124.0}, duration=0.01)
    env.reset(seed=0)
    task = env.unwrapped.task
    kept = [ref(each) for each in (task, task.blade, task.plant.A, task.bank.release)]
    env.close()
    del env, task
    kept_blades.clear()
    gc.collect()
    assert [each() for each in kept] == [None] * 4
