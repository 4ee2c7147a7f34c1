"""A layout as intervals of bare and covered span, and how much of every series of ``contributions`` each layout takes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines.placement.model.chebyshev import ChebyshevSpan
from baselines.placement.model.contributions import BARE, COVERED

Array = NDArray[np.float64]

KINDS = len(COVERED)
TOUCHING = 1e-9
"""Share of the longest patch by which patches that touch may overlap."""


@dataclass(frozen=True, slots=True, eq=False)
class PatchEdges:
    """N layouts of a + s patches, actuators first, with the Chebyshev polynomials at their edges; of a length of 0, it is none."""

    actuators: Array
    """(N, a): root-side edges, m."""
    sensors: Array
    """(N, s)."""
    tips: Array
    """(N, a + s): the other edges, m."""
    span: ChebyshevSpan
    starts: Array
    ends: Array
    """(N, a + s, k) each."""

    @classmethod
    def of(cls, actuators: Array, sensors: Array, length: float | Array, span: ChebyshevSpan) -> PatchEdges:
        """Evaluate the polynomials; ``length`` in m, of all patches or of each (N, a + s)."""
        root_side = np.concatenate([actuators, sensors], axis=1)
        tips = root_side + length
        starts, ends = np.split(span.values(np.concatenate([root_side, tips], axis=1)), 2, axis=1)
        return cls(actuators, sensors, tips, span, starts, ends)

    def force_shares(self) -> tuple[Array, Array]:
        """(N, a, 2, k) and (N, s, 2, k): how much of the two force series each actuator and each sensor takes."""
        count = self.actuators.shape[1]
        ends_first, starts_last, overlap = self._common()
        begin = np.where(starts_last, self.starts[:, None, count:], self.starts[:, :count, None])
        end = np.where(ends_first, self.ends[:, :count, None], self.ends[:, None, count:])
        common = (end - begin) * overlap
        covered = self.ends - self.starts
        own = np.stack([covered[:, :count], common.sum(axis=2)], axis=2)
        return own, np.stack([covered[:, count:], common.sum(axis=1)], axis=2)

    def _common(self) -> tuple[NDArray[np.bool_], ...]:
        """(N, a, s, 1) each: whether the actuator ends first, the sensor starts last, and the two overlap."""
        count = self.actuators.shape[1]
        first, second = self.actuators[:, :, None], self.sensors[:, None, :]
        first_end, second_end = self.tips[:, :count, None], self.tips[:, None, count:]
        overlap = (first < second_end) & (second < first_end)
        starts_last = first <= second
        ends_first = np.where(first_end == second_end, starts_last, first_end < second_end)
        return ends_first[..., None], starts_last[..., None], overlap[..., None]

    def slopes(self) -> Array:
        """(N, 2 (a + s), k), 1/m: of the polynomials at the starts, then at the ends."""
        root_side = np.concatenate([self.actuators, self.sensors], axis=1)
        return self.span.slopes(np.concatenate([root_side, self.tips], axis=1))

    def force_share_slopes(self, slopes: Array) -> tuple[Array, Array]:
        """(N, 2 (a + s), a, 2, k) and (N, 2 (a + s), s, 2, k): derivatives of ``force_shares`` by every edge, starts first, 1/m."""
        a, s = self.actuators.shape[1], self.sensors.shape[1]
        start, end = np.split(slopes, 2, axis=1)
        ends_first, starts_last, overlap = self._common()
        top, below = (np.zeros((len(slopes), 2, a + s, patches, 2, self.span.count)) for patches in (a, s))
        own_top, own_below = np.arange(a), np.arange(s)
        for edge, at, of_actuator in ((0, -start, ~starts_last), (1, end, ends_first)):
            by_actuator = (overlap & of_actuator) * at[:, :a, None]
            by_sensor = (overlap & ~of_actuator) * at[:, None, a:]
            top[:, edge, own_top, own_top, 0] = at[:, :a]
            below[:, edge, a + own_below, own_below, 0] = at[:, a:]
            top[:, edge, own_top, own_top, 1] = by_actuator.sum(axis=2)
            top[:, edge, a:, :, 1] = by_sensor.swapaxes(1, 2)
            below[:, edge, :a, :, 1] = by_actuator
            below[:, edge, a + own_below, own_below, 1] = by_sensor.sum(axis=1)
        return tuple(each.reshape(len(each), 2 * (a + s), *each.shape[3:]) for each in (top, below))  # type: ignore[return-value]


@dataclass(frozen=True, slots=True, eq=False)
class Intervals:
    """N layouts cut at their E patch edges, root to tip: interval j lies between edge j and edge j + 1, edge 0 is the root."""

    patches: PatchEdges
    edges: Array
    """(N, E + 1), m."""
    values: Array
    """(N, E + 1, k): the polynomials there."""
    covered: Array
    """(N, E, kinds): 1 for the kind of section that the interval has."""
    order: NDArray[np.intp]
    """(N, E): which of the patches' starts (actuators, then sensors) and ends the edges 1 … E are."""

    @classmethod
    def of(cls, patches: PatchEdges) -> Intervals:
        """Cut layouts at their patches' edges."""
        starts = np.concatenate([patches.actuators, patches.sensors], axis=1)
        count = starts.shape[1]
        position = np.concatenate([starts, patches.tips], axis=1)
        step = np.repeat([1, -1], count) * np.ones(position.shape, dtype=int)
        on_top = np.tile(np.arange(count) < patches.actuators.shape[1], 2)
        first_ends = np.where(
            step > 0, TOUCHING * (patches.tips - starts).max(), 0.0
        )  # touching patches: one ends before the next begins
        order = np.argsort(position + first_ends, axis=1, kind="stable")
        event = np.take_along_axis(step, order, axis=1)
        above = np.where(on_top[order], event, 0).cumsum(axis=1) > 0
        below = np.where(on_top[order], 0, event).cumsum(axis=1) > 0
        kind = np.zeros(position.shape, dtype=int)
        kind[:, 1:] = (above + 2 * below)[:, :-1]
        edges = np.concatenate([np.zeros((len(starts), 1)), np.take_along_axis(position, order, axis=1)], axis=1)
        root = np.broadcast_to(patches.span.values(np.zeros(1)), (len(starts), 1, patches.span.count))
        at_edges = np.take_along_axis(np.concatenate([patches.starts, patches.ends], axis=1), order[..., None], axis=1)
        values = np.concatenate([root, at_edges], axis=1)
        covered = (kind[..., None] == np.arange(KINDS)).astype(float)
        return cls(patches, edges, values, covered, order)

    def share(self) -> Array:
        """(N, 3 k): Σ over the intervals of a kind of T(end) − T(start), for covered kinds."""
        steps = np.diff(self.values, axis=1)
        return np.asarray(self.covered.transpose(0, 2, 1)[:, BARE + 1 :] @ steps).reshape(len(steps), -1)

    def pulled_share(self, tension: Array) -> Array:
        """(N, 4 k): the same for every kind, each interval times its c."""
        steps = np.diff(self.values, axis=1)
        weighted = self._pull(tension)[..., None] * self.covered
        return np.asarray(weighted.transpose(0, 2, 1) @ steps).reshape(len(steps), -1)

    def _pull(self, tension: Array) -> Array:
        """The constants c (N, E): what patches further out pull, and h at the interval's own end."""
        h = self.values @ tension
        at_start = np.einsum("nek,nek->ne", self.covered, h[:, :-1])
        at_end = np.einsum("nek,nek->ne", self.covered, h[:, 1:])
        beyond = np.cumsum((at_end - at_start)[:, ::-1], axis=1)[:, ::-1]
        return at_start + beyond

    def share_slopes(self, slopes: Array) -> Array:
        """(N, 2 patches, 3 k): derivatives of ``share`` by every edge, starts first, 1/m, from the polynomials' slopes."""
        change = self.covered - _beyond(self.covered)
        return self._of_edges(change[..., BARE + 1 :, None] * self._in_order(slopes)[..., None, :])

    def pulled_share_slopes(self, tension: Array, slopes: Array) -> Array:
        """(N, 2 patches, 4 k): derivatives of ``pulled_share`` likewise."""
        pull, covered, slope = self._pull(tension), self.covered, self._in_order(slopes)
        weighted = pull[..., None] * covered
        change = weighted - _beyond(weighted)
        pull_slope = np.einsum("nek,nek->ne", covered - _beyond(covered), slope @ tension)  # of every c up to this edge
        steps = np.diff(self.values, axis=1)
        inboard = np.cumsum(covered[..., None] * steps[..., None, :], axis=1)
        return self._of_edges(change[..., None] * slope[..., None, :] + pull_slope[..., None, None] * inboard)

    def _in_order(self, slopes: Array) -> Array:
        """(N, E, k)."""
        return np.take_along_axis(slopes, self.order[..., None], axis=1)

    def _of_edges(self, by_edge: Array) -> Array:
        """(N, E, kinds, k) in the order of the patches' starts and ends: (N, E, kinds k)."""
        back = np.argsort(self.order, axis=1)
        return np.take_along_axis(by_edge.reshape(*by_edge.shape[:2], -1), back[..., None], axis=1)


def _beyond(of_intervals: Array) -> Array:
    """(N, E, kinds): of each interval's outboard neighbour, zero of the last one's."""
    beyond = np.zeros_like(of_intervals)
    beyond[:, :-1] = of_intervals[:, 1:]
    return beyond
