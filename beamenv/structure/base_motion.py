"""Inertia loads of the blade that rotates: centrifugal, and Euler's where the speed changes.

A point at (x, y, R₀ + z) has the acceleration −Ω²(x, 0, R₀ + z) + Ω̇(R₀ + z, 0, −x), so that by d'Alembert

    f = Ω² ∫∮ρ [Uᵀx + Wᵀ(R₀ + z)] ds dz − Ω̇ ∫∮ρ [Uᵀ(R₀ + z) − Wᵀx] ds dz

on the displacements U (lag) and W (span). On the blade in motion the same acceleration gives the Coriolis matrix Ω G₁ and, with
Ω̇, the circulatory matrix ½ Ω̇ G₁.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed
from beamenv.structure.assembly import generalised_displacements
from beamenv.structure.beam import RotatingBeam
from beamenv.structure.walls.wall_kinematics import DS, DTY, DU, DU1

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class BaseLoads(Sealed):
    """Generalised forces (N,) of the trial functions."""

    centrifugal: Array
    """Per Ω², (rad/s)²."""
    euler: Array
    """Per Ω̇, rad/s²."""


def base_loads(beam: RotatingBeam, speed: float = 0.0) -> BaseLoads:
    """The loads of a blade, from the section inertia that its mass matrix is made of; in the blade's model where it stands at a
    speed, rad/s.
    """
    if beam.model == "blade":
        return BaseLoads(*beam.exact.base_forces(beam.at(speed)))
    edges = [edge for inlay in beam.inlays for edge in (inlay.start, inlay.start + inlay.length)]
    stations = beam.space.stations(beam.breakpoints(edges), beam.stations_per_span)
    inertia = beam.walls_at(stations.z).inertia()
    rows = generalised_displacements(beam.space.evaluate(stations.z))
    arm = (beam.hub_radius + stations.z)[:, None]
    # W = … − xθy + n³(θy − u'): a turn of the section as a whole (θy = u') moves its points by −x alone
    along_x = -(inertia.lag_span[:, :, DTY] + inertia.lag_span[:, :, DU1])
    span_x = -(inertia.span_span[:, :, DTY] + inertia.span_span[:, :, DU1])
    centrifugal = along_x + arm * inertia.span_span[:, :, DS]
    euler = span_x - arm * inertia.lag_lag[:, :, DU]
    return BaseLoads(*(np.einsum("s,sin,si->n", stations.weight, rows, each) for each in (centrifugal, euler)))
