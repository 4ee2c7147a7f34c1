"""The shape that every picture of a blade is drawn from."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade.build import build_beam
from beamenv.blade.config import BladeConfig
from beamenv.blade.shape import bodies, body, edges, end_triangles, patch, quadrilaterals, side_triangles, sides
from beamenv.patches import MFC
from beamenv.structure import (
    GRAPHITE_EPOXY,
    BoxSection,
    CSection,
    ISection,
    Layup,
    PolygonSection,
    RotatingBeam,
    StripSection,
    TubeSection,
)

BOX = RotatingBeam(
    BoxSection(0.2, 0.06, 0.01), Layup.uniform(GRAPHITE_EPOXY, [30.0] * 6), 2.0, pretwist_deg=40.0, presetting_deg=10.0, taper=2.0
)
ANGLES = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
TUBE = PolygonSection(
    tuple(zip(0.1 * np.cos(ANGLES), 0.1 * np.sin(ANGLES), strict=True)), tuple(f"wall {k}" for k in range(24)), 0.01
)
WEDGE = PolygonSection(((0.1, 0.0), (0.0, 0.04), (-0.1, 0.0)), ("top", "back", "bottom"), 0.004)
"""Nose to the right, flat below."""
HOLLOW = PolygonSection(
    ((0.0, -0.1), (0.1, -0.1), (0.1, 0.1), (0.0, 0.1), (0.03, 0.0)), ("bottom", "right", "top", "upper", "lower"), 0.004
)


def bladed(section, **changes):
    """A straight, untwisted blade 1 m long."""
    return RotatingBeam(section, Layup.uniform(GRAPHITE_EPOXY, [0.0] * 2), 1.0, **changes)


def sheet(wall, width):
    return MFC.inlay(wall, 0.0, 1.0, width)


def turned(angle_deg, points):
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    return np.asarray(points) @ np.array([[c, s], [-s, c]])


def area(polygon):
    x, y = polygon.T
    return 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))


def test_corners_of_a_box_are_half_a_wall_outside_its_mid_line_turned_and_shrunk_along_the_span():
    root, tip = body(BOX, np.array([0.0, 2.0])).at_rest()
    np.testing.assert_allclose(root[:, :2], turned(10.0, [[0.105, -0.035], [0.105, 0.035], [-0.105, 0.035], [-0.105, -0.035]]))
    np.testing.assert_allclose(tip[:, :2], turned(50.0, [[0.055, -0.02], [0.055, 0.02], [-0.055, 0.02], [-0.055, -0.02]]))
    np.testing.assert_array_equal(tip[:, 2], 2.0)


def test_the_drawn_blade_has_the_dimensions_of_its_configuration():
    config = BladeConfig()
    beam = replace(config.beam, taper=2.0, presetting_deg=5.0)
    for station, angle, size in ((0, 5.0, 1.0), (1, 35.0, 0.5)):
        corners = body(build_beam(replace(config, beam=beam)), np.array([0.0, beam.length])).at_rest()[station, :, :2]
        width = size * beam.width + beam.thickness
        np.testing.assert_allclose(corners[1] - corners[2], turned(angle, [[width, 0.0]])[0], atol=1e-15)


def test_the_outer_face_of_every_wall_is_half_a_thickness_from_its_mid_line():
    for section in (TUBE, HOLLOW):
        outer, mid = body(bladed(section), np.zeros(1)).points[0], section.vertices
        along = np.roll(mid, -1, axis=0) - mid
        normal = np.stack([along[:, 1], -along[:, 0]], axis=-1) / np.linalg.norm(along, axis=-1)[:, None]
        for corner in (outer, np.roll(outer, -1, axis=0)):
            np.testing.assert_allclose(((corner - mid) * normal).sum(axis=-1), 0.5 * section.thickness, rtol=1e-9)


def test_a_sharp_trailing_edge_is_cut_off_within_a_wall_s_thickness():
    outer = body(bladed(WEDGE), np.zeros(1)).points[0]
    assert np.linalg.norm(outer - WEDGE.vertices, axis=-1).max() < 2.0 * WEDGE.thickness
    assert area(outer) > area(WEDGE.vertices)


def test_a_section_is_shifted_by_lag_and_flap_and_turned_by_twist_about_its_axis():
    skin = body(bladed(WEDGE), np.array([0.0, 0.5, 1.0]))
    moved = skin.displaced(np.array([[0.0, 0.01, 0.03], [0.0, -0.02, -0.05], [0.0, 0.1, np.radians(30.0)]]))
    np.testing.assert_allclose(moved[0], skin.at_rest()[0])
    np.testing.assert_allclose(moved[2, :, :2], turned(30.0, skin.points[2]) + [0.03, -0.05])
    frames = np.stack([np.zeros((3, 3)), np.array([[0.0, 0.01, 0.03], [0.0, -0.02, -0.05], [0.0, 0.1, np.radians(30.0)]])])
    np.testing.assert_array_equal(skin.displaced(frames), np.stack([skin.at_rest(), moved]))


def test_a_patch_lies_in_the_middle_of_its_wall_s_outer_face():
    strip = patch(BOX, sheet("top", 0.03), np.array([0.0, 2.0])).at_rest()
    np.testing.assert_allclose(strip[0, :, :2], turned(10.0, [[-0.015, 0.035], [0.015, 0.035]]))
    np.testing.assert_allclose(strip[1, :, :2], turned(50.0, [[-0.015, 0.02], [0.015, 0.02]]))
    middle = patch(bladed(WEDGE), sheet("top", 0.02), np.zeros(1), raised=0.001).points[0].mean(axis=0)
    np.testing.assert_allclose(middle, [0.05, 0.02] + 0.003 * np.array([0.04, 0.1]) / np.hypot(0.04, 0.1))


def test_a_patch_on_a_wall_that_the_section_has_not_is_refused():
    with pytest.raises(ValueError, match="wall is 'top', but must be one wall of the section: wall 0, wall 1"):
        patch(bladed(TUBE), sheet("top", 0.01), np.zeros(1))


def test_a_patch_on_a_round_wall_is_drawn_above_all_of_it():
    blade = bladed(TubeSection(0.2, 0.2, 0.004))
    ends = patch(blade, MFC.inlay("top", 0.0, 1.0, 0.1), np.zeros(1)).points[0]
    assert ends[0] == pytest.approx([-0.1 * np.sin(0.5), 0.102], abs=1e-3)
    assert ends[1] == pytest.approx([0.1 * np.sin(0.5), 0.102], abs=1e-3)


def test_the_outline_of_an_open_section_goes_there_on_its_outer_face_and_back_on_the_inner():
    strip, channel = (
        body(bladed(each), np.zeros(1)).points[0] for each in (StripSection(0.03, 0.002), CSection(0.04, 0.08, 0.002))
    )
    np.testing.assert_allclose(strip, [[0.015, 0.001], [-0.015, 0.001], [-0.015, -0.001], [0.015, -0.001]])
    assert area(channel) == pytest.approx(0.002 * (0.04 + 0.08 + 0.04), rel=1e-12)
    assert [len(each.points[0]) for each in bodies(bladed(ISection(0.06, 0.1, 0.003)), np.zeros(1))] == [4, 4, 4]


@pytest.mark.parametrize("section", [BoxSection(0.2, 0.06, 0.01), TUBE, WEDGE, HOLLOW])
def test_faces_look_outwards(section):
    walls = body(bladed(section), np.linspace(0.0, 1.0, 4)).at_rest()
    faces = sides(walls)
    assert faces.shape == (3 * len(section.vertices), 4, 3)
    # Gauss: a closed surface that looks outwards encloses a positive volume, here the contour's area times the length.
    normals = 0.5 * np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    ends = area(walls[-1, :, :2]) * walls[-1, 0, 2]
    volume = ((faces.mean(axis=1) * normals).sum() + ends) / 3.0
    assert volume == pytest.approx(area(walls[0, :, :2]), rel=1e-9)
    strip = quadrilaterals(patch(bladed(BoxSection(0.2, 0.06, 0.01)), sheet("bottom", 0.03), np.array([0.1, 0.2])).at_rest())
    assert np.cross(strip[2] - strip[0], strip[3] - strip[1])[1] < 0.0
    under = replace(sheet("strip", 0.01), face="inner")
    strip = quadrilaterals(patch(bladed(StripSection(0.03, 0.002)), under, np.array([0.1, 0.2])).at_rest())
    assert np.cross(strip[2] - strip[0], strip[3] - strip[1])[1] < 0.0


@pytest.mark.parametrize("section", [BoxSection(0.2, 0.06, 0.01), TUBE, WEDGE, HOLLOW])
def test_the_mesh_is_a_closed_surface(section):
    # Euler: V - E + F = 2 for a closed surface without holes, each edge of which two triangles share.
    contour, stations = section.vertices, 7
    end, corners = end_triangles(contour), len(contour)
    triangles = np.concatenate([side_triangles(stations, corners, closed=True), end, end + corners * (stations - 1)])
    ends = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    distinct, shared = np.unique(ends, axis=0, return_counts=True)
    assert set(shared) == {2}
    assert len(np.unique(triangles)) - len(distinct) + len(triangles) == 2


def test_the_ends_of_a_hollow_section_are_covered_once_and_nothing_else_is():
    areas = [area(HOLLOW.vertices[triangle]) for triangle in end_triangles(HOLLOW.vertices)]
    assert min(areas) > 0.0
    assert sum(areas) == pytest.approx(area(HOLLOW.vertices))


def test_sharp_corners_are_edges_and_a_round_section_has_its_outermost_points():
    assert edges(BOX.section)[0].tolist() == [0, 1, 2, 3]
    assert edges(TUBE)[0].tolist() == [0, 6, 12, 18]
