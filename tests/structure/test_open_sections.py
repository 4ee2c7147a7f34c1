"""Strips and open walls against textbooks: stiffness, shear centre, and warping that the clamp holds back."""

import numpy as np
import pytest
from scipy.optimize import brentq

from beamenv.structure import (
    GRAPHITE_EPOXY,
    CSection,
    ISection,
    Lamina,
    Laminate,
    Layup,
    RotatingBeam,
    StripSection,
    WallsSection,
    ZSection,
)
from tests.structure.aluminium import ALUMINIUM, DENSITY, E, G, classical


def torsion_of_rectangle(width, depth):
    """J of Saint-Venant's series (Timoshenko and Goodier 1970, §109)."""
    odd = np.arange(1, 80, 2)
    series = np.sum(np.tanh(0.5 * np.pi * odd * width / depth) / odd**5)
    return width * depth**3 * (1.0 / 3.0 - 64.0 / np.pi**5 * depth / width * series)


@pytest.mark.parametrize(("width", "depth", "within"), [(0.03, 0.002, 2e-4), (0.05, 0.005, 2e-4), (0.03, 0.03, 1e-3)])
def test_solid_strip_has_the_stiffness_of_the_textbooks(width, depth, within):
    found = np.diag(classical(StripSection(width, depth)))
    bending = E * np.array([width * depth, width * depth**3 / 12.0, depth * width**3 / 12.0])
    np.testing.assert_allclose(found[:3], bending, rtol=1e-10)
    assert found[3] == pytest.approx(G * torsion_of_rectangle(width, depth), rel=within)


@pytest.mark.parametrize("angles", [[30.0] * 4, [45.0, -45.0, -45.0, 45.0], [0.0, 90.0, 90.0, 0.0]])
def test_laminated_strip_has_the_stiffness_of_a_plate_strip(angles):
    """Classical lamination theory with free edges: compliances a_zz, d_zz, d_sz over the width, 50 times the thickness.

    Along the span and in bending within 0.2 %; in torsion less what the edges lose, some 0.6 thicknesses √(G_sz/G_nz) of the width.
    """
    width, thickness = 0.05, 0.001
    layup = Layup.uniform(GRAPHITE_EPOXY, angles)
    laminate = Laminate.equal_plies(layup.plies("strip"), thickness)
    levels = np.array(laminate.interfaces)
    plies = [ply.material.transformed_stiffness(np.radians(ply.angle_deg)) for ply in laminate.plies]
    membrane, bending = (
        np.linalg.inv(sum(ply * step for ply, step in zip(plies, np.diff(levels**k) / k, strict=True))) for k in (1, 3)
    )
    compliance = width * np.linalg.inv(classical(StripSection(width, thickness), layup))
    assert compliance[0, 0] == pytest.approx(membrane[1, 1], rel=2e-3)
    assert compliance[1, 1] == pytest.approx(bending[1, 1], rel=2e-3)
    assert 1.0 < compliance[3, 3] / (0.25 * bending[2, 2]) < 1.04
    assert abs(compliance[1, 3]) == pytest.approx(0.5 * abs(bending[1, 2]), rel=0.01, abs=1e-9 * compliance[3, 3])


def test_shear_centre_of_a_channel_is_outside_its_web():
    """3b²/(d + 6b) behind it for thin walls (Megson 2017, Example 17.1), within 1 %."""
    width, depth = 0.04, 0.08
    found = CSection(width, depth, 0.002).properties(ALUMINIUM)
    assert found.shear_centre[0] == pytest.approx(-3.0 * width**2 / (depth + 6.0 * width), rel=0.01)
    assert found.tension_centre[0] == pytest.approx(width**2 / (2.0 * width + depth), rel=1e-3)


def test_a_z_bends_across_its_flanges_and_its_centre_is_the_middle_of_its_web():
    width, depth, thickness = 0.04, 0.08, 0.002
    found = ZSection(width, depth, thickness).properties(ALUMINIUM)
    np.testing.assert_allclose([*found.shear_centre, *found.tension_centre], 0.0, atol=1e-12)
    product = 2.0 * width * thickness * (0.5 * width) * (0.5 * depth)
    assert abs(found.classical_stiffness[1, 2]) == pytest.approx(E * product, rel=0.01)


def test_open_walls_twist_as_strips_and_no_cell_carries_shear_flow():
    """Σ b t³/3 of thin walls, within what corners and ends make: 2 % at b/t = 30."""
    for section, lengths in (
        (CSection(0.06, 0.06, 0.002), 0.18),
        (ZSection(0.06, 0.06, 0.002), 0.18),
        (ISection(0.06, 0.06, 0.002), 0.178),
    ):
        assert classical(section)[3, 3] == pytest.approx(G * lengths * 0.002**3 / 3.0, rel=0.02)


def vlasov(section, length, torsion, count):
    """Torsional frequencies, rad/s, of an I whose flanges the clamp holds (Vlasov 1961; Gere 1954, J. Applied Mechanics 21)."""
    b, d, t = section.width, section.depth, section.thickness
    warping = E * d**2 * t * b**3 / 24.0
    inertia = DENSITY * (b * t * d**2 / 2.0 + t * d**3 / 12.0 + t * b**3 / 6.0)

    def determinant(omega):
        a, c = torsion / warping, inertia * omega**2 / warping
        m, n = (np.sqrt(0.5 * (sign * a + np.sqrt(a**2 + 4.0 * c))) for sign in (1.0, -1.0))
        far = np.exp(-m * length)  # of cosh and sinh, the growing part scaled away
        cosh, sinh = 0.5 * (1.0 + far**2), 0.5 * (1.0 - far**2)
        cos, sin = np.cos(n * length) * far, np.sin(n * length) * far
        rows = [
            [1.0, 0.0, 1.0, 0.0],
            [0.0, m, 0.0, n],
            [m**2 * cosh, m**2 * sinh, -(n**2) * cos, -(n**2) * sin],
            [
                (warping * m**3 - torsion * m) * sinh,
                (warping * m**3 - torsion * m) * cosh,
                (warping * n**3 + torsion * n) * sin,
                -(warping * n**3 + torsion * n) * cos,
            ],
        ]
        return np.linalg.det(np.array(rows) / np.array([1.0, m, m**2, warping * m**3])[:, None])

    omegas = np.linspace(10.0, 4000.0, 4000)
    signs = np.sign([determinant(omega) for omega in omegas])
    roots = [brentq(determinant, omegas[k], omegas[k + 1]) for k in np.flatnonzero(signs[1:] != signs[:-1])]
    return np.array(roots[:count])


@pytest.mark.parametrize("length", [1.0, 2.0])
def test_the_clamp_holds_back_the_warping_of_an_i(length):
    """Two torsion modes within 1.5 % of Vlasov's theory; with free warping the first would be half of it or less."""
    section = ISection(0.06, 0.1, 0.003)
    modes = RotatingBeam(section, ALUMINIUM, length=length).modes(count=10)
    twist = np.array([f for f, family in zip(modes.natural_frequencies, modes.families, strict=True) if family == "twist"])[:2]
    np.testing.assert_allclose(twist, vlasov(section, length, classical(section)[3, 3], 2), rtol=0.015)


def test_a_wide_strip_vibrates_as_a_cantilever_plate():
    """300 × 30 × 2 mm, flap: Kirchhoff's plate by a Ritz method of its own, 18.41, 115.35 and 323.2 Hz, within 0.15 %; the clamp
    holds its contraction back there, and Euler and Bernoulli's beam is 0.7 % lower.
    """
    modes = RotatingBeam(StripSection(0.03, 0.002), ALUMINIUM, length=0.3).modes(count=8)
    flap = [f for f, family in zip(modes.natural_frequencies, modes.families, strict=True) if family == "flap"]
    np.testing.assert_allclose(np.array(flap[:3]) / (2.0 * np.pi), [18.411, 115.35, 323.21], rtol=1.5e-3)


def test_walls_by_their_lines_are_the_same_section_as_by_its_name():
    lines = {"top": [[0.03, 0.05], [-0.03, 0.05]], "bottom": [[-0.03, -0.05], [0.03, -0.05]], "web": [[0.0, -0.05], [0.0, 0.05]]}
    by_lines, by_name = classical(WallsSection(lines, 0.003)), classical(ISection(0.06, 0.1, 0.003))
    np.testing.assert_allclose(np.diag(by_lines), np.diag(by_name), rtol=1e-9)


@pytest.mark.parametrize("section", [StripSection(0.05, 0.002), CSection(0.05, 0.03, 0.002), ISection(0.05, 0.03, 0.002)])
def test_an_open_section_that_does_not_contract_is_the_limit_of_one_that_hardly_does(section):
    """ν = 0: nothing contracts where warping is held back; one more shape of its vibrations takes that place, and lowers tones."""
    none, hardly = (Layup.uniform(Lamina.isotropic(E, nu, DENSITY), [0.0]) for nu in (0.0, 1e-5))
    stiffness = [section.properties(layup).stiffness for layup in (none, hardly)]
    scale = np.sqrt(np.outer(np.diag(stiffness[1]), np.diag(stiffness[1])))
    assert np.abs((stiffness[0] - stiffness[1]) / scale).max() < 3e-5
    tone = [RotatingBeam(section, layup, 1.0).natural_frequencies(0.0, 6) for layup in (none, hardly)]
    assert tone[0] == pytest.approx(tone[1], rel=5e-4)
    assert np.all(tone[0] < tone[1] * (1.0 + 1e-5))
