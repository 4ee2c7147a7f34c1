"""What patches do to a blade when no voltage is on: their own mass and stiffness."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.patches import MFC, PatchLayout, patch_force
from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Inlay, Lamina, Layup, Ply, RotatingBeam

ALUMINIUM = Lamina.isotropic(E=70e9, nu=0.3, density=2700.0)
SECTION = BoxSection(width=0.2, depth=0.05, thickness=0.004)
BARE = RotatingBeam(SECTION, Layup.uniform(ALUMINIUM, angles_deg=[0]), length=2.0, model="thesis", shear="rigid")
"""Of walls as the thesis has them, whose law of mixtures is known by hand."""
START, LENGTH, WIDTH = 0.3, 0.085, 0.057
PATCHED = replace(BARE, inlays=(MFC.inlay("top", START, LENGTH, WIDTH),))


def stretch_entry(beam, matrix):
    """The entry of the first stretch function, s = z/L."""
    column = beam.space.columns(("extension",))[0]
    return getattr(beam.matrices, matrix)[column, column]


def test_patch_adds_the_mass_by_which_it_is_heavier_than_what_it_replaces():
    """(ρp − ρh) t w per metre: 0.047 kg/m, 4 g in all; ∫Δm (z/L)² dz in the mass matrix."""
    added = (MFC.lamina.density - ALUMINIUM.density) * MFC.thickness * WIDTH
    assert added * LENGTH == pytest.approx(4e-3, rel=0.01)
    expected = added * ((START + LENGTH) ** 3 - START**3) / (3.0 * BARE.length**2)
    assert stretch_entry(PATCHED, "mass") - stretch_entry(BARE, "mass") == pytest.approx(expected, rel=1e-9)


def test_patch_changes_the_stretching_stiffness_of_its_strip_by_the_law_of_mixtures():
    """A22 − A12²/A11 of two layers with N_ss = 0, the MFC's span modulus along z: ΔEA Lp/L² in the stiffness matrix."""
    q_host = ALUMINIUM.reduced_stiffness()
    q_patch = MFC.lamina.reduced_stiffness()
    host, patch = SECTION.thickness - MFC.thickness, MFC.thickness
    hoop = q_host[0, 0] * host + q_patch[1, 1] * patch
    mixed = q_host[0, 1] * host + q_patch[0, 1] * patch
    span = q_host[1, 1] * host + q_patch[0, 0] * patch
    change = (span - mixed**2 / hoop - ALUMINIUM.E1 * SECTION.thickness) * WIDTH
    found = stretch_entry(PATCHED, "elastic_stiffness") - stretch_entry(BARE, "elastic_stiffness")
    assert found == pytest.approx(change * LENGTH / BARE.length**2, rel=1e-6)
    assert change < 0.0


@pytest.mark.parametrize("model", ["blade", "thesis"])
@pytest.mark.parametrize("shear", ["higher_order", "first_order", "rigid"])
def test_inlay_of_the_hosts_own_material_changes_nothing(shear, model):
    layup = Layup.uniform(GRAPHITE_EPOXY, angles_deg=[30] * 6)
    bare = RotatingBeam(SECTION, layup, length=2.0, model=model, shear=shear, pretwist_deg=30.0)
    inlays = tuple(Inlay(wall, START, LENGTH, WIDTH, Ply(GRAPHITE_EPOXY, 30.0), 3e-4) for wall in ("top", "bottom"))
    patched = replace(bare, inlays=inlays)
    one, other = (beam.natural_frequencies(0.0, 8) for beam in (bare, patched))
    assert other == pytest.approx(one, rel=1e-3)  # elements of another size: frequencies within 0.1 %
    if model == "blade":
        return
    for name in ("mass", "elastic_stiffness", "spin_stiffness", "gyroscopic"):
        one, other = getattr(bare.matrices, name), getattr(patched.matrices, name)
        assert other == pytest.approx(one, abs=1e-10 * np.abs(one).max())


@pytest.mark.parametrize(("model", "shear_flow"), [("blade", None), ("thesis", "consistent"), ("thesis", None)])
@pytest.mark.parametrize("width", [0.2, 0.254])
def test_inlay_over_a_whole_wall_is_another_outermost_ply(model, shear_flow, width):
    """The embedded limit: from root to tip and from edge to edge it makes a lay-up of six plies, the last of piezo material."""
    angles = {"bottom": [30] * 6, "left": [30] * 6, "right": [30] * 6}
    host = Layup.by_wall(GRAPHITE_EPOXY, top=[30] * 6, **angles)
    plies = tuple(Ply(GRAPHITE_EPOXY, 30.0) for _ in range(6))
    covered = Layup(default=plies, walls={"top": (*plies[:5], Ply(MFC.lamina, 90.0))})
    options = {"length": 2.0, "pretwist_deg": 30.0, "hub_radius": 0.2, "model": model, "shear_flow": shear_flow}
    section = replace(SECTION, width=width)
    whole = Inlay("top", 0.0, 2.0, width, Ply(MFC.lamina, 90.0), section.thickness / 6.0)
    inlaid = RotatingBeam(section, host, inlays=(whole,), **options)
    laid_up = RotatingBeam(section, covered, **options)
    same = 3e-3 if model == "blade" else 1e-8  # all sections of a blade distort in the shapes of the one without inlays
    assert inlaid.natural_frequencies(200.0, 12) == pytest.approx(laid_up.natural_frequencies(200.0, 12), rel=same)


def test_patch_force_on_a_fully_covered_wall_is_the_same_however_the_patch_got_there():
    """Embedded in the host or laid up as its outermost ply: the condensed resultants see the same wall."""
    plies = tuple(Ply(GRAPHITE_EPOXY, 30.0) for _ in range(4))
    sheet = replace(MFC, thickness=SECTION.thickness / 4.0)
    covered = Layup(default=plies, walls={"top": (*plies[:3], Ply(MFC.lamina, 90.0))})
    laid_up = RotatingBeam(SECTION, covered, length=2.0)
    inlay = sheet.inlay("top", 0.0, 2.0, SECTION.width)
    inlaid = RotatingBeam(SECTION, Layup(default=plies), length=2.0, inlays=(inlay,))
    per_volt = []
    for beam in (laid_up, inlaid):
        bent = np.linalg.solve(beam.matrices.elastic_stiffness, patch_force(beam, sheet, "top", 0.0, 2.0, SECTION.width))
        per_volt.append([rows[0] @ bent for name, rows in beam.displacements(2.0).items() if name in ("v", "s", "phi")])
    assert per_volt[1] == pytest.approx(per_volt[0], rel=1e-3)


def test_sensor_shares_of_mass_stop_at_its_edges():
    """Mass per metre jumps at the patch and only there: no smearing between stations."""
    z = np.array([0.29, 0.3001, 0.38, 0.3849, 0.39])
    mass = PATCHED.walls_at(z).inertia().mass_per_length
    bare = ALUMINIUM.density * SECTION.thickness * 2.0 * (SECTION.width + SECTION.depth)
    added = (MFC.lamina.density - ALUMINIUM.density) * MFC.thickness * WIDTH
    assert mass - bare == pytest.approx(added * np.array([0, 1, 1, 1, 0]), abs=1e-12)


def test_passive_patches_of_the_default_layout_shift_the_first_frequency_by_less_than_a_percent():
    layup = Layup.uniform(GRAPHITE_EPOXY, angles_deg=[30] * 6)
    bare = RotatingBeam(BoxSection(0.254, 0.0508, 0.01016), layup, length=2.023)
    active, idle = PatchLayout(), PatchLayout(passive=False)
    patched = replace(bare, inlays=active.inlays(bare.length))
    assert len(patched.inlays) == 8
    assert idle.inlays(bare.length) == ()
    shift = patched.natural_frequencies(0.0, 1)[0] / bare.natural_frequencies(0.0, 1)[0] - 1.0
    assert 0.0 < abs(shift) < 0.01
