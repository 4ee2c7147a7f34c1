"""Sections that cannot be, each refused in one sentence."""

import numpy as np
import pytest

from beamenv.blade.presets import blade_config
from beamenv.structure import (
    BoxSection,
    RotatingBeam,
    WallsSection,
    Web,
)
from tests.structure.aluminium import ALUMINIUM, classical

BOX = {"shape": "box", "width": 0.2, "depth": 0.06, "thickness": 0.004}
REFUSED = {
    "no such shape": (
        {"shape": "star"},
        r"section\.shape is 'star' \(did you mean strip\?\), but must be one of box, tube",
    ),
    "a field missing": ({"shape": "box", "width": 0.2}, r"section\.depth is missing"),
    "walls that fill it": ({**BOX, "thickness": 0.07}, r"section\.thickness is 0\.07, but must be below 0\.06 m, where walls meet"),
    "a web beside it": (
        {**BOX, "webs": [{"position": 1.2}]},
        r"webs\[0\]\.position is 1\.2, but must be a number above 0 and below 1",
    ),
    "webs that cross": (
        {**BOX, "webs": [{"position": 0.5}, {"position": 0.5, "name": "level", "tilt_deg": 90.0}]},
        r"webs\[1\]\.position is 0\.5, but must be one at which it crosses no other web",
    ),
    "a thickness of no wall": (
        {**BOX, "thicknesses": {"spar": 0.01}},
        r"thicknesses is 'spar', but must be for walls of the section",
    ),
    "a contour that crosses itself": (
        {"shape": "polygon", "corners": [[0, 0], [1, 1], [1, 0], [0, 1.5]], "edge_walls": ["a"] * 4, "thickness": 0.01},
        r"section\.corners is .*, but must be (distinct|those of a mid-line that neither crosses)",
    ),
    "no profile": (
        {"shape": "airfoil", "chord": 0.3, "thickness": 0.001, "profile": "Clark Y"},
        r"profile is 'Clark Y'.*NACA and four",
    ),
    "coordinates in percent": (
        {"shape": "airfoil", "chord": 0.3, "thickness": 0.001, "coordinates": [[100, 0.1], [50, 6], [0, 0], [50, -6], [100, -0.1]]},
        r"coordinates\[0\] is \[100\.0, 0\.1\], but must be a point over the chord, .* percentages",
    ),
    "coordinates in metres": (
        {"shape": "airfoil", "chord": 0.3, "thickness": 0.001, "coordinates": [[0.3, 0.01], [0.1, 0.02], [0, 0], [0.1, -0.02]] * 2},
        r"coordinates is .*, but must be points over the chord, .* not in metres: the last lie at x = 0\.3",
    ),
    "webs of one name": (
        {**BOX, "webs": [{"position": 0.3}, {"position": 0.6}]},
        r"section\.webs\[1\]\.name is 'web', but must be another name than those of the other walls: right, top, left, bottom, web",
    ),
    "walls that meet like a needle": (
        {"shape": "walls", "thickness": 0.002, "lines": {"a": [[0, 0], [0.2, 0], [0.1, 0.01]]}},
        r"section\.lines is \[\[0\.0, 0\.0\], .*, 0\.01\]\], but must be points whose walls meet at 10° or more: .* 5\.71°",
    ),
    "a piece shorter than its corners": (
        {"shape": "walls", "thickness": 0.002, "lines": {"a": [[0, 0], [0.2, 0], [0.2, 0.001], [0.4, 0.001]]}},
        r"section\.thickness is 0\.002, but must be below 0\.001 m: piece 2 of wall 'a' is 0\.001 m long, beside a corner of 90°",
    ),
    "a skin that fills its tail": (
        {"shape": "airfoil", "chord": 0.3, "thickness": 0.01},
        r"thickness is 0\.01, but must be below 0\.004",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_section_that_cannot_be_is_refused_in_one_sentence(case):
    section, words = REFUSED[case]
    with pytest.raises(ValueError, match=words) as refusal:
        blade_config("thesis", {"beam": {"section": section}})
    assert str(refusal.value).count(". ") == 0


MESHED = {
    "a web at a corner": (BoxSection(0.2, 0.06, 0.004, webs=(Web(0.99),)), "too near to a corner, an end or another web"),
    "webs too close": (
        BoxSection(0.2, 0.06, 0.004, webs=(Web(0.5, "a"), Web(0.51, "b"))),
        "too near to a corner, an end or another web",
    ),
    "a wall that ends nowhere": (
        WallsSection({"top": [[0.03, 0.02], [-0.03, 0.02]], "web": [[0.0, -0.02], [0.0, 0.01]]}, 0.002),
        "wall 'web' must end on another wall",
    ),
    "walls that cross": (
        WallsSection({"top": [[0.03, 0.02], [-0.03, 0.02]], "web": [[0.0, -0.02], [0.0, 0.03]]}, 0.002),
        "walls 'top' and 'web' that cross",
    ),
}


@pytest.mark.parametrize("case", MESHED)
def test_walls_that_cannot_stand_on_one_another_are_refused_in_one_sentence(case):
    section, words = MESHED[case]
    with pytest.raises(ValueError, match=words):
        section.properties(ALUMINIUM)


@pytest.mark.parametrize("case", MESHED)
def test_a_blade_of_walls_that_cannot_stand_is_refused_in_the_same_sentence(case):
    section, words = MESHED[case]
    beam = RotatingBeam(section=section, layup=ALUMINIUM, length=1.0)
    with pytest.raises(ValueError, match=words):
        beam.matrices  # noqa: B018


def test_walls_that_close_a_cell_are_refused_for_a_polygon_has_them():
    around = [[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1], [0.0, 0.0]]
    with pytest.raises(ValueError, match="walls that close no cell: closed ones are a polygon"):
        WallsSection({"all": around}, 0.002)


def test_half_a_needles_walls_take_what_their_mitre_says():
    """A piece between a loose end and a corner of interior angle β has room up to h = 2 L tan(β/2), and the mesh says the same."""
    length, angle = 0.02, np.radians(25.0)
    end = [0.2 - length * np.cos(angle), length * np.sin(angle)]
    limit = 2.0 * length * np.tan(0.5 * angle)
    lines = {"a": [[0.0, 0.0], [0.2, 0.0], end]}
    assert classical(WallsSection(lines, 0.999 * limit))[0, 0] > 0.0
    with pytest.raises(ValueError, match=f"below {limit:.4g} m: piece 2"):
        WallsSection(lines, 1.001 * limit)
