"""A rotor that runs up: Ω(t), the equation of motion about an equilibrium that moves, and that equilibrium.

The blade vibrates about the steady state of the speed it has now, q̄(Ω). With ξ the displacements and spins by which it differs,
the energies of a blade that turns at Ω(t) give to first order in ξ and Ω̇

    M ξ̈ + (Ω G₁ + C) ξ̇ + (K + ½ Ω̇ G₁) ξ = F u + P d + Ω̇ f_E − M a − (Ω G₁ + C) v,        v = w ṡ,   a = w s̈ + w′ ṡ²

with M, G₁, K, F and Euler's force f_E about q̄ (``RotatingBeam.at``), and s = Ω². Forces in q̄ balance at every speed, so that what
is left of the inertia is that of q̄ itself, which moves: K w = f_c, the steady state's change with s, and w′ = dw/ds. ½ Ω̇ G₁ is the
circulatory matrix of Euler's acceleration Ω̇ ŷ × p, as Ω G₁ is Coriolis' of 2 Ω ŷ × ṗ. Everything is a smooth function of s: it is
worked out at few speeds and interpolated. ξ = Ψ(s) η, with the modes Ψ₀ of the true plant at the configured speed carried to others
by one step of inverse iteration, K⁻¹MΨ₀, so that a line which is bent otherwise is still not stretched; ΨᵀMΨ = 1, as near to Ψ₀ as
that allows. Damping C = 2ζω₀ acts in these coordinates. Left out are Ψ′ṡ beside η̇, stresses that Euler's force raises, of 2 % of
the centrifugal ones in the default run-up (Ω̇/Ω²), and with the square of Ω̇ the turning of the sections' axes. The higher modes
take part in q̄, but not in ξ. Beside the whole non-linear blade integrated in time, from 100 to 130 rad/s in 0.1 s, the tip moves
alike within 0.1 % in lag and 3 % of a ten times smaller motion in flap.

In the thesis' model, which knows no steady state, displacements q are the blade's own,

    M q̈ + (Ω G₁ + C) q̇ + (K_e + Ω² K_Ω + ½ Ω̇ G₁) q = F u + P d + Ω² f_c + Ω̇ f_E,

and the static equilibrium K⁻¹ Ω² f_c of the retained modes stands for q̄. Either way the smooth solution without control and load is
the moving equilibrium ξ_s or q_s, and vibration is about it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.patches import actuation, sensing
from beamenv.plant.reduction import surface_strain
from beamenv.structure.base_motion import base_loads
from beamenv.structure.geometrically_exact.operating_point import OperatingPoint
from beamenv.structure.geometrically_exact.sections_along import between

Array = NDArray[np.float64]

NODES = 20
"""Chebyshev nodes in time at which the moving equilibrium obeys the equation of motion: too few to follow vibration in 0.5 s, many
enough for residuals of 1e-5 between them (1e-7 in the thesis' model)."""

STEADY_STATES = 8
"""Speeds at which steady states are worked out."""


@dataclass(frozen=True, slots=True)
class Cycloid:
    """Ω(t) from one speed to another within ``duration`` s."""

    first: float
    last: float
    duration: float

    def speed(self, time: Array) -> Array:
        """Ω, rad/s."""
        share = time / self.duration
        return self.first + (self.last - self.first) * (share - np.sin(2.0 * np.pi * share) / (2.0 * np.pi))

    def acceleration(self, time: Array) -> Array:
        """Ω̇, rad/s²."""
        share = time / self.duration
        return (self.last - self.first) / self.duration * (1.0 - np.cos(2.0 * np.pi * share))

    def jerk(self, time: Array) -> Array:
        """Ω̈, rad/s³."""
        share = time / self.duration
        return (self.last - self.first) / self.duration**2 * 2.0 * np.pi * np.sin(2.0 * np.pi * share)


@dataclass(frozen=True, eq=False)
class RunUp(ABC):
    """Modal matrices (r, r) and loads (r,) in one basis, that of the true plant at the configured speed, at any time."""

    course: Cycloid
    damping: Array
    """C (r, r), 1/s."""

    @staticmethod
    def of(blade: Blade, course: Cycloid) -> RunUp:
        """In the modes of the configured speed, with their damping; ``ValueError`` past the critical speed."""
        critical, speeds = blade.beam.critical_speed, [course.first, course.last]
        if max(speeds) >= critical:
            raise ValueError(f"scenario: plants.spin_up is {speeds}, but must be below the critical speed, {critical:.6g} rad/s.")
        return (AboutRest if blade.config.model == "thesis" else AboutSteadyStates).of(blade, course)

    @abstractmethod
    def stiffness(self, time: Array) -> Array:
        """K (…, r, r), symmetric: that of the energy."""

    @abstractmethod
    def coupling(self, time: Array) -> Array:
        """G₁ (…, r, r), skew."""

    @abstractmethod
    def base_load(self, time: Array) -> Array:
        """What moves the equilibrium (…, r)."""

    @abstractmethod
    def at_rest(self, time: Array) -> Array:
        """η (…, r) of the steady state of the speed then."""

    @abstractmethod
    def shapes(self, time: Array) -> Array:
        """Ψ (…, N, r)."""

    @abstractmethod
    def patches(self, time: Array) -> tuple[Array, Array, Array] | None:
        """F (…, r, m), C_s (…, p, r) and strains (…, k, r) at times; None where the speed does not change them, nor Ψ."""

    def restoring(self, time: Array) -> Array:
        """K + ½ Ω̇ G₁ (…, r, r)."""
        return self.stiffness(time) + 0.5 * self.course.acceleration(time)[..., None, None] * self.coupling(time)

    def rate_matrix(self, time: Array) -> Array:
        """Ω G₁ + C (…, r, r)."""
        return self.course.speed(time)[..., None, None] * self.coupling(time) + self.damping

    def equilibrium(self) -> tuple[Array, Array]:
        """Chebyshev coefficients (NODES, r) over [0, T] of the moving equilibrium and of its rate, by collocation.

        In run-ups of a few periods, which are too quick for one smooth motion to stand out, it is the least solution found. Any
        would do: what the blade does, equilibrium + vibration, is the same.
        """
        rate = 2.0 / self.course.duration
        nodes = (1.0 + chebyshev.chebpts1(NODES)) / rate
        identity = np.eye(NODES)
        position, velocity, acceleration = (
            chebyshev.chebval(rate * nodes - 1.0, rate**order * chebyshev.chebder(identity, order)).T for order in range(3)
        )
        r = len(self.damping)
        equations = np.einsum("kn,ij->kinj", acceleration, np.eye(r))
        equations += np.einsum("kn,kij->kinj", velocity, self.rate_matrix(nodes))
        equations += np.einsum("kn,kij->kinj", position, self.restoring(nodes))
        solved = np.linalg.lstsq(equations.reshape(NODES * r, -1), self.base_load(nodes).ravel())[0]
        coefficients = solved.reshape(NODES, r)
        return coefficients, np.vstack([rate * chebyshev.chebder(coefficients, axis=0), np.zeros((1, r))])

    def departure(self, time: Array) -> Array:
        """η (K, r) of the moving equilibrium at times (K,) less the steady state of the speed then: what Euler's force and the
        change of speed do.
        """
        moving = chebyshev.chebval(2.0 * time / self.course.duration - 1.0, self.equilibrium()[0]).T
        return np.asarray(moving - self.at_rest(time))

    def initial_vibration(self) -> tuple[Array, Array]:
        """η and η̇ (r,) at t = 0: the steady state of the first speed less the moving equilibrium."""
        displaced, moving = (chebyshev.chebval(-1.0, part) for part in self.equilibrium())
        return self.at_rest(np.zeros(())) - displaced, -np.asarray(moving)


@dataclass(frozen=True, eq=False)
class AboutRest(RunUp):
    """In the thesis' model."""

    elastic: Array
    spin: Array
    gyroscopic: Array
    centrifugal: Array
    euler: Array
    modes: Array
    """Ψ (N, r)."""

    @classmethod
    def of(cls, blade: Blade, course: Cycloid) -> AboutRest:
        """From the matrices that are good at any speed."""
        config, matrices, loads = blade.config, blade.beam.matrices, base_loads(blade.beam)
        modal = blade.true_modal
        shapes = modal.mode_shapes

        def reduced(matrix: Array) -> Array:
            return np.asarray(shapes.T @ matrix @ shapes)

        return cls(
            course=course,
            damping=np.diag(2.0 * config.damping_ratio * modal.natural_frequencies),
            elastic=reduced(matrices.elastic_stiffness),
            spin=reduced(matrices.spin_stiffness),
            gyroscopic=reduced(matrices.gyroscopic) if config.gyroscopic else np.zeros_like(modal.gyroscopic),
            centrifugal=shapes.T @ loads.centrifugal,
            euler=shapes.T @ loads.euler,
            modes=shapes,
        )

    def stiffness(self, time: Array) -> Array:
        """K_e + Ω² K_Ω."""
        return self.elastic + self.course.speed(time)[..., None, None] ** 2 * self.spin

    def coupling(self, time: Array) -> Array:
        """The same at any speed."""
        return np.broadcast_to(self.gyroscopic, (*time.shape, *self.gyroscopic.shape))

    def base_load(self, time: Array) -> Array:
        """Ω² f_c + Ω̇ f_E."""
        speed, acceleration = self.course.speed(time)[..., None], self.course.acceleration(time)[..., None]
        return np.asarray(speed**2 * self.centrifugal + acceleration * self.euler)

    def at_rest(self, time: Array) -> Array:
        """K⁻¹ Ω² f_c."""
        load = self.course.speed(time)[..., None] ** 2 * self.centrifugal
        return np.asarray(np.linalg.solve(self.stiffness(time), load[..., None])[..., 0])

    def shapes(self, time: Array) -> Array:
        """The same at any speed."""
        return np.broadcast_to(self.modes, (*time.shape, *self.modes.shape))

    def patches(self, time: Array) -> None:
        """The same at any speed."""
        return


@dataclass(frozen=True, eq=False)
class AboutSteadyStates(RunUp):
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

    @classmethod
    def of(cls, blade: Blade, course: Cycloid) -> AboutSteadyStates:
        """From the blade's steady states between first and last speed."""
        config, beam, layout = blade.config, blade.beam, blade.config.patches
        modal, squares = blade.true_modal, _squares(course)
        rows: dict[str, list[Array]] = {}
        sweeps, masses = [], []
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
            sweeps.append(sweep)
            masses.append(shapes.T @ point.mass)
        slopes = _derivative(squares) @ np.array(sweeps)
        rows["momentum_slope"] = list(np.einsum("nrN,nN->nr", np.array(masses), slopes))
        damping = np.diag(2.0 * config.damping_ratio * modal.natural_frequencies)
        return cls(course=course, damping=damping, squares=squares, **{name: np.array(value) for name, value in rows.items()})

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
