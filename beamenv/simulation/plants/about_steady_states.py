"""A spin-up in the blade's model: about the steady state of the speed that it has now (see ``spin_up``)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.patches import actuation, sensing
from beamenv.plant.reduction import surface_strain
from beamenv.simulation.plants.spin_up import Cycloid, SpinUp
from beamenv.structure.base_motion import base_loads
from beamenv.structure.geometrically_exact.operating_point import OperatingPoint
from beamenv.structure.geometrically_exact.sections_along import between

Array = NDArray[np.float64]

STEADY_STATES = 8
"""Speeds at which steady states are worked out."""


@dataclass(frozen=True, eq=False)
class AboutSteadyStates(SpinUp):
    """In the blade's model: what the blade has at n squared speeds, leading axis."""

    squares: Array
    """s (n,)."""
    modes: Array
    """Ψ (n, N, r)."""
    stiffnesses: Array
    couplings: Array
    """(n, r, r)."""
    euler: Array
    """Ψᵀ f_E (n, r)."""
    momentum: Array
    """Ψᵀ M w (n, r)."""
    momentum_slope: Array
    """Ψᵀ M w′ (n, r)."""
    turning: Array
    """Ψᵀ G₁ w (n, r)."""
    forces: Array
    charges: Array
    strains: Array
    """Ψᵀ F (n, r, m), C_s Ψ (n, p, r), (n, k, r)."""
    sensed: Array | None
    """(n, 5, p, r) of listed sensors: what they show of η, of η̇ at no speed, of η̈, of η̇ per Ω and of η per Ω̇."""

    @classmethod
    def of(cls, blade: Blade, course: Cycloid) -> AboutSteadyStates:
        """From the blade's steady states between first and last speed."""
        config, beam, layout = blade.config, blade.beam, blade.config.patches
        modal, squares = blade.true_modal, _squares(course)
        rows: dict[str, list[Array]] = {}
        sweeps, masses, sensed = [], [], []
        for square in squares.tolist():
            speed = float(np.sqrt(square))
            point, loads = beam.at(speed), base_loads(beam, speed)
            coupling = (point.gyroscopic / speed if speed else beam.matrices.gyroscopic) * config.gyroscopic
            sweep, shapes = beam.exact.steady_state_slope(point), _carried(modal.mode_shapes, modal.natural_frequencies, point)
            for name, value in (
                ("modes", shapes),
                ("stiffnesses", shapes.T @ point.stiffness @ shapes),
                ("couplings", shapes.T @ coupling @ shapes),
                ("euler", shapes.T @ loads.euler),
                ("momentum", shapes.T @ point.mass @ sweep),
                ("turning", shapes.T @ coupling @ sweep),
                ("forces", shapes.T @ actuation(beam, layout, speed)),
                ("charges", sensing(beam, layout, speed) @ shapes),
                ("strains", surface_strain(beam, speed) @ shapes),
            ):
                rows.setdefault(name, []).append(value)
            if config.sensors:
                sensed.append(_sensed(blade, speed) @ shapes)
            sweeps.append(sweep)
            masses.append(shapes.T @ point.mass)
        slopes = _derivative(squares) @ np.array(sweeps)
        rows["momentum_slope"] = list(np.einsum("nrN,nN->nr", np.array(masses), slopes))
        damping = np.diag(2.0 * config.damping_ratio * modal.natural_frequencies)
        known = {name: np.array(value) for name, value in rows.items()}
        return cls(course=course, damping=damping, squares=squares, sensed=np.array(sensed) if sensed else None, **known)

    def _at(self, values: Array, time: Array) -> Array:
        """Values (n, …) at times (…)."""
        weights = between(self.squares, self.course.speed(np.atleast_1d(time)) ** 2)
        found = np.tensordot(weights, values, 1)
        return found if time.ndim else found[0]

    def stiffness(self, time: Array) -> Array:
        """About the steady state then."""
        return self._at(self.stiffnesses, time)

    def coupling(self, time: Array) -> Array:
        """About the steady state then."""
        return self._at(self.couplings, time)

    def base_load(self, time: Array) -> Array:
        """Ω̇ f_E − M (w s̈ + w′ ṡ²) − (Ω G₁ + C) w ṡ."""
        speed, acceleration = self.course.speed(time)[..., None], self.course.acceleration(time)[..., None]
        rate = 2.0 * speed * acceleration
        second = 2.0 * acceleration**2 + 2.0 * speed * self.course.jerk(time)[..., None]
        inertia = self._at(self.momentum, time) * second + self._at(self.momentum_slope, time) * rate**2
        carried = (speed * self._at(self.turning, time) + self._at(self.momentum, time) @ self.damping) * rate
        return np.asarray(acceleration * self._at(self.euler, time) - inertia - carried)

    def at_rest(self, time: Array) -> Array:
        """Zero: motion is about it."""
        return np.zeros((*time.shape, len(self.damping)))

    def shapes(self, time: Array) -> Array:
        """Carried to the speed then."""
        return self._at(self.modes, time)

    def patches(self, time: Array) -> tuple[Array, Array, Array]:
        """About the steady state then."""
        return self._at(self.forces, time), self._at(self.charges, time), self._at(self.strains, time)

    def readings(self, time: Array) -> tuple[Array, Array, Array] | None:
        """About the steady state then; accelerometers feel Coriolis' acceleration of the speed and Euler's of its change."""
        if self.sensed is None:
            return None
        position, rate, acceleration, coriolis, euler = np.moveaxis(self._at(self.sensed, time), -3, 0)
        speed, change = self.course.speed(time)[..., None, None], self.course.acceleration(time)[..., None, None]
        return position + change * euler, rate + speed * coriolis, acceleration


def _sensed(blade: Blade, speed: float) -> Array:
    """(5, p, N): rows of listed sensors about the steady state at a speed, rad/s."""
    rows = blade.changed(replace(blade.config, speed=speed)).sensor_rows
    assert rows is not None
    return np.stack([rows.position, rows.rate - speed * rows.coriolis, rows.acceleration, rows.coriolis, rows.euler])


def _carried(shapes: Array, frequencies: Array, point: OperatingPoint) -> Array:
    """Ψ (N, r) of a steady state, ΨᵀMΨ = 1, from modes of another."""
    moved = np.linalg.solve(point.stiffness, point.mass @ shapes * frequencies**2)
    root = np.linalg.cholesky(moved.T @ point.mass @ moved)
    orthonormal = np.linalg.solve(root, moved.T).T
    left, _, right = np.linalg.svd(orthonormal.T @ point.mass @ shapes)
    return np.asarray(orthonormal @ (left @ right))


def _squares(course: Cycloid) -> Array:
    """Chebyshev points (n,) between the squares of first and last speed; one where these are the same."""
    low, high = sorted((course.first**2, course.last**2))
    if low == high:
        return np.array([low])
    return np.asarray(0.5 * (low + high) + 0.5 * (high - low) * chebyshev.chebpts1(STEADY_STATES))


def _derivative(nodes: Array) -> Array:
    """(n, n): derivatives at n nodes of the polynomial through values there."""
    if len(nodes) == 1:
        return np.zeros((1, 1))
    apart = nodes[:, None] - nodes + np.eye(len(nodes))
    weight = 1.0 / apart.prod(axis=1)
    matrix = weight / weight[:, None] / apart
    matrix[np.diag_indices_from(matrix)] = 0.0
    return matrix - np.diag(matrix.sum(axis=1))
