"""Forced response of the bare blade: exact, by Newmark's method with the thesis' constants, and over frequency."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from baselines.evaluation.metrics import settled_from
from beamenv.plant.reduction import ModalModel, truncate
from beamenv.structure import RotatingBeam
from beamenv.structure.beam import EXTRA_STATIONS
from beamenv.structure.modes import normal_modes
from beamenv.structure.newmark import NewmarkScheme, newmark

Array = NDArray[np.float64]

DIRECTIONS = {"lag": ("u", 0), "flap": ("v", 1)}

THESIS_SCHEME = NewmarkScheme(alpha=0.75, delta=0.5)
THESIS_INTERVAL = 1e-4
"""s."""

MODES = 24
"""Retained by the exact response: the tip of a uniformly loaded blade is then within 0.1 % of all modes'."""


@dataclass(frozen=True, eq=False)
class ForcedBlade:
    """A blade under a uniform line load, with modal damping."""

    beam: RotatingBeam
    speed: float
    """rad/s."""
    direction: str
    """Of load and tip displacement: "lag" or "flap"."""
    damping_ratio: float
    gyroscopic: bool = True
    pressure: bool = False
    """Whether the line load falls with the chord of a tapered blade, as a pressure would; ``load`` is then that at the root."""

    @cached_property
    def force(self) -> Array:
        """(N,): generalised force per N/m."""
        if not self.pressure:
            return self.beam.line_load()[:, DIRECTIONS[self.direction][1]]
        beam = self.beam
        stations = beam.space.stations(np.array([0.0, beam.length]), beam.space.order + EXTRA_STATIONS)
        chord = 1.0 - (1.0 - 1.0 / beam.taper) * stations.z / beam.length
        return (stations.weight * chord) @ beam.space.evaluate(stations.z)[DIRECTIONS[self.direction][0], 0]

    @cached_property
    def modal(self) -> ModalModel:
        """Undamped modes without gyroscopic coupling, and the coupling between them."""
        return truncate(self.beam, self.speed, MODES, self.gyroscopic)

    def _dynamics(self) -> tuple[Array, Array, Array]:
        omega, shapes = self.modal.natural_frequencies, self.modal.mode_shapes
        size = len(omega)
        field = DIRECTIONS[self.direction][0]
        damping = self.modal.gyroscopic + np.diag(2.0 * self.damping_ratio * omega)
        dynamics = np.block([[np.zeros((size, size)), np.diag(omega)], [-np.diag(omega), -damping]])
        force = np.concatenate([np.zeros(size), shapes.T @ self.force])
        tip = self.beam.displacements(np.array([self.beam.length]))[field][0] @ shapes / omega
        return dynamics, force, np.concatenate([tip, np.zeros(size)])

    def step_response(self, load: float, duration: float, interval: float = THESIS_INTERVAL) -> tuple[Array, Array]:
        """Times (K,) in s and tip displacement (K,) in m after ``load`` N/m is applied to the blade at rest: exact."""
        dynamics, force, tip = self._dynamics()
        transition = expm(dynamics * interval)
        final = -np.asarray(np.linalg.solve(dynamics, load * force), dtype=np.float64)
        times = np.linspace(0.0, duration, round(duration / interval) + 1)
        return times, (free_motion(transition, -final, len(times)) + final) @ tip

    def static_displacement(self, load: float) -> float:
        """Where the tip comes to rest under ``load`` N/m, in m."""
        dynamics, force, tip = self._dynamics()
        return float(-tip @ np.linalg.solve(dynamics, load * force))

    def full_matrices(self) -> tuple[Array, Array, Array]:
        """Mass, damping with gyroscopic coupling, and stiffness (N, N) by all trial functions."""
        matrices = self.beam.matrices
        stiffness = matrices.stiffness(self.speed)
        omega, shapes = normal_modes(matrices.mass, stiffness)
        moved = matrices.mass @ shapes
        damping = moved @ np.diag(2.0 * self.damping_ratio * omega) @ moved.T
        if self.gyroscopic:
            damping = damping + self.speed * matrices.gyroscopic
        return matrices.mass, damping, stiffness

    @property
    def tip(self) -> Array:
        """(N,): the tip's displacement by each trial function."""
        return self.beam.displacements(np.array([self.beam.length]))[DIRECTIONS[self.direction][0]][0]

    def frequency_response(self, frequencies: Array) -> Array:
        """Amplitude (K,) of the tip, m per N/m, at ``frequencies`` (K,) in rad/s."""
        dynamics, force, tip = self._dynamics()
        poles, vectors = np.linalg.eig(dynamics)
        participation = np.linalg.solve(vectors, force) * (tip @ vectors)
        return np.abs((participation / (1j * frequencies[:, None] - poles)).sum(axis=1))


def newmark_responses(
    blades: Sequence[ForcedBlade], load: float, duration: float, interval: float = THESIS_INTERVAL
) -> tuple[Array, Array]:
    """Times (K,) and tips (blades, K) as ``step_response`` has them, by Newmark's method on all trial functions.

    With the thesis' constants, a₃ and a₄ corrected. All blades have as many trial functions.
    """
    mass, damping, stiffness = (np.array(each) for each in zip(*(blade.full_matrices() for blade in blades), strict=True))
    forces = np.array([load * blade.force for blade in blades])
    steps = round(duration / interval)
    history = newmark(mass, damping, stiffness, lambda _: forces, interval, steps, THESIS_SCHEME)
    tips = [np.ascontiguousarray(history[:, k]) @ blade.tip for k, blade in enumerate(blades)]
    return np.linspace(0.0, duration, steps + 1), np.array(tips)


def free_motion(transition: Array, start: Array, samples: int) -> Array:
    """States (samples, n) from ``start`` (n,) on, each ``transition`` (n, n) times the one before.

    As many at a time as there are already, by the power of the transition that leads so far: within 10⁻¹² of one after another.
    """
    states = np.empty((samples, len(start)))
    states[0], power, known = start, transition.T, 1
    while known < samples:
        following = states[known : 2 * known]
        np.matmul(states[: len(following)], power, out=following)
        power, known = power @ power, 2 * known
    return states


def settling_time(times: Array, displacement: Array, final: float, band: float = 0.05) -> float:
    """When the response stays within ``band`` of its largest excursion from ``final`` for good, in s; or its duration."""
    excursion = np.abs(displacement - final)
    return float(times[min(int(settled_from(excursion, band * excursion.max())), len(times) - 1)])
