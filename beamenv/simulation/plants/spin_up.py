"""A rotor that runs up: Ω(t), the time-varying plant, and the vibration that the run-up itself excites.

    M q̈ + (Ω G₁ + C) q̇ + (K_e + Ω² K_Ω + ½ Ω̇ G₁) q = F u + P d + Ω² f_c + Ω̇ f_E

with Euler's force Ω̇ f_E and its circulatory matrix ½ Ω̇ G₁ (``beamenv.structure.base_motion``). Vibration is about the
equilibrium, as at constant speed; here the equilibrium moves. It is the smooth solution q_s(t) without control and load,

    K q_s = Ω² f_c + Ω̇ f_E − (Ω G₁ + C) q̇_s − M q̈_s,

and x is the state of q − q_s, which obeys the same equations without Ω² f_c and Ω̇ f_E. J, sensors (whose amplifiers do not pass
so slow a drift) and strain mean x, as at constant speed.

Speed follows a cycloid, Ω = Ω₀ + ΔΩ (τ − sin(2πτ)/2π) with τ = t/T: Ω̇ and Ω̈ are zero at both ends, but q_s is not at rest at
t = 0⁺, where the blade still stands in the static equilibrium of Ω₀. The difference is the vibration that the start excites: from
100 to 300 rad/s in 0.5 s it is about that of a sudden 56 N/m in lag.

The motion is expanded in the modes of the true plant at the configured speed, 200 rad/s. With eleven of them the frequencies of the
first six are 0.16 % too high at most at 100 and 300 rad/s, those of all eleven 0.6 %. The plant of an interval is that of the
speed at its middle, held over the interval; coordinates are energy coordinates at every instant.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.plant.plant import Plant
from beamenv.plant.read_only import sealed
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.plants.coordinates import coordinates, widened
from beamenv.structure.base_motion import base_loads

Array = NDArray[np.float64]

NODES = 20
"""Chebyshev nodes in time at which the moving equilibrium obeys the equation of motion: too few to follow vibration in 0.5 s, many
enough for residuals of 1e-7 between them."""


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


@dataclass(frozen=True, slots=True, eq=False)
class RunUp:
    """Modal matrices (r, r) and loads (r,) in one basis of unit modal mass, for every speed."""

    course: Cycloid
    elastic: Array
    spin: Array
    gyroscopic: Array
    damping: Array
    centrifugal: Array
    euler: Array

    @classmethod
    def of(cls, blade: Blade, course: Cycloid) -> RunUp:
        """In the modes of the configured speed, with their damping."""
        config, matrices, loads = blade.config, blade.beam.matrices, base_loads(blade.beam)
        modal = blade.true_modal
        shapes = modal.mode_shapes

        def reduced(matrix: Array) -> Array:
            return np.asarray(shapes.T @ matrix @ shapes)

        return cls(
            course=course,
            elastic=reduced(matrices.elastic_stiffness),
            spin=reduced(matrices.spin_stiffness),
            gyroscopic=reduced(matrices.gyroscopic) if config.gyroscopic else np.zeros_like(modal.gyroscopic),
            damping=np.diag(2.0 * config.damping_ratio * modal.natural_frequencies),
            centrifugal=shapes.T @ loads.centrifugal,
            euler=shapes.T @ loads.euler,
        )

    def stiffness(self, time: Array) -> Array:
        """K_e + Ω² K_Ω (…, r, r), the symmetric part: that of the energy."""
        return self.elastic + self.course.speed(time)[..., None, None] ** 2 * self.spin

    def restoring(self, time: Array) -> Array:
        """K_e + Ω² K_Ω + ½ Ω̇ G₁ (…, r, r)."""
        return self.stiffness(time) + 0.5 * self.course.acceleration(time)[..., None, None] * self.gyroscopic

    def rate_matrix(self, time: Array) -> Array:
        """Ω G₁ + C (…, r, r)."""
        return self.course.speed(time)[..., None, None] * self.gyroscopic + self.damping

    def base_load(self, time: Array) -> Array:
        """Ω² f_c + Ω̇ f_E (…, r)."""
        speed, acceleration = self.course.speed(time)[..., None], self.course.acceleration(time)[..., None]
        return np.asarray(speed**2 * self.centrifugal + acceleration * self.euler)

    def equilibrium(self) -> tuple[Array, Array]:
        """Chebyshev coefficients (NODES, r) over [0, T] of q_s and of its rate, by collocation.

        In run-ups of a few periods, which are too quick for one smooth motion to stand out, it is the least solution found. Any
        would do: what the blade does, q_s + vibration, is the same.
        """
        rate = 2.0 / self.course.duration
        nodes = (1.0 + chebyshev.chebpts1(NODES)) / rate
        identity = np.eye(NODES)
        position, velocity, acceleration = (
            chebyshev.chebval(rate * nodes - 1.0, rate**order * chebyshev.chebder(identity, order)).T for order in range(3)
        )
        r = len(self.elastic)
        equations = np.einsum("kn,ij->kinj", acceleration, np.eye(r))
        equations += np.einsum("kn,kij->kinj", velocity, self.rate_matrix(nodes))
        equations += np.einsum("kn,kij->kinj", position, self.restoring(nodes))
        solved = np.linalg.lstsq(equations.reshape(NODES * r, -1), self.base_load(nodes).ravel())[0]
        coefficients = solved.reshape(NODES, r)
        return coefficients, np.vstack([rate * chebyshev.chebder(coefficients, axis=0), np.zeros((1, r))])

    def departure(self, time: Array) -> Array:
        """η_s (K, r) at times (K,) less the static equilibrium of the speed then: what Euler's force and the change of speed do."""
        static = np.linalg.solve(self.stiffness(time), (self.course.speed(time)[:, None] ** 2 * self.centrifugal)[..., None])
        return np.asarray(chebyshev.chebval(2.0 * time / self.course.duration - 1.0, self.equilibrium()[0]).T - static[..., 0])

    def initial_vibration(self) -> tuple[Array, Array]:
        """η and η̇ (r,) at t = 0: the static equilibrium of the first speed less the moving one."""
        start = np.zeros(())
        at_rest = np.linalg.solve(self.stiffness(start), self.course.first**2 * self.centrifugal)
        displaced, moving = (chebyshev.chebval(-1.0, part) for part in self.equilibrium())
        return at_rest - displaced, -np.asarray(moving)


def spin_up_bank(blade: Blade, design: Blade, speeds: tuple[float, float], steps: int) -> Bank:
    """One plant for each of ``steps`` control intervals; ``ValueError`` past the critical speed."""
    critical = blade.beam.critical_speed
    if max(speeds) >= critical:
        raise ValueError(f"scenario: plants.spin_up is {list(speeds)}, but must be below the critical speed, {critical:.6g} rad/s.")
    reference, interval = blade.truth, blade.config.control_interval
    run_up = RunUp.of(blade, Cycloid(*speeds, steps * interval))
    edges: Array = interval * np.arange(steps + 1, dtype=np.float64)
    middles: Array = edges[:-1] + 0.5 * interval
    roots = _root(run_up.stiffness(edges))  # K = U Uᵀ, x = [Uᵀη; η̇]
    mid_roots = _root(run_up.stiffness(middles))
    plants = [plant_at(reference, run_up, time, root) for time, root in zip(middles, mid_roots, strict=True)]
    bank = Bank.gather(reference, plants, run_up.course.speed(middles), None)
    n = len(reference.A)
    incoming, outgoing = _changes(roots[:-1], mid_roots, n), _changes(mid_roots, roots[1:], n)
    back = incoming.swapaxes(1, 2)
    return replace(
        bank,
        operators=replace(bank.operators, fused=sealed(_at_instants(bank.operators.fused, incoming, outgoing))),
        readout=sealed(back @ bank.readout),
        tip=sealed(back @ bank.tip),
        strain=sealed(bank.strain @ incoming),
        release=np.asarray(np.linalg.solve(incoming, bank.release.swapaxes(1, 2)), dtype=np.float64).swapaxes(1, 2),
        start=_initial_state(run_up, roots[0], n)[None],
        runs=True,
        to_design=_views(blade, design, roots[:-1], n),
    ).in_cost_axes()


def _root(stiffness: Array) -> Array:
    return np.asarray(np.linalg.cholesky(stiffness), dtype=np.float64)


def plant_at(reference: Plant, run_up: RunUp, time: float, root: Array) -> Plant:
    """The plant at one time in energy coordinates [Uᵀη; η̇], U = ``root``; the electronics are those of any time."""
    r, b = len(root), 2 * len(root)
    at = np.asarray(time)
    inverse = np.linalg.inv(root)
    to_reference = np.eye(len(reference.A))  # energy coordinates of the configured speed from those of this one
    to_reference[:r, :r] = reference.natural_frequencies[:, None] * inverse.T
    dynamics = reference.A @ to_reference
    dynamics[:b, :b] = 0.0
    dynamics[:r, r:b] = root.T
    dynamics[r:b, :r], dynamics[r:b, r:b] = -run_up.restoring(at) @ inverse.T, -run_up.rate_matrix(at)
    return replace(
        reference,
        A=sealed(dynamics),
        tip_displacement=sealed(reference.tip_displacement @ to_reference),
        strain=sealed(reference.strain @ to_reference),
        C=sealed(reference.C @ to_reference),
    )


def _changes(before: Array, after: Array, states: int) -> Array:
    """(K, n, n): energy coordinates of one root from those of another, x' = T x."""
    r = before.shape[-1]
    change = np.tile(np.eye(states), (len(before), 1, 1))
    change[:, :r, :r] = after.swapaxes(1, 2) @ np.linalg.inv(before).swapaxes(1, 2)
    return change


def _at_instants(fused: Array, incoming: Array, outgoing: Array) -> Array:
    """Operators (K, s, …) from the energy coordinates at each interval's begin to those at its end, from those in its middle."""
    n, size = incoming.shape[-1], fused.shape[1]
    joined = np.tile(np.eye(size), (len(fused), 1, 1))
    joined[:, :n, :n] = incoming
    moved = joined.swapaxes(1, 2) @ fused
    moved[..., :n] = moved[..., :n] @ outgoing.swapaxes(1, 2)
    moved[..., -size:] = moved[..., -size:] @ joined  # the cost
    return np.asarray(moved)


def _initial_state(run_up: RunUp, root: Array, states: int) -> Array:
    displaced, moving = run_up.initial_vibration()
    return np.concatenate([root.T @ displaced, moving, np.zeros(states - 2 * len(root))])


def _views(blade: Blade, design: Blade, roots: Array, states: int) -> Array | None:
    """(K, n, d): states at the begin of each interval in the design blade's coordinates."""
    if blade.beam.space != design.beam.space:
        return None
    shapes = blade.true_modal.mode_shapes
    return widened(np.stack([coordinates(shapes @ np.linalg.inv(root).T, shapes, design) for root in roots]), states)
