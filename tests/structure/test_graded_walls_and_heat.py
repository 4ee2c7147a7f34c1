"""Graded walls that are heated: against moments by hand, and against the same walls in uniform layers."""

import numpy as np
import pytest

from beamenv.structure import BoxSection, FunctionallyGraded, Lamina, Laminate, Layup, Ply, RotatingBeam, StripSection
from beamenv.structure.section.section import mesh_of
from beamenv.structure.section.solid_sections import SolidSections
from beamenv.structure.walls.graded import SCHEMES
from beamenv.structure.walls.named import SILICON_NITRIDE, SUS304

NU, H = 0.3, 0.01
SOFT, STIFF = Lamina.isotropic(70e9, NU, 2700.0, 23e-6), Lamina.isotropic(380e9, NU, 3960.0, 7e-6)
BOX = BoxSection(0.254, 0.0508, 0.01016)


def graded(exponent, inner=SOFT, outer=STIFF, scheme="voigt"):
    return FunctionallyGraded(inner, outer, exponent, scheme)


def layup_of(exponent, **of):
    return Layup.uniform(graded(exponent, **of), [0.0])


def test_temperature_acts_on_both_materials():
    hot = FunctionallyGraded("sus304", "silicon-nitride", 1.0).at(600.0)
    assert hot.constituents == (SUS304.at(600.0), SILICON_NITRIDE.at(600.0))
    assert graded(1.0).at(600.0) == graded(1.0)
    plain = graded(2.0)
    assert plain.at(500.0) is plain
    with pytest.raises(ValueError, match=r"^temperature is 200.0, but must be a number from 300 to 1000 \(K\)"):
        Layup.uniform(FunctionallyGraded("sus304", STIFF, 1.0), [0.0]).at(200.0)


def test_heat_bends_a_graded_strip_as_its_moments_say():
    """E and α linear through the thickness, one ν: σ = E (ε + κ n − α) alone, without resultants; exact whatever the width."""
    n = np.polynomial.legendre.leggauss(8)
    depth, weight = 0.5 * H * n[0], 0.5 * H * n[1]
    share = depth / H + 0.5
    E = SOFT.E1 + (STIFF.E1 - SOFT.E1) * share
    alpha = SOFT.alpha1 + (STIFF.alpha1 - SOFT.alpha1) * share
    A, B, D = (weight @ (E * depth**k) for k in range(3))
    strain, curvature = np.linalg.solve([[A, B], [B, D]], [weight @ (E * alpha), weight @ (E * alpha * depth)])
    strip = StripSection(0.03, H)
    mesh = mesh_of(strip, (1.0,), (), (True,))
    laminate = Laminate.equal_plies((Ply(graded(1.0), 0.0),), H)
    built = SolidSections.build(mesh, [laminate], np.zeros((1, len(mesh.edges)), dtype=int), 0.0, heated=True)
    found = built.expansion.strain[0, :, 0]
    assert found[2] == pytest.approx(strain, rel=1e-9)
    assert abs(found[3]) == pytest.approx(abs(curvature), rel=1e-9)


def test_heated_blade_of_a_pair_strains_by_what_its_materials_are_there():
    """At the infinite exponent as the inner material alone, to the last bit; graded, in between."""

    def stretch(layup):
        beam = RotatingBeam(BOX, layup, 2.0, temperature=500.0, reference_temperature=300.0)
        return float((beam.displacements(beam.length)["s"] @ beam.at(0.0).steady.coefficients)[0])

    steel, ceramic = (stretch(Layup.uniform(each, [0.0])) for each in (SUS304, SILICON_NITRIDE))
    assert stretch(layup_of(1e6, inner="sus304", outer="silicon-nitride")) == steel
    assert ceramic < stretch(layup_of(1.0, inner="sus304", outer="silicon-nitride")) < steel
    with pytest.raises(ValueError, match=r"alpha1 is None, but must be a number \(1/K\) where temperature strains the blade"):
        stretch(layup_of(1.0, inner=Lamina.isotropic(7e10, 0.3, 2700.0)))


def in_layers(material, count):
    """The wall as uniform plies, each of the mixture at its middle."""
    mixture = material.mixture(((np.arange(count) + 0.5) / count) ** material.exponent)
    columns = (mixture.E, mixture.nu, mixture.density, mixture.alpha)
    return Layup(tuple(Ply(Lamina.isotropic(*map(float, row)), 0.0) for row in zip(*columns, strict=True)))


@pytest.mark.parametrize("scheme", SCHEMES)
def test_uniform_layers_approach_the_graded_wall_with_the_square_of_their_number(scheme):
    """All of a strip's 6 × 6 stiffness, with moduli and Poisson's ratio that change: 10⁻⁴ from 48 layers to the graded wall."""
    material, strip = graded(2.0, SUS304, SILICON_NITRIDE, scheme), StripSection(0.05, H)
    exact = strip.properties(Layup.uniform(material, [0.0])).stiffness
    scale = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
    off = [np.abs((strip.properties(in_layers(material, n)).stiffness - exact) / scale).max() for n in (24, 48)]
    assert off[1] < 1.1e-4
    assert off[0] / off[1] == pytest.approx(4.0, rel=0.01)


def test_uniform_layers_expand_as_the_graded_wall():
    material = graded(2.0, SUS304, SILICON_NITRIDE, "mori-tanaka")

    def curvature_and_strain(layup):
        strip = StripSection(0.05, H)
        mesh, plies = mesh_of(strip, (1.0,), (), (True,)), layup.plies("strip")
        which = np.zeros((1, len(mesh.edges)), dtype=int)
        built = SolidSections.build(mesh, [Laminate.equal_plies(plies, H)], which, 0.0, heated=True)
        return built.expansion.strain[0, [2, 3], 0]

    exact = curvature_and_strain(Layup.uniform(material, [0.0]))
    off = [np.abs(curvature_and_strain(in_layers(material, n)) / exact - 1.0).max() for n in (24, 48)]
    assert off[1] < 1e-3
    assert off[0] / off[1] == pytest.approx(4.0, rel=0.02)
