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


@pytest.fixture(scope="module", params=["blade", "thesis"])
def cantilever(request):
    return RotatingBeam(SECTION, ISOTROPIC, LENGTH, model=request.param, shear="rigid")


@pytest.fixture(scope="module")
def walled():
    """Of walls as the thesis has them: by hand to round-off."""
    return RotatingBeam(SECTION, ISOTROPIC, LENGTH, model="thesis", shear="rigid")


def static_tip(beam, force):
    """u, v, s and φ of the tip at rest."""
    tip = beam.displacements(beam.length)
    bent = np.linalg.solve(beam.matrices.elastic_stiffness, force)
    return np.array([tip[field][0] @ bent for field in ("u", "v", "s", "phi")])


def unlike_elements(beam):
    """What solid sections may differ by that are cut into elements where one patch or another is: walls as the thesis has them
    are integrated exactly.
    """
    return 1.5e-3 if beam.model == "blade" else 1e-9


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
def test_tip_deflection_per_volt_is_that_of_two_opposite_moments(walled, material, start):
    """v(L) = −M/(EI) Lp (L − z_p − Lp/2) and s(L) = F Lp/EA, no lag and no twist: to round-off in rigid theory.

    The tip's share is exact although polynomials cannot follow the curvature's jumps: by reciprocity it is the work of the
    patch on the deflection under a tip load, a cubic.
    """
    stiffness = SECTION.stiffness(ISOTROPIC, shear="rigid", model="thesis")
    moment, pull = moment_per_volt(material)
    found = static_tip(walled, patch_force(walled, material, "top", start, PATCH, WIDTH))
    deflection = -moment / stiffness[1, 1] * PATCH * (LENGTH - start - 0.5 * PATCH)
    stretch = pull * PATCH / stiffness[0, 0]
    assert found[[1, 2]] == pytest.approx([deflection, stretch], rel=1e-9)
    assert found[[0, 3]] == pytest.approx(0.0, abs=1e-9 * abs(deflection))


def test_extending_the_top_bends_the_tip_down(cantilever):
    """A positive voltage lengthens the MFC above: v < 0; below it bends up by as much."""
    top, bottom = (static_tip(cantilever, patch_force(cantilever, MFC, wall, START, PATCH, WIDTH)) for wall in ("top", "bottom"))
    assert top[1] < 0.0 < top[2]
    assert bottom == pytest.approx(top * [1.0, -1.0, 1.0, 1.0], rel=unlike_elements(cantilever), abs=1e-18)


def test_force_grows_with_width_and_adds_along_the_span(cantilever):
    whole = patch_force(cantilever, MFC, "top", START, PATCH, WIDTH)
    halves = sum(patch_force(cantilever, MFC, "top", START + k * PATCH / 2, PATCH / 2, WIDTH) for k in (0, 1))
    assert halves == pytest.approx(whole, abs=1e-9 * np.abs(whole).max())
    one, two = (
        static_tip(cantilever, patch_force(cantilever, MFC, "top", START, PATCH, share * WIDTH))[1:3] for share in (1.0, 2.0)
    )
    assert two == pytest.approx(2.0 * one, rel=unlike_elements(cantilever))


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
    one, other = (
        static_tip(beam, patch_force(beam, MFC, "top", START, PATCH, WIDTH))[1:3]
        for beam in (cantilever, replace(cantilever, inlays=(inlay,)))
    )
    assert other == pytest.approx(one, rel=1e-2 * unlike_elements(cantilever))


OBLIQUE_BLADE = RotatingBeam(
    BoxSection(0.254, 0.0508, 0.01016),
    Layup.uniform(GRAPHITE_EPOXY, angles_deg=[30] * 6),
    length=2.023,
    hub_radius=0.2023,
    pretwist_deg=30.0,
)
WALLED_BLADE = replace(OBLIQUE_BLADE, model="thesis", shear_flow="consistent")
"""Of walls as the thesis has them, with a constant shear flow."""


def charge_by_quadrature(patch, start, length, width, wall):
    """(N,): ∫ē ε dA over a sheet in the oblique blade's top or bottom wall, from the strain measures written out again.

    ε is the mean over the sheet's own depth; with plies alike through the wall, N_ss = 0 leaves
    ε_ss = −[Q12 ε0 + Q26' (γ0 + h²γ2/12)]/Q11, which is the same at every depth.
    """
    beam, box = WALLED_BLADE, WALLED_BLADE.section
    across, depth, h = box.width, box.depth, box.thickness
    Q = GRAPHITE_EPOXY.transformed_stiffness(np.radians(30.0))
    relaxed = (Q[1, 2] - Q[0, 1] * Q[0, 2] / Q[0, 0]) / (Q[2, 2] - Q[0, 2] ** 2 / Q[0, 0])  # K15/K55
    nodes, weights = np.polynomial.legendre.leggauss(24)
    along, hoop = patch.piezoelectric_stress()
    total = np.zeros(beam.space.size)
    for z, weight in zip(start + 0.5 * length * (nodes + 1.0), 0.5 * length * weights, strict=True):
        rows = {key: row[0] for key, row in beam.space.evaluate(np.array([z])).items()}
        angle = np.radians(beam.pretwist_deg) * z / beam.length
        upward = 1.0 if wall == "top" else -1.0
        l, m = -upward * np.sin(angle), upward * np.cos(angle)  # noqa: E741
        for place, share in zip(0.5 * width * nodes, 0.5 * width * weights, strict=True):
            chordwise = -upward * place  # the contour goes round counter-clockwise: along −x on top, along x below
            x = chordwise * np.cos(angle) - upward * 0.5 * depth * np.sin(angle)
            y = chordwise * np.sin(angle) + upward * 0.5 * depth * np.cos(angle)
            warping = (0.5 * depth - across * depth / (across + depth)) * place
            bend_x, bend_y, stretch, bimoment = rows["theta_x", 1], rows["theta_y", 1], rows["s", 1], rows["phi", 2]
            shear = l * (rows["v", 1] + rows["theta_x", 0]) - m * (rows["u", 1] - rows["theta_y", 0])
            flexure = y * bend_x - x * bend_y - warping * bimoment
            e0 = stretch + flexure
            e1 = m * bend_x - l * bend_y - (m * x - l * y) * bimoment
            e3 = 4.0 / (3.0 * h**2) * (l * (bend_y - rows["u", 2]) - m * (bend_x + rows["v", 2]))
            g0 = shear + across * depth / (across + depth) * rows["phi", 1] - relaxed * flexure
            ess = -(Q[0, 1] * e0 + Q[0, 2] * (g0 - shear / 3.0)) / Q[0, 0]
            inner, outer = 0.5 * h - patch.thickness, 0.5 * h
            n1, n3 = ((outer ** (k + 1) - inner ** (k + 1)) / ((k + 1) * patch.thickness) for k in (1, 3))
            total += weight * share * (along * (e0 + n1 * e1 + n3 * e3) + hoop * ess)
    return total


@pytest.mark.parametrize("material", ["MFC", "PZT"])
def test_sensors_count_the_charge_of_the_strain_under_them_and_actuators_push_against_it(material):
    """Eq. 4.37 by a quadrature of its own on an oblique, pretwisted blade; per volt, thickness/spacing of it is the force."""
    layout = PatchLayout(actuators=(0.5,), sensors=(0.3, 1.2), material=material)
    patch, size = layout.only("actuators").patch, (layout.length, layout.width)
    below = np.array([charge_by_quadrature(patch, start, *size, "bottom") for start in (0.3, 1.2)])
    assert sensing(WALLED_BLADE, layout) == pytest.approx(below, abs=1e-10 * np.abs(below).max())
    above = charge_by_quadrature(patch, 0.5, *size, "top") * patch.thickness / patch.electrode_spacing
    assert actuation(WALLED_BLADE, layout)[:, 0] == pytest.approx(above, abs=1e-10 * np.abs(above).max())


def test_a_sensor_below_reads_the_bending_that_the_actuator_above_makes_with_the_opposite_sign():
    """On a blade that is symmetric top to bottom: bending part −, stretching part + the known constant times the column."""
    beam = RotatingBeam(SECTION, ISOTROPIC, LENGTH)
    layout = PatchLayout(actuators=(START,), sensors=(START,))
    column = layout.only("sensors").patch.charge_per_reaction * actuation(beam, layout)[:, 0]
    row = sensing(beam, layout)[0]
    tip = beam.displacements(LENGTH)
    bent, stretched = (np.linalg.solve(beam.matrices.elastic_stiffness, tip[field][0]) for field in ("v", "s"))
    assert row @ bent == pytest.approx(-column @ bent, rel=unlike_elements(beam))
    assert row @ stretched == pytest.approx(column @ stretched, rel=unlike_elements(beam))


def test_charge_under_a_tip_load_is_the_stress_constant_times_the_strain_under_the_patch(walled):
    """Eq. 4.37, ∫ē ε dA: e_zz ε_zz at the sheet's own depth and e_ss ε_ss with ε_ss = −ν ε0, times the patch's area."""
    load = 100.0
    layout = PatchLayout(sensors=(START,), length=PATCH, width=WIDTH, passive=False)
    bent = np.linalg.solve(walled.matrices.elastic_stiffness, load * walled.displacements(LENGTH)["v"][0])
    bending = SECTION.stiffness(ISOTROPIC, shear="rigid", model="thesis")[1, 1]
    curvature = load * (LENGTH - START - 0.5 * PATCH) / bending
    span, hoop = MFC.piezoelectric_stress()
    at_midline = 0.5 * SECTION.depth * curvature
    at_patch = (0.5 * SECTION.depth + 0.5 * (SECTION.thickness - MFC.thickness)) * curvature
    expected = (span * at_patch - hoop * NU * at_midline) * PATCH * WIDTH
    assert sensing(walled, layout)[0] @ bent == pytest.approx(expected, rel=1e-9)


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
    starts = np.linspace(0.0, 0.7 * 2.023 - 0.085, 4)
    alone = [patch_force(OBLIQUE_BLADE, MFC, "top", start, 0.085, 0.057) for start in starts]
    assert each == pytest.approx(np.column_stack(alone), abs=1e-9 * np.abs(each).max())
    assert ganged == pytest.approx(sum(alone)[:, None], abs=1e-9 * np.abs(ganged).max())


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
