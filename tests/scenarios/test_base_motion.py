"""Centrifugal and Euler's loads: closed forms of a uniform box, and d'Alembert's principle in the inertial frame."""

import numpy as np
import pytest

from beamenv.structure import BoxSection, Lamina, Layup, RotatingBeam
from beamenv.structure.assembly import generalised_displacements
from beamenv.structure.base_motion import base_loads
from beamenv.structure.stations import Stations
from beamenv.structure.walls.wall_kinematics import motion_rows

DENSITY, WIDTH, DEPTH, WALL, LENGTH, HUB = 2700.0, 0.2, 0.05, 0.01, 2.0, 0.3
METAL = Lamina.isotropic(E=7e10, nu=0.3, density=DENSITY)
MASS = DENSITY * 2.0 * WALL * (WIDTH + DEPTH)  # kg/m
ALONG_CHORD = 2.0 * DENSITY * (WALL * WIDTH**3 / 12.0 + DEPTH * (WALL * WIDTH**2 / 4.0 + WALL**3 / 12.0))  # ∮∫ρX², kg m
ACROSS = 2.0 * DENSITY * (WALL * DEPTH**3 / 12.0 + WIDTH * (WALL * DEPTH**2 / 4.0 + WALL**3 / 12.0))


def box(**changes):
    arguments = {"length": LENGTH, "hub_radius": HUB, "model": "thesis", "shear": "first_order", "terms": 6} | changes
    return RotatingBeam(section=BoxSection(WIDTH, DEPTH, WALL), layup=Layup.uniform(METAL, [0.0]), **arguments)


def field(beam, name):
    """Coefficients of the field's first trial function, (z/L)² or z/L."""
    coefficients = np.zeros(beam.space.size)
    coefficients[beam.space.terms * beam.space.fields.index(name)] = 1.0
    return coefficients


def test_the_centrifugal_load_stretches_a_uniform_box_by_its_mass_times_radius():
    beam = box()
    load = base_loads(beam).centrifugal
    assert load @ field(beam, "s") == pytest.approx(MASS * (HUB / 2.0 + LENGTH / 3.0) * LENGTH, rel=1e-12)  # ∫ m (R₀ + z) z/L dz
    for name in ("u", "v", "theta_x", "theta_y", "phi"):
        assert load @ field(beam, name) == pytest.approx(0.0, abs=1e-10)


def test_the_euler_load_bends_a_uniform_box_in_lag_alone():
    beam = box()
    load = base_loads(beam).euler
    lag = -MASS * (HUB / 3.0 + LENGTH / 4.0) * LENGTH  # −∫ m (R₀ + z) (z/L)² dz
    assert load @ field(beam, "u") == pytest.approx(lag, rel=1e-12)
    assert load @ field(beam, "theta_y") == pytest.approx(-ALONG_CHORD * LENGTH / 2.0, rel=1e-12)  # rotary inertia
    for name in ("v", "s", "theta_x", "phi"):
        assert load @ field(beam, name) == pytest.approx(0.0, abs=1e-10)


def test_the_euler_load_is_minus_mass_times_radius_for_every_lag_trial_function():
    """The virtual work −∫ m (R₀ + z) δu dz, by a quadrature of its own."""
    beam = box(shear="rigid", terms=10)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    z = 0.5 * LENGTH * (nodes + 1.0)
    rows = beam.displacements(z)
    work = -(0.5 * LENGTH * weights * MASS * (HUB + z)) @ rows["u"]
    turning = -ALONG_CHORD * (0.5 * LENGTH * weights) @ rows["theta_y"]
    block = slice(0, beam.space.terms)
    np.testing.assert_allclose(base_loads(beam).euler[block], (work + turning)[block], rtol=1e-10, atol=1e-12)


def test_a_chord_out_of_the_plane_of_rotation_is_pulled_back_into_it():
    """The propeller moment −Ω² (∮∫ρX² − ∮∫ρY²) ½ sin 2β per metre."""
    angle = 25.0
    beam = box(presetting_deg=angle)
    moment = -(ALONG_CHORD - ACROSS) * 0.5 * np.sin(2.0 * np.radians(angle))
    assert base_loads(beam).centrifugal @ field(beam, "phi") == pytest.approx(moment * LENGTH / 3.0, rel=1e-10)
    assert moment < 0.0


@pytest.mark.parametrize("shear", ["first_order", "higher_order"])
def test_loads_and_matrices_are_those_of_point_masses_in_the_inertial_frame(shear):
    """m r̈ of every point of a pretwisted blade, moved as X(t) = R(θ(t)) (r + N q(t)), against M, G₁, ½ Ω̇ G₁, f_c and f_E."""
    beam = box(pretwist_deg=30.0, shear=shear)
    mass, at, rows = point_masses(beam)
    rng = np.random.default_rng(0)
    scale = 1e-3
    q, rate, second = scale * rng.normal(size=(3, beam.space.size)) * [[1.0], [50.0], [2500.0]]
    matrices, loads = beam.matrices, base_loads(beam)

    def inertia(speed, acceleration, moving=1.0):
        return generalised_inertia(mass, at, rows, (moving * q, moving * rate, moving * second), speed, acceleration)

    np.testing.assert_allclose(inertia(70.0, 0.0, 0.0), -(70.0**2) * loads.centrifugal, atol=1e-9 * 70.0**2)
    euler = 0.5 * (inertia(70.0, 900.0, 0.0) - inertia(70.0, -900.0, 0.0))
    np.testing.assert_allclose(euler, -900.0 * loads.euler, atol=1e-9 * 900.0)
    circulatory = 0.5 * (inertia(70.0, 900.0) - inertia(70.0, -900.0)) - euler
    np.testing.assert_allclose(circulatory, 450.0 * matrices.gyroscopic @ q, atol=1e-9)
    coriolis = 0.5 * (inertia(70.0, 0.0) - inertia(-70.0, 0.0))
    np.testing.assert_allclose(coriolis, 70.0 * matrices.gyroscopic @ rate, atol=1e-9)
    np.testing.assert_allclose(inertia(0.0, 0.0), matrices.mass @ second, atol=1e-9)


def point_masses(beam):
    """Masses (P,), places (P, 3) and displacement rows (P, 3, N) of a cloud of points that integrates the blade exactly."""
    stations = Stations.between(np.array([0.0, beam.length]), 40)
    walls = beam.walls_at(stations.z)
    points, motion = walls.points, motion_rows(walls.points, walls.flow, walls.laws.thickness, beam.shear)
    displaced = generalised_displacements(beam.space.evaluate(stations.z))
    nodes, weights = np.polynomial.legendre.leggauss(4)  # through the wall
    masses, places, rows = [], [], []
    for n, weight in zip(0.5 * WALL * nodes, 0.5 * WALL * weights, strict=True):
        masses.append(DENSITY * weight * stations.weight[:, None] * points.ds)
        span = np.broadcast_to((beam.hub_radius + stations.z)[:, None], points.x.shape)
        places.append(np.stack([points.x + n * points.l, points.y + n * points.m, span], axis=-1))
        powers = np.array([1.0, n, n**3])
        section = np.stack([np.einsum("spkg,k->spg", part, powers) for part in (motion.lag, motion.flap, motion.span)], axis=2)
        rows.append(section @ displaced[:, None])
    size = beam.space.size
    return (
        np.concatenate([m.ravel() for m in masses]),
        np.concatenate([p.reshape(-1, 3) for p in places]),
        np.concatenate([row.reshape(-1, 3, size) for row in rows]),
    )


def generalised_inertia(mass, at, rows, motion, speed, acceleration):
    """Σ m Nᵀ Rᵀ r̈ with r̈ of X = R(θ) ρ by the product rule in the inertial frame; R turns (span, lag) by θ = Ωt + ½Ω̇t²."""
    still, velocity, second = (rows @ part for part in motion)
    relative = at + still
    turn = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])  # R = exp(θ turn), here at θ = 0: R' = turn, R'' = turn²
    in_space = second + 2.0 * speed * velocity @ turn.T + relative @ (acceleration * turn + speed**2 * turn @ turn).T
    return np.einsum("p,pkn,pk->n", mass, rows, in_space)
