"""Which plant of a bank each blade of a batch has now, and what a step needs of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.simulation.kernel import Operators
from beamenv.simulation.memory import place
from beamenv.simulation.plants.bank import Bank

Array = NDArray[np.float64]
Rows = NDArray[np.int64]


class Allotment:
    """The plants of N blades, their operators gathered; ``shape`` is that of the batch, () for one blade.

    Where a bank has groups, the blades have as many, equally large and one after the other.
    """

    def __init__(self, bank: Bank, shape: tuple[int, ...]) -> None:
        self._bank, self._shape = bank, shape
        self._each = len(bank) // bank.groups
        count = math.prod(shape)
        self.group: Rows = np.repeat(np.arange(bank.groups), count // bank.groups)
        """(N,) which group each blade is of."""
        self._first = self._each * self.group
        self.index: Rows = self._first.copy()
        """(N,) places in the bank."""
        self.drawn = self._each > 1 and not bank.runs
        """Whether each episode has a plant of its own, drawn from those of its group."""
        self.operators: Operators
        """Of the one plant that all blades have now, of each block's (blocks, …), or of each blade's (*shape, …)."""
        self.effort_weight: Array
        """(m, m), (blocks, m, m) or (*shape, m, m), J s."""
        self._gather()

    @property
    def place(self) -> Rows:
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
        if self.drawn and self._shape and len(rows) < len(self.index):
            at = place(rows, self._shape)  # in place: operators of many blades are many megabytes
            self.operators.fused[at] = self._bank.operators.fused[index]
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
        self.effort_weight = self._bank.effort_weight[places]

    def _places(self) -> Any:
        """One place in the bank for all blades, one for each block or one for each blade: whichever is the least that will do."""
        if not self._shape:
            return self.index[0]
        groups = self.index.reshape(self._bank.groups, -1)
        if self.drawn or not (groups == groups[:, :1]).all():
            return self.index.reshape(self._shape)
        return groups[0, 0] if len(groups) == 1 else np.repeat(groups[:, 0], self._shape[0] // len(groups))
