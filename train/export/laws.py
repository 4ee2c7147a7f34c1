"""Block diagrams of linear laws, and of those that are linear but for what they know of their instruments."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from baselines import ClippedLQG, LinearController, ScheduledLQG
from train.export.blocks import Array, Block, Delay, Input, affine, clip, join, pair, pick, products, reduce
from train.export.scales import Drawn, Scales


class Matrices(NamedTuple):
    """ξ⁺ = F ξ + G y + H u, u = clip(M ξ + T y): readings y of full scale, voltages u of the drive's limit."""

    F: Array
    G: Array
    H: Array
    M: Array
    T: Array


def normalised_matrices(law: LinearController, scales: Scales) -> Matrices:
    """Of a law, whatever units it takes and gives."""
    full, drive = scales.full_scale, scales.drive[:, None]
    G, T = law.measurement_input * full, law.measurement_gain * full / drive
    return Matrices(law.transition, G, law.voltage_input * scales.drive, law.state_gain / drive, T)


def linear_law(law: LinearController, readings: Block, scales: Scales) -> Drawn:
    """Two affine blocks around one delay."""
    F, G, H, M, T = normalised_matrices(law, scales)
    memory = Delay(law.order, label="memory")
    asked = affine(T, readings, label="from_readings")
    asked = affine(M, memory, label="from_memory") + asked if law.order else asked
    action = clip(asked, scales.limits, label="action")
    return Drawn(action, {memory: moved(memory, (F, G, H), readings, action)} if law.order else {})


def moved(memory: Delay, matrices: tuple[Array, Array, Array], readings: Block, acting: Block) -> Block:
    """F ξ + G y + H u."""
    F, G, H = matrices
    driven = affine(F, memory, label="moved") + affine(G, readings, label="read")
    return driven + affine(H, acting, label="driven") if H.any() else driven


def clipped_lqg(law: ClippedLQG, readings: Block, scales: Scales) -> Drawn:
    """A filter that expects readings as they will be taken."""
    predicted = Delay(law.order, label="predicted")
    highest = law.full_scale / scales.full_scale
    expected = clip(affine(law.output / scales.full_scale[:, None], predicted), (-highest, highest), label="expected")
    estimate = predicted + affine(law.kalman_gain * scales.full_scale, readings - expected)
    action = clip(affine(-law.feedback_gain / scales.drive[:, None], estimate), scales.limits, label="action")
    following = affine(law.transition, estimate) + affine(law.voltage_input * scales.drive, action)
    return Drawn(action, {predicted: following})


def scheduled_law(law: ScheduledLQG, readings: Block, scales: Scales) -> Drawn:
    """All laws of the grid, in shares that the measured speed decides."""
    speed = Input(1, "rad/s", label="speed")
    shares = _shares(speed, law.speeds)
    each = [normalised_matrices(one, scales) for one in law.laws]
    memory = Delay(law.order, label="memory")
    whole = np.stack([np.block([[one.F, one.G], [one.M, one.T]]) for one in each])
    product = _mixed(whole, join(memory, readings), shares)
    action = clip(product[law.order :], scales.limits, label="action")
    following = product[: law.order] + _mixed(np.stack([one.H for one in each]), action, shares)
    return Drawn(action, {memory: following}, (speed,))


def _shares(speed: Block, speeds: Array) -> Block:
    """(k,): all of it at a speed of its own, falling linearly to none at its neighbours'."""
    gaps = np.diff(speeds)
    within = clip(speed, (speeds[0], speeds[-1]))
    rising = (within - speeds) * np.append(0.0, 1.0 / gaps)
    falling = (within - speeds) * np.append(-1.0 / gaps, 0.0)
    return clip(pair("minimum", pair("add", rising, 1.0), pair("add", falling, 1.0)), (0.0, 1.0), label="shares")


def _mixed(matrices: Array, of: Block, shares: Block) -> Block:
    """Σ_j shares_j matrices_j (k, r, c) @ x."""
    k, r, c = matrices.shape
    each = products(matrices, pick(of, np.tile(np.arange(c), k))) * pick(shares, np.repeat(np.arange(k), r))
    return reduce("sum", pick(each, np.arange(k * r).reshape(k, r).T), r)
