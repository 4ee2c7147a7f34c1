"""Plies and laminated walls against hand values."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beamenv.structure import GRAPHITE_EPOXY, Lamina, Laminate, Ply
from beamenv.structure.walls.laminate import wall_law

E, NU, H = 70e9, 0.3, 0.004
G = E / (2.0 * (1.0 + NU))
ALUMINIUM = Lamina.isotropic(E, NU, density=2700.0)


def test_plane_stress_stiffness_of_graphite_epoxy():
    """Q = E/(1 − ν12 ν21): 207.1, 5.177 and 1.294 GPa."""
    q = GRAPHITE_EPOXY.reduced_stiffness()
    through = 1.0 - 0.25**2 * 5.17 / 206.8
    assert q[[0, 1, 2], [0, 1, 2]] == pytest.approx([206.8e9 / through, 5.17e9 / through, 3.1e9])
    assert q[0, 1] == pytest.approx(0.25 * 5.17e9 / through)
    assert np.diag(q) / 1e9 == pytest.approx([207.12, 5.178, 3.1], rel=1e-3)


@settings(max_examples=25)
@given(angle=st.floats(-np.pi, np.pi))
def test_turned_ply_follows_jones(angle):
    """Jones, Mechanics of Composite Materials, Eq. 2.84, the standard formulas that the thesis misprints."""
    q = GRAPHITE_EPOXY.reduced_stiffness()
    q11, q22, q12, q66 = q[0, 0], q[1, 1], q[0, 1], q[2, 2]
    c, s = np.cos(angle), np.sin(angle)
    bar = {
        (0, 0): q11 * c**4 + 2.0 * (q12 + 2.0 * q66) * s**2 * c**2 + q22 * s**4,
        (1, 1): q11 * s**4 + 2.0 * (q12 + 2.0 * q66) * s**2 * c**2 + q22 * c**4,
        (0, 1): (q11 + q22 - 4.0 * q66) * s**2 * c**2 + q12 * (s**4 + c**4),
        (2, 2): (q11 + q22 - 2.0 * q12 - 2.0 * q66) * s**2 * c**2 + q66 * (s**4 + c**4),
        (0, 2): (q11 - q12 - 2.0 * q66) * s * c**3 + (q12 - q22 + 2.0 * q66) * s**3 * c,
        (1, 2): (q11 - q12 - 2.0 * q66) * s**3 * c + (q12 - q22 + 2.0 * q66) * s * c**3,
    }
    turned = GRAPHITE_EPOXY.transformed_stiffness(angle)
    for (row, column), value in bar.items():
        assert turned[row, column] == pytest.approx(value, abs=1e-9 * q11)
        assert turned[column, row] == pytest.approx(value, abs=1e-9 * q11)


def test_transverse_shear_modulus_turns_from_g23_to_g13():
    """θ = 0, hoop fibres: the plane n–z is 3–2; θ = 90°: 3–1."""
    assert GRAPHITE_EPOXY.transverse_shear_stiffness(0.0) == GRAPHITE_EPOXY.G23
    assert GRAPHITE_EPOXY.transverse_shear_stiffness(np.pi / 2.0) == pytest.approx(GRAPHITE_EPOXY.G13)


def test_isotropic_wall_without_hoop_force_has_the_stiffnesses_of_strip_and_plate():
    """E h; E h³/12(1 − ν²), E h⁷/448(1 − ν²); G h, G h³/12, G h⁵/80; their mixed moments; no coupling of stretch and shear."""
    law = wall_law(Laminate.equal_plies((Ply(ALUMINIUM, 0.0), Ply(ALUMINIUM, 37.0)), H))
    plate = E / (1.0 - NU**2)
    expected = np.zeros((6, 6))
    expected[0, 0] = E * H
    expected[1, 1], expected[2, 2] = plate * H**3 / 12.0, plate * H**7 / 448.0
    expected[1, 2] = expected[2, 1] = plate * H**5 / 80.0
    expected[3, 3], expected[4, 4], expected[5, 5] = G * H, G * H**3 / 12.0, G * H**5 / 80.0
    expected[3, 5] = expected[5, 3] = G * H**3 / 12.0
    scale = np.sqrt(np.diag(expected))
    assert law.stiffness / np.outer(scale, scale) == pytest.approx(expected / np.outer(scale, scale), abs=1e-12)
    assert law.transverse_shear[0] == pytest.approx(G * H)
    assert law.hoop_coupling == pytest.approx([NU, 0.0, 0.0, 0.0, 0.0, 0.0], abs=1e-14)
    assert law.density[[0, 2]] == pytest.approx([2700.0 * H, 2700.0 * H**3 / 12.0])


def test_balanced_wall_couples_neither_stretch_and_shear_nor_is_softer_than_its_plies_alone():
    """[±45]s: A16 = 0; a lone +45 ply wall couples, and so stretches more easily."""
    balanced, oblique = (
        wall_law(Laminate.equal_plies(tuple(Ply(GRAPHITE_EPOXY, angle) for angle in angles), H)).stiffness
        for angles in ((45, -45, -45, 45), (45, 45, 45, 45))
    )
    assert balanced[0, 3] == pytest.approx(0.0, abs=1e-9 * balanced[0, 0])
    assert abs(oblique[0, 3]) > 0.1 * oblique[0, 0]
    free = oblique[0, 0] - oblique[0, 3] ** 2 / oblique[3, 3]
    assert free < balanced[0, 0]


def test_off_axis_strip_has_its_engineering_modulus():
    """N_ss = 0 and shear free: 1/E(θ) = c⁴/E2 + s⁴/E1 + (1/G12 − 2ν12/E1) s²c², with θ from the hoop direction."""
    m, angle = GRAPHITE_EPOXY, np.radians(65.0)
    law = wall_law(Laminate.equal_plies((Ply(m, 65.0),), H)).stiffness
    c, s = np.cos(angle), np.sin(angle)
    modulus = 1.0 / (c**4 / m.E2 + s**4 / m.E1 + (1.0 / m.G12 - 2.0 * m.nu12 / m.E1) * s**2 * c**2)
    assert (law[0, 0] - law[0, 3] ** 2 / law[3, 3]) / H == pytest.approx(modulus, rel=1e-10)


def test_outer_layer_replaces_as_much_of_the_wall_as_it_is_thick():
    wall = Laminate.equal_plies(tuple(Ply(GRAPHITE_EPOXY, angle) for angle in (0, 30, 60)), 0.003)
    foreign = Ply(ALUMINIUM, 0.0)
    replaced = wall.with_outer_layer(foreign, 0.0015)
    assert replaced.interfaces == pytest.approx((-0.0015, -0.0005, 0.0, 0.0015))
    assert [ply.angle_deg for ply in replaced.plies] == [0, 30, 0]
    assert wall.with_outer_layer(foreign, 0.001).plies == (*wall.plies[:2], foreign)
