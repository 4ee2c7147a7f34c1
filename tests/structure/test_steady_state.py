"""How a blade stands as it turns steadily, and how it vibrates about that: against equations solved another way."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial.legendre import legvander
from scipy.integrate import solve_bvp

from beamenv.blade.config import BeamConfig
from beamenv.patches import MFC
from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Lamina, Layup, Ply, RotatingBeam, trial_functions
from beamenv.structure.geometrically_exact import at_stations
from beamenv.structure.modes import normal_modes
from beamenv.structure.trial_functions import legendre_derivative

SPEED = 200.0
ROD = Lamina.isotropic(E=70e9, nu=0.0, density=2700.0)
"""Whose sections keep their shape as it is stretched, so that the clamp holds nothing back."""
BLADE = BeamConfig().build()


def unclamped(xi, terms, length, reach):
    """Trial functions of sections that warp at the clamp as they please: Saint-Venant's beam."""
    value = legvander(2.0 * xi - 1.0, terms - 1)
    return value, value @ (2.0 * legendre_derivative(terms)) / length


def steady(beam, speed, z):
    """u, v, s, c (rad) by name at z."""
    coefficients = beam.at(speed).steady.coefficients
    return {name: rows @ coefficients for name, rows in beam.displacements(z).items()}


@pytest.mark.parametrize("speed", [20.0, 200.0, 1000.0])
def test_an_isotropic_rod_stretches_as_its_equation_says(speed):
    """N′ + m Ω² (R₀ + z + w) = 0 with N = EA (w′ + 3/2 w′²), Green's strain to second order: by collocation, to 5 % strain. At
    20 rad/s that is w = R₀ cos λz + B sin λz − R₀ − z, λ² = mΩ²/EA, w′(L) = 0, to three halves of the strain, 2e-5.
    """
    hub, length = 0.2, 2.0
    beam = RotatingBeam(BoxSection(0.2, 0.05, 0.004), Layup.uniform(ROD, [0]), length, hub_radius=hub)
    wave, z = speed * np.sqrt(ROD.density / ROD.E1), np.linspace(0.0, length, 9)

    def slopes(z, y):
        return np.stack([(np.sqrt(1.0 + 6.0 * y[1]) - 1.0) / 3.0, -(wave**2) * (hub + z + y[0])])

    mesh = np.linspace(0.0, length, 41)
    solution = solve_bvp(slopes, lambda a, b: np.array([a[0], b[1]]), mesh, np.zeros((2, 41)), tol=1e-9)
    assert solution.success
    found = steady(beam, speed, z)
    assert found["s"] == pytest.approx(solution.sol(z)[0], abs=1e-7 * length)
    others = ("u", "v", "theta_x", "theta_y", "phi")
    assert np.abs([found[name] for name in others]).max() < 1e-9
    if speed == 20.0:
        B = (1.0 + hub * wave * np.sin(wave * length)) / (wave * np.cos(wave * length))
        closed = hub * np.cos(wave * z) + B * np.sin(wave * z) - hub - z
        assert found["s"] == pytest.approx(closed, rel=6e-5, abs=1e-12)


def stretch_and_twist(beam, speed, z):
    """w and φ of the blade's equations of extension and twist alone, which obey its symmetry, by collocation:
    N′ + m Ω² (R₀ + z + w) = 0 and M′ = ½ Ω² (I_x − I_y) sin 2(β + φ), N and M being conjugate to w′ and φ′ in
    ½ EA w′² + K w′φ′ + ½ GJ φ′² + ½ (EA w′ + K φ′) w′² + ½ (p w′ + q φ′) φ′², and p w′ + q φ′ the polar moment of the
    spanwise stress.
    """
    solid, length = beam.exact.sections.solid, beam.length
    stretch, twist = 2, 5
    EA, K, GJ = solid.stiffness[0][[stretch, stretch, twist], [stretch, twist, twist]]
    p, q = solid.saint_venant_moments[0][[3, 5]].sum(axis=0)[[stretch, twist]]
    mass, Ix, Iy = solid.inertia[0, [0, 3, 5]]
    start, rate = np.radians(beam.presetting_deg), np.radians(beam.pretwist_deg) / length

    def strains(N, M):
        e, k = N / EA, np.zeros_like(N)
        for _ in range(30):  # Newton on both
            along = EA * (e + 1.5 * e**2) + K * k * (1.0 + e) + 0.5 * p * k**2 - N
            around = K * (e + 0.5 * e**2) + GJ * k + p * e * k + 1.5 * q * k**2 - M
            residual = np.stack([along, around])
            a, b, d = EA * (1.0 + 3.0 * e) + K * k, K * (1.0 + e) + p * k, GJ + p * e + 3.0 * q * k
            det = a * d - b * b
            e = e - (d * residual[0] - b * residual[1]) / det
            k = k - (a * residual[1] - b * residual[0]) / det
        return e, k

    def slopes(z, y):
        w, phi, N, M = y
        e, k = strains(N, M)
        turn = np.sin(2.0 * (start + rate * z + phi))
        return np.stack([e, k, -mass * speed**2 * (beam.hub_radius + z + w), 0.5 * speed**2 * (Ix - Iy) * turn])

    mesh = np.linspace(0.0, length, 41)
    solution = solve_bvp(slopes, lambda a, b: np.array([a[0], a[1], b[2], b[3]]), mesh, np.zeros((4, 41)), tol=1e-6)
    assert solution.success
    return solution.sol(z)[:2]


@pytest.mark.parametrize("slenderness", [1.0, 10.0])
def test_saint_venants_blade_stretches_and_untwists_as_its_equations_say(slenderness, monkeypatch):
    """The default blade, sections free to warp at the clamp, its speed at the tip that of 200 rad/s: within 0.2 % of the tip's
    stretch and 4 % of its twist. What is left is of the ends, where Saint-Venant does not hold: a tenth in a ten times longer one.
    """
    monkeypatch.setattr(trial_functions, "clamped_table", unclamped)
    beam = BeamConfig(length=2.023 * slenderness, hub_radius=0.2023 * slenderness).build()
    z = np.linspace(0.0, beam.length, 9)
    w, phi = stretch_and_twist(beam, SPEED / slenderness, z)
    found = steady(beam, SPEED / slenderness, z)
    assert found["s"] == pytest.approx(w, abs=2e-3 / slenderness * np.abs(w).max())
    assert found["phi"] == pytest.approx(phi, abs=4e-2 / slenderness * np.abs(phi).max())


def test_the_default_blade_at_200_rad_per_s():
    """It stretches by 32.3 mm, untwists by 15.2° at the tip (solid elements: 33 mm, 14 to 17°) and strains by 2.85 % outside; the
    clamp takes 1.4 % from the stretch that Saint-Venant's equations give.
    """
    tip = np.array([BLADE.length])
    found = steady(BLADE, SPEED, tip)
    assert 1e3 * found["s"][0] == pytest.approx(32.3, abs=0.1)
    assert np.degrees(found["phi"][0]) == pytest.approx(-15.2, abs=0.1)
    strain = BLADE.steady_strain(BLADE.length * np.linspace(1e-6, 1.0, 60), SPEED)
    assert np.abs(strain).max() == pytest.approx(0.0285, abs=0.0005)
    w, phi = stretch_and_twist(BLADE, SPEED, tip)
    assert 100.0 * (found["s"] / w - 1.0) == pytest.approx(-1.4, abs=0.3)
    assert found["phi"] == pytest.approx(phi, rel=0.04)


def test_modes_five_and_six_part_about_the_true_steady_state():
    """By +5.4 and −5.0 % from those of the linear one; 3-D elements found +5 and −5 %."""
    about, linear = (
        replace(BLADE, steady_state=state).natural_frequencies(SPEED, 6, gyroscopic=False) for state in ("nonlinear", "linear")
    )
    assert 100.0 * (about / linear - 1.0)[[4, 5]] == pytest.approx([5.0, -5.0], abs=0.8)


def test_both_steady_states_are_one_at_low_speed():
    """They differ by Ω²: a hundredth at a tenth of the speed, of stretch and of frequency."""
    linear = replace(BLADE, steady_state="linear")
    apart = []
    for speed in (20.0, 2.0):
        one, other = (beam.at(speed).steady.coefficients for beam in (BLADE, linear))
        apart.append(np.abs(one / speed**2 - other / speed**2).max())
    assert apart[0] / apart[1] == pytest.approx(100.0, rel=0.2)


@pytest.mark.parametrize("angle", [0, 45, 60, 75])
def test_the_spanwise_stress_of_every_section_carries_its_tension(angle):
    """∫σ_zz dA = N, whatever extension does beside it: walls of one angle all round couple it with twist, and near the ends shapes
    do not follow.
    """
    at = replace(BLADE, layup=Layup.uniform(GRAPHITE_EPOXY, [angle] * 6)).exact.at_stations
    strain = at.strain_rows @ np.linalg.solve(at.elastic_at_rest, at.force(at.inertia(at.unloaded).centrifugal))
    asked = at.asked(strain)
    assert at.moments(strain, asked)[:, 0] == pytest.approx(at.resultants(strain, asked)[:, 2], rel=1e-9)


def test_a_blade_that_untwists_by_twenty_degrees_has_a_steady_state():
    """Walls of 75° all round at 250 rad/s; under a stress that does not carry the tension it would have none."""
    blade = replace(BLADE, layup=Layup.uniform(GRAPHITE_EPOXY, [75] * 6), pretwist_deg=0.0)
    state = blade.exact.placement(np.array([blade.length]), blade.at(250.0).steady.coefficients)
    twist = np.degrees(np.arctan2(state.turn[0, 1, 0], state.turn[0, 0, 0]))
    assert -25.0 < twist < -15.0
    assert np.all(blade.natural_frequencies(250.0, 3) > 0.0)


UNSYMMETRIC = RotatingBeam(
    BoxSection(0.2, 0.05, 0.008),
    Layup.by_wall(GRAPHITE_EPOXY, top=[60, 60], bottom=[-60, 30], left=[30, 60], right=[-60, 45]),
    length=1.5,
    hub_radius=0.2,
    pretwist_deg=25.0,
    presetting_deg=20.0,
    taper=1.5,
)
"""Which bends both ways, shears and twists as it turns."""


def test_stiffness_is_the_slope_of_the_force_that_is_left_over():
    """K at the steady state by central differences of internal less centrifugal force, on smooth increments."""
    speed = 150.0
    at, point = UNSYMMETRIC.exact.at_stations, UNSYMMETRIC.at(speed)
    q, terms = at.moved(point.steady.coefficients, at.newton_step(point.steady.coefficients, speed)), UNSYMMETRIC.space.terms
    rng, step = np.random.default_rng(4), 1e-4

    def left_over(q):
        """(N,) on the increments of where the blade is."""
        placement = at_stations.Placement.of(at.rows @ q, at.frames)
        resultants = at._stressed(placement, at.asked(placement.strain)).resultants
        rows = placement.strain_rows @ at.rows
        return np.einsum("s,sin,si->n", at.weight, rows, resultants) - speed**2 * at.force(at.inertia(placement).centrifugal)

    smooth = np.zeros((6, terms))
    assert np.abs(left_over(q)).max() < 1e-6 * np.abs(left_over(0.0 * q)).max()
    for _ in range(4):
        smooth[:, :4] = rng.normal(size=(6, 4))
        direction = smooth.ravel()
        slope = (left_over(at.moved(q, step * direction)) - left_over(at.moved(q, -step * direction))) / (2.0 * step)
        expected = point.stiffness @ direction
        assert slope == pytest.approx(expected, abs=1e-4 * np.abs(expected).max())


@pytest.mark.parametrize("beam", [BLADE, UNSYMMETRIC], ids=["default", "unsymmetric"])
def test_vibration_about_the_steady_state_keeps_its_energy(beam):
    """M and K are symmetric and positive, G is skew, and all poles are on the imaginary axis."""
    point = beam.at(150.0)
    for matrix in (point.mass, point.stiffness):
        assert np.array_equal(matrix, matrix.T)
        scale = np.sqrt(np.diag(matrix))
        assert np.linalg.eigvalsh(matrix / np.outer(scale, scale)).min() > 0.0
    assert np.abs(point.gyroscopic + point.gyroscopic.T).max() < 1e-12 * np.abs(point.gyroscopic).max()
    _, shapes = normal_modes(point.mass, point.stiffness, 20)
    coupling, stiffness = shapes.T @ point.gyroscopic @ shapes, shapes.T @ point.stiffness @ shapes
    first_order = np.block([[np.zeros((20, 20)), np.eye(20)], [-stiffness, -coupling]])
    poles = np.linalg.eigvals(first_order)
    assert np.abs(poles.real).max() < 1e-9 * np.abs(poles).max()


def test_thin_walls_under_a_heavy_sheet_have_a_steady_state():
    """One that Newton's method does not find from the linear one: it is reached by way of lower speeds."""
    plies = tuple(Ply(GRAPHITE_EPOXY, 30.0) for _ in range(6))
    layup = Layup(default=plies, walls={"top": (*plies[:5], Ply(MFC.lamina, 90.0))})
    beam = RotatingBeam(BoxSection(0.2, 0.05, 0.004), layup, length=2.0, pretwist_deg=30.0, hub_radius=0.2)
    tips = [steady(beam, speed, np.array([2.0]))["s"][0] / speed**2 for speed in (100.0, 200.0)]
    assert tips[1] == pytest.approx(tips[0], rel=0.03)
