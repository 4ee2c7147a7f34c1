"""Disturbances: for a batch of blades, the line loads and the sensor noise of one sampling instant after another.

At instant j each blade has one row [load case + white load (k), N/m, held over [t_j, t_j + Δt] | sensor noise (p) of the
reading at t_j], with k = 2, the line loads, unless the plant has others. The white parts are normals times a factor of their
covariance, factorised once. Where a scenario asks for them, k more normals drive the turbulence, and p standard normals tell which
readings are lost: [loads (k) | sensor noise (p) | lost (p) | turbulence (k)].

There are two ways to draw them. ``SharedDisturbances`` has one generator for the whole batch: fast. ``SeededDisturbances``
(``seeded_disturbances``) has a generator for each blade, so that a blade meets the same episode whatever else is in its batch.
Neither keeps a generator: it is handed in at every call.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
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
            np.multiply(self._amplitude, self._arrays.floats(gain).reshape(*out.shape[:-1], 1), out=out)
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


def _drawn_by_column(run: Run, normals: Array) -> Array:
    """A run's share of normals drawn one after the other, seen as (groups, blocks, size, c)."""
    groups, blocks, size = run.shape
    return normals[run.rows].reshape(groups, blocks, -1, size).swapaxes(-2, -1)


def merged(cases: LoadCases | None, those: Those, others: LoadCases) -> LoadCases:
    """``cases`` with those of some blades exchanged for ``others``."""
    all_of_them = cases is None or (isinstance(those, SomeRows) and len(those.rows) == len(cases))
    return others if all_of_them else cases.replace(those, others)  # type: ignore[union-attr]
