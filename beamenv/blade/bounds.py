"""Where patches may lie: bounds of their root-side edges, no overlap, and the nearest layout that keeps to both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.configuration import Count, Number, Numbers, Refused, checked
from beamenv.patches.layout import PatchLayout, Side

Array = NDArray[np.float64]

TOLERANCE = 1e-9
"""m: what round-off may take from a distance."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """``count`` patches of one side, each ``length`` m long, with root-side edges from ``low`` to ``high`` m."""

    name: str
    """actuators or sensors."""
    low: float
    high: float
    length: float
    count: int

    @classmethod
    def of(cls, layout: PatchLayout, beam_length: float, count: int, bounds: Sequence[float] | None, name: Side) -> Bounds:
        """Bounds (m) of the root-side edges, 0 … 0.7 L, or where a group says so, less a patch unless given.

        Raises ``ValueError`` for bounds outside of that or without room, and for more patches than fit.
        """
        count, group = checked(name, count, Count()), layout.only(name)
        last = group.outermost * beam_length - group.length
        low, high = checked_bounds(bounds, last, group.outermost)
        fitting = int(np.floor((high - low + TOLERANCE) / group.length)) + 1
        if count > fitting:
            room = f"patches of {group.length:g} m with root-side edges from {low:g} to {high:.6g} m"
            raise Refused(name, count, f"at most {fitting}, for {room}")
        return cls(name, low, high, group.length, count)

    @property
    def slack(self) -> float:
        """m: how far the patches can move when they are pushed together."""
        return max(self.high - self.low - (self.count - 1) * self.length, 0.0)

    def uniform(self) -> Array:
        """Equally spaced from bound to bound (count,)."""
        return np.linspace(self.low, self.high, self.count)

    def random(self, generator: np.random.Generator, number: int) -> Array:
        """(number, count) layouts, every feasible one equally likely."""
        gaps = np.sort(generator.random((number, self.count)), axis=1) * self.slack
        return self.low + gaps + self.length * np.arange(self.count)

    def repaired(self, positions: ArrayLike) -> Array:
        """The nearest feasible layouts, ascending, to any positions (…, count): overlaps are moved apart.

        The least sum of squared displacements of the sorted patches: with y_i = x_i − i · length isotonic regression (by its
        max-min formula), then the bounds.
        """
        steps = self.length * np.arange(self.count)
        level = ascending(np.sort(np.asarray(positions, dtype=float), axis=-1) - steps)
        return np.clip(level, self.low, self.low + self.slack) + steps

    def checked(self, positions: ArrayLike) -> Array:
        """Positions (count,) in ascending order; ``ValueError`` unless they are finite, within the bounds and apart."""
        try:
            given = np.array(checked(self.name, positions, Numbers(least=self.count, most=self.count)))
        except ValueError:
            raise Refused(self.name, positions, f"{self.count} finite positions (m)") from None
        ordered = np.sort(given)
        if ordered[0] < self.low - TOLERANCE or ordered[-1] > self.high + TOLERANCE:
            raise Refused(self.name, given.tolist(), f"between {self.low:g} and {self.high:.6g} m")
        if self.count > 1 and np.diff(ordered).min() < self.length - TOLERANCE:
            raise Refused(self.name, given.tolist(), f"at least a patch, {self.length:g} m, apart")
        return ordered


def ascending(wanted: Array) -> Array:
    """The nearest ascending numbers to any (…, count), in the least sum of squares: isotonic regression by its max-min formula."""
    count = wanted.shape[-1]
    sums = np.concatenate([np.zeros((*wanted.shape[:-1], 1)), np.cumsum(wanted, axis=-1)], axis=-1)
    start, end = np.meshgrid(np.arange(count), np.arange(count), indexing="ij")
    means = (sums[..., end + 1] - sums[..., start]) / np.maximum(end - start + 1, 1)
    means = np.where(end >= start, means, np.inf)
    least_beyond = np.minimum.accumulate(means[..., ::-1], axis=-1)[..., ::-1]
    return np.asarray(np.where(start <= end, least_beyond, -np.inf).max(axis=-2))


def checked_bounds(bounds: Sequence[float] | None, last: float, outermost: float) -> tuple[float, float]:
    """(low, high) in m; ``ValueError`` for anything but two numbers in order within 0 … ``last``."""
    if last < 0.0:
        raise ValueError(f"a patch is too long: it must fit within 0 and {outermost} of the span, by {-last:.6g} m more.")
    if bounds is None:
        return 0.0, last
    low, high = checked("bounds", bounds, Numbers(Number(unit="m"), least=2, most=2))
    if not -TOLERANCE <= low <= high <= last + TOLERANCE:
        raise Refused("bounds", bounds, f"ascending root-side edges between 0 and {last:.6g} m")
    return max(low, 0.0), min(high, last)
