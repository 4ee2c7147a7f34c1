"""Classical stiffness of laminated boxes against 2-D finite elements (ANBA4, itself within 0.4 % of VABS)."""

import re

import numpy as np
import pytest

from beamenv.structure import BoxSection, Layup

NAMES = ("EA", "EI_flap", "EI_lag", "GJ", "extension-twist", "flap-twist")
COLUMNS = ("EA_N", "EI_flap_Nm2", "EI_lag_Nm2", "GJ_Nm2", "extension_twist_Nm", "flap_twist_Nm2")
BOXES = ("CUS-30-0.537in", "CP-0-0.537in", "CAS-30-0.537in", "CUS-15-0.530in")


def contour_angles(text):
    """[30/-30]x3, from the span and outermost ply first, as angles from the contour tangent and innermost ply first."""
    angles, repeats = re.fullmatch(r"\[([-/\d]+)\]x(\d)", text).groups()
    return [90.0 - float(angle) for angle in angles.split("/")][::-1] * int(repeats)


@pytest.fixture
def boxes(table, graphite_of_the_elements):
    """By name: section, lay-up and the elements' stiffnesses."""

    def box(row):
        wall = row["wall_m"]
        section = BoxSection(row["outer_width_m"] - wall, row["outer_depth_m"] - wall, wall)
        plies = {"top": row["top"], "bottom": row["bottom"], "left": row["sides"], "right": row["sides"]}
        layup = Layup.by_wall(graphite_of_the_elements, **{name: contour_angles(text) for name, text in plies.items()})
        return section, layup, dict(zip(NAMES, (row[column] for column in COLUMNS), strict=True))

    return {row["name"]: box(row) for row in table("box_sections.csv")}


def stiffnesses(section, layup, **theory):
    matrix = section.stiffness(layup, **theory)
    values = [*np.diag(matrix), abs(matrix[0, 3]), abs(matrix[1, 3])]
    return dict(zip(NAMES, values, strict=True))


def percent_off(found, reference):
    """Deviations in % of what the elements find to be other than zero."""
    return {name: 100.0 * (found[name] / reference[name] - 1.0) for name in NAMES if reference[name]}


def test_lay_up_of_the_reference_is_turned_inside_out():
    assert contour_angles("[30/-15]x2") == [105.0, 60.0, 105.0, 60.0]


@pytest.mark.parametrize("shear", ["first_order", "higher_order"])
def test_wall_stiffness_agrees_with_finite_elements(boxes, shear, thesis_world):
    """By wall kinematics: all within 3 %; EA, couplings and all of CAS within 0.6 %, GJ within 1.7 %; bending of CUS boxes is the
    worst, −2.75 %.

    The cross-ply box's GJ, −1.68 %, is Bredt's to every digit: the elements have solid corners.
    """
    assert set(boxes) == set(BOXES)
    for name, (section, layup, reference) in boxes.items():
        off = percent_off(stiffnesses(section, layup, shear=shear, **thesis_world), reference)
        assert max(map(abs, off.values())) < 3.0, (name, off)
        assert abs(off["EA"]) < 0.6
        assert abs(off["GJ"]) < 1.7
        assert all(abs(off[coupling]) < 0.6 for coupling in NAMES[4:] if coupling in off)
        if name.startswith("CAS"):
            assert max(map(abs, off.values())) < 0.6


def test_solid_elements_agree_with_solid_elements(boxes):
    """Boxes of one angle a wall within 0.3 %, thick walls, corners and all; cross plies within 0.55 %: through the wall one cubic
    follows them, which strain in thickness one by one (0.09 % with polynomials of order twelve).
    """
    for name, (section, layup, reference) in boxes.items():
        off = percent_off(stiffnesses(section, layup), reference)
        assert max(map(abs, off.values())) < (0.55 if name.startswith("CP") else 0.3), (name, off)


@pytest.mark.parametrize(
    ("box", "expected"),
    [
        ("CUS-30-0.537in", {"EA": 0.0, "EI_flap": 29.5, "EI_lag": 64.6, "GJ": -1.1, "extension-twist": -0.1}),
        ("CUS-15-0.530in", {"EA": 0.0, "EI_flap": 27.2, "EI_lag": 57.2, "GJ": -1.3, "extension-twist": -0.1}),
        ("CAS-30-0.537in", {"EA": 8.1, "EI_flap": 12.3, "EI_lag": 24.5, "GJ": 6.9, "flap-twist": -14.5}),
        ("CP-0-0.537in", {"EA": -0.6, "EI_flap": -0.9, "EI_lag": -1.2, "GJ": -1.7}),
    ],
)
def test_shear_flow_of_the_thesis_overestimates_off_axis_walls(boxes, box, expected):
    """Percent off the elements: the thesis' side walls cannot relax in shear. Cross plies are untouched."""
    section, layup, reference = boxes[box]
    off = percent_off(stiffnesses(section, layup, model="thesis"), reference)
    assert off == pytest.approx(expected, abs=0.06)  # own output: guards, does not prove


def test_shear_flows_agree_where_stretch_and_shear_do_not_couple(boxes):
    """K15 = 0 for plies along and across: the tables of the thesis at θ = 0 stand."""
    section, layup, _ = boxes["CP-0-0.537in"]
    one, other = (section.stiffness(layup, shear_flow=flow, model="thesis") for flow in ("consistent", "thesis"))
    assert one == pytest.approx(other, rel=1e-12, abs=1e-6)


def test_antisymmetric_sides_of_the_cas_box_couple_extension_and_twist_by_half_a_percent(
    boxes, graphite_of_the_elements, thesis_world
):
    """0.45 % of √(EA GJ), where the elements print zero: [±30] stacks twist as they stretch, and both sides the same way round.

    With one side stacked in the opposite order the coupling is zero and nothing else changes by more than 0.01 %.
    """
    section, layup, _ = boxes["CAS-30-0.537in"]
    found = stiffnesses(section, layup, **thesis_world)
    share = found["extension-twist"] / np.sqrt(found["EA"] * found["GJ"])
    assert share == pytest.approx(0.0045, abs=1e-4)  # own output: guards, does not prove
    opposed = {"top": [60] * 6, "bottom": [120] * 6, "left": [120, 60] * 3, "right": [60, 120] * 3}
    without = stiffnesses(section, Layup.by_wall(graphite_of_the_elements, **opposed), **thesis_world)
    assert without["extension-twist"] == pytest.approx(0.0, abs=1e-9 * without["EA"])
    for name in ("EA", "EI_flap", "EI_lag", "GJ", "flap-twist"):
        assert without[name] == pytest.approx(found[name], rel=1e-4)
