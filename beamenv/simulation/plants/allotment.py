"""Which plant of a bank each blade of a batch has now, and what a step needs of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.simulation.kernel import Operators, row_product
from beamenv.simulation.memory import Arrangement
from beamenv.simulation.plants.bank import Bank

Array = NDArray[np.float64]
Rows = NDArray[np.int64]


SHARED = 4
"""Blades to a plant, on average, from which on those that share one are multiplied together: sorting them takes time, too."""


class Passage(NamedTuple):
    """Blades that come from one plant to another."""

    rows: Rows
    """(k,)"""
    change: Array
    """(k, n, n): states, as rows, times this are those of the next plant."""


class Shared(NamedTuple):
    """Blades sorted by their plants."""

    order: Rows
    """(N,)"""
    plants: list[tuple[int, slice]]
    """Each with its part of that order; none where too few share one."""


class Allotment:
    """The plants of N blades, their operators gathered; ``sizes`` says how many blades each of the bank's groups has."""

    def __init__(self, bank: Bank, lie: Arrangement, sizes: Sequence[int]) -> None:
        self._bank, self._lie = bank, lie
        self._each = len(bank) // bank.groups
        self.group: Rows = np.repeat(np.arange(bank.groups), sizes)
        """(N,) which group each blade is of."""
        self._first = self._each * self.group
        self._leads = np.searchsorted(self.group, np.arange(bank.groups))
        self.index: Rows = self._first.copy()
        """(N,) places in the bank."""
        self.drawn = self._each > 1 and not bank.runs
        """Whether each episode has a plant of its own, drawn from those of its group."""
        walk = bank.walk
        self.draws = 0 if walk is None else walk.draws
        """Uniform numbers that the course of an episode takes."""
        self._courses = np.zeros((len(self.group), 0 if walk is None else walk.courses(np.zeros((1, walk.draws))).shape[1]))
        self._elapsed: Rows = np.zeros(len(self.group), dtype=np.int64)
        self.operators: Operators
        """Of the one plant that all blades have now, of each group's (groups, …), or of each blade's (*shape, …)."""
        self.effort_weight: Array
        """(m, m), (groups, m, m) or (*shape, m, m), J s."""
        self._shared: Shared | None = None
        """None until it is asked for."""
        self._gather()

    @property
    def within_group(self) -> Rows:
        """(N,) places among the plants of each blade's group."""
        return self.index - self._first

    def set_out(self, rows: Rows, uniform: Array) -> None:
        """Put ``rows`` on the courses that uniform numbers (len(rows), draws) say."""
        assert self._bank.walk is not None
        self._courses[rows], self._elapsed[rows] = self._bank.walk.courses(uniform), 0
        self._allot(rows, self._first[rows] + self._bank.walk.places(self._courses[rows], self._elapsed[rows]))

    def walk_on(self) -> Passage | None:
        """One control interval further on their courses; which blades so come to another plant, None if none does."""
        assert self._bank.walk is not None and self._bank.to_common is not None and self._bank.from_common is not None
        self._elapsed += 1
        index = self._first + self._bank.walk.places(self._courses, self._elapsed)
        rows = np.flatnonzero(index != self.index)
        if not len(rows):
            return None
        passage = Passage(rows, self._bank.to_common[self.index[rows]] @ self._bank.from_common[index[rows]])
        self._allot(rows, index[rows])
        return passage

    def draw(self, rows: Rows, uniform: Array) -> None:
        """Give ``rows`` the plants that uniform numbers (len(rows),) say."""
        self._allot(rows, self._first[rows] + (uniform * self._each).astype(np.int64))

    def begin(self, rows: Rows) -> None:
        """Give ``rows`` the first plants of their groups."""
        self._allot(rows, self._first[rows])

    def product(self, rows: Any, matrix: Any, out: Any = None) -> Any:
        """As ``row_product``; blades that share a plant are multiplied by its operators together, where there are many such."""
        if matrix is not self.operators.fused or not self.drawn or matrix.ndim < 4:
            return row_product(rows, matrix, out)
        if self._shared is None:
            self._shared = self._by_plant()
        if not self._shared.plants:
            return row_product(rows, matrix, out)
        order, sorted_rows = self._shared.order, rows.reshape(len(self.index), -1)[self._shared.order]
        products = np.empty((len(order), matrix.shape[-1]))
        for plant, those in self._shared.plants:
            np.matmul(sorted_rows[those], self._bank.operators.fused[plant], products[those])
        out = np.empty((*rows.shape[:-1], matrix.shape[-1])) if out is None else out
        out.reshape(len(order), -1)[order] = products
        return out

    def _by_plant(self) -> Shared:
        order = np.argsort(self.index, kind="stable")
        plants, first = np.unique(self.index[order], return_index=True)
        if len(order) < SHARED * len(plants):
            return Shared(order, [])
        ends = [*first[1:].tolist(), len(order)]
        return Shared(order, [(k, slice(a, b)) for k, a, b in zip(plants.tolist(), first.tolist(), ends, strict=True)])

    def _allot(self, rows: Rows, index: Rows) -> None:
        self.index[rows], self._shared = index, None
        if self.drawn and self._lie.shape and len(rows) < len(self.index):
            at = self._lie.rows_of(rows)  # in place: operators of many blades are many megabytes
            self.operators.fused[at] = self._bank.operators.fused[index]
            self.operators.weights[at] = self._bank.operators.weights[index]
            self.effort_weight[at] = self._bank.effort_weight[index]
        elif self._each > 1:
            self._gather()

    def follow(self) -> None:
        """Give each blade the next plant, where a bank's plants follow one another."""
        self.index = np.minimum(self.index + 1, self._first + (self._each - 1))
        self._gather()

    def state_dict(self) -> dict[str, Any]:
        """Which plant each blade has, and on what course it is."""
        index = {"index": self.index.copy()}
        return index | {"courses": self._courses.copy(), "elapsed": self._elapsed.copy()} if self._bank.walk else index

    def load_state_dict(self, state: Mapping[str, ArrayLike]) -> None:
        """Go back to a ``state_dict`` of an allotment of the same bank and batch."""
        self.index = np.asarray(state["index"]).copy()
        if self._bank.walk is not None:
            self._courses, self._elapsed = (np.asarray(state[name]).copy() for name in ("courses", "elapsed"))
        self._gather()

    def _gather(self) -> None:
        self._shared, places = None, self._places()
        self.operators = self._bank.operators.pick(places) if len(self._bank) > 1 else self._bank.operators
        if self._lie.runs:  # a product serves a group, but squares are weighted blade by blade
            weights = self._bank.operators.weights[self.index]
            self.operators = replace(self.operators, weights=weights.reshape(*self._lie.shape, weights.shape[-1]))
        self.effort_weight = self._bank.effort_weight[places]

    def _places(self) -> Any:
        """One place in the bank for all blades, one for each group or one for each blade: whichever is the least that will do."""
        if not self._lie.shape:
            return self.index[0]
        first = self.index[self._leads]
        if self.drawn or not np.array_equal(self.index, first[self.group]):
            return self.index.reshape(self._lie.shape)
        return first if self._lie.runs else first[0]
