"""The block diagram of a multiple-model law: a bank of filters, how likely each is, and one voltage from all of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from baselines import LinearController, MultipleModel
from train.export.blocks import Block, Delay, affine, choose, clip, function, join, pair, pick, reduce, signal
from train.export.innovations import Innovations, innovations, lost_readings
from train.export.motions import Moving, moving
from train.export.scales import Drawn, Scales

LEAST = float(np.finfo(np.float32).tiny)
"""Of a weight: what single precision can hold."""


class Asked(NamedTuple):
    """What there is to revise."""

    models: Block
    """(m,), of the drive's limit: what the law asks for, the fallback's where that is in charge."""
    fallback: Block
    """(m,): what the fallback asks for."""
    misfit: Block
    """(1,): how badly any model fits."""
    weights: Block
    """(H,): how likely each is."""


Revision = Callable[[Asked], Block]


class Remembered(NamedTuple):
    """What the law remembers besides the filters' states, as ``baselines.design.weighing.Memory`` has it."""

    evidence: Delay
    squared: Delay
    voltages: Delay
    reading: Delay
    own: Delay
    instant: Delay
    readings: Delay
    astray: Delay

    @classmethod
    def of(cls, law: MultipleModel) -> Remembered:
        """One delay for each; those of no numbers are left out in the end."""
        H, p = law.bank.counts[0], law.instruments.counts[0]
        own = 0 if law.fallback is None else law.fallback.order
        sizes = {"evidence": H, "squared": H, "voltages": law.voltage_gain.shape[-1], "reading": p, "own": own}
        return cls(**{name: Delay(sizes.get(name, 1), label=name) for name in cls._fields})


def multiple_model(law: MultipleModel, readings: Block, scales: Scales, revise: Revision | None = None) -> Drawn:
    """Correct, weigh, drive, predict; with actions (m,) that are ``revise``d if that is given."""
    old, motion = Remembered.of(law), moving(law)
    current, p = readings * scales.full_scale, law.instruments.counts[0]
    step = pair("minimum", old.instant, len(law.bank.cross) - 1.0, label="step")
    lost = lost_readings(law.bank, readings, old.reading, old.instant)
    found = innovations(law.bank, step, current, motion.seen[:p], lost)
    weights, evidence = _weighed(law, old.evidence + found.log_density)
    misfit, judged = _judged(law, old, found, lost, weights)
    voltage = _mean(law, motion, found, step, old.voltages, weights)
    if law.fallback is not None:
        cautious = _of_fallback(law, law.fallback, old.own, current)
        voltage = choose(judged[old.astray], cautious, voltage, label="voltage")
        if revise is not None:
            voltage = revise(Asked(voltage / scales.drive, cautious / scales.drive, misfit, weights)) * scales.drive
        judged[old.own] = _followed(law.fallback, old.own, current, voltage)
    voltages = join(voltage, old.voltages)
    moved, evidence = motion.follow(step, found.whitened, voltages, weights, evidence)
    following = {
        **judged,
        motion.states: moved,
        old.evidence: evidence,
        old.voltages: voltages[: old.voltages.size],
        old.reading: readings,
        old.instant: pair("minimum", old.instant + 1.0, float(max(len(law.bank.cross), law.window + 1))),
    }
    return Drawn(voltage / scales.drive, {delay: block for delay, block in following.items() if delay.size})


def _weighed(law: MultipleModel, evidence: Block) -> tuple[Block, Block]:
    """Weights (H,), each at least the floor, which add up to 1, and the logarithm of each over that beforehand."""
    prior, floor = np.log(law.prior), max(law.floor, LEAST)
    logarithm = pair("add", evidence, prior)
    logarithm = logarithm - reduce("maximum", logarithm)
    weights = function("exp", logarithm)
    whole = reduce("sum", weights)
    weights = pair("maximum", weights / whole, floor)
    together = reduce("sum", weights)
    logarithm = pair("maximum", logarithm - function("log", whole), float(np.log(floor)))
    return pair("divide", weights, together, label="weights"), logarithm - function("log", together) - prior


def _judged(
    law: MultipleModel, old: Remembered, found: Innovations, lost: list[Block], weights: Block
) -> tuple[Block, dict[Delay, Block]]:
    """How badly any hypothesis fits (1,), and what is remembered of that; where none has, it stays so."""
    fading, p = 1.0 - 1.0 / law.window, law.instruments.counts[0]
    squared = old.squared * fading + found.squared
    count = p - reduce("sum", join(*lost)) if lost else signal(float(p))
    readings = old.readings * fading + count
    mean = reduce("sum", weights * squared)
    bad = pair("greater", mean, readings * law.misfit) * pair("greater", old.instant, law.window - 0.5)
    astray = pair("maximum", old.astray, bad, label="now_astray")
    misfit = pair("divide", mean, pair("maximum", readings, 1.0), label="misfit")
    return misfit, {old.squared: squared, old.readings: readings, old.astray: astray}


def _mean(law: MultipleModel, motion: Moving, found: Innovations, step: Block, before: Block, weights: Block) -> Block:
    """(m,), V: the mean of what each regulator asks for, as the drive lets it through."""
    H, m = law.state_gain.shape[:2]
    limits, p = law.instruments.voltage_limits, law.instruments.counts[0]
    by_voltage = np.arange(H * m).reshape(H, m).T
    answers = pick(motion.answers(step, found.whitened), by_voltage) - join(*motion.seen[p:])
    if before.size:
        answers = answers - affine(law.voltage_gain.swapaxes(0, 1).reshape(m * H, -1), before)
    answers = clip(answers, np.repeat(limits, H, axis=1), label="answers")
    return reduce("sum", answers * pick(weights, np.tile(np.arange(H), m)), m)


def _of_fallback(law: MultipleModel, fallback: LinearController, own: Block, current: Block) -> Block:
    """(m,), V: what it asks for by its memory, as the drive lets it through."""
    asked = affine(fallback.state_gain, own) + affine(fallback.measurement_gain, current)
    return clip(asked, law.instruments.voltage_limits, label="cautious")


def _followed(fallback: LinearController, own: Block, current: Block, voltage: Block) -> Block:
    """The fallback remembers what is applied, whoever is in charge."""
    moved = affine(fallback.transition, own) + affine(fallback.measurement_input, current)
    return moved + affine(fallback.voltage_input, voltage)
