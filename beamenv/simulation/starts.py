"""How the episodes of some blades of a batch begin: their load cases and their first states."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from beamenv.arrays import Arrays, Those, namespace, on_host
from beamenv.scenarios.drawing import load_cases
from beamenv.scenarios.load_cases import LoadCases
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.chance import Numbers
from beamenv.simulation.kernel import joined_product, row_product
from beamenv.simulation.plants.allotment import Allotment
from beamenv.simulation.plants.bank import Bank


@dataclass(frozen=True, slots=True, eq=False)
class Starts:
    """Those of blades of a bank, whose plants are allotted already."""

    bank: Bank
    stepped: Bank
    """The same bank of the blades' arrays."""
    plants: Allotment
    arrays: Arrays
    speeds: Any
    """(K,) rad/s, with 64 bits, where the blades are."""

    def cases(self, scenario: Scenario, those: Those, numbers: Numbers, seeded: bool) -> LoadCases:
        """Load cases of numbers; on the host, as NumPy's, where each blade is ``seeded``: has its own generator."""
        index, bank = those.take(self.plants.index), self.bank
        lowest = np.array([plant.natural_frequencies[0] for plant in (bank.plant, *bank.others)])
        own = lowest[self.plants.group[on_host(those.rows)]] if bank.groups > 1 else float(lowest[0])
        if seeded:
            return load_cases(scenario, bank.plant, own, numbers.load, numbers.turns, bank.speeds[on_host(index)])
        load, turns = self.arrays.exact(numbers.load), self.arrays.exact(numbers.turns)
        cases = load_cases(scenario, bank.plant, own, load, turns, self.speeds[index])
        return cases if self.arrays.of_numpy else cases.convert(self.arrays.floats)

    def state(self, those: Those, deflection: Any, initial_state: Any) -> Any:
        """(k, n) in the axes of the bank: of static deflections under (k, loads) N/m, or those given ((n,) or (k, n))."""
        bank, index = self.stepped, those.take(self.plants.index)
        state = (joined_product if self.arrays.compiled else row_product)(deflection, self.of(bank.release, index))
        if bank.start is not None:
            state = state + (bank.start[self.plants.group[those.rows]] if self.arrays.of_numpy else bank.start[0])
        if initial_state is None:
            return state
        given = namespace(state).broadcast_to(self.arrays.floats(initial_state), state.shape)
        if bank.own is not None:
            given = row_product(given, bank.own[0][index].swapaxes(-1, -2))
        return row_product(given, bank.axes[index].swapaxes(-1, -2))

    def shown(self, those: Those, deflection: Any, state: Any, table: Any, given: bool) -> Any:
        """(k, p): what a table of the plants (K, n, p) shows of states (k, n) that were not ``given`` but came of deflections."""
        index = those.take(self.plants.index)
        if given or not self.arrays.compiled or len(self.bank) > 1 or self.stepped.start is not None:
            return row_product(state, self.of(table, index))
        return joined_product(deflection, self.stepped.release[0] @ table[0])

    def of(self, tables: Any, index: Any) -> Any:
        """Arrays of the plants at ``index`` (k,); of tensors where there is one plant, that alone."""
        return tables[0] if len(self.bank) == 1 and not self.arrays.of_numpy else tables[index]
