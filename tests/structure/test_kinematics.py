"""Strains are the derivatives of displacements: the rows of both are written down apart and checked against each other."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Lamina, Layup, PolygonSection, RotatingBeam
from beamenv.structure.walls.wall_kinematics import DISPLACEMENTS, STRAINS, motion_rows, transverse_shear_rows

ALUMINIUM = Lamina.isotropic(E=70e9, nu=0.3, density=2700.0)
ISOTROPIC = Layup.uniform(ALUMINIUM, angles_deg=[0])
CORNERS = ((0.15, -0.03), (0.1, 0.05), (-0.07, 0.06), (-0.12, -0.05))
CROOKED = PolygonSection(CORNERS, ("a", "b", "c", "d"), thickness=0.006)


@pytest.fixture(params=["higher_order", "first_order", "rigid"])
def walls(request, thesis_world):
    """Walls of an isotropic blade of a section without any symmetry, turned by 20°."""
    beam = RotatingBeam(CROOKED, ISOTROPIC, length=1.0, presetting_deg=20.0, shear=request.param, **thesis_world)
    return beam.walls_at(np.zeros(1))


def motion(walls):
    return motion_rows(walls.points, walls.flow, walls.laws.thickness, walls.shear)


def strains_of(displacements):
    """Generalised strains from displacements and their slopes along z, by name."""
    u1, v1, phi1 = displacements["u'"], displacements["v'"], displacements["phi'"]
    return {"gamma_x": u1 - displacements["theta_y"], "gamma_y": v1 + displacements["theta_x"], "phi'": phi1}


def vector(names, values):
    return np.array([values.get(name, 0.0) for name in names])


def arbitrary_displacements(shear):
    values = dict(zip(DISPLACEMENTS, np.random.default_rng(3).normal(size=len(DISPLACEMENTS)), strict=True))
    if shear == "rigid":
        values["theta_y"], values["theta_x"] = values["u'"], -values["v'"]
    return values


def test_span_strain_is_the_slope_of_the_span_displacement(walls):
    """ε_zz = ∂W/∂z, power by power of n: w' of s, θ' of θ, φ'' of φ', and u'', v'' of u', v'."""
    slope_of = {"w'": "s", "theta_x'": "theta_x", "theta_y'": "theta_y", "phi''": "phi'", "u''": "u'", "v''": "v'"}
    displaced, strained = motion(walls).span, walls.strain_rows()[..., :3, :]
    for strain, displacement in slope_of.items():
        one = strained[..., STRAINS.index(strain)]
        other = displaced[..., DISPLACEMENTS.index(displacement)]
        assert one == pytest.approx(other, rel=1e-12, abs=1e-15)


def test_membrane_shear_is_the_turn_of_the_wall(walls):
    """γ_sz = ∂W/∂s + ∂T/∂z with the tangential displacement T = −m U + l V: l γy − m γx + ψφ' at the mid-line, 2φ' per n."""
    values = arbitrary_displacements(walls.shear)
    points, moved = walls.points, motion(walls)
    along_edge = np.diff(points.along[0])[::2]
    span = moved.span[0] @ vector(DISPLACEMENTS, values)
    warped = np.repeat((span[1::2] - span[::2]) / along_edge[:, None], 2, axis=0)
    slopes = vector(DISPLACEMENTS, {"u": values["u'"], "v": values["v'"], "phi": values["phi'"]})
    tangential = -points.m[0, :, None] * (moved.lag[0] @ slopes) + points.l[0, :, None] * (moved.flap[0] @ slopes)
    expected = walls.strain_rows()[0] @ vector(STRAINS, strains_of(values))
    assert (warped + tangential)[:, 0] == pytest.approx(expected[:, 3], rel=1e-9, abs=1e-12)
    assert (warped + tangential)[:, 1] == pytest.approx(expected[:, 4], rel=1e-9, abs=1e-12)


def test_transverse_shear_is_the_tilt_of_the_normal_and_vanishes_at_the_faces_in_the_higher_order_theory(walls):
    """γ_nz = ∂W/∂n + ∂N/∂z = g(n)(m γy + l γx): g = 1 − 4n²/h² or 1. Warping's own share, −aφ' + aφ', cancels."""
    values = arbitrary_displacements(walls.shear)
    points, moved, thickness = walls.points, motion(walls), CROOKED.thickness
    span = moved.span[0] @ vector(DISPLACEMENTS, values)
    slopes = vector(DISPLACEMENTS, {"u": values["u'"], "v": values["v'"], "phi": values["phi'"]})
    normal = points.l[0] * (moved.lag[0, :, 0] @ slopes) + points.m[0] * (moved.flap[0, :, 0] @ slopes)
    at_midline = transverse_shear_rows(points)[0] @ vector(STRAINS, strains_of(values))
    for n in thickness * np.array([-0.5, -0.2, 0.0, 0.3, 0.5]):
        profile = 1.0 - 4.0 * n**2 / thickness**2 if walls.shear == "higher_order" else 1.0
        tilt = span[:, 1] + 3.0 * n**2 * span[:, 2] + normal
        assert tilt == pytest.approx(profile * at_midline, rel=1e-9, abs=1e-12)


def test_warping_of_a_box_by_hand(thesis_world):
    """F_w = ±wd(w − d)/4(w + d) at the corners, straight between: its inertia and, with the plates' own, EI_ω."""
    w, d, h = 0.2, 0.05, 0.004
    walls = RotatingBeam(BoxSection(w, d, h), ISOTROPIC, length=1.0, shear="rigid", **thesis_world).walls_at(np.zeros(1))
    corner = w * d * (w - d) / (4.0 * (w + d))
    primary = h * 2.0 * (w + d) * corner**2 / 3.0
    secondary = h**3 / 12.0 * (w**3 + d**3) / 6.0
    warping = walls.inertia().span_span[0, DISPLACEMENTS.index("phi'"), DISPLACEMENTS.index("phi'")]
    assert warping == pytest.approx(ALUMINIUM.density * (primary + secondary), rel=1e-10)
    stiffness = walls.stiffness()[0, STRAINS.index("phi''"), STRAINS.index("phi''")]
    assert stiffness == pytest.approx(70e9 * (primary + secondary / (1.0 - 0.3**2)), rel=1e-10)


def test_square_box_does_not_warp_at_its_midline(thesis_world):
    walls = RotatingBeam(BoxSection(0.1, 0.1, 0.004), ISOTROPIC, length=1.0, **thesis_world).walls_at(np.zeros(1))
    assert walls.flow.warping == pytest.approx(0.0, abs=1e-16)


def test_a_blade_that_stretches_lags_behind(thesis_world):
    """Spin about y and motion along z: Coriolis acceleration 2ΩẆ along x; ∫ 2m (z/L)²(z/L) dz = mL/2 between u and s."""
    beam = RotatingBeam(BoxSection(0.2, 0.05, 0.004), ISOTROPIC, length=2.0, **thesis_world)
    lag, stretch = (beam.space.columns((motion,))[0] for motion in ("lag", "extension"))
    mass = 2700.0 * 0.004 * 0.5
    assert beam.matrices.gyroscopic[lag, stretch] == pytest.approx(0.5 * mass * 2.0, rel=1e-12)
    assert beam.matrices.gyroscopic[stretch, lag] == pytest.approx(-0.5 * mass * 2.0, rel=1e-12)


@settings(max_examples=25)
@given(
    shift=st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3)),
    angles=st.lists(st.floats(-90.0, 90.0), min_size=1, max_size=4),
    shear=st.sampled_from(["higher_order", "first_order", "rigid"]),
    world=st.sampled_from([{}, {"model": "thesis"}, {"model": "thesis", "shear_flow": "consistent"}]),
)
def test_the_axis_a_section_is_described_from_changes_no_frequency_at_rest(shift, angles, shear, world):
    """Pole, origin and centroid are bookkeeping: u, s and θ take up the shift, if every sign of the warping is right.

    The shear flow must answer to all of ε0, its warping part −F_w φ'' too: without it 30° plies miss this by 8 %.
    """
    layup = Layup.uniform(GRAPHITE_EPOXY, angles)
    beam = RotatingBeam(CROOKED, layup, length=1.5, shear=shear, terms=6, **world)
    moved = tuple((x + shift[0], y + shift[1]) for x, y in CORNERS)
    shifted = replace(beam, section=replace(CROOKED, corners=moved))
    count = 12
    assert shifted.natural_frequencies(0.0, count) == pytest.approx(beam.natural_frequencies(0.0, count), rel=1e-8)
