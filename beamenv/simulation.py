"""A batch of blades in motion: what the single and the batched environment both wrap. The physics is ``kernel.advance``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.disturbances import SeededDisturbances, SharedDisturbances, columns_first, noise_factor, place
from beamenv.kernel import Operators, advance, product_into, row_dot
from beamenv.loads import static_deflection
from beamenv.plant import Plant
from beamenv.reduction import REFERENCE_LOAD
from beamenv.scenarios import Scenario, draw_load_cases

Array = NDArray[np.float64]
Rows = NDArray[np.int64]
Generators = np.random.Generator | Sequence[np.random.Generator]

FAILURE_STRAIN = 0.0045
"""Spanwise strain at which an episode ends: the greatest tensile strain an MFC is rated for (4500 ppm, Smart Material's data
sheet); the laminate breaks later."""

_BLOCK = 256
"""Blades that lie together in memory: BLAS multiplies blocks of this size fastest."""

_FULL, _MINUS_FULL = np.array(1.0), np.array(-1.0)
"""NumPy is quicker with these than with Python numbers, which tells with a blade alone."""


class Motion(NamedTuple):
    """What one control interval brought to each blade, in fresh arrays; "…" is N, or nothing for a single blade."""

    observation: Array
    """(…, p) sensor readings, clipped to full scale."""
    reward: Array
    """(…,)"""
    failed: NDArray[np.bool_]
    """(…,) strained beyond ``FAILURE_STRAIN``, or no longer finite."""
    volts: Array
    """(…, m), V, after saturation: what the patches got."""
    tip_displacement: Array
    """(…, 2), m: lag, flap, at the end of the interval."""
    energy: Array
    """(…,), J: vibration energy at the end of the interval."""
    effort: Array
    """(…,), J s: the actuators' share uᵀRu Δt of the cost increment."""
    cost_increment: Array
    """(…,), J s: ∫(xᵀQx + uᵀRu)dt over the interval."""


def reward_scale(plant: Plant) -> float:
    """Cost of one control interval, J s, that is a reward of −1: xᵀQx Δt in the static deflection under 30 N/m in flap.

    It depends on the plant alone, so the return of an episode is −J over a constant whatever the scenario and the controller.
    Without control a default episode comes to about −1 a step, 6.7 µJ s for the default blade.
    """
    state = static_deflection(plant, (0.0, REFERENCE_LOAD))
    return float(state @ plant.state_weight @ state) * plant.control_interval


def normalised(plant: Plant) -> Plant:
    """The plant as a controller meets it: voltages in units of the drive limit, currents in units of sensor full scale."""
    drive, full_scale = drive_limit(plant), plant.sensor_full_scale
    return replace(
        plant,
        B=plant.B * drive,
        C=plant.C / full_scale[:, None],
        D=plant.D * drive / full_scale[:, None],
        input_weight=plant.input_weight * np.outer(drive, drive),
        sensor_noise=plant.sensor_noise / np.outer(full_scale, full_scale),
        voltage_limits=plant.voltage_limits / drive,
        sensor_full_scale=np.ones_like(full_scale),
    )


def drive_limit(plant: Plant) -> Array:
    """(m,) V: the voltage an action of 1 stands for, the larger magnitude of the two limits."""
    return np.abs(plant.voltage_limits).max(axis=0)


def _alike(values: Array) -> Array:
    """One number () in place of equal ones (k,): it broadcasts faster."""
    return np.array(values[0]) if np.all(values == values[0]) else values


def _shape(count: int | None) -> tuple[int, ...]:
    """Shape of the batch: () for a blade alone, else (blocks, size) with size near ``_BLOCK`` where count has such a divisor."""
    if count is None:
        return ()
    size = next((size for size in range(min(count, _BLOCK), _BLOCK // 4, -1) if count % size == 0), count)
    return count // size, size


class Blades:
    """A batch of ``count`` blades of one plant, advanced together; ``count=None`` is a blade alone, without a batch axis.

    ``generators`` is one generator for all blades or a sequence of one for each, whichever ``begin`` was first given.
    With ``physical_units`` actions are volts and readings amperes, else both are normalised.
    """

    def __init__(self, plant: Plant, scenario: Scenario, count: int | None, physical_units: bool = False) -> None:
        self.plant, self.scenario, self.count = plant, scenario, count
        self._shape = _shape(count)
        self._physical = physical_units
        self._normalised = normalised(plant)
        self._operators = Operators.from_plant(self._normalised)
        self._drive, self._full_scale = _alike(drive_limit(plant)), _alike(plant.sensor_full_scale)
        self._lowest, self._highest = (_alike(limit) for limit in self._normalised.voltage_limits)
        self._effort_weight = self._normalised.input_weight * plant.control_interval
        self._reward_per_cost = -1.0 / reward_scale(plant)
        self._release = static_deflection(plant, np.eye(2))
        self._safe_energy = _safe_energy(plant)
        self._disturbances: SharedDisturbances | SeededDisturbances | None = None
        self._lay_out()

    def _lay_out(self) -> None:
        n, m = self.plant.B.shape
        _, self._joined = columns_first(self._shape, n + m + 2)
        _, self._product = columns_first(self._shape, self._operators.fused.shape[1])
        _, self._weighted = columns_first(self._shape, m)
        self._state, self._voltages, self._loads = np.split(self._joined, [n, n + m], axis=-1)
        self._next_state = self._product[..., :n]

    def __getstate__(self) -> tuple[Any, ...]:
        return self.plant, self.scenario, self.count, self._physical, self._joined.copy(), self._disturbances

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        """Views must be views again of what they show, or a copied batch would come to a halt."""
        *arguments, joined, disturbances = state
        self.__init__(*arguments)  # type: ignore[misc]
        self._joined[...] = joined
        self._disturbances = disturbances

    @property
    def state(self) -> Array:
        """(…, n) true states in energy coordinates: ½ xᵀx is the vibration energy in joules."""
        return self._by_blade(self._state)

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
            self._disturbances = kind(noise_factor(self._normalised, scenario), self._shape)
        assert self._disturbances is not None
        own = generators if isinstance(generators, np.random.Generator) else [generators[row] for row in rows]
        cases = draw_load_cases(scenario, self.plant, own, len(rows))
        noise = self._disturbances.begin(rows, cases, generators)  # type: ignore[arg-type]
        state = cases.deflection @ self._release
        if initial_state is not None:
            state[...] = initial_state
        at = place(rows, self._shape)
        self._joined[at] = 0.0
        self._state[at] = state
        motion = self._undriven(state, noise)
        return motion if self._shape else Motion(*(field[0] for field in motion))

    def _undriven(self, state: Array, noise: Array) -> Motion:
        """Motion at the start of an episode, one row for each state (rows, n)."""
        count = len(state)
        return Motion(
            observation=self._observed(state @ self._normalised.C.T + noise),
            reward=np.zeros(count),
            failed=np.zeros(count, dtype=np.bool_),
            volts=np.zeros((count, self.plant.B.shape[1])),
            tip_displacement=state @ self.plant.tip_displacement.T,
            energy=0.5 * row_dot(state, state),
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
        self._voltages[...] = held.reshape(self._voltages.shape)
        self._disturbances.loads(self._loads)
        _, reading, tip, increment = advance(self._operators, self._joined, out=self._product)
        self._state[...] = self._next_state
        reading += self._disturbances.next(generators, resting)  # type: ignore[arg-type]
        energy = 0.5 * row_dot(self._state, self._state)
        weighted = product_into(self._weighted, self._voltages, self._effort_weight)
        effort = row_dot(weighted, self._voltages)
        if self._shape:
            increment, energy, effort = (each.reshape(self.count) for each in (increment, energy, effort))
        return Motion(
            self._observed(self._by_blade(reading)),
            increment * self._reward_per_cost,
            self._failed(energy),
            held * self._drive,
            self._by_blade(tip),
            energy,
            effort,
            increment,
        )

    def _by_blade(self, columns: Array) -> Array:
        """A copy (…, columns) of what is laid out in blocks."""
        return np.array(columns, order="C").reshape(self.count or 1, -1) if self._shape else columns.copy()

    def _observed(self, reading: Array) -> Array:
        """Readings (…, p) in full scales, as the data acquisition gives them; changed in place."""
        np.minimum(reading, _FULL, out=reading)
        np.maximum(reading, _MINUS_FULL, out=reading)
        if self._physical:
            reading *= self._full_scale
        return reading

    def _failed(self, energy: Array) -> NDArray[np.bool_]:
        """|cᵀx| ≤ ‖c‖‖x‖: only a blade with enough energy can have failed, and only then are its strains worked out."""
        failed = np.zeros(energy.shape, dtype=np.bool_)
        most = energy.max() if self._shape else energy
        if not most <= self._safe_energy:  # a NaN is not safe either
            strain = np.abs(self._by_blade(self._state) @ self.plant.strain.T).max(axis=-1)
            failed[...] = ~(strain <= FAILURE_STRAIN)
        return failed


def _safe_energy(plant: Plant) -> float:
    """Vibration energy, J, below which no state can strain the blade beyond ``FAILURE_STRAIN``."""
    steepest = float(np.sqrt((plant.strain**2).sum(axis=-1)).max(initial=0.0))
    return np.inf if steepest == 0.0 else 0.5 * (FAILURE_STRAIN / steepest) ** 2
