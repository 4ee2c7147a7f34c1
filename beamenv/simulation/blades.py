"""A batch of blades in motion: what every environment wraps, and training through the plant. The physics is ``kernel.advance``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import REFERENCE, Arrays, Masked, Those, namespace, on_host
from beamenv.plant.plant import Plant, drive_limit, normalised
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.chance import Generators, Numbers, draw
from beamenv.simulation.kernel import joined_product, row_dot, row_product
from beamenv.simulation.memory import Arrangement, Fresh, InPlace
from beamenv.simulation.motion import Motion
from beamenv.simulation.plants.allotment import Allotment, Passage
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.reward import reward_scale as reward_scale
from beamenv.simulation.signals.disturbances import SharedDisturbances, Turbulence, noise_factor
from beamenv.simulation.signals.electronics import Electronics
from beamenv.simulation.signals.faults import fault_draws
from beamenv.simulation.signals.own_loads import OwnLoads
from beamenv.simulation.signals.seeded_disturbances import SeededDisturbances
from beamenv.simulation.starts import Starts
from beamenv.simulation.strain_limit import StrainLimit, safe_energy

Array = NDArray[np.float64]
Rows = NDArray[np.int64]


def _alike(values: Array) -> Array:
    """One number () in place of equal ones (k,): it broadcasts faster."""
    return np.array(values[0]) if np.all(values == values[0]) else values


class Blades:
    """A batch of ``count`` blades, advanced together; ``count=None`` is a blade alone, without a batch axis.

    ``plant`` is the one plant of them all, or a bank of plants, of which each episode has one. ``generators`` is one generator
    for all blades or a sequence of one for each, whichever ``begin`` was first given. Where the bank has groups, so have the
    blades, one after the other: ``count`` is then how many in each, and rows that begin are to be in ascending order. With
    ``physical_units`` actions are volts and readings amperes, else both are normalised.

    ``arrays`` says what it is made of. NumPy's of 64 bits are the reference; of 32 bits the same episodes differ by rounding. With
    torch all that is returned are tensors on the device, gradients pass from actions to what follows of them until ``detach``, and
    NumPy's generators give the episodes that NumPy has of them. Torch's own generator draws on the device: then nothing goes
    between it and the host in a step, loads of one's own aside. Tensors are of a batch of one group.
    """

    def __init__(
        self,
        plant: Plant | Bank,
        scenario: Scenario,
        count: int | Sequence[int] | None,
        physical_units: bool = False,
        arrays: Arrays = REFERENCE,
    ) -> None:
        self.bank = plant if isinstance(plant, Bank) else Bank.single(plant)
        self.plant, self.scenario, self.arrays, self._of_numpy = self.bank.plant, scenario, arrays, arrays.of_numpy
        self._sizes = (count,) if isinstance(count, int) else None if count is None else tuple(count)
        self.count = None if self._sizes is None else sum(self._sizes)
        self._host_lie = Arrangement.of(self._sizes)
        self._lie = self._host_lie if self._of_numpy else Arrangement((self.count or 1,))
        self.shape = self._shape = self._lie.shape
        self._physical, self._sensors = physical_units, len(self.plant.C)
        self._normalised = normalised(self.plant)
        limits = drive_limit(self.plant), self.plant.sensor_full_scale, *self._normalised.voltage_limits
        self._drive, self._full_scale, self._lowest, self._highest = (arrays.floats(_alike(limit)) for limit in limits)
        self._most, self._least = arrays.floats(np.array(1.0)), arrays.floats(np.array(-1.0))
        """Of readings, as arrays: NumPy is quicker with these than with Python's numbers."""
        self._disturbances: SharedDisturbances | SeededDisturbances | None = None
        n = self.count or 1
        self.electronics = Electronics(self.plant, scenario, n, arrays) if scenario.imperfect else None
        self.own_loads = OwnLoads(scenario.loads, self.plant.control_interval, n, self.plant.loads) if scenario.loads else None
        self._stepped = self.bank.convert(arrays)
        tables = self._stepped.strain, self._stepped.standing, self._stepped.failure_strain
        safe = safe_energy(self.bank.strain, self.bank.standing, self.bank.failure_strain)
        self._limit = StrainLimit(*tables, safe, arrays)
        self.plants = Allotment(self._stepped, self._lie, self._sizes or (1,), arrays)
        self._starts = Starts(self.bank, self._stepped, self.plants, arrays, arrays.exact(self.bank.speeds))
        own = self.plants.product if self.plants.drawn and not self._lie.runs else self._lie.product
        alone = joined_product if arrays.compiled else row_product
        self._multiply = own if self._shape and self._of_numpy else alone  # a blade alone has no time to ask
        self._fault_draws = fault_draws(scenario.failures) if self.plants.drawn or self.electronics is not None else 0
        self._changing = (
            self.bank.runs or self.bank.walk is not None or (self.electronics is not None and self.electronics.changing)
        )
        moving = self.plant, *self.bank.others
        per_cost = np.array([-1.0 / reward_scale(plant) for plant in moving])
        self._reward_per_cost = arrays.floats(per_cost[0] if len(moving) == 1 else per_cost[self.plants.group])[()]
        sizes = self.plant.B.shape[1], self.plant.disturbance_input.shape[1], self.plant.blade_states
        by_column = len(self.bank) == self.bank.groups and not (self._lie.runs and self.count == self.bank.groups)
        operators = self._stepped.operators
        self._memory: Any = (
            InPlace(self._lie, operators, sizes, arrays, by_column) if self._of_numpy else Fresh(n, operators, sizes, arrays)
        )
        self._halves = arrays.floats(np.full(sizes[-1], 0.5))
        """Weights of the squares of the blade's own states in the energy."""

    def __getstate__(self) -> tuple[Any, ...]:
        moving = self._memory.joined, self._disturbances, self.electronics, self.plants.state_dict(), self.own_loads
        return self.bank, self.scenario, self._sizes, self._physical, self.arrays, *moving

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        """Views must be views again of what they show, or a copied batch would come to a halt."""
        *arguments, joined, disturbances, electronics, plants, own = state
        self.__init__(*arguments)  # type: ignore[misc]
        self._memory.load(joined)
        self._disturbances, self.electronics, self.own_loads = disturbances, electronics, own
        self.plants.load_state_dict(plants)

    @property
    def state(self) -> Any:
        """(…, n) true states in energy coordinates: ½ xᵀx of the blade's own is the vibration energy in joules; of a plant that has
        coordinates of its own, in these.
        """
        turned, place = self._batched(self.moving), 0 if len(self.bank) == 1 else self.plants.index
        state = row_product(turned, self._stepped.axes[place])
        if self._stepped.own is not None:
            state = row_product(state, self._stepped.own[1][place].swapaxes(-1, -2))
        return state if self._shape else state[0]

    @property
    def moving(self) -> Any:
        """(…, n) the true states in the axes of the bank, in which the kernel steps."""
        return self._by_blade(self._memory.state)

    @property
    def index(self) -> Any:
        """(N,) place of each blade's plant in the bank, or among the plants of its group."""
        return self.plants.within_group

    @property
    def disturbances(self) -> SharedDisturbances | SeededDisturbances:
        """Loads and noise, from the first ``begin`` on."""
        if self._disturbances is None:
            raise ValueError("no episode has begun: call reset first.")
        return self._disturbances

    @property
    def design_state(self) -> Any:
        """(…, d) the true states as the design plant has its own: by displacements and velocities."""
        to_design = self._stepped.to_design
        if to_design is None:
            raise ValueError("the true blade's state cannot be told in the design's coordinates: their trial functions differ.")
        state = self.moving
        if len(self.bank) == self.bank.groups and self._shape:
            return self._lie.product(state[None], to_design if self._lie.runs else to_design[0])[0]
        seen = row_product(self._batched(state), to_design[self.plants.index])
        return seen if self._shape else seen[0]

    @property
    def coming_loads(self) -> Any:
        """(…, k) N/m, lag and flap: the line loads, white ones included, that act over the interval to come."""
        out = np.zeros((*self._shape, self.plant.disturbance_input.shape[1]), self.arrays.precision) if self._of_numpy else None
        loads = self.disturbances.loads(out)
        return self._by_blade(loads if self.own_loads is None else self.own_loads.added(loads))

    @property
    def speed(self) -> Any:
        """(…,) rad/s: what a tachometer shows."""
        speeds = self._stepped.speeds[self.plants.index]
        return speeds if self._shape else speeds[0]

    @property
    def truth(self) -> Any:
        """(…, 2 + m + 2 p): which plant of the bank moves, delay in intervals, gains of actuators, gains of sensors, biases in full
        scales, all of them as they are now: what only a law of tier 3 is told.
        """
        (p, _), m, index = self.plant.C.shape, self.plant.B.shape[1], self.plants.within_group
        sound = np.tile(np.repeat([0.0, 1.0, 0.0], [1, m + p, p]), (self.count or 1, 1))
        told = namespace(index).column_stack(
            [index, self.arrays.floats(sound) if self.electronics is None else self.electronics.told()]
        )
        return told if self._shape else told[0]

    def steady(self, rows: Any = None) -> Any:
        """(…, 4): stretch, untwist, largest strain and its place of the blades, or of ``rows``, as their episodes begin and nothing
        vibrates.
        """
        if len(self.bank) == 1 and not self._of_numpy and rows is None:
            whole: Any = self._stepped.steady
            return whole.expand(self.count or 1, -1)
        steady = self._stepped.steady[self.plants.index if rows is None else self.plants.index[rows]]
        return steady if self._shape else steady[0]

    def begin(
        self, generators: Generators, rows: Any = None, scenario: Scenario | None = None, initial_state: Any = None
    ) -> Motion:
        """Start the episodes of ``rows``, or of all blades, and return their motion at t = 0.

        ``scenario`` and ``initial_state`` ((n,) or (len(rows), n), in place of the load case's) hold for these episodes only. Of
        tensors, with torch's generator, ``rows`` may be a mask (N,): the motion is then what it would be of all blades.
        """
        scenario = self.scenario if scenario is None else scenario
        if rows is None:
            rows = self.arrays.exact(np.arange(self.count or 1))
            self._disturbances = self._chance(generators, scenario)
        assert self._disturbances is not None
        those = Masked(rows) if rows.dtype == namespace(rows).bool else self._lie.those(rows)
        numbers = self._numbers(generators, those, scenario)
        self._begin_plants_and_faults(those, numbers)
        seeded = isinstance(generators, Sequence)
        cases = self._starts.cases(scenario, those, numbers, seeded)
        chance: Any = self._disturbances
        noise = chance.begin(those, cases, generators if seeded else self.arrays.floats(numbers.noise))
        deflection, given = self.arrays.floats(cases.deflection), initial_state is not None
        state = self._starts.state(those, deflection, initial_state)
        self._memory.put(those, state)
        output, tip = (
            self._starts.shown(those, deflection, state, table, given) for table in (self._stepped.readout, self._stepped.tip)
        )
        if self._stepped.pyroelectric is not None:
            output = output + those.take(self._shown_of_heat())
        motion = self._undriven(state, output, tip, noise, those)
        return motion if self._shape else Motion(*(field[0] for field in motion))

    def _chance(self, generators: Generators, scenario: Scenario) -> SharedDisturbances | SeededDisturbances:
        seeded = isinstance(generators, Sequence)
        kind, lie = (SeededDisturbances, self._lie) if seeded else (SharedDisturbances, self._host_lie)
        loads = self.plant.disturbance_input.shape[1]
        return kind(noise_factor(self._normalised, scenario), lie, Turbulence.of(self.plant, scenario), loads, self.arrays)

    def _numbers(self, generators: Generators, those: Those, scenario: Scenario) -> Numbers:
        """What is drawn for episodes that begin, as NumPy's of what each blade's own generator drew."""
        assert self._disturbances is not None
        widths = self._disturbances.columns, self._fault_draws, self.plants.draws, self.plant.loads
        return draw(scenario, generators, on_host(those.rows), self.plants.group, *widths)

    def _begin_plants_and_faults(self, those: Those, numbers: Numbers) -> None:
        """Which plant each blade has, what is wrong with it, and what loads of one's own it meets."""
        exact = self.arrays.exact
        if self.bank.walk is not None:
            self.plants.set_out(those, exact(numbers.course))
        elif self.plants.drawn:
            self.plants.draw(those, exact(numbers.faults)[:, 0])
        else:
            self.plants.begin(those)
        if self.electronics is not None:
            self.electronics.begin(those, exact(numbers.faults))
        if self.own_loads is not None:
            rows = those.mask.nonzero()[:, 0] if isinstance(those, Masked) else those.rows
            own = numbers.own[rows] if isinstance(those, Masked) else numbers.own
            self.own_loads.begin(on_host(rows), on_host(own))

    def _undriven(self, state: Any, output: Any, tip: Any, noise: Any, those: Those) -> Motion:
        """Motion at the start of an episode, one row for each state (k, n)."""
        array, noise = namespace(state), noise[:, : len(self.plant.C)]
        energetic, none = state[:, : self.plant.blade_states], array.zeros_like(state[:, 0])
        if self.electronics is None:
            reading = array.clip(output + noise, -1.0, 1.0)
        else:
            reading = self.electronics.first_reading(those, output, noise)
        return Motion(
            observation=self._in_units(reading),
            reward=none,
            failed=none > 0.0,
            volts=array.zeros_like(state[:, :1]) + array.zeros_like(self._stepped.effort_weight[0, 0]),
            tip_displacement=tip,
            energy=0.5 * row_dot(energetic, energetic),
            effort=none + 0.0,
            cost_increment=none + 0.0,
        )

    def step(self, actions: Any, generators: Generators, resting: Rows | None = None) -> Motion:
        """Hold ``actions`` (…, m) over one control interval.

        ``resting`` are rows whose episode is over and that are about to begin another: no disturbance is drawn for them.
        """
        assert self._disturbances is not None
        memory = self._memory
        held = self._limited(actions / self._drive if self._physical else actions)
        acting = held if self.electronics is None else self.electronics.drive(self._batched(held))
        loads = self._disturbances.loads(memory.loads)
        if self.own_loads is not None:
            loads = self.own_loads.added(loads)
            self.own_loads.elapse()
        joined, voltages = memory.join(acting, loads)
        multiply, plants = self._multiply, self.plants
        effort = row_dot(multiply(voltages, plants.effort_weight, memory.weighted), voltages)
        reading, tip, increment, energy = memory.advance(plants.operators, joined, multiply, self._halves)
        noise = self._disturbances.next(generators, resting)
        if self._changing and (passage := self._elapse()) is not None:
            self._carry(passage)
        if self._stepped.pyroelectric is not None:
            reading = reading + self._shown_of_heat().reshape(reading.shape)
        if self._shape:
            increment, energy, effort = (each.reshape(self.count) for each in (increment, energy, effort))
        return Motion(
            self._observed(reading, noise),
            increment * self._reward_per_cost,
            self._limit.failed(energy, increment, lambda: self.moving, self.plants.index),
            held * self._drive,
            self._by_blade(tip),
            energy,
            effort,
            increment,
        )

    def _shown_of_heat(self) -> Any:
        """(N, p): what sensors show, in full scales, of their own warming."""
        assert self._stepped.pyroelectric is not None
        per_warming = self._stepped.pyroelectric[self.plants.index]
        return row_product(self.arrays.floats(self.plants.warming()), per_warming)

    def _limited(self, actions: Any) -> Any:
        """Actions as the drive lets them through; NumPy is quicker with two calls than with one."""
        if self._of_numpy:
            return np.maximum(np.minimum(actions, self._highest), self._lowest)
        return namespace(actions).clip(actions, self._lowest, self._highest)

    def _elapse(self) -> Passage | None:
        """One control interval later: where plants follow one another, the next is on; what breaks then is broken.

        Where blades come to another plant, their states are to be carried to its coordinates.
        """
        if self.bank.runs:
            self.plants.follow()
        if self.electronics is not None:
            self.electronics.elapse()
        return self.plants.walk_on() if self.bank.walk is not None else None

    def _carry(self, passage: Passage) -> None:
        """The states of some blades in the coordinates of the plants that they have come to."""
        those, change = passage
        self._memory.carry(those, row_product(self._batched(self._memory.of(those)), change))

    def detach(self) -> None:
        """Cut what moves, tensors, from the graph that it came of: gradients do not pass further back."""
        self._memory.detach()
        if self.electronics is not None:
            self.electronics.detach()

    def state_dict(self) -> dict[str, Any]:
        """What moves, from the first ``begin`` on: copies of arrays, in dictionaries; the generators are the caller's.

        An equally made batch that has begun as this one did, with one generator or with one for each blade, continues from it bit
        for bit after ``load_state_dict``.
        """
        return {
            "joined": self._memory.joined,
            "plants": self.plants.state_dict(),
            "disturbances": self.disturbances.state_dict(),
            "electronics": None if self.electronics is None else self.electronics.state_dict(),
            **({} if self.own_loads is None else {"own_loads": self.own_loads.state_dict()}),
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict``, of arrays or of what NumPy makes arrays of."""
        self._memory.load(state["joined"])
        self.plants.load_state_dict(state["plants"])
        self.disturbances.load_state_dict(state["disturbances"])
        if self.electronics is not None:
            self.electronics.load_state_dict(state["electronics"])
        if self.own_loads is not None:
            self.own_loads.load_state_dict(state["own_loads"])

    def _by_blade(self, columns: Any) -> Any:
        """A copy (…, columns) of what is laid out in blocks; tensors lie by blade."""
        if not self._of_numpy:
            return columns
        return np.array(columns, order="C").reshape(self.count or 1, -1) if self._shape else columns.copy()

    def _batched(self, values: Any) -> Any:
        """Values of a blade alone as of a batch of one."""
        return values if self._shape else np.atleast_2d(values)

    def _observed(self, output: Any, noise: Any) -> Any:
        """Readings (…, p) as the data acquisition gives them, in full scales or in amperes."""
        if self.electronics is not None:
            flat = self.electronics.acquire(*(self._batched(self._by_blade(each)) for each in (output, noise)))
            return self._in_units(flat if self._shape else flat[0])
        if noise.shape[-1] > self._sensors:
            noise = noise[..., : self._sensors]
        reading = output + noise
        if not self._of_numpy:
            return self._in_units(namespace(output).clip(reading, -1.0, 1.0))
        np.minimum(reading, self._most, out=reading)
        np.maximum(reading, self._least, out=reading)
        return self._in_units(self._by_blade(reading) if self._shape else reading)

    def _in_units(self, reading: Any) -> Any:
        return reading * self._full_scale if self._physical else reading
