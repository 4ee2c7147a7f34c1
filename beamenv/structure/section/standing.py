"""Whether the walls of a section stand on one another: all are joined, and none cross."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.scale import Contradiction
from beamenv.structure.walls.chain import Chain

Array = NDArray[np.float64]


def check_joined(chains: Sequence[Chain], joined: Iterable[tuple[int, int]]) -> None:
    """``ValueError`` for chains that are in more than one part; ``joined`` are pairs of those that end on one another."""
    part = list(range(len(chains)))
    for one, other in joined:
        part = [part[one] if each == part[other] else each for each in part]
    alone = [k for k, each in enumerate(part) if each != part[0]]
    if alone:
        raise Contradiction(f"section is in parts: wall {chains[alone[0]].walls[0]!r} must end on another wall, or another on it.")


def check_apart(chains: Sequence[Chain]) -> None:
    """``ValueError`` for walls that cross."""
    for one, other in combinations(chains, 2):
        crossing = _crossing(one, other)
        if crossing is not None:
            raise Contradiction(f"section has walls {crossing[0]!r} and {crossing[1]!r} that cross, but one must end on the other.")


def _crossing(one: Chain, other: Chain) -> tuple[str, str] | None:
    """The names of two pieces of which each crosses the other between its ends."""
    across = _sides(one, other.starts) * _sides(one, other.ends), (_sides(other, one.starts) * _sides(other, one.ends)).T
    found = np.argwhere((across[0] < 0.0) & (across[1] < 0.0))
    return (one.walls[found[0, 0]], other.walls[found[0, 1]]) if len(found) else None


def _sides(chain: Chain, points: Array) -> Array:
    """(K, P): on which side of each piece points lie; 0 in line with it, within rounding."""
    along, to = (chain.ends - chain.starts)[:, None], points[None] - chain.starts[:, None]
    turned = along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0]
    size = np.abs(along).max() * np.abs(to).max()
    return np.where(np.abs(turned) <= 1e-9 * size, 0.0, np.sign(turned))
