"""The block diagram of a law behind the inverse of its actuators' hysteresis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from baselines import InverseHysteresis
from beamenv.simulation.signals.hysteresis import Hysteresis
from train.export.blocks import Array, Block, Delay, affine, choose, clip, join, pair, pick, reduce, signal
from train.export.laws import linear_law, moved, normalised_matrices
from train.export.scales import Drawn, Scales

SMALLEST = 1e-30
"""A difference that is divided by is no smaller: single precision can hold it."""


def inverse_hysteresis(law: InverseHysteresis, readings: Block, scales: Scales) -> Drawn:
    """What acts is what the linear law asks for; that law alone if there is no hysteresis."""
    if not law.loop:
        return linear_law(law.law, readings, scales)
    F, G, H, M, T = normalised_matrices(law.law, scales)
    memory, plays = Delay(law.law.order, label="memory"), Delay(scales.drive.size * len(law.operator.radii), label="plays")
    action = _inverse(law.operator, affine(M, memory) + affine(T, readings), plays, scales.limits)
    following, acting = _acting(law.operator, action, plays)
    return Drawn(action, {memory: moved(memory, (F, G, H), readings, acting), plays: following})


def _acting(operator: Hysteresis, voltages: Block, plays: Block) -> tuple[Block, Block]:
    """The plays' next outputs (n · J,), and what acts (n,) of n voltages."""
    J = len(operator.radii)
    radii, each = np.tile(operator.radii, voltages.size), pick(voltages, np.repeat(np.arange(voltages.size), J))
    following = clip(plays, (each - radii, each + radii))
    return following, voltages * operator.direct + reduce("sum", following, voltages.size) * operator.weight


def _inverse(operator: Hysteresis, wanted: Block, plays: Block, limits: Array) -> Block:
    """Voltages (m,) within the limits that act as wanted, or come nearest.

    What acts rises with the voltage, and is linear between its bends and the limits: between the last of them at which less acts
    than is wanted and the first at which more does.
    """
    m, J = wanted.size, len(operator.radii)
    count = 2 * J + 2
    at = _bends(operator, plays, limits)
    acts = _acting(operator, at, pick(plays, np.repeat(np.arange(m * J).reshape(m, 1, J), count, axis=1)))[1]

    def spread(of: Block) -> Block:
        return pick(of, np.repeat(np.arange(m), count))

    more = pair("greater", acts, spread(wanted))
    least, most = spread(reduce("minimum", acts, m)), spread(reduce("maximum", acts, m))
    below = reduce("maximum", choose(more, np.repeat(limits[0], count), at), m)
    above = reduce("minimum", choose(more, at, np.repeat(limits[1], count)), m)
    acts_below, acts_above = reduce("maximum", choose(more, least, acts), m), reduce("minimum", choose(more, acts, most), m)
    share = (wanted - acts_below) / pair("maximum", acts_above - acts_below, SMALLEST)
    return pair("add", below, (above - below) * clip(share, (0.0, 1.0)), label="action")


def _bends(operator: Hysteresis, plays: Block, limits: Array) -> Block:
    """Voltages (m · (2 J + 2),) of each actuator: where a play sets in, upwards and downwards, within the limits, and these."""
    m, J = limits.shape[1], len(operator.radii)
    radii = np.tile(operator.radii, m)
    each = np.repeat(limits, J, axis=1)
    upwards, downwards = clip(plays + radii, each), clip(plays - radii, each)
    return pick(join(upwards, downwards, signal(limits)), _by_actuator(m, J, J, 1, 1))


def _by_actuator(m: int, *counts: int) -> NDArray[np.int64]:
    """Indices (m, …) of parts, one after the other, that have so many numbers of each actuator."""
    firsts = m * np.cumsum([0, *counts[:-1]])
    parts = (first + np.arange(m * count).reshape(m, count) for first, count in zip(firsts, counts, strict=True))
    return np.concatenate(list(parts), axis=1)
