"""One patch on an isotropic cantilever against hand formulas; reciprocity of actuation and sensing."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.patches import MFC, PZT, PatchLayout, actuation, patch_force, sensing
from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Inlay, Lamina, Layup, RotatingBeam

NU = 0.3
ISOTROPIC = Layup.uniform(Lamina.isotropic(E=70e9, nu=NU, density=2700.0), angles_deg=[0])
SECTION = BoxSection(width=0.2, depth=0.05, thickness=0.004)
LENGTH, START, PATCH, WIDTH = 2.0, 0.3, 0.085, 0.057


@pytest.fixture(scope="module")
def cantilever():
    return RotatingBeam(SECTION, ISOTROPIC, LENGTH, shear="rigid")


def static_tip(beam, force):
    """u, v, s and φ of the tip at rest."""
    tip = beam.displacements(beam.length)
    bent = np.linalg.solve(beam.matrices.elastic_stiffness, force)
    return np.array([tip[field][0] @ bent for field in ("u", "v", "s", "phi")])


def moment_per_volt(material):
    """M = (f0 y + f1) width about the chord: e and its moment over the sheet, per spacing, at the top wall y = d/2.

    f0 = (e_zz − ν e_ss) t, the wall being free around the section; f1 = e_zz t (h − t)/2, its first moment about the mid-line.
    """
    span, hoop = material.piezoelectric_stress() / material.electrode_spacing
    skin = material.thickness
    f0 = (span - NU * hoop) * skin
    f1 = span * skin * 0.5 * (SECTION.thickness - skin)
    return (f0 * 0.5 * SECTION.depth + f1) * WIDTH, f0 * WIDTH


@pytest.mark.parametrize("material", [MFC, PZT], ids=["MFC", "PZT"])
@pytest.mark.parametrize("start", [0.0, START, 1.2])
def test_tip_deflection_per_volt_is_that_of_two_opposite_moments(cantilever, material, start):
    """v(L) = −M/(EI) Lp (L − z_p − Lp/2) and s(L) = F Lp/EA, no lag and no twist: to round-off in rigid theory.

    The tip's share is exact although polynomials cannot follow the curvature's jumps: by reciprocity it is the work of the
    patch on the deflection under a tip load, a cubic.
    """
    stiffness = SECTION.stiffness(ISOTROPIC, shear="rigid")
    moment, pull = moment_per_volt(material)
    found = static_tip(cantilever, patch_force(cantilever, material, "top", start, PATCH, WIDTH))
    deflection = -moment / stiffness[1, 1] * PATCH * (LENGTH - start - 0.5 * PATCH)
    stretch = pull * PATCH / stiffness[0, 0]
    assert found[[1, 2]] == pytest.approx([deflection, stretch], rel=1e-9)
    assert found[[0, 3]] == pytest.approx(0.0, abs=1e-9 * abs(deflection))


def test_extending_the_top_bends_the_tip_down(cantilever):
    """A positive voltage lengthens the MFC above: v < 0; below it bends up by as much."""
    top, bottom = (static_tip(cantilever, patch_force(cantilever, MFC, wall, START, PATCH, WIDTH)) for wall in ("top", "bottom"))
    assert top[1] < 0.0 < top[2]
    assert bottom == pytest.approx(top * [1.0, -1.0, 1.0, 1.0], rel=1e-9, abs=1e-18)


def test_force_grows_with_width_and_adds_along_the_span(cantilever):
    whole = patch_force(cantilever, MFC, "top", START, PATCH, WIDTH)
    halves = sum(patch_force(cantilever, MFC, "top", START + k * PATCH / 2, PATCH / 2, WIDTH) for k in (0, 1))
    twice = patch_force(cantilever, MFC, "top", START, PATCH, 2.0 * WIDTH)
    scale = np.abs(whole).max()
    assert halves == pytest.approx(whole, abs=1e-12 * scale)
    in_bending = cantilever.space.columns(("flap", "extension"))
    assert twice[in_bending] == pytest.approx(2.0 * whole[in_bending], abs=1e-10 * scale)


def test_all_shear_theories_agree_on_a_slender_cantilever():
    """Shear theories change the deflection per volt by less than 0.5 % (the patch's moment shears nothing)."""
    found = [
        static_tip(beam, patch_force(beam, MFC, "top", START, PATCH, WIDTH))[1]
        for beam in (RotatingBeam(SECTION, ISOTROPIC, LENGTH, shear=shear) for shear in ("rigid", "first_order", "higher_order"))
    ]
    assert found == pytest.approx([found[0]] * 3, rel=5e-3)


@pytest.mark.parametrize("neighbour", [0.8, 1.3])
def test_other_cuts_of_the_wall_do_not_widen_or_narrow_a_patch(cantilever, neighbour):
    """An inlay of the host's own material elsewhere on the wall, 0.8 or 1.3 times as wide, changes nothing."""
    host = ISOTROPIC.plies("top")[0]
    inlay = Inlay("top", 1.5, 0.1, neighbour * WIDTH, host, MFC.thickness)
    one, other = (patch_force(beam, MFC, "top", START, PATCH, WIDTH) for beam in (cantilever, replace(cantilever, inlays=(inlay,))))
    assert other == pytest.approx(one, abs=1e-12 * np.abs(one).max())


OBLIQUE_BLADE = RotatingBeam(
    BoxSection(0.254, 0.0508, 0.01016),
    Layup.uniform(GRAPHITE_EPOXY, angles_deg=[30] * 6),
    length=2.023,
    hub_radius=0.2023,
    pretwist_deg=30.0,
)


@pytest.mark.parametrize("material", ["MFC", "PZT"])
def test_a_sensor_row_is_the_column_of_an_actuator_in_its_place(material):
    """Charge per displacement = spacing/thickness × force per volt of the same patch: Maxwell's reciprocity."""
    layout = PatchLayout(actuators=(0.1, 0.5), sensors=(0.3, 0.9, 1.2), material=material)
    rows = sensing(OBLIQUE_BLADE, layout)
    patch = layout.patch
    columns = [patch_force(OBLIQUE_BLADE, patch, "bottom", start, layout.length, layout.width) for start in (0.3, 0.9, 1.2)]
    assert rows.shape == (3, OBLIQUE_BLADE.space.size)
    assert rows == pytest.approx(patch.electrode_spacing / patch.thickness * np.array(columns), rel=1e-12)


def test_a_sensor_below_reads_the_bending_that_the_actuator_above_makes_with_the_opposite_sign():
    """On a blade that is symmetric top to bottom: bending part −, stretching part + the known constant times the column."""
    beam = RotatingBeam(SECTION, ISOTROPIC, LENGTH)
    layout = PatchLayout(actuators=(START,), sensors=(START,))
    column = layout.patch.charge_per_reaction * actuation(beam, layout)[:, 0]
    row = sensing(beam, layout)[0]
    flap, stretch = beam.space.columns(("flap",)), beam.space.columns(("extension",))
    assert row[flap] == pytest.approx(-column[flap], rel=1e-9, abs=1e-12 * np.abs(column).max())
    assert row[stretch] == pytest.approx(column[stretch], rel=1e-9, abs=1e-12 * np.abs(column).max())


def test_charge_under_a_tip_load_is_the_stress_constant_times_the_strain_under_the_patch(cantilever):
    """Eq. 4.37, ∫ē ε dA: e_zz ε_zz at the sheet's own depth and e_ss ε_ss with ε_ss = −ν ε0, times the patch's area."""
    load = 100.0
    layout = PatchLayout(sensors=(START,), length=PATCH, width=WIDTH, passive=False)
    bent = np.linalg.solve(cantilever.matrices.elastic_stiffness, load * cantilever.displacements(LENGTH)["v"][0])
    bending = SECTION.stiffness(ISOTROPIC, shear="rigid")[1, 1]
    curvature = load * (LENGTH - START - 0.5 * PATCH) / bending
    span, hoop = MFC.piezoelectric_stress()
    at_midline = 0.5 * SECTION.depth * curvature
    at_patch = (0.5 * SECTION.depth + 0.5 * (SECTION.thickness - MFC.thickness)) * curvature
    expected = (span * at_patch - hoop * NU * at_midline) * PATCH * WIDTH
    assert sensing(cantilever, layout)[0] @ bent == pytest.approx(expected, rel=1e-9)


def test_tip_per_volt_equals_charge_per_tip_force(cantilever):
    """Betti: what a volt on a patch moves, a force there charges, up to spacing/thickness."""
    layout = PatchLayout(sensors=(START,), length=PATCH, width=WIDTH, passive=False)
    compliance = np.linalg.inv(cantilever.matrices.elastic_stiffness)
    tip = cantilever.displacements(LENGTH)["v"][0]
    per_volt = tip @ compliance @ patch_force(cantilever, MFC, "bottom", START, PATCH, WIDTH)
    per_newton = sensing(cantilever, layout)[0] @ compliance @ tip
    assert per_newton == pytest.approx(MFC.charge_per_reaction * per_volt, rel=1e-10)


def test_ganged_actuators_push_with_the_sum_of_their_columns():
    """The thesis' first method (one voltage) against its second (one each)."""
    each, ganged = (actuation(OBLIQUE_BLADE, PatchLayout(ganged=together)) for together in (False, True))
    assert each.shape == (60, 4)
    assert ganged == pytest.approx(each.sum(axis=1, keepdims=True))


def test_patch_across_a_whole_oblique_wall_twists_what_its_mirror_image_twists_back():
    """Off-axis plies couple the patch to twist: the sign turns with the ply angle, the deflection does not."""
    tips = []
    for angle in (30, -30):
        beam = RotatingBeam(BoxSection(0.254, 0.0508, 0.01016), Layup.uniform(GRAPHITE_EPOXY, [angle] * 6), LENGTH)
        tips.append(static_tip(beam, patch_force(beam, MFC, "top", START, PATCH, 0.254)))
    assert tips[0][3] == pytest.approx(-tips[1][3], rel=1e-6)
    assert abs(tips[0][3]) > 1e-9
    assert tips[0][1:3] == pytest.approx(tips[1][1:3], rel=1e-6)


def test_presetting_turns_the_deflection_with_the_section():
    """The tip moves along the section's own normal: v at 0°, −u at 90°."""
    flat, upright = (
        static_tip(beam, patch_force(beam, MFC, "top", START, PATCH, WIDTH))
        for beam in (RotatingBeam(SECTION, ISOTROPIC, LENGTH, presetting_deg=angle) for angle in (0.0, 90.0))
    )
    assert upright[0] == pytest.approx(-flat[1], rel=1e-9)
    assert upright[1] == pytest.approx(0.0, abs=1e-9 * abs(flat[1]))
