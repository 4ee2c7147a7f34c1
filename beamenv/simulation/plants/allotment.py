"""Which plant of a bank each blade of a batch has now, and what a step needs of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import REFERENCE, Arrays, Masked, SomeRows, Those, copied, integers, namespace
from beamenv.simulation.kernel import Operators, row_product
from beamenv.simulation.memory import Arrangement
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.plants.walks import Warming

Rows = NDArray[np.int64]


SHARED = 4
"""Blades to a plant, on average, from which on those that share one are multiplied together: sorting them takes time, too."""


class Passage(NamedTuple):
    """Blades that come from one plant to another."""

    those: Those
    change: Any
    """(k, n, n): states, as rows, times this are those of the next plant."""


class Shared(NamedTuple):
    """Blades sorted by their plants."""

    order: Rows
    """(N,)"""
    plants: list[tuple[int, slice]]
    """Each with its part of that order; none where too few share one."""


class Allotment:
    """The plants of N blades, their operators gathered; ``sizes`` says how many blades each of the bank's groups has."""

    def __init__(self, bank: Bank, lie: Arrangement, sizes: Sequence[int], arrays: Arrays = REFERENCE) -> None:
        self._bank, self._lie, self._arrays = bank, lie, arrays
        self._each = len(bank) // bank.groups
        self.group: Rows = np.repeat(np.arange(bank.groups), sizes)
        """(N,) which group each blade is of."""
        self._first = arrays.exact(self._each * self.group)
        self._leads = np.searchsorted(self.group, np.arange(bank.groups))
        self.index: Any = copied(self._first)
        """(N,) places in the bank."""
        self.drawn = self._each > 1 and not bank.runs
        """Whether each episode has a plant of its own, drawn from those of its group."""
        walk, count = bank.walk, len(self.group)
        self.draws = 0 if walk is None else walk.draws
        """Uniform numbers that the course of an episode takes."""
        self._courses = arrays.exact(np.zeros((count, 0 if walk is None else walk.courses(np.zeros((1, walk.draws))).shape[1])))
        self._elapsed = arrays.exact(np.zeros(count, dtype=np.int64))
        self.operators: Operators
        """Of the one plant that all blades have now, of each group's (groups, …), or of each blade's (*shape, …)."""
        self.effort_weight: Any
        """(m, m), (groups, m, m) or (*shape, m, m), J s."""
        self._shared: Shared | None = None
        """None until it is asked for."""
        self._gather()

    @property
    def within_group(self) -> Any:
        """(N,) places among the plants of each blade's group."""
        return self.index - self._first

    def set_out(self, those: Those, uniform: Any) -> None:
        """Put some blades on the courses that uniform numbers (k, draws) say."""
        walk = self._bank.walk
        assert walk is not None
        self._courses, self._elapsed = those.put(self._courses, walk.courses(uniform)), those.put(self._elapsed, 0)
        own = walk.places(those.take(self._courses), those.take(self._elapsed))
        self._allot(those, those.take(self._first) + own)

    def walk_on(self) -> Passage | None:
        """One control interval further on their courses; which blades so come to another plant, None if none does."""
        bank, before = self._bank, self.index
        assert bank.walk is not None and bank.to_common is not None and bank.from_common is not None
        self._elapsed = self._elapsed + 1
        index = self._first + bank.walk.places(self._courses, self._elapsed)
        those = self._moved(index != before)
        if those is None:
            return None
        now = those.take(index)
        passage = Passage(those, bank.to_common[those.take(before)] @ bank.from_common[now])
        self._allot(those, now)
        return passage

    def warming(self) -> Any:
        """(N, 2): K per control interval by which blades warm now, and K since their episodes began."""
        walk = self._bank.walk
        assert isinstance(walk, Warming)
        return walk.warming(self._courses, self._elapsed)

    def _moved(self, moves: Any) -> Those | None:
        """The blades of a mask (N,); None where there are none and it costs nothing to ask."""
        if not self._arrays.looks:
            return Masked(moves)
        rows = moves.nonzero()[0] if self._arrays.of_numpy else moves.nonzero()[:, 0]
        return self._lie.those(rows) if len(rows) else None

    def draw(self, those: Those, uniform: Any) -> None:
        """Give some blades the plants that uniform numbers (k,) say."""
        self._allot(those, those.take(self._first) + integers(uniform * self._each))

    def begin(self, those: Those) -> None:
        """Give some blades the first plants of their groups."""
        self._allot(those, those.take(self._first))

    def product(self, rows: Any, matrix: Any, out: Any = None) -> Any:
        """As ``row_product``; blades that share a plant are multiplied by its operators together, where there are many such."""
        if matrix is not self.operators.fused or not self.drawn or matrix.ndim < 4:
            return row_product(rows, matrix, out)
        if self._shared is None:
            self._shared = self._by_plant()
        if not self._shared.plants:
            return row_product(rows, matrix, out)
        order, sorted_rows = self._shared.order, rows.reshape(len(self.index), -1)[self._shared.order]
        products = np.empty((len(order), matrix.shape[-1]), matrix.dtype)
        for plant, those in self._shared.plants:
            np.matmul(sorted_rows[those], self._bank.operators.fused[plant], products[those])
        out = np.empty((*rows.shape[:-1], matrix.shape[-1]), matrix.dtype) if out is None else out
        out.reshape(len(order), -1)[order] = products
        return out

    def _by_plant(self) -> Shared:
        order = np.argsort(self.index, kind="stable")
        plants, first = np.unique(self.index[order], return_index=True)
        if len(order) < SHARED * len(plants):
            return Shared(order, [])
        ends = [*first[1:].tolist(), len(order)]
        return Shared(order, [(k, slice(a, b)) for k, a, b in zip(plants.tolist(), first.tolist(), ends, strict=True)])

    def _allot(self, those: Those, index: Any) -> None:
        self.index, self._shared = those.put(self.index, index), None
        in_place = self._arrays.of_numpy and self._lie.shape and isinstance(those, SomeRows)
        if self.drawn and in_place and len(index) < len(self.index):  # operators of many blades are many megabytes
            those.lay(self.operators.fused, self._bank.operators.fused[index])
            those.lay(self.operators.weights, self._bank.operators.weights[index])
            those.lay(self.effort_weight, self._bank.effort_weight[index])
        elif self._each > 1:
            self._gather()

    def follow(self) -> None:
        """Give each blade the next plant, where a bank's plants follow one another."""
        last = self._first + (self._each - 1)
        self.index = namespace(last).minimum(self.index + 1, last)
        self._gather()

    def state_dict(self) -> dict[str, Any]:
        """Which plant each blade has, and on what course it is."""
        moving = {"index": self.index}
        if self._bank.walk:
            moving |= {"courses": self._courses, "elapsed": self._elapsed}
        return {name: copied(values) for name, values in moving.items()}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict`` of an allotment of the same bank and batch."""
        self.index = copied(state["index"])
        if self._bank.walk is not None:
            self._courses, self._elapsed = (copied(state[name]) for name in ("courses", "elapsed"))
        self._gather()

    def _gather(self) -> None:
        self._shared, places = None, self._places()
        operators = self._bank.operators
        self.operators = operators.pick(places) if operators.fused.ndim > 2 else operators
        if self._lie.runs:  # a product serves a group, but squares are weighted blade by blade
            weights = self._bank.operators.weights[self.index]
            self.operators = replace(self.operators, weights=weights.reshape(*self._lie.shape, weights.shape[-1]))
        self.effort_weight = self._bank.effort_weight[places]

    def _places(self) -> Any:
        """One place in the bank for all blades, one for each group or one for each blade: whichever is the least that will do."""
        if not self._lie.shape:
            return self.index[0]
        if not self._arrays.of_numpy:
            return self.index if self._each > 1 else 0
        first = self.index[self._leads]
        if self.drawn or not np.array_equal(self.index, first[self.group]):
            return self.index.reshape(self._lie.shape)
        return first if self._lie.runs else first[0]
