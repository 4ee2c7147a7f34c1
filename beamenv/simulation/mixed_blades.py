"""A batch of blades of several banks, in any order, seen as one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import REFERENCE, Arrays
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.blades import Blades, Rows
from beamenv.simulation.chance import Generators
from beamenv.simulation.motion import Motion
from beamenv.simulation.plants.bank import Bank

Array = NDArray[np.float64]


class MixedBlades:
    """N blades, blade k of ``banks[kind[k]]``, with the interface of ``Blades``; all have equally many states and patches.

    Blades of one kind lie together, and neighbouring kinds that are alike are one batch of as many groups.
    One generator for all serves kind after kind, in their order. ``arrays`` are of NumPy, as ``Blades`` has them.
    """

    def __init__(
        self, banks: Sequence[Bank], kind: Rows, scenario: Scenario, physical_units: bool = False, arrays: Arrays = REFERENCE
    ) -> None:
        self.count = len(kind)
        members = [rows for rows in (np.flatnonzero(kind == k) for k in range(len(banks))) if len(rows)]
        present = [bank for k, bank in enumerate(banks) if np.any(kind == k)]
        self._parts: list[Blades] = []
        self._rows: list[Rows] = []
        for together in _alike([len(rows) for rows in members], present):
            rows = np.concatenate([members[k] for k in together])
            sizes = [len(members[k]) for k in together]
            self._parts.append(Blades(Bank.joined([present[k] for k in together]), scenario, sizes, physical_units, arrays))
            self._rows.append(rows)
        self._part, self._own = np.empty(self.count, dtype=np.int64), np.empty(self.count, dtype=np.int64)
        for part, rows in enumerate(self._rows):
            self._part[rows], self._own[rows] = part, np.arange(len(rows))
        self._order = np.argsort(np.concatenate(self._rows))

    @property
    def state(self) -> Array:
        """(N, n) true states in energy coordinates."""
        return _in_order([blades.state for blades in self._parts], self._order)

    @property
    def design_state(self) -> Array:
        """(N, d) true states in the design plants' coordinates."""
        return _in_order([blades.design_state for blades in self._parts], self._order)

    @property
    def coming_loads(self) -> Array:
        """(N, 2): as ``Blades.coming_loads``."""
        return _in_order([blades.coming_loads for blades in self._parts], self._order)

    @property
    def index(self) -> Rows:
        """(N,) place of each blade's plant in its bank."""
        return _in_order([blades.index for blades in self._parts], self._order)

    @property
    def speed(self) -> Array:
        """(N,) rad/s."""
        return _in_order([blades.speed for blades in self._parts], self._order)

    @property
    def truth(self) -> Array:
        """(N, 2 + m + 2 p): as ``Blades.truth``."""
        return _in_order([blades.truth for blades in self._parts], self._order)

    def steady(self, rows: Rows | None = None) -> Array:
        """(…, 4): as ``Blades.steady``."""
        steady = _in_order([blades.steady() for blades in self._parts], self._order)
        return steady if rows is None else steady[rows]

    def begin(
        self,
        generators: Generators,
        rows: Rows | None = None,
        scenario: Scenario | None = None,
        initial_state: Array | None = None,
    ) -> Motion:
        """As ``Blades.begin``."""
        motions, places = [], []
        for part, (blades, members) in enumerate(zip(self._parts, self._rows, strict=True)):
            place = members if rows is None else self._of_part(part, rows)
            if len(place) == 0:
                continue
            own = None if rows is None else self._own[rows[place]]
            state = initial_state[place] if initial_state is not None and initial_state.ndim == 2 else initial_state
            motions.append(blades.begin(_of(generators, members), own, scenario, state))
            places.append(place)
        return _one_motion(motions, np.argsort(np.concatenate(places)))

    def _of_part(self, part: int, rows: Rows) -> Rows:
        """Places in ``rows`` of those that a part has, in its own order."""
        places = np.flatnonzero(self._part[rows] == part)
        return places[np.argsort(self._own[rows[places]])]

    def step(self, actions: Array, generators: Generators, resting: Rows | None = None) -> Motion:
        """As ``Blades.step``."""
        motions = []
        for part, (blades, members) in enumerate(zip(self._parts, self._rows, strict=True)):
            own = None if resting is None else self._own[resting[self._of_part(part, resting)]]
            motions.append(
                blades.step(actions.take(members, axis=0), _of(generators, members), own if own is not None and len(own) else None)
            )
        return _one_motion(motions, self._order)

    def state_dict(self) -> dict[str, Any]:
        """What moves, part by part: see ``Blades.state_dict``."""
        return {"parts": [blades.state_dict() for blades in self._parts]}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict`` of an equally made batch."""
        for blades, own in zip(self._parts, state["parts"], strict=True):
            blades.load_state_dict(own)


def _alike(sizes: Sequence[int], banks: Sequence[Bank]) -> list[list[int]]:
    """Kinds, in their order, of which neighbours have banks that are alike; single blades, multiplied otherwise, keep apart."""
    together: list[list[int]] = []
    for kind, (size, bank) in enumerate(zip(sizes, banks, strict=True)):
        first = together[-1][0] if together else kind
        if together and (size == 1) == (sizes[first] == 1) and bank.is_like(banks[first]):
            together[-1].append(kind)
        else:
            together.append([kind])
    return together


def _of(generators: Generators, members: Rows) -> Generators:
    """The members' own generators, or the one that serves all."""
    return generators if isinstance(generators, np.random.Generator) else [generators[row] for row in members]


def _one_motion(motions: Sequence[Motion], order: Rows) -> Motion:
    return Motion(*(_in_order(parts, order) for parts in zip(*motions, strict=True)))


def _in_order(parts: Sequence[NDArray[Any]], order: Rows) -> NDArray[Any]:
    """Rows of several arrays, one after the other, in another order."""
    return (parts[0] if len(parts) == 1 else np.concatenate(parts)).take(order, axis=0)
