"""Disturbances: for a batch of blades, the line loads and the sensor noise of one sampling instant after another.

At instant j each blade has one row [load case + white load (k), N/m, held over [t_j, t_j + Δt] | sensor noise (p) of the
reading at t_j], with k = 2, the line loads, unless the plant has others. The white parts are normals times a factor of their
covariance, factorised once. Where a scenario asks for them, k more normals drive the turbulence, and p standard normals tell which
readings are lost: [loads (k) | sensor noise (p) | lost (p) | turbulence (k)].

There are two ways to draw them. ``SharedDisturbances`` has one generator for the whole batch: fast. ``SeededDisturbances``
has a generator for each blade, so that a blade meets the same episode whatever else is in its batch. Neither keeps a
generator: it is handed in at every call.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import REFERENCE, Arrays, SomeRows, Those, copied
from beamenv.plant.plant import Plant
from beamenv.scenarios.load_cases import LoadCases
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.memory import Arrangement, Run
from beamenv.simulation.signals.normals import Normals, normals_like

Array = NDArray[np.float64]
Rows = NDArray[np.int64]
Generator = np.random.Generator

BLOCK = 64
"""Instants that ``SeededDisturbances`` draws at a time: enough to make a generator's call cheap."""


def noise_factor(plant: Plant, scenario: Scenario) -> Array:
    """F (c, c): standard normals (…, c) @ F are [white loads, N/m | sensor noise, in the plant's unit | lost | turbulence].

    The columns of lost readings (p standard normals) and of turbulence (k, N/m) are there where the scenario has any.
    """
    p, k = len(plant.C), plant.disturbance_input.shape[1]
    read = k + p
    lost, gusts = (p if scenario.acquisition.dropout else 0), (k if scenario.rotor.turbulence else 0)
    factor = np.zeros((read + lost + gusts,) * 2)
    if scenario.white_load:
        factor[:k, :k] = _square_root(plant.process_noise / plant.control_interval)
    if scenario.sensor_noise:
        factor[k:read, k:read] = _square_root(plant.sensor_noise / plant.control_interval)
    factor[read : read + lost, read : read + lost] = np.eye(lost)
    factor[read + lost :, read + lost :] = scenario.rotor.turbulence * np.diag(plant.load_scale[:gusts])
    return factor


@dataclass(frozen=True, slots=True)
class Turbulence:
    """First-order Gauss–Markov loads, sampled exactly: g⁺ = a g + √(1 − a²) n, with a = exp(−Δt/τ), started in steady state."""

    decay: float
    """a"""

    @classmethod
    def of(cls, plant: Plant, scenario: Scenario) -> Turbulence | None:
        """That of a scenario; None without any."""
        rotor = scenario.rotor
        return cls(math.exp(-plant.scenario_interval / rotor.turbulence_time)) if rotor.turbulence else None

    def following(self, gusts: Any, normals: Any) -> Any:
        """The loads (…, k) of the next instant, from this one's and normals of the right size."""
        return self.decay * gusts + math.sqrt(1.0 - self.decay**2) * normals


def _square_root(covariance: Array) -> Array:
    """Symmetric root: unlike a Cholesky factor it exists for a singular covariance too."""
    values, vectors = np.linalg.eigh(covariance)
    return (vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T


class SharedDisturbances:
    """Disturbances of N blades from one generator, of NumPy or of torch, drawn anew at every instant.

    NumPy's draws normals as (blocks, column, blade), group after group where the batch has groups: in the numbers of the blades'
    arrays, or, of tensors, with 64 bits.
    """

    def __init__(
        self, factor: Array, lie: Arrangement, turbulence: Turbulence | None = None, loads: int = 2, arrays: Arrays = REFERENCE
    ) -> None:
        count, self._lie, self._loads, self._arrays = math.prod(lie.shape), lie, loads, arrays
        drawn_with = arrays.precision if arrays.of_numpy else REFERENCE.precision
        self._factor = factor if np.any(factor - np.diag(np.diagonal(factor))) else np.diagonal(factor).copy()
        self._own_factor = arrays.floats(self._factor)
        memory, self._seen = lie.columns_first(len(factor), drawn_with)
        self._drawn = [(self._seen, self._seen)]
        """Normals (…, c), and where the disturbances made of them go."""
        if lie.runs:
            memory = np.zeros((count, len(factor)), drawn_with)
            self._drawn = [(_drawn_by_column(run, memory), run.of(self._seen)) for run in lie.runs]
        self._normals = Normals(memory)
        self._turbulence = turbulence
        if arrays.of_numpy:
            self._rows: Any = self._seen
            self._gusts: Any = np.zeros((*lie.shape, loads), arrays.precision)
            self._amplitude: Any = lie.columns_first(loads, arrays.precision)[1]
        else:
            self._rows, self._gusts, self._amplitude = (arrays.zeros(count, width) for width in (len(factor), loads, loads))
        self._steps = arrays.exact(np.zeros(count, dtype=np.int64))
        self._cases: LoadCases | None = None

    def __getstate__(self) -> tuple[Any, ...]:
        carried = copied(self._rows), copied(self._amplitude), self._steps, self._cases, self._gusts
        return self._factor, self._lie, self._turbulence, self._loads, self._arrays, *carried

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        """Views must be views again of what they show, or a copied batch would come to a halt."""
        factor, lie, turbulence, loads, arrays, rows, amplitude, steps, cases, gusts = state
        self.__init__(np.diag(factor) if factor.ndim == 1 else factor, lie, turbulence, loads, arrays)  # type: ignore[misc]
        self._rows[...], self._amplitude[...] = rows, amplitude
        self._steps, self._cases, self._gusts = steps, cases, gusts

    def begin(self, those: Those, cases: LoadCases, normals: Any) -> Any:
        """Start some blades at instant 0 of their load cases; their sensor noise there, [noise (p) | …] (k, c − loads).

        ``normals`` (k, c) are standard normals for this instant.
        """
        self._cases = merged(self._cases, those, cases)
        self._steps = those.put(self._steps, 0)
        self._amplitude = those.lay(self._amplitude, cases.amplitude)
        disturbance = normals * self._own_factor if self._factor.ndim == 1 else normals @ self._own_factor
        self._rows = those.lay(self._rows, disturbance)
        if self._turbulence is not None:
            self._gusts = those.lay(self._gusts, disturbance[:, len(self._factor) - self._loads :])
        return disturbance[:, self._loads :]

    @property
    def columns(self) -> int:
        """c: how many normals an instant takes of each blade."""
        return len(self._factor)

    def loads(self, out: Any = None) -> Any:
        """The line loads of this instant (…, k), with NumPy written to ``out``."""
        cases, first = self._cases, self._rows[..., : self._loads]
        assert cases is not None
        gain = cases.gain(self._steps)
        if self._arrays.of_numpy:
            np.multiply(self._amplitude, gain.reshape(*out.shape[:-1], 1), out=out, casting="same_kind")
            np.add(out, first, out=out)
        else:
            out = self._amplitude * gain[:, None] + first
        if cases.has_harmonics:
            out += cases.of_rotor(self._steps).reshape(out.shape)
        if self._turbulence is not None:
            out += self._gusts
        return out

    def next(self, generator: Any, resting: Rows | None = None) -> Any:
        """Go to the next instant; the sensor noise there, [noise (p) | …] (…, c − loads). ``resting`` makes no difference here."""
        self._steps = self._steps + 1
        self._draw(generator)
        if self._turbulence is not None:
            self._gusts = self._turbulence.following(self._gusts, self._rows[..., len(self._factor) - self._loads :])
        return self._rows[..., self._loads :]

    def _draw(self, generator: Any) -> None:
        factor = self._own_factor if self._arrays.of_numpy else self._factor
        if not isinstance(generator, np.random.Generator):
            normals = normals_like(generator, self._rows)
            self._rows = normals * self._own_factor if factor.ndim == 1 else normals @ self._own_factor
            return
        self._normals.draw(generator)
        for normals, rows in self._drawn:
            if factor.ndim == 1:
                np.multiply(normals, factor, out=rows)
            else:
                rows[...] = normals @ factor
        if not self._arrays.of_numpy:
            self._rows = self._arrays.floats(self._seen.reshape(self._rows.shape))

    def state_dict(self) -> dict[str, Any]:
        """Copies of what moves; the generator is the caller's."""
        names = "rows", "amplitude", "steps", "gusts"
        moving = {name: copied(getattr(self, f"_{name}")) for name in names}
        return {**moving, "cases": None if self._cases is None else self._cases.state_dict()}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict`` of equally made disturbances."""
        self._rows[...], self._amplitude[...] = copied(state["rows"]), copied(state["amplitude"])
        self._steps, self._gusts = copied(state["steps"]), copied(state["gusts"])
        self._cases = None if state["cases"] is None else LoadCases.from_state_dict(state["cases"])


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
        rows = np.asarray(those.rows)
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


def _drawn_by_column(run: Run, normals: Array) -> Array:
    """A run's share of normals drawn one after the other, seen as (groups, blocks, size, c)."""
    groups, blocks, size = run.shape
    return normals[run.rows].reshape(groups, blocks, -1, size).swapaxes(-2, -1)


def merged(cases: LoadCases | None, those: Those, others: LoadCases) -> LoadCases:
    """``cases`` with those of some blades exchanged for ``others``."""
    all_of_them = cases is None or (isinstance(those, SomeRows) and len(those.rows) == len(cases))
    return others if all_of_them else cases.replace(those, others)  # type: ignore[union-attr]
