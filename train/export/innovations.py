"""What readings say of each hypothesis: innovations, whitened by L D Lᵀ of their covariances, all hypotheses at once."""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np

from baselines.design.filter_bank import FilterBank
from train.export.blocks import Block, choose, clip, function, join, pair, pick, products, signal

Entries = dict[tuple[int, int], Block]


class Innovations(NamedTuple):
    """Of H hypotheses, as ``baselines.design.filter_bank.Correction`` has it."""

    whitened: Block
    """(H · p,)."""
    squared: Block
    """(H,)."""
    log_density: Block
    """(H,)."""


def lost_readings(bank: FilterBank, readings: Block, before: Block, instant: Block) -> list[Block]:
    """1 for each reading (1,) that shows the one before, and is not clipped; none where no hypothesis says that lost ones do."""
    if not bank.holds.any():
        return []
    inside = pair("greater", 1.0, function("absolute", readings))
    again = pair("equal", readings, before) * inside * pair("greater", instant, 0.5)
    return [again[i] for i in np.arange(readings.size)[:, None]]


def innovations(bank: FilterBank, step: Block, current: Block, expected: list[Block], lost: list[Block]) -> Innovations:
    """From readings ``current`` (p,), A, and those that each hypothesis expects, p blocks (H,), as they will be taken: clipped."""
    p, H = current.size, bank.counts[0]
    full = bank.full_scale
    errors = [current[[i]] - clip(each, (-full[i], full[i])) for i, each in enumerate(expected)]
    entries = _entries(bank, step)
    kept = [1.0 - each for each in lost]
    left, seen = (_without(entries, lost, kept), [e * k for e, k in zip(errors, kept, strict=True)]) if lost else (entries, errors)
    whitened, squared, logarithm = _solved(left, seen)
    if lost and not bank.holds.all():
        others, _, _ = _solved(entries, errors)
        holds = signal(bank.holds.astype(float))
        whitened = [choose(holds, own, other) for own, other in zip(whitened, others, strict=True)]
    by_hypothesis = np.arange(p * H).reshape(p, H).T
    return Innovations(pick(join(*whitened), by_hypothesis, label="whitened"), squared, (squared + logarithm) * -0.5)


def _entries(bank: FilterBank, step: Block) -> Entries:
    """Lower triangle of the covariances at an instant, each entry (H,)."""
    p, H = bank.full_scale.size, bank.counts[0]
    places = [(i, j) for i, j in product(range(p), repeat=2) if j <= i]
    table = np.stack([bank.covariance[..., i, j] for i, j in places], axis=-1)[..., None]
    found = products(table, signal(np.ones(H)), step, label="covariance")
    return {place: pick(found, np.arange(H) * len(places) + k) for k, place in enumerate(places)}


def _without(entries: Entries, lost: list[Block], kept: list[Block]) -> Entries:
    """The same with rows and columns of the identity for what is lost: it says nothing then."""
    return {(i, j): each * kept[i] + lost[i] if i == j else each * (kept[i] * kept[j]) for (i, j), each in entries.items()}


def _solved(entries: Entries, errors: list[Block]) -> tuple[list[Block], Block, Block]:
    """Covariance⁻¹ e, p blocks (H,), eᵀ covariance⁻¹ e and the logarithm of the determinant, by L D Lᵀ."""
    p = len(errors)
    low: Entries = {}
    pivots: list[Block] = []
    forward: list[Block] = []
    for j in range(p):
        pivot, own = entries[j, j], errors[j]
        for k in range(j):
            pivot = pivot - low[j, k] * low[j, k] * pivots[k]
            own = own - low[j, k] * forward[k]
        pivots.append(pivot)
        forward.append(own)
        for i in range(j + 1, p):
            rest = entries[i, j]
            for k in range(j):
                rest = rest - low[i, k] * low[j, k] * pivots[k]
            low[i, j] = rest / pivot
    solved = [each / pivot for each, pivot in zip(forward, pivots, strict=True)]
    squared, logarithm = forward[0] * solved[0], function("log", pivots[0])
    for j in range(1, p):
        squared, logarithm = squared + forward[j] * solved[j], logarithm + function("log", pivots[j])
    for j in reversed(range(p)):
        for i in range(j + 1, p):
            solved[j] = solved[j] - low[i, j] * solved[i]
    return solved, squared, logarithm
