"""Deflection, twist, mass and tension against hand formulas."""

import numpy as np
import pytest

from beamenv.structure import BoxSection, Lamina, Layup, RotatingBeam
from beamenv.structure.stations import Stations

ALUMINIUM = Lamina.isotropic(E=70e9, nu=0.3, density=2700.0)
ISOTROPIC = Layup.uniform(ALUMINIUM, angles_deg=[0])
WITHOUT_POISSON = Layup.uniform(Lamina.isotropic(E=70e9, nu=0.0, density=2700.0), angles_deg=[0])
SECTION = BoxSection(width=0.2, depth=0.05, thickness=0.004)
LENGTH = 2.0
PERIMETER = 2.0 * (SECTION.width + SECTION.depth)


@pytest.fixture
def walled(thesis_world):
    """A cantilever whose walls strain as the thesis has it: by hand to round-off."""
    return lambda shear="rigid", **options: RotatingBeam(SECTION, ISOTROPIC, LENGTH, shear=shear, **thesis_world, **options)


def deflection(beam, load):
    return np.linalg.solve(beam.matrices.elastic_stiffness, load)


def tip(beam, field):
    return beam.displacements(beam.length)[field][0]


@pytest.mark.parametrize(("direction", "field", "entry"), [(0, "u", 2), (1, "v", 1)])
def test_uniform_load_bends_the_tip_by_q_l4_over_8_ei(direction, field, entry, world):
    """Exactly, since the quartic lies in the trial space of the rigid theory, and the clamp has no contraction to hold back."""
    beam = RotatingBeam(SECTION, WITHOUT_POISSON, LENGTH, shear="rigid", **world)
    q = 500.0
    bending = SECTION.stiffness(WITHOUT_POISSON, shear="rigid", **world)[entry, entry]
    found = tip(beam, field) @ deflection(beam, q * beam.line_load()[:, direction])
    assert found == pytest.approx(q * LENGTH**4 / (8.0 * bending), rel=1e-10)


def test_first_order_theory_adds_the_shear_deflection_of_timoshenko(walled):
    """qL⁴/8EI + qL²/2kGA with kGA = G h p: thin upright walls carry it, the lying ones in transverse shear.

    From below, and the more slowly the nearer: v leaves the clamp with z², which the higher-order theory asks for (v' = 0),
    while a Timoshenko beam leaves it with the slope qL/kGA: 2/(N + 1)² of the shear deflection is missing with N terms.
    """
    missing = {}
    for terms in (5, 10, 20):
        beam = walled(shear="first_order", terms=terms)
        full = beam.walls_at(np.zeros(1)).stiffness()[0]
        bending, shear = full[1, 1], full[4, 4]
        assert shear == pytest.approx(ALUMINIUM.G12 * PERIMETER * SECTION.thickness, rel=1e-12)
        by_shear = LENGTH**2 / (2.0 * shear)
        found = tip(beam, "v") @ deflection(beam, beam.line_load()[:, 1])
        missing[terms] = 1.0 - (found - LENGTH**4 / (8.0 * bending)) / by_shear
    assert missing == pytest.approx({terms: 2.0 / (terms + 1) ** 2 for terms in missing}, rel=1e-3)


def test_tip_load_strains_the_outer_face_by_moment_over_section_modulus(walled, thesis_world):
    """ε = P(L − z)(d/2 + h/2)/EI at the face of the top wall: tension on top when the tip is pushed down."""
    beam, load = walled(), -300.0
    bent = deflection(beam, load * tip(beam, "v"))
    z = np.array([0.1, 0.8, 1.9])
    on_top = [k for k, wall in enumerate(np.repeat(SECTION.walls, 2)) if wall == "top"]
    strain = beam.surface_strain(z)[:, on_top] @ bent
    bending = SECTION.stiffness(ISOTROPIC, shear="rigid", **thesis_world)[1, 1]
    face = 0.5 * (SECTION.depth + SECTION.thickness)
    expected = -load * (LENGTH - z) * face / bending
    assert strain == pytest.approx(np.column_stack([expected, expected]), rel=1e-9)


@pytest.mark.parametrize("length", [0.3, 0.6])
def test_tip_torque_twists_a_clamped_box_as_vlasov_says(length, thesis_world):
    """φ(L) = T (L − λ tanh(L/λ))/GJ with λ = √(EI_ω/GJ): the clamp holds warping within about λ of the root."""
    flat = BoxSection(width=0.2, depth=0.02, thickness=0.002)
    beam = RotatingBeam(flat, ISOTROPIC, length, shear="rigid", terms=16, **thesis_world)
    full = beam.walls_at(np.zeros(1)).stiffness()[0]
    torsion, warping = full[7, 7], full[8, 8]
    reach = np.sqrt(warping / torsion)
    assert 0.05 < reach / length < 0.4
    found = tip(beam, "phi") @ deflection(beam, tip(beam, "phi"))
    assert found == pytest.approx((length - reach * np.tanh(length / reach)) / torsion, rel=1e-6)


def stretch_mass(beam):
    """∫ m (z/L)² dz: the mass that the first trial function of the stretch, z/L, moves."""
    column = beam.space.columns(("extension",))[0]
    return beam.matrices.mass[column, column]


@pytest.mark.parametrize("taper", [1.0, 1.5, 2.0])
def test_tapered_blade_weighs_what_its_shrinking_perimeter_says(taper, walled):
    """m(z) = ρ h p [1 − (1 − 1/τ) z/L]: total ½ρhpL(1 + 1/τ), and ∫m(z/L)² = ρhpL[⅓ − ¼(1 − 1/τ)]."""
    beam = walled(taper=taper)
    root = ALUMINIUM.density * SECTION.thickness * PERIMETER
    stations = Stations.between(np.array([0.0, LENGTH]), 8)
    mass = beam.walls_at(stations.z).inertia().mass_per_length
    assert stations.weight @ mass == pytest.approx(0.5 * root * LENGTH * (1.0 + 1.0 / taper), rel=1e-12)
    assert stretch_mass(beam) == pytest.approx(root * LENGTH * (1.0 / 3.0 - 0.25 * (1.0 - 1.0 / taper)), rel=1e-12)


def test_tension_of_a_uniform_blade():
    """T = m [R₀(L − z) + ½(L² − z²)], whatever the pieces of the span."""
    hub, mass = 0.3, 5.0
    stations = Stations.between(np.array([0.0, 0.4, 0.5, LENGTH]), 5)
    z = stations.z
    tension = stations.integral_to_tip(mass * (hub + z))
    assert tension == pytest.approx(mass * (hub * (LENGTH - z) + 0.5 * (LENGTH**2 - z**2)), rel=1e-12)


def test_tension_of_a_tapered_blade_and_of_one_with_a_heavy_piece():
    """∫ from z to L of (a − bσ)(R₀ + σ), and a mass that jumps at a breakpoint."""
    hub, a, b = 0.3, 5.0, 1.2
    stations = Stations.between(np.array([0.0, 0.7, LENGTH]), 6)
    z = stations.z

    def antiderivative(s):
        return a * hub * s + 0.5 * (a - b * hub) * s**2 - b * s**3 / 3.0

    tapered = stations.integral_to_tip((a - b * z) * (hub + z))
    assert tapered == pytest.approx(antiderivative(LENGTH) - antiderivative(z), rel=1e-12)
    jump = stations.integral_to_tip(np.where(z < 0.7, 9.0, 1.0))
    assert jump == pytest.approx(np.where(z < 0.7, 9.0 * (0.7 - z) + 1.3, LENGTH - z), rel=1e-12)


def test_tension_stiffens_flap_by_its_work(walled):
    """K_Ω of v = (z/L)²: ∫T v'² dz less the softening of rotary inertia, −∫ρy² v'²; hand integrals."""
    hub = 0.25
    beam = walled(hub_radius=hub)
    column = beam.space.columns(("flap",))[0]
    mass = ALUMINIUM.density * SECTION.thickness * PERIMETER
    work = 4.0 * mass / LENGTH**4 * (hub * LENGTH**4 / 12.0 + 0.5 * LENGTH**5 * (1.0 / 3.0 - 1.0 / 5.0))
    inertia = beam.walls_at(np.zeros(1)).inertia().mass[0, 3, 3]
    softening = inertia * 4.0 / (3.0 * LENGTH)
    assert beam.matrices.spin_stiffness[column, column] == pytest.approx(work - softening, rel=1e-12)
    w, d, h = SECTION.width, SECTION.depth, SECTION.thickness
    about_chord = 2.0 * ALUMINIUM.density * (w * h * d**2 / 4.0 + w * h**3 / 12.0 + h * d**3 / 12.0)
    assert inertia == pytest.approx(about_chord, rel=1e-12)


def test_chord_in_the_plane_of_rotation_is_stiffened_in_twist_by_the_tennis_racket_effect(walled):
    """K_Ω of φ alone: Ω² ∫ρ(x² − y²)φ² turns its sign with a presetting of 90°; stretching and warping do not notice."""
    flat, upright = (walled(presetting_deg=angle) for angle in (0.0, 90.0))
    column = flat.space.columns(("twist",))[0]
    inertia = flat.walls_at(np.zeros(1)).inertia()
    excess = inertia.flap_flap[0, 5, 5] - inertia.lag_lag[0, 5, 5]
    difference = flat.matrices.spin_stiffness[column, column] - upright.matrices.spin_stiffness[column, column]
    assert excess > 0.0
    assert difference == pytest.approx(2.0 * excess * LENGTH / 5.0, rel=1e-9)
