"""Who and what is chosen is chosen on plants of its own: neither those that train nor those that judge."""

from contextlib import closing

import gymnasium
import numpy as np

import beamenv
from beamenv.knowledge import on_validation_bank
from beamenv.scenarios.scenario import scenario
from beamenv.task import resolve_task
from train.benchmark.bench import Bench, Setting
from train.controllers.named import named
from train.learning.validation import EPISODES, Validation
from train.shared.held_out import VALIDATION

ON_FIVE_PLANTS = {"plants": {"speed_ratio": [0.7, 1.3], "bank": 5}}
SHORT = 0.02


def test_the_benchmark_chooses_on_plants_of_its_own_with_laws_told_as_where_they_are_judged():
    choosing, judging = (Setting("own", scenario(ON_FIVE_PLANTS), 3, '{"duration": 0.02}', each) for each in (True, False))
    with closing(Bench()) as one, closing(Bench()) as other:
        chosen, judged = one.blades(choosing), other.blades(judging)
        moving = set(chosen.envs.unwrapped.task.bank.speeds)
        assert not moving & set(judged.envs.unwrapped.task.bank.speeds)
        assert moving == set(chosen.task.truth.bank.speeds)
        assert not moving & set(chosen.task.prior.bank.speeds)
        assert chosen.task.prior.scenario == judged.task.prior.scenario
        assert chosen.task.design.config == judged.task.design.config


def test_of_what_is_kept_for_judging_a_bench_that_chooses_tells_nothing():
    with closing(Bench()) as bench:
        blades = bench.blades(Setting("long-delay", scenario("long-delay"), 2, '{"duration": 0.02}', validation=True))
        assert blades.task.prior.scenario.drive.delay == (0, 0)


def test_training_looks_at_a_policy_in_the_episodes_of_that_bank():
    task = resolve_task(scenario=ON_FIVE_PLANTS, duration=SHORT)
    looked = resolve_task(scenario=on_validation_bank(task.scenario), duration=SHORT)
    law = named("lqg").build_for(task)
    there, here = (_relative(each, law) for each in (looked, task))
    assert np.isclose(Validation([task]).cost(law), there, rtol=1e-12)
    assert not np.isclose(here, there, rtol=1e-3)


def _relative(task, law):
    """J over no control, by the batched environment."""
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=EPISODES, scenario=task.scenario, duration=SHORT, dtype="float64")
    costs = []
    for controlled in (True, False):
        readings, _ = envs.reset(seed=list(range(VALIDATION, VALIDATION + EPISODES)))
        memory, total = None, 0.0
        for _ in range(task.steps):
            action, memory = law.predict(readings, memory) if controlled else (np.zeros((EPISODES, 4)), None)
            readings, *_, info = envs.step(action)
            total += info["cost_increment"].mean()
        costs.append(total)
    return costs[0] / costs[1]
