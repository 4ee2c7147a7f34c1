"""A spin-up in the thesis' model, which knows no steady state: about the blade at rest (see ``spin_up``)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.simulation.plants.spin_up import Cycloid, SpinUp
from beamenv.structure.base_motion import base_loads

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class AboutRest(SpinUp):
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

    def readings(self, time: Array) -> None:
        """None: the thesis' model reads currents alone."""
        return
