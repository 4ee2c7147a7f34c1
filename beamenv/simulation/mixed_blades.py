"""A batch of blades of several plants: as many ``Blades`` as there are plants, seen as one batch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.blades import Blades, Generators, Motion, Rows
from beamenv.simulation.plants.bank import Bank

Array = NDArray[np.float64]


class MixedBlades:
    """N blades, blade k of ``banks[k]``, with the interface of ``Blades``; their plants have equally many states and patches.

    Blades of the same bank object are advanced together.
    """

    def __init__(self, banks: Sequence[Bank], scenario: Scenario, physical_units: bool = False) -> None:
        self.count = len(banks)
        distinct = {id(bank): bank for bank in banks}
        kind = np.array([list(distinct).index(id(bank)) for bank in banks])
        self._rows: list[Rows] = [np.flatnonzero(kind == k) for k in range(len(distinct))]
        self._groups = [
            Blades(bank, scenario, len(rows), physical_units) for bank, rows in zip(distinct.values(), self._rows, strict=True)
        ]

    @property
    def state(self) -> Array:
        """(N, n) true states in energy coordinates."""
        return _together([blades.state for blades in self._groups], self._rows)

    @property
    def design_state(self) -> Array:
        """(N, d) true states in the design plants' coordinates."""
        return _together([blades.design_state for blades in self._groups], self._rows)

    @property
    def index(self) -> Rows:
        """(N,) place of each blade's plant in its bank."""
        return np.asarray(_together([blades.index for blades in self._groups], self._rows))

    @property
    def speed(self) -> Array:
        """(N,) rad/s."""
        return _together([blades.speed for blades in self._groups], self._rows)

    def begin(
        self,
        generators: Generators,
        rows: Rows | None = None,
        scenario: Scenario | None = None,
        initial_state: Array | None = None,
    ) -> Motion:
        """As ``Blades.begin``."""
        wanted = np.arange(self.count) if rows is None else rows
        motions, places = [], []
        for blades, members in zip(self._groups, self._rows, strict=True):
            place = np.flatnonzero(np.isin(wanted, members))
            if len(place) == 0:
                continue
            own = None if rows is None else np.searchsorted(members, wanted[place])
            state = initial_state[place] if initial_state is not None and initial_state.ndim == 2 else initial_state
            motions.append(blades.begin(_of(generators, members), own, scenario, state))
            places.append(place)
        return _one_motion(motions, places)

    def step(self, actions: Array, generators: Generators, resting: Rows | None = None) -> Motion:
        """As ``Blades.step``."""
        motions = []
        for blades, members in zip(self._groups, self._rows, strict=True):
            own = None if resting is None else np.searchsorted(members, np.intersect1d(resting, members))
            motions.append(blades.step(actions[members], _of(generators, members), own if own is not None and len(own) else None))
        return _one_motion(motions, self._rows)

    def state_dict(self) -> dict[str, Any]:
        """What moves, group by group: see ``Blades.state_dict``."""
        return {"groups": [blades.state_dict() for blades in self._groups]}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict`` of an equally made batch."""
        for blades, own in zip(self._groups, state["groups"], strict=True):
            blades.load_state_dict(own)


def _of(generators: Generators, members: Rows) -> Generators:
    """The members' own generators, or the one that serves all."""
    return generators if isinstance(generators, np.random.Generator) else [generators[row] for row in members]


def _one_motion(motions: Sequence[Motion], places: Sequence[Rows]) -> Motion:
    return Motion(*(_together(parts, places) for parts in zip(*motions, strict=True)))


def _together(parts: Sequence[NDArray], places: Sequence[Rows]) -> NDArray:  # type: ignore[type-arg]
    """Rows of several arrays, each at its places, in one."""
    whole = np.empty((sum(map(len, places)), *parts[0].shape[1:]), dtype=parts[0].dtype)
    for part, place in zip(parts, places, strict=True):
        whole[place] = part
    return whole
