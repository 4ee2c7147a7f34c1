"""Designs as arrays: where N designs' patches begin, how long they are, and how wide and thick their sheets; and feasible ones."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from baselines.placement.sizing.limits import Limits
from beamenv.blade.bounds import ascending

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Designs:
    """N designs of at most E patches, actuators first; one of no length is left out."""

    starts: Array
    """(N, E): root-side edges, m."""
    lengths: Array
    """(N, E), m; 0: none."""
    sizes: Array
    """(N, 4), m: width and thickness of the actuators' sheet, then of the sensors'."""

    def __len__(self) -> int:
        return len(self.starts)

    def __getitem__(self, which: slice | list[int] | NDArray[np.intp]) -> Designs:
        return Designs(self.starts[which], self.lengths[which], self.sizes[which])

    @classmethod
    def joined(cls, several: list[Designs]) -> Designs:
        """One after the other."""
        return cls(*(np.concatenate([getattr(each, name) for each in several]) for name in ("starts", "lengths", "sizes")))

    @property
    def rows(self) -> Array:
        """(N, 2 E + 4): starts, lengths, sizes."""
        return np.concatenate([self.starts, self.lengths, self.sizes], axis=1)

    @classmethod
    def of_rows(cls, rows: Array) -> Designs:
        """From such rows."""
        patches = (rows.shape[1] - 4) // 2
        return cls(rows[:, :patches], rows[:, patches:-4], rows[:, -4:])

    def volumes(self, limits: Limits) -> Array:
        """(N, 2), m³ of the actuators and of the sensors."""
        longs = np.stack([self.lengths[:, limits.side_of == side].sum(axis=1) for side in (0, 1)], axis=1)
        return longs * self.sizes[:, 0::2] * self.sizes[:, 1::2]

    def channels(self, limits: Limits) -> NDArray[np.intp]:
        """(N,): actuators that are there."""
        return np.asarray(np.count_nonzero(self.lengths[:, limits.side_of == 0], axis=1), dtype=np.intp)


def repaired(designs: Designs, limits: Limits) -> Designs:
    """The nearest designs that can be made: sizes within their ranges, patches shorter than half the shortest left out but one of
    each side, those that do not fit shortened, then moved apart.
    """
    sizes = np.clip(designs.sizes, limits.least_sizes, limits.largest_sizes)
    starts, lengths = designs.starts.copy(), designs.lengths.copy()
    for side in (0, 1):
        own = limits.side_of == side
        lengths[:, own] = fitted(lengths[:, own], limits)
        starts[:, own], lengths[:, own] = apart(starts[:, own], lengths[:, own], limits.end)
    return Designs(starts, lengths, sizes)


def fitted(lengths: Array, limits: Limits) -> Array:
    """Lengths (N, e) that can be cut and find room on the span."""
    shortest, longest = limits.length
    found = np.where(lengths < 0.5 * shortest, 0.0, np.clip(lengths, shortest, longest))
    none = np.flatnonzero(~found.any(axis=1))
    found[none, lengths[none].argmax(axis=1)] = shortest
    for _ in range(found.shape[1]):
        total = found.sum(axis=1)
        beyond = np.flatnonzero(total > limits.end)
        if not len(beyond):
            break
        shrunk = found[beyond] * (limits.end / total[beyond])[:, None]
        found[beyond] = np.where(found[beyond] > 0.0, np.maximum(shrunk, shortest), 0.0)
        still = beyond[found[beyond].sum(axis=1) > limits.end * (1.0 + 1e-12)]
        least = np.where(found[still] > 0.0, found[still], np.inf).argmin(axis=1)
        found[still, least] = 0.0
    return found


def apart(starts: Array, lengths: Array, end: float) -> tuple[Array, Array]:
    """Starts and lengths (N, e) in ascending order, moved by the least sum of squares so that no patch lies on another."""
    order = np.argsort(starts + 0.5 * lengths, axis=1, kind="stable")
    lengths = np.take_along_axis(lengths, order, axis=1)
    steps = np.cumsum(lengths, axis=1) - lengths
    level = ascending(np.take_along_axis(starts, order, axis=1) - steps)
    room = np.maximum(end - lengths.sum(axis=1), 0.0)[:, None]
    return np.clip(level, 0.0, room) + steps, lengths


def without_overlap(designs: Designs, limits: Limits, tolerance: float = 1e-9) -> bool:
    """Whether every patch lies on the span and beside its neighbours."""
    for side in (0, 1):
        own = limits.side_of == side
        starts, tips = designs.starts[:, own], (designs.starts + designs.lengths)[:, own]
        if starts.min() < -tolerance or tips.max() > limits.end + tolerance:
            return False
        if starts.shape[1] > 1 and (starts[:, 1:] - tips[:, :-1]).min() < -tolerance:
            return False
    return True


def random_designs(limits: Limits, count: int, generator: np.random.Generator) -> Designs:
    """So many, of all numbers of patches alike."""
    patches = len(limits.side_of)
    lengths = generator.uniform(*limits.length, (count, patches))
    for side in (0, 1):
        own = np.flatnonzero(limits.side_of == side)
        kept = generator.integers(1, len(own) + 1, count)
        lengths[:, own] *= np.argsort(generator.random((count, len(own))), axis=1) < kept[:, None]
    sizes = generator.uniform(limits.least_sizes, limits.largest_sizes, (count, 4))
    return repaired(Designs(generator.uniform(0.0, limits.end, (count, patches)), lengths, sizes), limits)


def shortened(designs: Designs, share: float) -> Designs:
    """With all patches a share as long about their middles."""
    lengths = share * designs.lengths
    return replace(designs, lengths=lengths, starts=designs.starts + 0.5 * (designs.lengths - lengths))
