"""Which plant of a bank each blade of a batch has now, and what a step needs of it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.simulation.kernel import Operators
from beamenv.simulation.memory import place
from beamenv.simulation.plants.bank import Bank

Array = NDArray[np.float64]
Rows = NDArray[np.int64]


class Allotment:
    """The plants of N blades, their operators gathered; ``shape`` is that of the batch, () for one blade."""

    def __init__(self, bank: Bank, shape: tuple[int, ...], index: Rows) -> None:
        self._bank, self._shape = bank, shape
        self.index = index
        """(N,) places in the bank."""
        self.drawn = len(bank) > 1 and not bank.runs
        """Whether each episode has a plant of its own, drawn from the bank."""
        self.operators: Operators
        """Of the one plant that all blades have now, or of each blade's, (*shape, …)."""
        self.effort_weight: Array
        """(m, m) or (*shape, m, m), J s."""
        self._gather()

    def allot(self, rows: Rows, index: Rows) -> None:
        """Give ``rows`` the plants at ``index``."""
        self.index[rows] = index
        if self.drawn and self._shape and len(rows) < len(self.index):
            at = place(rows, self._shape)  # in place: operators of many blades are many megabytes
            self.operators.fused[at] = self._bank.operators.fused[index]
            self.effort_weight[at] = self._bank.effort_weight[index]
        elif len(self._bank) > 1:
            self._gather()

    def follow(self) -> None:
        """Give each blade the next plant, where a bank's plants follow one another."""
        self.index = np.minimum(self.index + 1, len(self._bank) - 1)
        self._gather()

    def state_dict(self) -> dict[str, Rows]:
        """Which plant each blade has."""
        return {"index": self.index.copy()}

    def load_state_dict(self, state: Mapping[str, ArrayLike]) -> None:
        """Go back to a ``state_dict`` of an allotment of the same bank and batch."""
        self.index = np.asarray(state["index"]).copy()
        self._gather()

    def _gather(self) -> None:
        first = self.index[0]
        alike = not self._shape or (not self.drawn and bool((self.index == first).all()))
        places = first if alike else self.index.reshape(self._shape)
        self.operators = self._bank.operators.pick(places) if len(self._bank) > 1 else self._bank.operators
        self.effort_weight = self._bank.effort_weight[places]
