"""Disturbances of a batch in which each blade has its own generator: it meets the same episode whatever else is in the batch.

Their rows, and what is drawn of a scenario, are those of ``disturbances``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import REFERENCE, Arrays, SomeRows, on_host
from beamenv.scenarios.load_cases import LoadCases
from beamenv.simulation.memory import Arrangement
from beamenv.simulation.signals.disturbances import Turbulence, merged

Array = NDArray[np.float64]
Rows = NDArray[np.int64]
Generator = np.random.Generator

BLOCK = 64
"""Instants that ``SeededDisturbances`` draws at a time: enough to make a generator's call cheap."""


class SeededDisturbances:
    """Disturbances of N blades, each from its own generator of NumPy, drawn with 64 bits whatever the blades' arrays are.

    The rows of the next ``BLOCK`` instants lie in a ring that all blades read at the same place; each blade's part is
    drawn again whenever its own episode has used up its block.
    """

    def __init__(
        self, factor: Array, lie: Arrangement, turbulence: Turbulence | None = None, loads: int = 2, arrays: Arrays = REFERENCE
    ) -> None:
        count, self._width, self._arrays = math.prod(lie.shape), loads, arrays
        self._turbulence, self._gusts = turbulence, np.zeros((count, loads))
        self._factor, self._shape = factor, lie.shape
        self._ring = np.zeros((BLOCK, count, len(factor)))
        self._see_ring()
        self._at = 0
        self._begun = np.zeros(count, dtype=np.int64)  # place in the ring where a blade's blocks begin
        self._due: dict[int, Rows] = {}
        self._drawn = np.zeros(count, dtype=np.int64)  # instants drawn so far, of each blade's episode
        self._cases: LoadCases | None = None

    @property
    def columns(self) -> int:
        """c: how many normals an instant takes of each blade."""
        return len(self._factor)

    def _see_ring(self) -> None:
        seen = self._ring.reshape(BLOCK, *self._shape, len(self._factor))
        self._loads, self._noise = list(seen[..., : self._width]), list(seen[..., self._width :])

    def _see_due(self) -> None:
        self._due = {start: np.flatnonzero(self._begun == start) for start in np.unique(self._begun).tolist()}

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name not in ("_loads", "_noise")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._see_ring()

    def begin(self, those: SomeRows, cases: LoadCases, generators: Sequence[Generator]) -> Any:
        """Start some blades at instant 0 of their load cases, NumPy's; their sensor noise there, [noise (p) | …] (k, c − loads)."""
        rows = on_host(those.rows)
        self._cases = merged(self._cases, SomeRows(rows, ()), cases)
        self._begun[rows] = self._at
        self._see_due()
        self._drawn[rows] = 0
        self._draw(rows, generators)
        return self._arrays.floats(self._ring[self._at, rows, self._width :])

    def loads(self, out: Any = None) -> Any:
        """The line loads of this instant (…, k), with NumPy written to ``out``."""
        if not self._arrays.of_numpy:
            return self._arrays.floats(self._loads[self._at])
        out[...] = self._loads[self._at]
        return out

    def next(self, generators: Sequence[Generator], resting: Rows | None = None) -> Any:
        """Go to the next instant; the sensor noise there, [noise (p) | …] (…, c − k).

        Nothing is drawn for blades that are ``resting``: their episode is over, their generator waits for the next.
        """
        self._at = (self._at + 1) % BLOCK
        due = self._due.get(self._at)
        if due is not None:
            self._draw(due if resting is None else np.setdiff1d(due, resting), generators)
        return self._arrays.floats(self._noise[self._at])

    def state_dict(self) -> dict[str, Any]:
        """Copies of what moves; the generators are the caller's."""
        return {
            "ring": self._ring.copy(),
            "at": self._at,
            "begun": self._begun.copy(),
            "drawn": self._drawn.copy(),
            "gusts": self._gusts.copy(),
            "cases": None if self._cases is None else self._cases.state_dict(),
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict`` of equally made disturbances."""
        self._ring[...], self._at = np.asarray(state["ring"]), int(state["at"])
        self._begun, self._drawn, self._gusts = (np.asarray(state[name]).copy() for name in ("begun", "drawn", "gusts"))
        self._cases = None if state["cases"] is None else LoadCases.from_state_dict(state["cases"])
        self._see_due()

    def _draw(self, rows: Rows, generators: Sequence[Generator]) -> None:
        """Draw the next block of ``rows``, whose blocks begin here."""
        if not len(rows):
            return
        assert self._cases is not None
        normals = np.empty((len(rows), BLOCK, len(self._factor)))
        for row, tape in zip(rows.tolist(), normals, strict=True):
            generators[row].standard_normal(out=tape)
        disturbance = (normals @ self._factor).swapaxes(0, 1)
        cases = self._cases if len(rows) == len(self._cases) else self._cases.rows(rows)
        disturbance[..., : self._width] += cases.at(self._drawn[rows] + np.arange(BLOCK)[:, None])
        if self._turbulence is not None:
            self._add_turbulence(disturbance, rows)
        self._ring[(self._at + np.arange(BLOCK)[:, None]) % BLOCK, rows] = disturbance
        self._drawn[rows] += BLOCK

    def _add_turbulence(self, disturbance: Array, rows: Rows) -> None:
        """Put the turbulence of a block onto its loads; an episode's first one is drawn from the steady state."""
        assert self._turbulence is not None
        begins, gusts, first = (self._drawn[rows] == 0)[:, None], self._gusts[rows], len(self._factor) - self._width
        for k, instant in enumerate(disturbance):
            following = self._turbulence.following(gusts, instant[:, first:])
            gusts = np.where(begins, instant[:, first:], following) if k == 0 else following
            instant[:, : self._width] += gusts
        self._gusts[rows] = gusts
