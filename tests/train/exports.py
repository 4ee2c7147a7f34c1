"""Which controllers the tests export: all laws by their registry, so that a new one takes part by itself, and all agents."""

from functools import lru_cache

import numpy as np
import pytest

from beamenv.task import resolve_task
from train.controllers.lstm_policy import LSTMPolicy
from train.controllers.named import discover
from train.controllers.policies import HistoryPolicy
from train.controllers.shipped import shipped
from train.controllers.sources import Trained

NOT_EXPORTED = {
    "adaptive-neural": "learns at every instant",
    "clairvoyant": "what the truth of the episode is",
    "informed-mpc": "quadratic program",
    "lqr": "the blade's true state",
    "lqr-load": "the blade's true state",
    "mpc": "quadratic program",
    "mpc-load": "quadratic program",
    "spin-up-lqg": "worked out on the way",
}
"""By name, with what its sentence says."""

BIG = {"multiple-model-general"}  # 35 MB of C
QUICK = {"gradient", "residual", "belief", "sac", "optimised-linear"}


def _case(name, build, scenario, slow):
    return pytest.param(build, scenario, id=f"{name}, {scenario}", marks=[pytest.mark.slow] if slow else [])


def _once(build):
    """What builds a controller, for all tests of a process."""
    return lru_cache(maxsize=1)(build)


def _law(name):
    return _once(lambda scenario: discover()[name].build_for(resolve_task(scenario=scenario)))


def _agent(folder):
    return _once(lambda scenario: Trained(folder).build(resolve_task(scenario=scenario)))


def _agents():
    for each in shipped():
        if each.seed == 0:
            scenario = "nominal" if each.scenario == "generalist" else each.scenario
            slow = each.agent not in QUICK or each.scenario not in ("generalist", "nominal")
            yield _case(each.agent, _agent(each.folder), scenario, slow)


LAWS = [
    *(_case(name, _law(name), "nominal", name in BIG) for name in discover() if name not in NOT_EXPORTED),
    _case("multiple-model", _law("multiple-model"), "delay", False),  # otherwise made than in the nominal scenario
    _case("multiple-model", _law("multiple-model"), "mid-failure", True),
    _case("multiple-model", _law("multiple-model"), "failure", True),
    _case("inverse-hysteresis", _law("inverse-hysteresis"), "hysteresis", True),
]


def _random(**shapes):
    """Weights of a network that would drive a blade somehow, in single precision as those that are trained."""
    generator = np.random.default_rng(0)
    return {name: (generator.normal(size=shape) / np.sqrt(shape[-1])).astype(np.float32) for name, shape in shapes.items()}


def _history(**settings):
    weights = _random(weight0=(6, 24), bias0=(6,), weight1=(6, 6), bias1=(6,), weight2=(4, 6), bias2=(4,))
    weights["weight2"] *= 0.05  # so small that the loop with the blade is stable
    return _once(lambda scenario: HistoryPolicy("history", weights, {"input_gain": 4.0, **settings}, -ONES, ONES))


def _lstm(held):
    gates = {"weight_ih": (20, 24), "weight_hh": (20, 5), "bias_ih": (20,), "bias_hh": (20,)}
    weights = _random(**gates, weight_out=(4, 5), bias_out=(4,))
    weights["weight_out"] *= 0.05
    return _once(lambda scenario: LSTMPolicy("lstm", weights, {"input_gain": 4.0, "held": held}, -0.5 * ONES, ONES))


ONES = np.ones(4, np.float32)

MADE_UP = [
    _case("history", _history(held=1), "nominal", False),
    _case("history of 3", _history(held=3, approach=0.3, activation="relu"), "nominal", False),
    _case("squashed history", _history(held=2, squashed=True), "nominal", False),
    _case("lstm", _lstm(1), "nominal", False),
    _case("lstm of 2", _lstm(2), "nominal", False),
]
"""Kinds of agents of which none ships, three instants in a window."""

EVERY = [*LAWS, *_agents(), *MADE_UP]
"""What builds a controller, and the scenario whose episodes it is run in."""
