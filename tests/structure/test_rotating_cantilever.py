"""Uniform Euler–Bernoulli beams against frequencies that Wright (1982), Hodges (1981), Yoo (1998) and Chung (2002) print too.

The reference has neither rotary inertia nor shear; rigid theory has no shear either, but a real section has rotary inertia, which
lowers the n-th frequency by about ½ (nπ r/L)², r being the radius of gyration. At L/r = 5000 that is 3e-6 in the fourth mode,
so 1e-5 is asked where 1e-4 is wanted; at L/r = 500 it would be 3e-4, and a test shows that this is all there is.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

from beamenv.structure import BoxSection, Lamina, Layup, Ply, PolygonSection, RotatingBeam

MODES = ("mode1", "mode2", "mode3", "mode4")
SLENDERNESS = 5000.0
SQUARE = BoxSection(width=0.1, depth=0.1, thickness=0.002)
WITHOUT_POISSON = Layup.uniform(Lamina.isotropic(E=70e9, nu=0.0, density=2700.0), angles_deg=[0])
"""Whose sections keep their shape in bending, so that the clamp holds nothing back, as in the reference."""


def reference_of(rows):
    return np.array([[row[mode] for mode in MODES] for row in rows])


def worst_deviation(computed, rows):
    return np.abs(np.array(computed) / reference_of(rows) - 1.0).max()


def bending_time(beam, bending_stiffness):
    """T = √(m L⁴/EI), s, with m from the lengths of the walls."""
    corners = beam.section.vertices
    lengths = np.hypot(*(np.roll(corners, -1, axis=0) - corners).T)
    density = [np.mean([ply.material.density for ply in beam.layup.plies(wall)]) for wall in beam.section.walls]
    mass_per_length = beam.section.thickness * lengths @ density
    return np.sqrt(mass_per_length * beam.length**4 / bending_stiffness)


def one_plane_frequencies(rows, layup, motion, slenderness, world):
    """Frequencies times T of a square box, bending in one plane alone."""
    stretch, bending = np.diag(SQUARE.stiffness(layup, shear="rigid", **world))[:2]
    length = slenderness * np.sqrt(bending / stretch)
    found = []
    for row in rows:
        beam = RotatingBeam(SQUARE, layup, length, hub_radius=row["hub_ratio"] * length, shear="rigid", terms=12, **world)
        time = bending_time(beam, bending)
        found.append(time * beam.natural_frequencies(row["speed"] / time, 4, (motion,), gyroscopic=False))
    return found


@pytest.mark.parametrize(("motion", "family"), [("flap", "flap"), ("chord", "lag")])
def test_slender_beam_spins_up_as_published(table, motion, family, world):
    """Four modes, speeds to 12, hubs of 0 and 0.1 L: within 1e-5 (3e-6 reached)."""
    rows = [row for row in table("rotating_cantilever.csv") if row["motion"] == motion]
    assert len(rows) == 18
    assert worst_deviation(one_plane_frequencies(rows, WITHOUT_POISSON, family, SLENDERNESS, world), rows) < 1e-5


def test_clamp_holds_back_poissons_contraction_near_it_alone(table, isotropic):
    """However slender the beam is: by 1.2e-4 at L/r = 5000, where it is 2000 depths long and polynomials have twelve terms."""
    rows = [row for row in table("rotating_cantilever.csv") if row["motion"] == "flap"]
    found = one_plane_frequencies(rows, isotropic, "flap", SLENDERNESS, {})
    assert np.all(np.array(found) > reference_of(rows) * (1.0 - 1e-5))
    assert worst_deviation(found, rows) < 1.5e-4


def test_what_is_left_is_rotary_inertia(table, isotropic, thesis_world):
    """Ten times the slenderness, a hundredth of the deviation; always to lower frequencies."""
    rows = [row for row in table("rotating_cantilever.csv") if row["motion"] == "flap"]
    stout, slender = (
        np.array(one_plane_frequencies(rows, isotropic, "flap", slenderness, thesis_world)) / reference_of(rows) - 1.0
        for slenderness in (SLENDERNESS / 10.0, SLENDERNESS)
    )
    assert np.all(stout < 0.0)
    assert stout[:, 3] / slender[:, 3] == pytest.approx(100.0, rel=0.05)
    assert stout[0] == pytest.approx([-0.9e-5, -7e-5, -1.6e-4, -2.9e-4], rel=0.2)


def box_with_its_mass_in_the_middle(share):
    """Stiff, nearly massless walls around heavy, soft middle pieces of top and bottom, ``share`` of the width.

    At L√(A/I) = 70 the rotary inertia of a homogeneous section would take 1.5 % from the fourth mode. Here the mass sits within
    ``share`` of the half width from the flap axis: its rotary inertia is share² of that and less.
    """
    c, b, k = 0.1, 0.05, 0.1 * share
    corners = ((c, -b), (c, b), (k, b), (-k, b), (-c, b), (-c, -b), (-k, -b), (k, -b))
    walls = ("right", "top right", "top middle", "top left", "left", "bottom left", "bottom middle", "bottom right")
    stiff = Lamina.isotropic(E=70e9, nu=0.3, density=1e-3)
    heavy = Lamina.isotropic(E=70e6, nu=0.3, density=1e5)
    plies = {wall: (Ply(heavy if "middle" in wall else stiff, 0.0),) for wall in walls}
    return PolygonSection(corners, walls, thickness=0.001), Layup(default=None, walls=plies)


def test_lag_and_stretch_couple_as_chung_and_yoo_found(table, thesis_world):
    """α = L√(A/I) = 70, speeds to 30, the fourth mode at rest being the stretch: within 1e-5 (6e-7 reached).

    They vibrate about the beam unstretched, as the thesis does: at such speeds its own pull would strain the root by a tenth.
    """
    rows = [row for row in table("rotating_cantilever.csv") if row["motion"] == "chord-stretch"]
    section, layup = box_with_its_mass_in_the_middle(share=0.01)
    stiffness = section.stiffness(layup, shear="rigid", **thesis_world)
    length = 70.0 * np.sqrt(stiffness[2, 2] / stiffness[0, 0])
    found = []
    for row in rows:
        beam = RotatingBeam(section, layup, length, hub_radius=row["hub_ratio"] * length, shear="rigid", terms=16, **thesis_world)
        time = bending_time(beam, stiffness[2, 2])
        found.append(time * beam.natural_frequencies(row["speed"] / time, 4, ("lag", "extension")))
    assert len(rows) == 22
    assert worst_deviation(found, rows) < 1e-5
    families = beam.modes(0.0, 4, ("lag", "extension")).families
    assert families == ("lag", "lag", "lag", "extension")
    assert found[0][3] == pytest.approx(np.pi / 2.0 * 70.0, rel=1e-6)


def box_with_bending_ratio(ratio, layup, world):
    """A box whose EI_lag is ``ratio`` times its EI_flap: the soft axis bends out of plane at zero presetting."""

    def section(width):
        return BoxSection(width, depth=0.1, thickness=0.002)

    def excess(width):
        stiffness = section(width).stiffness(layup, shear="rigid", **world)
        return stiffness[2, 2] / stiffness[1, 1] - ratio

    return section(brentq(excess, 0.1, 2.0, xtol=1e-14, rtol=1e-14))


def test_pretwisted_beam_spins_up_as_published(table, world):
    """Pretwist to 90°, presetting to 90°, speeds to 12, EI ratio 16: within 1e-5 (2e-6 reached)."""
    rows = table("pretwisted_cantilever.csv")
    section = box_with_bending_ratio(16.0, WITHOUT_POISSON, world)
    stretch, flap, lag, _ = np.diag(section.stiffness(WITHOUT_POISSON, shear="rigid", **world))
    length = SLENDERNESS * np.sqrt(lag / stretch)
    found = []
    for row in rows:
        twist = {"pretwist_deg": row["pretwist_deg"], "presetting_deg": row["presetting_deg"]}
        beam = RotatingBeam(section, WITHOUT_POISSON, length, shear="rigid", terms=12, **twist, **world)
        time = bending_time(beam, flap)
        found.append(time * beam.natural_frequencies(row["speed"] / time, 4, ("lag", "flap"), gyroscopic=False))
    assert len(rows) == 28
    assert worst_deviation(found, rows) < 1e-5
