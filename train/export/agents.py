"""Block diagrams of trained agents."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from train.controllers.belief_policy import BeliefPolicy
from train.controllers.lstm_policy import LSTMPolicy
from train.controllers.models_policy import SHARPNESS, ModelsPolicy
from train.controllers.policies import HistoryPolicy, Policy, RecurrentPolicy, ResidualPolicy, StateSpacePolicy
from train.export.blocks import Block, Delay, affine, choose, clip, function, join, pair
from train.export.many_models import Asked, multiple_model
from train.export.scales import Drawn, Scales

Weights = Mapping[str, Any]

UNIT = (-1.0, 1.0)
"""Readings within full scale, voltages within the drive's limit."""

LEAST_MISFIT = 1e-3
"""What ``ModelsPolicy`` adds to a misfit before its logarithm."""


def held_before(policy: Policy) -> Delay:
    """The voltages that were held over the last interval."""
    return Delay(len(policy.lowest), label="voltages")


def limited(policy: Policy, asked: Block) -> Block:
    """What the drive lets through."""
    return clip(asked, (policy.lowest, policy.highest), label="action")


def state_space(policy: StateSpacePolicy, readings: Block) -> Drawn:
    """A filter's memory, and what it drives."""
    asked, memory, onward = law_beside(policy.weights, readings)
    action = limited(policy, asked)
    return Drawn(action, {memory: onward + affine(policy.weights["feedback"].T, action)})


def law_beside(weights: Weights, readings: Block) -> tuple[Block, Delay, Block]:
    """Voltages that the law of these ``fused`` and ``readout`` asks for, its memory, and the next one before feedback."""
    order = len(weights["readout"])
    memory = Delay(order, label="memory")
    expected = affine(weights["readout"].T, memory, label="expected")
    given = readings + expected - clip(expected, UNIT)
    product = affine(weights["fused"].T, join(memory, given), label="product")
    return product[order:], memory, product[:order]


def recurrent(policy: RecurrentPolicy, readings: Block) -> Drawn:
    """A gated recurrent unit."""
    hidden, voltages = hidden_units(policy.weights), held_before(policy)
    inputs = join(readings * policy.settings["input_gain"], voltages)
    following, output = gated_unit(policy.weights, inputs, hidden)
    action = limited(policy, output)
    return Drawn(action, {hidden: following, voltages: action})


def residual(policy: ResidualPolicy, readings: Block) -> Drawn:
    """A linear law, and a unit that weighs it and adds to it."""
    hidden, voltages, m = hidden_units(policy.weights), held_before(policy), len(policy.lowest)
    asked, memory, onward = law_beside(policy.weights, readings)
    asked = clip(asked, (policy.lowest, policy.highest), label="asked")
    inputs = join(readings * policy.settings["input_gain"], voltages, asked)
    following, output = gated_unit(policy.weights, inputs, hidden)
    action = limited(policy, (output[:m] + 1.0) * asked + output[m:])
    onward = onward + affine(policy.weights["feedback"].T, action)
    return Drawn(action, {hidden: following, memory: onward, voltages: action})


def hidden_units(weights: Weights) -> Delay:
    """Of a recurrent network."""
    return Delay(weights["weight_hh"].shape[1], label="hidden")


def gated_unit(weights: Weights, inputs: Block, hidden: Block) -> tuple[Block, Block]:
    """Next hidden units and tanh outputs of a gated recurrent unit."""
    units = hidden.size
    given = affine(weights["weight_ih"], inputs, weights["bias_ih"], label="from_inputs")
    kept = affine(weights["weight_hh"], hidden, weights["bias_hh"], label="from_hidden")
    gates = function("sigmoid", given[: 2 * units] + kept[: 2 * units], label="gates")
    reset, update = gates[:units], gates[units:]
    candidate = function("tanh", given[2 * units :] + reset * kept[2 * units :], label="candidate")
    following = (1.0 - update) * candidate + update * hidden
    return following, function("tanh", affine(weights["weight_out"], following, weights["bias_out"]), label="output")


def history(policy: HistoryPolicy, readings: Block) -> Drawn:
    """A network on a window of the last instants."""
    voltages = held_before(policy)
    window, shifted = _window(policy.weights["weight0"].shape[1], readings, voltages)
    asked = _towards(network(policy, shifted), voltages, policy)
    action, age = _held(policy, asked, voltages)
    return Drawn(action, {window: shifted, voltages: action, **age})


def _window(width: int, readings: Block, voltages: Block) -> tuple[Delay, Block]:
    """The window as it was, and with the newest instant in place of the oldest."""
    window = Delay(width, label="window")
    return window, join(window[readings.size + voltages.size :], readings, voltages, label="shifted")


def network(policy: Policy, inputs: Block) -> Block:
    """What the layers ``weight0``, ``bias0``, … make of inputs."""
    weights, settings = policy.weights, policy.settings
    hidden, depth = inputs * settings["input_gain"], sum(name.startswith("bias") for name in weights)
    for layer in range(depth):
        hidden = affine(weights[f"weight{layer}"], hidden, weights[f"bias{layer}"], label=f"layer{layer}")
        if layer < depth - 1:
            hidden = pair("maximum", hidden, 0.0) if settings.get("activation") == "relu" else function("tanh", hidden)
    return function("tanh", hidden) if settings.get("squashed") else hidden


def _towards(asked: Block, voltages: Block, policy: Policy) -> Block:
    """Voltages a share ``approach`` of the way from those held before to those asked for."""
    share = policy.settings.get("approach", 1.0)
    return asked if share == 1.0 else voltages + (clip(asked, UNIT) - voltages) * share


def _held(policy: Policy, asked: Block, voltages: Block) -> tuple[Block, dict[Delay, Block]]:
    """The action, new at every ``held``-th instant, and how long it has been held."""
    held = policy.settings["held"]
    if held == 1:
        return limited(policy, asked), {}
    age = Delay(1, label="age")
    due, older = _due(age), age + 1.0
    following = choose(pair("greater", older, held - 0.5), 0.0, older)
    return limited(policy, choose(due, asked, voltages)), {age: following}


def _due(age: Block) -> Block:
    return pair("equal", age, 0.0, label="due")


def belief(policy: BeliefPolicy, readings: Block) -> Drawn:
    """A network on what a filter makes of all readings so far."""
    weights, voltages = policy.weights, held_before(policy)
    predicted = Delay(len(weights["transition"]), label="predicted")
    expected = clip(affine(weights["readout"].T, predicted), UNIT, label="expected")
    estimate = predicted + affine(weights["correction"].T, readings - expected)
    shown = join(affine(weights["shown"].T, estimate), voltages, label="shown")
    action, age = _held(policy, _towards(network(policy, shown), voltages, policy), voltages)
    following = affine(weights["transition"].T, estimate) + affine(weights["input"].T, action)
    return Drawn(action, {predicted: following, voltages: action, **age})


def lstm(policy: LSTMPolicy, readings: Block) -> Drawn:
    """Long short-term memory on a window, asked every few instants."""
    weights, voltages, units = policy.weights, held_before(policy), policy.weights["weight_hh"].shape[1]
    hidden, cell = Delay(units, label="hidden"), Delay(units, label="cell")
    window, shifted = _window(weights["weight_ih"].shape[1], readings, voltages)
    gates = affine(weights["weight_ih"], shifted * policy.settings["input_gain"], weights["bias_ih"])
    gates = gates + affine(weights["weight_hh"], hidden, weights["bias_hh"])
    taken, kept, candidate, shown = (gates[part * units : (part + 1) * units] for part in range(4))
    new_cell = function("sigmoid", kept) * cell + function("sigmoid", taken) * function("tanh", candidate)
    new_hidden = function("sigmoid", shown) * function("tanh", new_cell)
    action, age = _held(policy, affine(weights["weight_out"], new_hidden, weights["bias_out"]), voltages)
    for own in age:
        new_hidden, new_cell = (choose(_due(own), *each) for each in ((new_hidden, hidden), (new_cell, cell)))
    return Drawn(action, {window: shifted, hidden: new_hidden, cell: new_cell, voltages: action, **age})


def weighing_models(policy: ModelsPolicy, readings: Block, scales: Scales) -> Drawn:
    """A unit that weighs a multiple-model law and its fallback, and adds to them."""
    if policy.law is None:
        raise ValueError(f"{policy.name} adds to a law that it must be given: build it for a task, or beside(law).")
    hidden, voltages, m = hidden_units(policy.weights), held_before(policy), len(policy.lowest)
    units: dict[Delay, Block] = {}

    def revised(asked: Asked) -> Block:
        fit = function("tanh", function("log", asked.misfit + LEAST_MISFIT) * SHARPNESS)
        seen = readings * policy.settings["input_gain"]
        inputs = join(seen, voltages, asked.models, asked.fallback, fit, asked.weights, label="inputs")
        units[hidden], output = gated_unit(policy.weights, inputs, hidden)
        both = (output[:m] + 1.0) * asked.models + output[m : 2 * m] * asked.fallback
        return limited(policy, both + output[2 * m :])

    drawn = multiple_model(policy.law, readings, scales, revised)
    return Drawn(drawn.action, {**drawn.following, **units, voltages: drawn.action})


AGENTS: Mapping[type[Policy], Callable[[Any, Block], Drawn]] = {
    HistoryPolicy: history,
    RecurrentPolicy: recurrent,
    StateSpacePolicy: state_space,
    ResidualPolicy: residual,
    BeliefPolicy: belief,
    LSTMPolicy: lstm,
}
"""Those whose weights tell all."""
