"""Heat against textbooks: free expansion, bimetals, laminates, buckling and vibration of what is held, and reciprocity."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from beamenv.structure import BoxSection, Lamina, Layup, RotatingBeam, StripSection, TubeSection
from beamenv.structure.section.central_solution import Factorised, central_solution
from beamenv.structure.section.element_sums import element_sums
from beamenv.structure.section.expansion import ThermalSums, expansion_of
from beamenv.structure.section.section import mesh_of
from beamenv.structure.section.solid_sections import SolidSections
from beamenv.structure.sweep import frequency_sweep
from beamenv.structure.walls.laminate import Laminate, Ply

ALPHA = 23e-6
ALUMINIUM = replace(Lamina.isotropic(70e9, 0.3, 2700.0), alpha1=ALPHA, alpha2=ALPHA)
STEEL = replace(Lamina.isotropic(210e9, 0.3, 7850.0), alpha1=12e-6, alpha2=12e-6)
GRAPHITE = Lamina(206.8e9, 5.17e9, 3.1e9, 3.1e9, 2.5511e9, 0.25, 1528.15, alpha1=-0.3e-6, alpha2=28e-6)
BOX = BoxSection(0.1, 0.05, 0.004)
CLAMPED = (1e12,) * 6
MADE_AT = 300.0
KAPPA_Y = 3
"""Of the beam strains: θx′, bending in flap; 4: θy′."""


def blade(section=BOX, layup=None, length=2.0, **options):
    return RotatingBeam(section, layup or Layup.uniform(ALUMINIUM, [0.0]), length, **options)


def tip(beam, field, speed=0.0):
    return float((beam.displacements(beam.length)[field] @ beam.at(speed).steady.coefficients)[0])


def sections(section, plies, pretwist=0.0):
    laminate = Laminate.equal_plies(plies, section.thickness)
    mesh = mesh_of(section, (1.0,), (), (True,))
    return SolidSections.build(mesh, [laminate], np.zeros((1, len(mesh.edges)), dtype=int), pretwist, heated=True)


@pytest.mark.parametrize("section", [BOX, TubeSection(0.1, 0.05, 0.004), StripSection(0.05, 0.004)])
@pytest.mark.parametrize("twist", [0.0, 40.0])
def test_a_free_isotropic_blade_grows_by_alpha_times_the_rise_and_does_nothing_else(section, twist):
    hot, cold = (blade(section, temperature=temperature, pretwist_deg=twist) for temperature in (MADE_AT + 100.0, None))
    assert tip(hot, "s") == pytest.approx(ALPHA * 100.0 * hot.length, rel=1e-6)  # pretwisted warping is solved to so much
    assert max(abs(tip(hot, field)) for field in ("u", "v", "phi")) < 1e-7
    assert hot.natural_frequencies(0.0, 4) == pytest.approx(cold.natural_frequencies(0.0, 4), rel=1e-4)  # 2.3e-3 longer
    assert hot.steady_strain([1.0], 0.0) == pytest.approx(ALPHA * 100.0, rel=1e-6)


@pytest.mark.parametrize("size", [0.5, 1.0])
def test_a_difference_between_the_faces_bends_by_alpha_times_it_over_the_depth(size):
    """Away from the warmer side, on a circle; the tip then comes in by κ²L³/6."""
    section = BoxSection(0.1 * size, 0.05 * size, 0.004 * size)
    beam = blade(section, temperature=MADE_AT, temperature_difference=50.0)
    curvature = ALPHA * 50.0 / (0.054 * size)
    angle = curvature * beam.length
    assert tip(beam, "theta_x") == pytest.approx(angle, rel=2e-4)  # of second order in the stretch
    assert tip(beam, "v") == pytest.approx(-(1.0 - np.cos(angle)) / curvature, rel=2e-4)
    assert tip(beam, "s") == pytest.approx((np.sin(angle) / curvature - beam.length), rel=2e-3)


@pytest.mark.parametrize("width", [0.002, 0.1])
def test_a_two_layer_strip_bends_as_timoshenko_says(width):
    """κ = 6 (α₂ − α₁) ΔT (1 + m)² / h [3 (1 + m)² + (1 + mn)(m² + 1/mn)] with m = t₁/t₂, n = E₁/E₂ (Timoshenko, Journal of the
    Optical Society of America 11, 1925), here m = 1. Two layers of one Poisson's ratio bend so as a narrow beam and as a wide
    plate, which bends alike both ways, for E becomes E/(1 − ν) in both: to round-off whatever the width.
    """
    depth, n = 0.002, 210.0 / 70.0
    found = sections(StripSection(width, depth), (Ply(STEEL, 0.0), Ply(ALUMINIUM, 0.0))).expansion.strain[0, :, 0]
    expected = 6.0 * (ALPHA - 12e-6) * 4.0 / (depth * (12.0 + (1.0 + n) * (1.0 + 1.0 / n)))
    assert abs(found[KAPPA_Y]) == pytest.approx(expected, rel=1e-9)
    assert found[2] == pytest.approx(strain_of_two_layers(n), rel=1e-9)


def strain_of_two_layers(n):
    """Of their common face's middle, per K: both layers one unit thick, from forces and moments that are zero."""
    a = np.array([[n + 1.0, 0.5 * (1.0 - n)], [0.5 * (1.0 - n), (n + 1.0) / 3.0]])
    return float(np.linalg.solve(a, [n * 12e-6 + ALPHA, 0.5 * (ALPHA - n * 12e-6)])[0])


def test_without_contraction_a_two_layer_strip_bends_as_timoshenko_says_to_round_off():
    steel, aluminium = (replace(Lamina.isotropic(E, 0.0, 1.0), alpha1=a, alpha2=a) for E, a in ((210e9, 12e-6), (70e9, ALPHA)))
    steel, aluminium = replace(steel, alpha2=0.0), replace(aluminium, alpha2=0.0)
    found = sections(StripSection(0.02, 0.002), (Ply(steel, 90.0), Ply(aluminium, 90.0))).expansion.strain[0, :, 0]
    assert abs(found[KAPPA_Y]) == pytest.approx(24.0 * 11e-6 / (0.002 * (12.0 + 16.0 / 3.0)), rel=1e-9)


@pytest.mark.parametrize("angles", [[0.0, 90.0, 90.0, 0.0], [90.0, 0.0], [30.0, -30.0, 30.0, 60.0]])
def test_a_wide_strip_expands_bends_and_twists_as_lamination_theory_says(angles):
    """[A B; B D]⁻¹ ∫Q̄α (1, n) dn: what is left, 0.3 %, is at the free edges of a strip 100 times as wide as it is thick."""
    width, depth = 0.2, 0.002
    plies = tuple(Ply(GRAPHITE, angle) for angle in angles)
    found = sections(StripSection(width, depth), plies).expansion.strain[0, :, 0]
    laminate = Laminate.equal_plies(plies, depth)
    q = np.stack([ply.material.transformed_stiffness(np.radians(ply.angle_deg)) for ply in plies])
    free = np.stack([expansion_in_wall(ply) for ply in plies])
    A, B, D = laminate.moments(q, 2)
    load = laminate.moments(np.einsum("pij,pj->pi", q, free), 1)
    strain = np.linalg.solve(np.block([[A, B], [B, D]]), np.concatenate(load))
    scale = np.abs(strain[[1, 4, 5]]) + 1e-3 * np.abs(free).max() * np.array([1.0, 1.0 / depth, 1.0 / depth])
    twisted = np.array([found[2] - strain[1], abs(found[KAPPA_Y]) - abs(strain[4]), abs(found[5]) - 0.5 * abs(strain[5])])
    assert np.abs(twisted / scale).max() < 0.004


def expansion_in_wall(ply):
    c, s = np.cos(np.radians(ply.angle_deg)), np.sin(np.radians(ply.angle_deg))
    along, across = ply.material.expansion
    return np.array([c * c * along + s * s * across, s * s * along + c * c * across, 2.0 * c * s * (along - across)])


def test_free_strains_are_the_work_of_unit_resultants_on_free_expansion():
    """Reciprocity, the body-force analogy: e_T = ∫ α·σ dA, with the stresses σ of Saint-Venant's solutions of what does not change
    along the span: tension, bending and torsion.
    """
    mesh, laminates, which = three_plies()
    sums, heat = element_sums(mesh, laminates, which, 0.0), ThermalSums.of(mesh, laminates, which, 0.0)
    system = Factorised.of(sums)
    central = central_solution(system, 0.0)
    here = sums.gather(central.warping)
    by_work = (here.swapaxes(-1, -2) @ heat.warping).sum(axis=1) + central.strain.swapaxes(-1, -2) @ heat.beam.sum(axis=1)
    found = expansion_of(system, heat, np.zeros((*here.shape[:3], 1)), 0.0).strain
    for heated in range(2):
        expected = by_work[0, 2:, heated]
        assert found[0, 2:, heated] == pytest.approx(expected, abs=1e-7 * np.abs(expected).max())


def test_no_resultants_are_left_in_a_free_section_that_twists():
    """∫σ (1, x, y) dA of what balances, beside what Q α alone would give."""
    mesh, laminates, which = three_plies()
    system, heat = Factorised.of(element_sums(mesh, laminates, which, 3.0)), ThermalSums.of(mesh, laminates, which, 3.0)
    found = expansion_of(system, heat, np.zeros((*heat.warping.shape[:3], 1)), 3.0)
    alone = np.abs(heat.moments.sum(axis=1)[0, :3]).max(axis=0)
    assert np.all(np.abs(found.moments[0, :3]).max(axis=0) < 1e-9 * alone)


def three_plies():
    """A box's elements, its one wall, and which is where."""
    plies, section = (Ply(GRAPHITE, 20.0), Ply(ALUMINIUM, 0.0), Ply(GRAPHITE, -50.0)), BoxSection(0.1, 0.05, 0.006)
    mesh = mesh_of(section, (1.0,), (), (True,))
    return mesh, [Laminate.equal_plies(plies, 0.006)], np.zeros((1, len(mesh.edges)), dtype=int)


def test_what_holds_a_blade_is_the_resultant_of_heat():
    """EA α ΔT, and a spring takes of it what the blade is stiff beside it."""
    rise, stiffness = 10.0, np.linalg.inv(blade().exact.sections.solid.stiffness[0])
    by_blade = 1.0 / (stiffness[2, 2] * 2.0)
    beam = blade(temperature=MADE_AT + rise, tip_springs=(0.0, 0.0, 2.0 * by_blade, 0.0, 0.0, 0.0))
    assert tip(beam, "s") == pytest.approx(ALPHA * rise * 2.0 / 3.0, rel=2e-3)  # the clamp holds the contraction of 0.2 %


def buckling_rise(beam, high):
    """K beyond the reference at which no steady state is stable."""
    low = 0.0
    for _ in range(14):
        middle = 0.5 * (low + high)
        try:
            replace(beam, temperature=MADE_AT + middle).at(0.0)
            low = middle
        except ValueError:
            high = middle
    return 0.5 * (low + high)


@pytest.mark.parametrize(
    ("springs", "factor"),
    [(CLAMPED, 4.0), ((0.0, 0.0, 1e12, 1e12, 1e12, 0.0), 1.0), ((1e12, 1e12, 1e12, 0.0, 0.0, 0.0), 2.0457)],
    ids=["clamped", "guided", "pinned"],
)
def test_a_bar_that_is_held_buckles_at_eulers_load_over_ea_alpha(springs, factor):
    """P = k π² EI/L², with shear P/(1 + P/GA) (Engesser): EA α ΔT. Within 0.4 %: the strain itself and the clamp."""
    beam = blade(tip_springs=springs, terms=10)
    stiffness, compliance = (each(beam.exact.sections.solid.stiffness[0]) for each in (np.asarray, np.linalg.inv))
    euler = factor * np.pi**2 / (beam.length**2 * compliance[3, 3])
    expected = euler / (1.0 + euler * compliance[1, 1]) / (stiffness[2, 2] * ALPHA)
    assert buckling_rise(beam, 1.5 * expected) == pytest.approx(expected, rel=4e-3)


def vibration(compression, length, bending, mass):
    """Lowest frequency, rad/s, of a clamped-clamped Euler beam under compression, N: its characteristic equation."""

    def equation(square):
        half = 0.5 * compression / bending
        root = np.sqrt(half**2 + mass * square / bending)
        a, b = np.sqrt(root - half) * length, np.sqrt(root + half) * length
        return 2.0 * a * b * (1.0 - np.cosh(a) * np.cos(b)) + (a * a - b * b) * np.sinh(a) * np.sin(b)

    upper = (4.9 / length) ** 4 * bending / mass
    return np.sqrt(brentq(equation, 1e-4 * upper, upper))


def test_a_held_beam_that_is_heated_vibrates_as_the_compressed_euler_beam():
    """Characteristic equation of a clamped-clamped beam under axial force (Bokaian, Journal of Sound and Vibration 126, 1988),
    for a slender box, frequencies over that without heat. √(1 − P/P_cr), its fit, is within 1.5 % of it.
    """
    beam = blade(length=6.0, tip_springs=CLAMPED, terms=10)
    stiffness, mass = beam.exact.sections.solid.stiffness[0], beam.exact.sections.solid.inertia[0, 0]
    bending = 1.0 / np.linalg.inv(stiffness)[3, 3]
    euler = 4.0 * np.pi**2 * bending / beam.length**2
    cold = beam.natural_frequencies(0.0, 1, ("flap",))[0]
    for share in (0.25, 0.5, 0.8):
        hot = replace(beam, temperature=MADE_AT + share * euler / (stiffness[2, 2] * ALPHA))
        ratio = hot.natural_frequencies(0.0, 1, ("flap",))[0] / cold
        by_euler = vibration(share * euler, 6.0, bending, mass) / vibration(0.0, 6.0, bending, mass)
        assert ratio == pytest.approx(by_euler, rel=2e-3 + 5e-3 * share / (1.0 - share))  # shear takes 0.4 % of P_cr
        assert by_euler == pytest.approx(np.sqrt(1.0 - share), rel=0.015)


def test_forces_are_the_energys_change_and_stiffness_is_theirs():
    """About a heated, twisted, held blade that turns: the tangent is the difference of forces."""
    beam = blade(
        layup=Layup.uniform(GRAPHITE, [30.0, -10.0]),
        pretwist_deg=30.0,
        terms=6,
        temperature=360.0,
        temperature_difference=20.0,
        tip_springs=(1e4, 2e4, 3e4, 2e3, 1e3, 3e3),
    )
    point, at = beam.at(100.0), beam.exact.at_stations
    q = point.steady.coefficients
    generator = np.random.default_rng(0)
    for _ in range(3):
        direction = generator.standard_normal(len(q)) * 1e-6

        def force(sign, direction=direction):
            moved = at.moved(q, sign * direction)
            return at.about(moved, 100.0).stiffness @ at.newton_step(moved, 100.0)

        found = 0.5 * (force(1.0) - force(-1.0))
        assert found == pytest.approx(-point.stiffness @ direction, rel=1e-4, abs=1e-5 * np.abs(found).max())


def test_a_linear_steady_state_is_the_non_linear_one_of_little_heat():
    options = {
        "layup": Layup.uniform(GRAPHITE, [30.0] * 2),
        "pretwist_deg": 20.0,
        "tip_springs": CLAMPED,
    }
    either = [blade(**options, steady_state=state, temperature=MADE_AT + 1.0) for state in ("nonlinear", "linear")]
    cold = replace(either[0], temperature=None).natural_frequencies(0.0, 4)
    moved = [beam.natural_frequencies(0.0, 4) - cold for beam in either]
    assert moved[0] == pytest.approx(moved[1], rel=0.05, abs=0.05 * np.abs(moved[0]).max())


def test_a_sweep_of_a_heated_blade_is_what_each_speed_gives():
    beam = blade(
        layup=Layup.uniform(GRAPHITE, [30.0] * 2), pretwist_deg=20.0, temperature=350.0, temperature_difference=30.0, terms=8
    )
    speeds = np.linspace(0.0, 120.0, 26)
    alone = np.stack([beam.natural_frequencies(speed, 4) for speed in speeds[[0, 9, 25]]])
    assert frequency_sweep(beam, speeds, 4)[[0, 9, 25]] == pytest.approx(alone, rel=1e-5)


def test_heat_along_the_span_adds_up():
    """∫ α (T − T₀) dz of a table; frequencies are those of many terms with few."""
    beam = blade(temperature_table=((0.0, MADE_AT), (0.5, MADE_AT + 100.0), (1.0, MADE_AT + 40.0)))
    assert tip(beam, "s") == pytest.approx(ALPHA * (50.0 + 70.0) * 1.0, rel=1e-4)
    few, many = (replace(beam, terms=terms).natural_frequencies(100.0, 3) for terms in (8, 20))
    assert few == pytest.approx(many, rel=2e-3)


def test_a_table_of_one_temperature_is_that_temperature():
    layup = Layup.uniform(GRAPHITE, [30.0] * 2)
    one, other = blade(layup=layup, temperature=350.0), blade(layup=layup, temperature_table=((0.0, 350.0), (1.0, 350.0)))
    assert np.array_equal(one.natural_frequencies(50.0), other.natural_frequencies(50.0))


def test_without_a_temperature_nothing_changes():
    bare = blade(layup=Layup.uniform(GRAPHITE, [30.0] * 2), pretwist_deg=20.0)
    at_reference = replace(bare, temperature=MADE_AT)
    free = replace(bare, tip_springs=(0.0,) * 6)
    assert free.natural_frequencies(50.0) == pytest.approx(bare.natural_frequencies(50.0), rel=1e-12)
    assert at_reference.natural_frequencies(50.0) == pytest.approx(bare.natural_frequencies(50.0), rel=1e-9)


def test_fibres_along_the_span_leave_a_box_free_of_stress():
    """All of it expands alike across them, its corners and through its walls too."""
    beam = blade(layup=Layup.uniform(GRAPHITE, [90.0]), temperature=MADE_AT + 1.0)
    sections = beam.exact.sections.solid
    assert sections.expansion.strain[0, :, 0] == pytest.approx(GRAPHITE.alpha1 * np.eye(6)[2], abs=1e-9 * GRAPHITE.alpha2)
    of_tension = np.abs(sections.stress_moments[0, :, 2]) * GRAPHITE.alpha2
    assert np.abs(sections.expansion.moments[0, [3, 5], 0]) == pytest.approx(0.0, abs=1e-8 * of_tension[3])


def test_finite_elements_are_strained_alike():
    options = {
        "layup": Layup.uniform(GRAPHITE, [30.0] * 2),
        "pretwist_deg": 20.0,
        "temperature": 350.0,
        "temperature_difference": 20.0,
    }
    either = [blade(**options, discretisation=name) for name in ("galerkin", "finite-elements")]
    assert tip(either[1], "phi") == pytest.approx(tip(either[0], "phi"), rel=1e-5)
    assert tip(either[1], "v") == pytest.approx(tip(either[0], "v"), rel=1e-5)
    found, expected = (beam.natural_frequencies(80.0, 4) for beam in either)
    assert found == pytest.approx(expected, rel=5e-4)  # as without heat
