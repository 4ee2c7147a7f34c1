"""Closed cells: Bredt's torsion, bending by hand, and what no choice of axes may change."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Lamina, Layup, PolygonSection

E, NU = 70e9, 0.3
G = E / (2.0 * (1.0 + NU))
ALUMINIUM = Lamina.isotropic(E, NU, density=2700.0)
ISOTROPIC = Layup.uniform(ALUMINIUM, angles_deg=[0])
ANY_MODEL = st.sampled_from([{}, {"model": "thesis"}, {"model": "thesis", "shear_flow": "consistent"}])
OBLIQUE = Layup.uniform(GRAPHITE_EPOXY, angles_deg=[20, -50, 70])


def polygon(corners, thickness=0.01):
    corners = tuple(map(tuple, np.asarray(corners).tolist()))
    return PolygonSection(corners, tuple(f"wall {k}" for k in range(len(corners))), thickness)


def regular_polygon(edges, radius):
    """Regular polygon around a circle of the given radius."""
    angle = 2.0 * np.pi * np.arange(edges) / edges
    return radius / np.cos(np.pi / edges) * np.column_stack([np.cos(angle), np.sin(angle)])


def area_and_perimeter(corners):
    following = np.roll(corners, -1, axis=0)
    area = 0.5 * np.sum(corners[:, 0] * following[:, 1] - corners[:, 1] * following[:, 0])
    return area, np.hypot(*(following - corners).T).sum()


def bredt(area, perimeter, thickness):
    """4A²Gh/p of the closed cell and G p h³/3 of the wall itself, N m²."""
    return G * (4.0 * area**2 * thickness / perimeter + perimeter * thickness**3 / 3.0)


@pytest.mark.parametrize("shear", ["higher_order", "first_order", "rigid"])
@pytest.mark.parametrize("shear_flow", ["consistent", "thesis"])
def test_isotropic_box_has_bredts_torsional_stiffness(shear, shear_flow):
    """To round-off, in every theory of thin walls."""
    width, depth, thickness = 0.254, 0.0508, 0.01016
    stiffness = BoxSection(width, depth, thickness).stiffness(ISOTROPIC, shear=shear, shear_flow=shear_flow, model="thesis")
    assert stiffness[3, 3] == pytest.approx(bredt(width * depth, 2.0 * (width + depth), thickness), rel=1e-12)


@pytest.mark.parametrize("share", [0.04, 0.02, 0.01])
def test_thin_isotropic_box_has_the_stiffness_of_its_thin_walls(share, world):
    """EA exactly, for the mitred walls have the area p h; bending and torsion but for terms of the order of h/depth."""
    w, d = 0.2, 0.1
    h = share * d
    stiffness = BoxSection(w, d, h).stiffness(ISOTROPIC, **world)
    expected = [
        E * 2.0 * (w + d) * h,
        E * h * d**2 * (w / 2.0 + d / 6.0),
        E * h * w**2 * (d / 2.0 + w / 6.0),
        bredt(w * d, 2.0 * (w + d), h),
    ]
    assert stiffness[0, 0] == pytest.approx(expected[0], rel=1e-6)
    assert np.diag(stiffness) == pytest.approx(expected, rel=share)
    assert stiffness - np.diag(np.diag(stiffness)) == pytest.approx(0.0, abs=1e-6 * stiffness[1, 1])


def test_isotropic_box_stretches_and_bends_as_by_hand(thesis_world):
    """EA = E p h. EI: Steiner, the upright walls' own h d³/12, and the lying walls' plate bending E h³/12(1 − ν²) per width."""
    w, d, h = 0.254, 0.0508, 0.01016
    plate = E * h**3 / (12.0 * (1.0 - NU**2))
    stiffness = BoxSection(w, d, h).stiffness(ISOTROPIC, shear="rigid", **thesis_world)
    expected = [
        E * 2.0 * (w + d) * h,
        2.0 * (E * w * h * (d / 2.0) ** 2 + E * h * d**3 / 12.0 + w * plate),
        2.0 * (E * d * h * (w / 2.0) ** 2 + E * h * w**3 / 12.0 + d * plate),
        bredt(w * d, 2.0 * (w + d), h),
    ]
    assert stiffness == pytest.approx(np.diag(expected), rel=1e-12, abs=1e-6)


def test_higher_order_theory_lets_walls_shear_away_some_of_their_own_bending(thesis_world):
    """Condensing the shear strains can only soften: EI of a thick box falls by less than 3 % from rigid to higher order."""
    section = BoxSection(0.254, 0.0508, 0.01016)
    theories = ("rigid", "first_order", "higher_order")
    rigid, first, higher = (section.stiffness(ISOTROPIC, shear=shear, **thesis_world)[1, 1] for shear in theories)
    assert first == pytest.approx(rigid, rel=1e-12)
    assert 0.97 * rigid < higher < rigid


def test_polygons_approach_the_circular_tube(thesis_world):
    """GJ → 2πr³hG with the square of the number of edges."""
    radius, thickness = 0.1, 0.002
    tube = bredt(np.pi * radius**2, 2.0 * np.pi * radius, thickness)
    assert tube == pytest.approx(2.0 * np.pi * radius**3 * thickness * G, rel=2e-4)
    sections = [polygon(regular_polygon(edges, radius), thickness) for edges in (3, 20, 40, 80)]
    gaps = [section.stiffness(ISOTROPIC, **thesis_world)[3, 3] / tube - 1.0 for section in sections]
    assert gaps[1] / gaps[2] == pytest.approx(4.0, rel=0.02)
    assert gaps[2] / gaps[3] == pytest.approx(4.0, rel=0.01)
    assert abs(gaps[3]) < 2e-3


def test_circular_tube_has_no_warping_and_equal_bending_all_round(world):
    """A regular polygon about the origin: EI = π r³ h E within 0.3 % for 80 edges, no couplings."""
    radius, thickness = 0.1, 0.002
    stiffness = polygon(regular_polygon(80, radius), thickness).stiffness(ISOTROPIC, **world)
    assert np.diag(stiffness)[1:3] == pytest.approx(np.pi * radius**3 * thickness * E, rel=3e-3)
    assert stiffness - np.diag(np.diag(stiffness)) == pytest.approx(0.0, abs=1e-9 * stiffness[0, 0])


@st.composite
def convex_corners(draw):
    """Corners on a circle, at least a third of a radian apart, around the origin or not."""
    gaps = np.array(draw(st.lists(st.floats(1.0, 3.0), min_size=3, max_size=7)))
    angles = np.cumsum(2.0 * np.pi * gaps / gaps.sum())
    shift = np.array(draw(st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1))))
    return 0.2 * np.column_stack([np.cos(angles), np.sin(angles)]) + shift


@settings(max_examples=25)
@given(corners=convex_corners())
def test_any_isotropic_polygon_has_bredts_torsional_stiffness(corners):
    stiffness = polygon(corners).stiffness(ISOTROPIC, shear="rigid", model="thesis")
    assert stiffness[3, 3] == pytest.approx(bredt(*area_and_perimeter(corners), 0.01), rel=1e-11)


def invariants(section, **theory):
    """EA, GJ, extension–twist, and of the bending block its trace and determinant; coupling magnitudes of bending."""
    s = section.stiffness(OBLIQUE, **theory)
    bending = s[1:3, 1:3]
    return np.array(
        [s[0, 0], s[3, 3], s[0, 3], np.trace(bending), np.linalg.det(bending), np.hypot(*s[1:3, 0]), np.hypot(*s[1:3, 3])]
    )


@settings(max_examples=25)
@given(corners=convex_corners(), angle=st.floats(-np.pi, np.pi), start=st.integers(1, 6), model=ANY_MODEL)
def test_turning_a_section_or_starting_elsewhere_changes_no_invariant(corners, angle, start, model):
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    for shear in ("higher_order", "rigid"):
        theory = {"shear": shear, **model}
        original = invariants(polygon(corners), **theory)
        tolerance = {"rel": 1e-8, "abs": 1e-8 * original[0]}
        assert invariants(polygon(corners @ turn.T), **theory) == pytest.approx(original, **tolerance)
        assert invariants(polygon(np.roll(corners, start, axis=0)), **theory) == pytest.approx(original, **tolerance)


@settings(max_examples=25)
@given(
    corners=convex_corners(),
    share=st.floats(0.1, 0.9),
    shear=st.sampled_from(["higher_order", "first_order", "rigid"]),
    shear_flow=st.sampled_from(["consistent", "thesis"]),
)
def test_a_corner_on_a_straight_wall_changes_nothing(corners, share, shear, shear_flow):
    between = corners[0] + share * (corners[1] - corners[0])
    finer = np.vstack([corners[:1], between, corners[1:]])
    theory = {"shear": shear, "shear_flow": shear_flow, "model": "thesis"}
    whole, split = (polygon(points).stiffness(OBLIQUE, **theory) for points in (corners, finer))
    assert split == pytest.approx(whole, rel=1e-9, abs=1e-9 * whole[0, 0])


@pytest.mark.parametrize("shear", ["higher_order", "first_order", "rigid"])
def test_box_is_the_polygon_of_its_corners(shear, world):
    """Corners and walls as the docstring has them: right, top, left and bottom, counter-clockwise from the lower right."""
    box = BoxSection(0.254, 0.0508, 0.01016)
    corners = ((0.127, -0.0254), (0.127, 0.0254), (-0.127, 0.0254), (-0.127, -0.0254))
    layup = Layup.by_wall(GRAPHITE_EPOXY, top=[60, 30], bottom=[-60, -30], left=[10, 20], right=[80, -20])
    as_polygon = PolygonSection(corners, ("right", "top", "left", "bottom"), 0.01016)
    assert np.array_equal(as_polygon.stiffness(layup, shear=shear, **world), box.stiffness(layup, shear=shear, **world))


ANGLES = st.lists(st.floats(-90.0, 90.0), min_size=1, max_size=6)


@settings(max_examples=25)
@given(
    top=ANGLES,
    bottom=ANGLES,
    left=ANGLES,
    right=ANGLES,
    shear=st.sampled_from(["higher_order", "first_order", "rigid"]),
    model=ANY_MODEL,
)
def test_mirroring_every_ply_angle_turns_the_couplings_with_twist_and_leaves_the_rest(top, bottom, left, right, shear, model):
    """Reflection in the section's plane: stretch and bending keep their signs, twist changes its."""
    layup = Layup.by_wall(GRAPHITE_EPOXY, top=top, bottom=bottom, left=left, right=right)
    section = BoxSection(0.254, 0.0508, 0.01016)
    original, mirrored = (section.stiffness(each, shear=shear, **model) for each in (layup, layup.mirrored()))
    reflection = np.diag([1.0, 1.0, 1.0, -1.0])
    assert mirrored == pytest.approx(reflection @ original @ reflection, rel=1e-8, abs=1e-9 * original[0, 0])
    assert np.diag(mirrored) == pytest.approx(np.diag(original), rel=1e-9)


@settings(max_examples=25)
@given(top=ANGLES, bottom=ANGLES, left=ANGLES, right=ANGLES, model=ANY_MODEL)
def test_classical_stiffness_is_symmetric_and_positive(top, bottom, left, right, model):
    layup = Layup.by_wall(GRAPHITE_EPOXY, top=top, bottom=bottom, left=left, right=right)
    stiffness = BoxSection(0.254, 0.0508, 0.01016).stiffness(layup, **model)
    scale = np.sqrt(np.diag(stiffness))
    assert stiffness / np.outer(scale, scale) == pytest.approx((stiffness / np.outer(scale, scale)).T, abs=1e-9)
    assert np.linalg.eigvalsh(stiffness / np.outer(scale, scale)).min() > 0.0
