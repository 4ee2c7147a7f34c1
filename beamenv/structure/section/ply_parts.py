"""What a ply adds to a section of solid elements: one stiffness, or as many as change each in its own way with the depth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.section.elements import ACROSS
from beamenv.structure.section.integrals import Rule
from beamenv.structure.walls.depth_rules import gauss_rule_of_weight, interpolating_rule
from beamenv.structure.walls.graded import FunctionallyGraded, mixture_through
from beamenv.structure.walls.laminate import Ply
from beamenv.structure.walls.materials import Lamina, wall_stiffness

Array = NDArray[np.float64]

DILATATION = np.zeros((6, 6))
"""Stress of (ε_ss, ε_nn, γ_sn, γ_sz, γ_nz, ε_zz) per bulk modulus: ε_ss + ε_nn + ε_zz in all three directions."""
DILATATION[np.ix_([0, 1, 5], [0, 1, 5])] = 1.0

DISTORTION = np.diag([2.0, 2.0, 1.0, 1.0, 1.0, 2.0]) - 2.0 / 3.0 * DILATATION
"""The same per shear modulus."""


@dataclass(frozen=True, slots=True, eq=False)
class PlyPart:
    """A stiffness and a density that are integrated alike through a layer."""

    stiffness: Array | None
    """(6, 6), Pa, or as much of it as ``rule`` does not weigh, for (ε_ss, ε_nn, γ_sn, γ_sz, γ_nz, ε_zz)."""
    density: float
    """kg/m³."""
    rule: Rule | None = None
    """None: Gauss's."""


def parts_of(ply: Ply) -> list[PlyPart]:
    """One part of a ply that is the same through its thickness; of a graded one those of bulk and shear modulus and of density.

    Each of these three is integrated by Gauss's own rule for it, which is as exact as the usual one is where nothing changes.
    """
    if ply.uniform is not None:
        return [PlyPart(wall_stiffness(ply.uniform, np.radians(ply.angle_deg)), ply.uniform.density)]
    assert isinstance(ply.material, FunctionallyGraded)
    rule, mixture = mixture_through(ply.material)

    def weighed(values: Array) -> Rule:
        return _as_rule(*gauss_rule_of_weight(rule.place, rule.weight * values, ACROSS + 1))

    return [
        PlyPart(DILATATION, 0.0, weighed(mixture.bulk)),
        PlyPart(DISTORTION, 0.0, weighed(mixture.shear)),
        PlyPart(None, 1.0, weighed(mixture.density)),
    ]


def thermal_stress(ply: Ply) -> tuple[Array, Rule | None]:
    """Q α (6,), Pa/K, for a wall's strains (ε_ss, ε_nn, γ_sn, γ_sz, γ_nz, ε_zz): what holds a ply that is 1 K warmer; or its
    direction and the rule that weighs it with 3 K α, which may change its sign within a graded ply.
    """
    if ply.uniform is not None:
        return _held(ply.uniform, float(np.radians(ply.angle_deg))), None
    assert isinstance(ply.material, FunctionallyGraded)
    rule, mixture = mixture_through(ply.material)
    alpha = mixture.alpha if mixture.alpha is not None else [each.expansion for each in ply.material.constituents]
    return DILATATION[0], _as_rule(*interpolating_rule(rule.place, rule.weight * 3.0 * mixture.bulk * alpha, 2 * ACROSS + 2))


def _held(material: Lamina, angle: float) -> Array:
    along, across = material.expansion
    c, s = np.cos(angle), np.sin(angle)
    strain = np.array(
        [c * c * along + s * s * across, across, 0.0, 2.0 * c * s * (along - across), 0.0, s * s * along + c * c * across]
    )
    return np.asarray(wall_stiffness(material, angle) @ strain)


def _as_rule(places: Array, weights: Array) -> Rule:
    return tuple(places.tolist()), tuple(weights.tolist())
