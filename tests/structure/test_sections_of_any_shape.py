"""Tubes, airfoils, webs and open walls against 2-D finite elements and textbooks."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from beamenv.blade.presets import blade_config
from beamenv.structure import (
    GRAPHITE_EPOXY,
    AirfoilSection,
    BoxSection,
    CSection,
    ISection,
    Lamina,
    Laminate,
    Layup,
    RotatingBeam,
    StripSection,
    TubeSection,
    WallsSection,
    Web,
    ZSection,
)

DATA = Path(__file__).parents[1] / "data"
SIX = {name: np.array(rows) for name, rows in json.loads((DATA / "sections_6x6.json").read_text()).items()}
E, NU, DENSITY = 70e9, 0.3, 2700.0
G = E / (2.0 * (1.0 + NU))
ALUMINIUM = Layup.uniform(Lamina.isotropic(E, NU, DENSITY), [0.0])
AS4 = Lamina(E1=141.963e9, E2=9.7906e9, G12=5.99844e9, G13=5.99844e9, G23=4.79875e9, nu12=0.42, density=1444.8)


def classical(section, layup=ALUMINIUM):
    return section.properties(layup).classical_stiffness


def differences(found, wanted):
    """Over the root of the product of the diagonals."""
    unit = np.sqrt(np.diag(wanted))
    return (found - wanted) / np.outer(unit, unit)


def test_two_cell_box_has_the_stiffness_of_finite_elements():
    """T1: all 36 within 0.1 % (0.08 reached); its centres within 0.1 mm of 260."""
    found = BoxSection(0.20, 0.06, 0.004, webs=(Web(0.35),)).properties(ALUMINIUM)
    assert np.abs(differences(found.stiffness, SIX["T1-two-cell-isotropic"])).max() < 1e-3
    np.testing.assert_allclose(found.tension_centre, [-0.0029167, 0.0], atol=1e-6)
    np.testing.assert_allclose(found.shear_centre, [-0.0059687, 0.0], atol=1e-5)


def test_two_cell_box_of_oblique_plies_has_the_stiffness_of_a_fine_grid():
    """Couplings of both cells, a web whose plies are not the walls': within 0.15 % of 9-node elements on a grid of 1 mm."""
    wanted = np.array(json.loads((DATA / "two_cell_oblique.json").read_text(encoding="utf-8"))["stiffness"])
    layup = Layup.by_wall(GRAPHITE_EPOXY, right=[30.0], top=[30.0], left=[30.0], bottom=[30.0], web=[45.0])
    found = BoxSection(0.20, 0.06, 0.004, webs=(Web(0.35),)).properties(layup).stiffness
    assert np.abs(differences(found, wanted)).max() < 1.5e-3
    assert np.abs(found[2, 5]) > 0.1 * np.sqrt(found[2, 2] * found[5, 5])  # what extends it twists it


def test_naca_0012_skin_is_the_reference_s_by_its_name():
    """Its 61 corners within a micrometre, its stiffness within 0.1 %."""
    with open(DATA / "sections_corners.csv", encoding="utf-8") as file:
        corners = [[float(row["x_m"]), float(row["y_m"])] for row in csv.DictReader(file) if row["name"].startswith("A1")]
    section = AirfoilSection(0.30, 0.0015)
    np.testing.assert_allclose(section.vertices, corners, atol=1e-6)
    assert np.abs(differences(section.properties(ALUMINIUM).stiffness, SIX["A1-naca0012-isotropic"])).max() < 1e-3


def test_elliptic_tube_of_oblique_plies_has_the_stiffness_of_finite_elements():
    """E2: within 0.2 %, with corners at other places around the same ellipse."""
    found = TubeSection(0.20, 0.10, 0.003).properties(Layup.uniform(AS4, [30.0] * 6)).stiffness
    assert np.abs(differences(found, SIX["E2-ellipse-CUS30"])).max() < 2e-3


def test_walls_of_different_thickness_meet_at_mitred_corners():
    """EA and EI are those of the larger rectangle less the smaller, to rounding."""
    width, depth, flange, web = 0.1, 0.06, 0.006, 0.003
    found = classical(BoxSection(width, depth, flange, thicknesses={"left": web, "right": web}))
    outer, inner = (width + web, depth + flange), (width - web, depth - flange)
    assert found[0, 0] == pytest.approx(E * (outer[0] * outer[1] - inner[0] * inner[1]), rel=1e-10)
    assert found[1, 1] == pytest.approx(E * (outer[0] * outer[1] ** 3 - inner[0] * inner[1] ** 3) / 12.0, rel=1e-10)
    assert found[2, 2] == pytest.approx(E * (outer[1] * outer[0] ** 3 - inner[1] * inner[0] ** 3) / 12.0, rel=1e-10)


def bredt(width, depth, thickness, webs, web):
    """GJ of a box with upright webs at some x: shear flows of the cells from equal twist (Bredt 1896; Megson 2017, §19)."""
    at = [-0.5 * width, *webs, 0.5 * width]
    areas = depth * np.diff(at)
    system = np.zeros((len(areas),) * 2)
    for cell, long in enumerate(np.diff(at)):
        system[cell, cell] = 2.0 * long / thickness
        for other in (cell - 1, cell + 1):
            inside = 0 <= other < len(areas)
            shared = depth / (web if inside else thickness)
            system[cell, cell] += shared
            if inside:
                system[cell, other] -= shared
    return G * 2.0 * areas @ np.linalg.solve(system, 2.0 * areas)


def test_three_cells_twist_as_bredt_says_the_more_the_thinner_they_are():
    """What is left halves with the thickness: torsion of the walls themselves and the corners."""
    left = []
    for thickness in (2e-3, 1e-3, 5e-4):
        webs = (Web(0.3, "front"), Web(0.75, "rear"))
        section = BoxSection(0.20, 0.06, thickness, webs=webs, thicknesses={"front": 0.5 * thickness, "rear": 0.5 * thickness})
        left.append(classical(section)[3, 3] / bredt(0.20, 0.06, thickness, [-0.04, 0.05], 0.5 * thickness) - 1.0)
    assert left[0] < 0.01
    np.testing.assert_allclose(np.divide(left[:-1], left[1:]), 2.0, atol=0.1)


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0])
def test_a_web_has_the_mass_of_its_length_at_any_tilt(angle):
    box, web = BoxSection(0.2, 0.06, 0.002), Web(0.5, "web", angle)
    more = (
        BoxSection(0.2, 0.06, 0.002, webs=(web,)).properties(ALUMINIUM).mass_per_length - box.properties(ALUMINIUM).mass_per_length
    )
    length = (0.2 if angle == 90.0 else 0.06 / np.cos(np.radians(angle))) - 0.002 / np.cos(np.radians(angle % 90.0))
    assert more == pytest.approx(DENSITY * 0.002 * length, rel=1e-9)


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


def test_tables_of_twist_and_size_are_the_even_laws_where_they_are_straight():
    """One piece exactly; two of which neither changes anything within 1e-4, for their sizes are others."""
    beam = {"taper": 1.7, "pretwist_deg": 20.0}
    even = blade_config("thesis", {"beam": beam}).beam.build().natural_frequencies(200.0, 8)
    halfway = 0.5 * (1.0 + 1.0 / 1.7)
    one = {"chord_table": [[0.0, 1.0], [1.0, 1.0 / 1.7]], "twist_table": [[0.0, 0.0], [1.0, 20.0]]}
    two = {"chord_table": [[0.0, 1.0], [0.5, halfway], [1.0, 1.0 / 1.7]], "twist_table": [[0.0, 0.0], [0.25, 5.0], [1.0, 20.0]]}
    for tables, within in ((one, 1e-12), (two, 1e-4)):
        found = blade_config("thesis", {"beam": tables}).beam.build().natural_frequencies(200.0, 8)
        np.testing.assert_allclose(found, even, rtol=within)


def test_a_step_in_twist_rate_is_between_the_blades_of_either_rate():
    def first_torsion(table):
        modes = blade_config("thesis", {"beam": {"twist_table": table}}).beam.build().modes(200.0, 6)
        return float(modes.natural_frequencies[modes.families.index("twist")])

    slow, fast = first_torsion([[0.0, 0.0], [1.0, 10.0]]), first_torsion([[0.0, 0.0], [1.0, 40.0]])
    both = first_torsion([[0.0, 0.0], [0.5, 5.0], [1.0, 25.0]])
    assert min(slow, fast) < both < max(slow, fast)


BOX = {"shape": "box", "width": 0.2, "depth": 0.06, "thickness": 0.004}
REFUSED = {
    "no such shape": ({"shape": "star"}, r"section\.shape is 'star', but must be one of box, tube, polygon, airfoil"),
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


def test_walls_by_their_lines_are_the_same_section_as_by_its_name():
    lines = {"top": [[0.03, 0.05], [-0.03, 0.05]], "bottom": [[-0.03, -0.05], [0.03, -0.05]], "web": [[0.0, -0.05], [0.0, 0.05]]}
    by_lines, by_name = classical(WallsSection(lines, 0.003)), classical(ISection(0.06, 0.1, 0.003))
    np.testing.assert_allclose(np.diag(by_lines), np.diag(by_name), rtol=1e-9)


@pytest.mark.parametrize("points", [12, 30, 40, 100])
def test_coordinates_of_an_airfoil_do_wherever_they_are_cut(points):
    """A point just before the tail leaves no sliver: stiffness within 0.5 % of the profile's own points, 3 % where there are 12."""
    x = 0.5 * (1.0 + np.cos(np.linspace(0.0, np.pi, points)))
    half = 0.6 * (0.2969 * np.sqrt(x) - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1015 * x**4)
    around = [*zip(x, half, strict=True), *zip(x[-2::-1], -half[-2::-1], strict=True)]
    found = np.diag(classical(AirfoilSection(0.3, 0.001, coordinates=tuple((float(a), float(b)) for a, b in around))))
    named = np.diag(classical(AirfoilSection(0.3, 0.001)))
    np.testing.assert_allclose(found, named, rtol=0.03 if points < 30 else 0.005)


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
