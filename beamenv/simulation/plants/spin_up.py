"""A rotor that spins up: Ω(t), the equation of motion about an equilibrium that moves, and that equilibrium.

The blade vibrates about the steady state of the speed it has now, q̄(Ω). With ξ the displacements and spins by which it differs,
the energies of a blade that turns at Ω(t) give to first order in ξ and Ω̇

    M ξ̈ + (Ω G₁ + C) ξ̇ + (K + ½ Ω̇ G₁) ξ = F u + P d + Ω̇ f_E − M a − (Ω G₁ + C) v,        v = w ṡ,   a = w s̈ + w′ ṡ²

with M, G₁, K, F and Euler's force f_E about q̄ (``RotatingBeam.at``), and s = Ω². Forces in q̄ balance at every speed, so that what
is left of the inertia is that of q̄ itself, which moves: K w = f_c, the steady state's change with s, and w′ = dw/ds. ½ Ω̇ G₁ is the
circulatory matrix of Euler's acceleration Ω̇ ŷ × p, as Ω G₁ is Coriolis' of 2 Ω ŷ × ṗ. Everything is a smooth function of s: it is
worked out at few speeds and interpolated. ξ = Ψ(s) η, with the modes Ψ₀ of the true plant at the configured speed carried to others
by one step of inverse iteration, K⁻¹MΨ₀, so that a line which is bent otherwise is still not stretched; ΨᵀMΨ = 1, as near to Ψ₀ as
that allows. Damping C = 2ζω₀ acts in these coordinates. Left out are Ψ′ṡ beside η̇, stresses that Euler's force raises, of 2 % of
the centrifugal ones in the default spin-up (Ω̇/Ω²), and with the square of Ω̇ the turning of the sections' axes. The higher modes
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

Array = NDArray[np.float64]

NODES = 20
"""Chebyshev nodes in time at which the moving equilibrium obeys the equation of motion: too few to follow vibration in 0.5 s, many
enough for residuals of 1e-5 between them (1e-7 in the thesis' model)."""


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
class SpinUp(ABC):
    """Modal matrices (r, r) and loads (r,) in one basis, that of the true plant at the configured speed, at any time."""

    course: Cycloid
    damping: Array
    """C (r, r), 1/s."""

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

    @abstractmethod
    def readings(self, time: Array) -> tuple[Array, Array, Array] | None:
        """R, S, T (…, p, r) of listed sensors, y = R η + S η̇ + T η̈; None where the currents of all patches are read."""

    def restoring(self, time: Array) -> Array:
        """K + ½ Ω̇ G₁ (…, r, r)."""
        return self.stiffness(time) + 0.5 * self.course.acceleration(time)[..., None, None] * self.coupling(time)

    def rate_matrix(self, time: Array) -> Array:
        """Ω G₁ + C (…, r, r)."""
        return self.course.speed(time)[..., None, None] * self.coupling(time) + self.damping

    def equilibrium(self) -> tuple[Array, Array]:
        """Chebyshev coefficients (NODES, r) over [0, T] of the moving equilibrium and of its rate, by collocation.

        In spin-ups of a few periods, which are too quick for one smooth motion to stand out, it is the least solution found. Any
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
