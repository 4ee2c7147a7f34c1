"""Which controllers the tests export: all laws by their registry, so that a new one takes part by itself, and all agents."""

import pytest

from beamenv.task import resolve_task
from train.controllers.named import discover
from train.controllers.shipped import shipped
from train.controllers.sources import Trained

NOT_EXPORTED = {
    "clairvoyant": "what the truth of the episode is",
    "informed-mpc": "quadratic program",
    "lqr": "the blade's true state",
    "lqr-load": "the blade's true state",
    "mpc": "quadratic program",
    "mpc-load": "quadratic program",
    "run-up-lqg": "worked out on the way",
}
"""By name, with what its sentence says."""

BIG = {"multiple-model-general"}  # 35 MB of C
QUICK = {"gradient", "residual", "belief", "sac", "optimised-linear"}


def _case(name, build, scenario, slow):
    return pytest.param(build, scenario, id=f"{name}, {scenario}", marks=[pytest.mark.slow] if slow else [])


def _law(name, scenario):
    return lambda: discover()[name].build_for(resolve_task(scenario=scenario))


def _agent(folder, scenario):
    return lambda: Trained(folder).build(resolve_task(scenario=scenario))


def _agents():
    for each in shipped():
        if each.seed == 0:
            scenario = "default" if each.scenario == "generalist" else each.scenario
            slow = each.agent not in QUICK or each.scenario not in ("generalist", "nominal")
            yield _case(each.agent, _agent(each.folder, scenario), scenario, slow)


LAWS = [
    *(_case(name, _law(name, "default"), "default", name in BIG) for name in discover() if name not in NOT_EXPORTED),
    _case("multiple-model", _law("multiple-model", "delay"), "delay", False),  # otherwise made than in the default scenario
    _case("multiple-model", _law("multiple-model", "mid-failure"), "mid-failure", True),
    _case("multiple-model", _law("multiple-model", "failure"), "failure", True),
    _case("inverse-hysteresis", _law("inverse-hysteresis", "hysteresis"), "hysteresis", True),
]

EVERY = [*LAWS, *_agents()]
"""What builds a controller, and the scenario whose episodes it is run in."""
