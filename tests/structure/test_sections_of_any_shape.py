"""Boxes, tubes, airfoils and webs against 2-D finite elements and textbooks."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from beamenv.structure import (
    GRAPHITE_EPOXY,
    AirfoilSection,
    BoxSection,
    Lamina,
    Layup,
    TubeSection,
    Web,
)
from tests.structure.aluminium import ALUMINIUM, DENSITY, E, G, classical

DATA = Path(__file__).parents[1] / "data"
SIX = {name: np.array(rows) for name, rows in json.loads((DATA / "sections_6x6.json").read_text()).items()}
AS4 = Lamina(E1=141.963e9, E2=9.7906e9, G12=5.99844e9, G13=5.99844e9, G23=4.79875e9, nu12=0.42, density=1444.8)


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


@pytest.mark.parametrize("points", [12, 30, 40, 100])
def test_coordinates_of_an_airfoil_do_wherever_they_are_cut(points):
    """A point just before the tail leaves no sliver: stiffness within 0.5 % of the profile's own points, 3 % where there are 12."""
    x = 0.5 * (1.0 + np.cos(np.linspace(0.0, np.pi, points)))
    half = 0.6 * (0.2969 * np.sqrt(x) - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1015 * x**4)
    around = [*zip(x, half, strict=True), *zip(x[-2::-1], -half[-2::-1], strict=True)]
    found = np.diag(classical(AirfoilSection(0.3, 0.001, coordinates=tuple((float(a), float(b)) for a, b in around))))
    named = np.diag(classical(AirfoilSection(0.3, 0.001)))
    np.testing.assert_allclose(found, named, rtol=0.03 if points < 30 else 0.005)
