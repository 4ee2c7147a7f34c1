"""Heat in sections that are not alike all around or all along: by hand, and against plane finite elements of a strip's free end."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.structure import BoxSection, Lamina, Layup, PolygonSection, RotatingBeam, StripSection
from beamenv.structure.geometrically_exact.tip_springs import TipSprings
from beamenv.structure.walls.laminate import Ply

ALPHA = 23e-6
ALUMINIUM = Lamina.isotropic(70e9, 0.3, 2700.0, alpha=ALPHA)
MADE_AT = 300.0


def test_a_difference_is_about_the_middle_of_a_sections_depth_wherever_its_axis_is():
    """A triangle, of whose depth the axis is nearer to one end: at rest in the middle, warmer above, colder below."""
    corners = ((-0.05, 0.0), (0.05, 0.0), (0.0, 0.06))
    section = PolygonSection(corners, ("bottom", "right", "left"), 0.004)
    beam = RotatingBeam(section, Layup.uniform(ALUMINIUM, [0.0]), 2.0, temperature=MADE_AT, temperature_difference=40.0)
    solid = beam.exact.sections.solid
    rises = beam.exact.heat.rises(np.array([1.0]), beam.exact.sections)[0]
    low, high = solid.depths[0]
    assert rises[0] + rises[1] * np.array([low, high]) == pytest.approx([-20.0, 20.0], rel=1e-9)
    assert abs(low + high) > 0.01  # m: else nothing is shown
    strain = solid.expansion.strain[0] @ rises
    assert strain[2] == pytest.approx(ALPHA * rises[0], rel=1e-6)


@pytest.mark.parametrize("warmer", [-1, 1])
def test_stresses_that_balance_stiffen_the_twist_by_their_second_moment(warmer):
    """G J is more by ∫σ r² dA (Biot; Budiansky and Mayers, Journal of the Aeronautical Sciences 23, 1956); here walls of two
    expansions pull and push one another, σ = E (ε − α ΔT).
    """
    width, depth, thickness, rise = 0.2, 0.02, 0.002, 100.0
    more = warmer * 10e-6
    wide, narrow = (Ply(Lamina.isotropic(70e9, 0.3, 2700.0, alpha=alpha), 0.0) for alpha in (20e-6, 20e-6 + more))
    layups = [Layup(None, {"top": (wide,), "bottom": (wide,), "left": (sides,), "right": (sides,)}) for sides in (wide, narrow)]
    even, stressed = (
        RotatingBeam(BoxSection(width, depth, thickness), layup, 4.0, temperature=MADE_AT + rise, steady_state="linear")
        for layup in layups
    )
    share = depth / (width + depth)
    in_sides = -70e9 * more * rise * (1.0 - share)
    in_wide = 70e9 * more * rise * share
    of_sides = 2.0 * thickness * (depth * (0.5 * width) ** 2 + depth**3 / 12.0)
    of_wide = 2.0 * thickness * (width * (0.5 * depth) ** 2 + width**3 / 12.0)
    torsion = 70e9 / 2.6 * 4.0 * (width * depth) ** 2 * thickness / (2.0 * (width + depth))
    expected = (in_sides * of_sides + in_wide * of_wide) / torsion
    found = (stressed.natural_frequencies(0.0, 1, ("twist",)) / even.natural_frequencies(0.0, 1, ("twist",))) ** 2 - 1.0
    assert found[0] == pytest.approx(expected, rel=0.1)


def test_the_free_end_of_a_two_layer_strip_lets_go_of_its_stress():
    """The tip is 0.0200 κ h² nearer than on Timoshenko's circle, by plane-stress elements of order 4 of both layers, graded to the
    end (four by twenty in each layer; 0.03 and 0.05 m long alike). The sections' eight shapes follow that within a sixth.
    """
    depth, length = 0.01, 0.05
    lower, upper = (Ply(Lamina.isotropic(E, 0.3, 2700.0, alpha=alpha), 0.0) for E, alpha in ((70e9, 23e-6), (140e9, 5e-6)))
    strip = RotatingBeam(StripSection(0.001, depth), Layup((lower, upper)), length, temperature=MADE_AT + 1.0, terms=20)
    curvature = 6.0 * 18e-6 * 4.0 / (depth * (12.0 + 3.0 * 1.5))
    raised = abs((strip.displacements(length)["v"] @ strip.at(0.0).steady.coefficients)[0])
    assert (raised - 0.5 * curvature * length**2) / (curvature * depth**2) == pytest.approx(-0.0200, rel=0.2)


@pytest.mark.parametrize("taper", [1.0, 1.5])
def test_along_a_table_walls_have_the_modulus_of_their_place(taper):
    """Where the curve is straight between two ends of the table; polynomials in the size then follow the product."""
    curve = ((250.0, 1.1), (300.0, 1.0), (350.0, 0.8), (450.0, 0.7))
    material = replace(ALUMINIUM, curves={"E1": curve})
    table = ((0.0, 300.0), (0.5, 350.0), (1.0, 450.0))
    cold = RotatingBeam(BoxSection(0.1, 0.05, 0.004), Layup.uniform(ALUMINIUM, [0.0]), 2.0, taper=taper)
    hot = replace(cold, layup=Layup.uniform(material, [0.0]), temperature_table=table)
    z = np.array([0.0, 0.3, 0.9, 1.3, 1.9])
    found, whole = (beam.exact.sections.at(z, beam.exact.sections.solid.classical_stiffness)[:, 0, 0] for beam in (hot, cold))
    moduli = np.interp(np.interp(z / 2.0, *zip(*table, strict=True)), *zip(*curve, strict=True))
    np.testing.assert_allclose(found, moduli * whole, rtol=1e-6)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_spring_that_holds_a_turn_pulls_with_the_sine_of_its_angle(axis):
    """Whatever the others hold, and about any axis the stiffness is what the force changes by."""
    springs = TipSprings(np.eye(6), np.array([1.0, 2.0, 3.0, 5.0, 7.0, 11.0]))
    turned = np.zeros(6)
    turned[3 + axis] = 0.8
    force = springs.force(turned)
    assert force[3 + axis] == pytest.approx(springs.stiffness[3 + axis] * np.sin(0.8), rel=1e-12)
    assert springs.tangent(turned)[3 + axis, 3 + axis] == pytest.approx(springs.stiffness[3 + axis] * np.cos(0.8), rel=1e-12)
    tangent = springs.tangent(np.array([0.1, 0.2, 0.3, 0.4, -0.5, 0.6]))
    assert tangent == pytest.approx(tangent.T, abs=1e-14)


def test_springs_beside_which_a_blades_stiffness_is_lost_are_refused():
    strip = RotatingBeam(StripSection(0.03, 0.002), Layup.uniform(ALUMINIUM, [0.0]), 0.3, tip_springs=(1e14,) * 6)
    with pytest.raises(ValueError, match=r"beam.tip_springs is \[100000000000000.0, .*, but must be softer: beside them"):
        strip.natural_frequencies()
    held = replace(strip, tip_springs=(1e7,) * 6).natural_frequencies()
    assert held[0] == pytest.approx(4.73004**2 * np.sqrt(70e9 / 2700.0 / 12.0) * 0.002 / 0.3**2, rel=0.02)  # both ends clamped
