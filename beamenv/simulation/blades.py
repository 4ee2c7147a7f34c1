"""A batch of blades in motion: what the single and the batched environment both wrap. The physics is ``kernel.advance``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.plant.plant import Plant, drive_limit, normalised
from beamenv.scenarios.drawing import load_cases
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.chance import Generators, Numbers, draw
from beamenv.simulation.kernel import advance, row_dot, row_product, weighted
from beamenv.simulation.memory import Arrangement, Instant
from beamenv.simulation.motion import Motion
from beamenv.simulation.plants.allotment import Allotment, Passage
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.reward import reward_scale as reward_scale
from beamenv.simulation.signals.disturbances import SeededDisturbances, SharedDisturbances, Turbulence, noise_factor
from beamenv.simulation.signals.electronics import Electronics
from beamenv.simulation.signals.faults import fault_draws
from beamenv.simulation.signals.own_loads import OwnLoads
from beamenv.simulation.strain_limit import safe_energy, strained_too_much

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

_FULL, _MINUS_FULL = np.array(1.0), np.array(-1.0)
"""NumPy is quicker with these than with Python numbers, which tells with a blade alone."""


def _alike(values: Array) -> Array:
    """One number () in place of equal ones (k,): it broadcasts faster."""
    return np.array(values[0]) if np.all(values == values[0]) else values


class Blades:
    """A batch of ``count`` blades, advanced together; ``count=None`` is a blade alone, without a batch axis.

    ``plant`` is the one plant of them all, or a bank of plants, of which each episode has one. ``generators`` is one generator
    for all blades or a sequence of one for each, whichever ``begin`` was first given. Where the bank has groups, so have the
    blades, one after the other: ``count`` is then how many in each, and rows that begin are to be in ascending order. With
    ``physical_units`` actions are volts and readings amperes, else both are normalised.
    """

    def __init__(
        self, plant: Plant | Bank, scenario: Scenario, count: int | Sequence[int] | None, physical_units: bool = False
    ) -> None:
        self.bank = plant if isinstance(plant, Bank) else Bank.single(plant)
        self.plant, self.scenario = self.bank.plant, scenario
        self._sizes = (count,) if isinstance(count, int) else None if count is None else tuple(count)
        self.count = None if self._sizes is None else sum(self._sizes)
        self._lie = Arrangement.of(self._sizes)
        self.shape = self._shape = self._lie.shape
        self._physical = physical_units
        self._normalised = normalised(self.plant)
        self._drive, self._full_scale = _alike(drive_limit(self.plant)), _alike(self.plant.sensor_full_scale)
        self._lowest, self._highest = (_alike(limit) for limit in self._normalised.voltage_limits)
        self._strained = self.bank.strain.shape[-2] > 0
        self._safe_energy = safe_energy(self.bank.strain, self.bank.standing, self.bank.failure_strain)
        self._disturbances: SharedDisturbances | SeededDisturbances | None = None
        self.electronics = Electronics(self.plant, scenario, self.count or 1) if scenario.imperfect else None
        self.own_loads = (
            OwnLoads(scenario.loads, self.plant.control_interval, self.count or 1, self.plant.loads) if scenario.loads else None
        )
        self.plants = Allotment(self.bank, self._lie, self._sizes or (1,))
        several = self.plants.product if self.plants.drawn and self._shape else row_product  # a blade alone has no time to ask
        self._multiply = self._lie.product if self._lie.runs else several
        self._fault_draws = fault_draws(scenario.failures) if self.plants.drawn or self.electronics is not None else 0
        self._changing = (
            self.bank.runs or self.bank.walk is not None or (self.electronics is not None and self.electronics.changing)
        )
        own = self.plant, *self.bank.others
        self._lowest_frequency = np.array([plant.natural_frequencies[0] for plant in own])
        per_cost = np.array([-1.0 / reward_scale(plant) for plant in own])
        self._reward_per_cost = per_cost[0] if len(own) == 1 else per_cost[self.plants.group]
        self._lay_out()

    def _lay_out(self) -> None:
        """Column by column where blades of a group have one plant, blade by blade for a plant each: as BLAS likes it."""
        (n, m), k = self.plant.B.shape, self.plant.disturbance_input.shape[1]
        size, width, b = n + m + k, self.bank.operators.fused.shape[-1], self.plant.blade_states
        widths = max(size, width), max(size, width), m, b
        if len(self.bank) == self.bank.groups and not (self._lie.runs and self.count == self.bank.groups):
            arrays = [self._lie.columns_first(width)[1] for width in widths]
        else:
            arrays = [np.zeros((*self._shape, width)) for width in widths]
        *memories, self._weighted, self._squares = arrays
        self._halves = np.full(b, 0.5)
        """Weights of the squares of the blade's states, which are kept from one instant to the next, in the energy."""
        self._now, self._then = (Instant.of(each, n, m, k, b, width) for each in memories)

    def __getstate__(self) -> tuple[Any, ...]:
        moving = self._now.joined.copy(), self._disturbances, self.electronics, self.plants.state_dict(), self.own_loads
        return self.bank, self.scenario, self._sizes, self._physical, *moving

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        """Views must be views again of what they show, or a copied batch would come to a halt."""
        *arguments, joined, disturbances, electronics, plants, own = state
        self.__init__(*arguments)  # type: ignore[misc]
        self._now.joined[...] = joined
        np.square(self._now.energetic, out=self._squares)
        self._disturbances, self.electronics, self.own_loads = disturbances, electronics, own
        self.plants.load_state_dict(plants)

    @property
    def state(self) -> Array:
        """(…, n) true states in energy coordinates: ½ xᵀx of the blade's own is the vibration energy in joules; of a plant that has
        coordinates of its own, in these.
        """
        turned, place = np.atleast_2d(self.moving), 0 if len(self.bank) == 1 else self.plants.index
        state = row_product(turned, self.bank.axes[place])
        if self.bank.own is not None:
            state = row_product(state, self.bank.own[1][place].swapaxes(-1, -2))
        return np.asarray(state if self._shape else state[0])

    @property
    def moving(self) -> Array:
        """(…, n) the true states in the axes of the bank, in which the kernel steps."""
        return self._by_blade(self._now.state)

    @property
    def index(self) -> Rows:
        """(N,) place of each blade's plant in the bank, or among the plants of its group."""
        return self.plants.within_group

    @property
    def disturbances(self) -> SharedDisturbances | SeededDisturbances:
        """Loads and noise, from the first ``begin`` on."""
        if self._disturbances is None:
            raise ValueError("blades have not begun: call begin first.")
        return self._disturbances

    @property
    def design_state(self) -> Array:
        """(…, d) the true states as the design plant has its own: by displacements and velocities."""
        if self.bank.to_design is None:
            raise ValueError("the true blade's state cannot be told in the design's coordinates: their trial functions differ.")
        state = self.moving
        if len(self.bank) == self.bank.groups and self._shape:
            views = self.bank.to_design if self._lie.runs else self.bank.to_design[0]
            return np.asarray(self._lie.product(state[None], views)[0])
        seen = row_product(np.atleast_2d(state), self.bank.to_design[self.plants.index])
        return np.asarray(seen if self._shape else seen[0])

    @property
    def coming_loads(self) -> Array:
        """(…, k) N/m, lag and flap: the line loads, white ones included, that act over the interval to come."""
        loads = np.zeros((*self._shape, self.plant.disturbance_input.shape[1]))
        self.disturbances.loads(loads)
        if self.own_loads is not None:
            self.own_loads.add(loads)
        return self._by_blade(loads)

    @property
    def speed(self) -> Array:
        """(…,) rad/s: what a tachometer shows."""
        speeds = self.bank.speeds[self.plants.index]
        return speeds if self._shape else speeds[0]

    @property
    def truth(self) -> Array:
        """(…, 2 + m + 2 p): which plant of the bank moves, delay in intervals, gains of actuators, gains of sensors, biases in full
        scales, all of them as they are now: what only a law of tier 3 is told.
        """
        (p, _), m = self.plant.C.shape, self.plant.B.shape[1]
        sound = np.tile(np.repeat([0.0, 1.0, 0.0], [1, m + p, p]), (self.count or 1, 1))
        told = np.column_stack([self.plants.within_group, sound if self.electronics is None else self.electronics.told()])
        return told if self._shape else told[0]

    def steady(self, rows: Rows | None = None) -> Array:
        """(…, 4): stretch, untwist, largest strain and its place of the blades, or of ``rows``, as their episodes begin and nothing
        vibrates.
        """
        steady = self.bank.steady[self.plants.index if rows is None else self.plants.index[rows]]
        return steady if self._shape else steady[0]

    def begin(
        self,
        generators: Generators,
        rows: Rows | None = None,
        scenario: Scenario | None = None,
        initial_state: Array | None = None,
    ) -> Motion:
        """Start the episodes of ``rows``, or of all blades, and return their motion at t = 0.

        ``scenario`` and ``initial_state`` ((n,) or (len(rows), n), in place of the load case's) hold for these episodes only.
        """
        scenario = self.scenario if scenario is None else scenario
        if rows is None:
            rows = np.arange(self.count or 1)
            kind = SharedDisturbances if isinstance(generators, np.random.Generator) else SeededDisturbances
            turbulence = Turbulence.of(self.plant, scenario)
            loads = self.plant.disturbance_input.shape[1]
            self._disturbances = kind(noise_factor(self._normalised, scenario), self._lie, turbulence, loads)
        assert self._disturbances is not None
        widths = self._disturbances.columns, self._fault_draws, self.plants.draws, self.plant.loads
        numbers = draw(scenario, generators, rows, self.plants.group, *widths)
        self._begin_plants_and_faults(rows, numbers)
        index = self.plants.index[rows]
        lowest = self._lowest_frequency[self.plants.group[rows]]
        speeds = self.bank.speeds[index]
        cases = load_cases(scenario, self.plant, lowest, numbers.load, numbers.turns, speeds)
        if self.own_loads is not None:
            self.own_loads.begin(rows, numbers.own)
        begins: Any = numbers.noise if isinstance(generators, np.random.Generator) else generators
        noise = self._disturbances.begin(rows, cases, begins)
        state = row_product(cases.deflection, self.bank.release[index])
        if self.bank.start is not None:
            state += self.bank.start[self.plants.group[rows]]
        if initial_state is not None:
            given = np.broadcast_to(initial_state, state.shape)
            if self.bank.own is not None:
                given = row_product(given, self.bank.own[0][index].swapaxes(-1, -2))
            state[...] = row_product(given, self.bank.axes[index].swapaxes(-1, -2))
        at = self._lie.rows_of(rows)
        self._now.joined[at] = 0.0
        self._now.state[at] = state
        self._squares[at] = state[:, : self.plant.blade_states] ** 2
        motion = self._undriven(state, noise, rows)
        return motion if self._shape else Motion(*(field[0] for field in motion))

    def _begin_plants_and_faults(self, rows: Rows, numbers: Numbers) -> None:
        """Which plant each blade has, and what is wrong with it."""
        if self.bank.walk is not None:
            self.plants.set_out(rows, numbers.course)
        elif self.plants.drawn:
            self.plants.draw(rows, numbers.faults[:, 0])
        else:
            self.plants.begin(rows)
        if self.electronics is not None:
            self.electronics.begin(rows, numbers.faults)

    def _undriven(self, state: Array, noise: Array, rows: Rows) -> Motion:
        """Motion at the start of an episode, one row for each state (rows, n)."""
        count = len(state)
        index, energetic = self.plants.index[rows], state[:, : self.plant.blade_states]
        output, noise = row_product(state, self.bank.readout[index]), noise[:, : len(self.plant.C)]
        if self.electronics is None:
            reading = np.clip(output + noise, -1.0, 1.0)
        else:
            reading = self.electronics.first_reading(rows, output, noise)
        return Motion(
            observation=self._in_units(reading),
            reward=np.zeros(count),
            failed=np.zeros(count, dtype=np.bool_),
            volts=np.zeros((count, self.plant.B.shape[1])),
            tip_displacement=row_product(state, self.bank.tip[index]),
            energy=0.5 * row_dot(energetic, energetic),
            effort=np.zeros(count),
            cost_increment=np.zeros(count),
        )

    def step(self, actions: Array, generators: Generators, resting: Rows | None = None) -> Motion:
        """Hold ``actions`` (…, m) over one control interval.

        ``resting`` are rows whose episode is over and that are about to begin another: no disturbance is drawn for them.
        """
        assert self._disturbances is not None
        held = actions / self._drive if self._physical else actions
        held = np.maximum(np.minimum(held, self._highest), self._lowest)
        acting = held if self.electronics is None else self.electronics.drive(np.atleast_2d(held))
        now, then = self._now, self._then
        now.voltages[...] = acting.reshape(now.voltages.shape)
        self._disturbances.loads(now.loads)
        if self.own_loads is not None:
            self.own_loads.add(now.loads)
            self.own_loads.elapse()
        _, reading, tip, increment = advance(self.plants.operators, now.joined, then.product, self._multiply, self._squares)
        self._now, self._then = then, now  # the product begins with the next state
        noise = self._disturbances.next(generators, resting)  # type: ignore[arg-type]
        energy = weighted(np.square(then.energetic, out=self._squares), self._halves)
        effort = row_dot(self._multiply(now.voltages, self.plants.effort_weight, self._weighted), now.voltages)
        if self._changing and (passage := self.elapse()) is not None:
            self._carry(passage)
        if self._shape:
            increment, energy, effort = (each.reshape(self.count) for each in (increment, energy, effort))
        return Motion(
            self._observed(reading, noise),
            increment * self._reward_per_cost,
            self._failed(energy if self._strained else energy + increment),  # where no strain is known, only what is no number
            held * self._drive,
            self._by_blade(tip),
            energy,
            effort,
            increment,
        )

    def elapse(self) -> Passage | None:
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
        rows, change = passage
        at = self._lie.rows_of(rows) or ...
        state = row_product(np.atleast_2d(self._now.state[at]), change)
        self._now.state[at] = state if self._shape else state[0]
        self._squares[at] = self._now.energetic[at] ** 2

    def state_dict(self) -> dict[str, Any]:
        """What moves, from the first ``begin`` on: copies of arrays, in dictionaries; the generators are the caller's.

        An equally made batch that has begun as this one did, with one generator or with one for each blade, continues from it bit
        for bit after ``load_state_dict``.
        """
        return {
            "joined": self._now.joined.copy(),
            "plants": self.plants.state_dict(),
            "disturbances": self.disturbances.state_dict(),
            "electronics": None if self.electronics is None else self.electronics.state_dict(),
            **({} if self.own_loads is None else {"own_loads": self.own_loads.state_dict()}),
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict``, of arrays or of what NumPy makes arrays of."""
        self._now.joined[...] = np.asarray(state["joined"])
        np.square(self._now.energetic, out=self._squares)
        self.plants.load_state_dict(state["plants"])
        self.disturbances.load_state_dict(state["disturbances"])
        if self.electronics is not None:
            self.electronics.load_state_dict(state["electronics"])
        if self.own_loads is not None:
            self.own_loads.load_state_dict(state["own_loads"])

    def _by_blade(self, columns: Array) -> Array:
        """A copy (…, columns) of what is laid out in blocks."""
        return np.array(columns, order="C").reshape(self.count or 1, -1) if self._shape else columns.copy()

    def _observed(self, output: Array, noise: Array) -> Array:
        """Readings (…, p) as the data acquisition gives them, in full scales or in amperes."""
        if self.electronics is not None:
            flat = self.electronics.acquire(np.atleast_2d(self._by_blade(output)), np.atleast_2d(self._by_blade(noise)))
            return self._in_units(flat if self._shape else flat[0])
        noisy = np.empty(output.shape)  # the output may be part of the state
        np.add(output, noise[..., : output.shape[-1]], out=noisy)
        reading: Array = noisy.reshape(self.count or 1, -1) if self._shape else noisy
        np.minimum(reading, _FULL, out=reading)
        np.maximum(reading, _MINUS_FULL, out=reading)
        return self._in_units(reading)

    def _in_units(self, reading: Array) -> Array:
        return reading * self._full_scale if self._physical else reading

    def _failed(self, energy: Array) -> NDArray[np.bool_]:
        """Only a blade with enough energy can have failed, and only then are its strains worked out."""
        failed = np.zeros(energy.shape, dtype=np.bool_)
        most = energy.max() if self._shape else energy
        if not most <= self._safe_energy:  # a NaN is not safe either
            rows = np.flatnonzero(~(np.atleast_1d(energy) <= self._safe_energy))
            state, index = np.atleast_2d(self.moving)[rows], self.plants.index[rows]
            np.atleast_1d(failed)[rows] = strained_too_much(
                self.bank.strain[index], self.bank.standing[index], self.bank.failure_strain[index], state
            )
        return failed
