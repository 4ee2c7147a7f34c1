"""Which plant of a bank each blade of a batch has now, and what a step needs of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.simulation.kernel import Operators
from beamenv.simulation.memory import Arrangement
from beamenv.simulation.plants.bank import Bank

Array = NDArray[np.float64]
Rows = NDArray[np.int64]


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
        self.operators: Operators
        """Of the one plant that all blades have now, of each group's (groups, …), or of each blade's (*shape, …)."""
        self.effort_weight: Array
        """(m, m), (groups, m, m) or (*shape, m, m), J s."""
        self._gather()

    @property
    def within_group(self) -> Rows:
        """(N,) places among the plants of each blade's group."""
        return self.index - self._first

    def draw(self, rows: Rows, uniform: Array) -> None:
        """Give ``rows`` the plants that uniform numbers (len(rows),) say."""
        self._allot(rows, self._first[rows] + (uniform * self._each).astype(np.int64))

    def begin(self, rows: Rows) -> None:
        """Give ``rows`` the first plants of their groups."""
        self._allot(rows, self._first[rows])

    def _allot(self, rows: Rows, index: Rows) -> None:
        self.index[rows] = index
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

    def state_dict(self) -> dict[str, Rows]:
        """Which plant each blade has."""
        return {"index": self.index.copy()}

    def load_state_dict(self, state: Mapping[str, ArrayLike]) -> None:
        """Go back to a ``state_dict`` of an allotment of the same bank and batch."""
        self.index = np.asarray(state["index"]).copy()
        self._gather()

    def _gather(self) -> None:
        places = self._places()
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
