"""Doubling against SciPy's Schur method, analytic answers, and what happens when it fails."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import solve_continuous_are

import baselines.placement.cost.riccati as riccati
from baselines.placement.cost.problem import PlacementProblem
from baselines.placement.cost.riccati import solve_riccati
from baselines.placement.model.equations import filter_equation, regulator_equation
from beamenv.blade.presets import blade_config


def by_scipy(A, G, Q):
    factor = np.linalg.cholesky(G + 1e-300 * np.eye(len(G))) if np.linalg.matrix_rank(G) == len(G) else None
    if factor is None:
        values, vectors = np.linalg.eigh(G)
        kept = values > 1e-13 * values[-1]
        factor = vectors[:, kept] * np.sqrt(values[kept])
    return solve_continuous_are(A, factor, Q, np.eye(factor.shape[1]))


def test_scalar_equation_has_its_textbook_root():
    """2ap + q − gp² = 0: p = (a + √(a² + gq))/g, also for an unstable a."""
    a, g, q = np.array([-2.0, 0.5, -0.01, 3.0]), np.array([0.7, 2.0, 5.0, 0.1]), np.array([1.0, 3.0, 0.02, 4.0])
    found = solve_riccati(a[:, None, None], g[:, None, None], q[:, None, None])[:, 0, 0]
    assert found == pytest.approx((a + np.sqrt(a**2 + g * q)) / g, rel=1e-12)


@pytest.mark.parametrize("side", ["actuators", "sensors"])
@pytest.mark.parametrize("speed", [0.0, 200.0])
def test_a_population_of_blades_is_solved_as_scipy_solves_each(side, speed):
    problem = PlacementProblem.of(blade_config(speed=speed), side)
    reduced = problem.reduced(problem.bounds.random(np.random.default_rng(0), 12))
    A, G, Q = (np.broadcast_to(each, (12, 22, 22)) for each in problem.equation(reduced))
    found = solve_riccati(A, G, Q)
    for k in range(12):
        expected = by_scipy(A[k], G[k], Q[k])
        assert np.abs(found[k] - expected).max() <= 1e-9 * np.abs(expected).max()


@given(st.integers(0, 10_000), st.integers(1, 8), st.integers(1, 3))
def test_any_stable_system_has_a_stabilising_solution(seed, order, inputs):
    generator = np.random.default_rng(seed)
    A = generator.standard_normal((3, order, order)) - 3.0 * np.sqrt(order) * np.eye(order)
    B = generator.standard_normal((3, order, inputs))
    Q = np.eye(order)[None]
    G = B @ B.swapaxes(1, 2)
    X = solve_riccati(A, G, Q)
    residual = A.swapaxes(1, 2) @ X + X @ A + Q - X @ G @ X
    assert np.abs(residual).max() <= 1e-10 * np.abs(X @ A).max()
    assert np.linalg.eigvals(A - G @ X).real.max() < 0.0
    assert np.linalg.eigvalsh(X).min() > 0.0


def test_what_doubling_cannot_solve_goes_to_scipy(monkeypatch):
    problem = PlacementProblem.of(blade_config())
    reduced = problem.reduced(problem.bounds.uniform()[None])
    expected = solve_riccati(*problem.equation(reduced))
    monkeypatch.setattr(riccati, "MOST_DOUBLINGS", 2)
    assert solve_riccati(*problem.equation(reduced)) == pytest.approx(expected, rel=1e-9, abs=1e-12 * np.abs(expected).max())
    monkeypatch.setattr(riccati, "doubling", lambda A, G, Q: np.full_like(A, np.nan))
    assert solve_riccati(*problem.equation(reduced)) == pytest.approx(expected, rel=1e-9, abs=1e-12 * np.abs(expected).max())


def test_filter_of_a_blade_is_the_regulator_of_the_one_that_spins_backwards():
    """Duality: sensors where the actuators are, readings B R^(−½), loads of intensity Q; only the Coriolis forces turn round."""
    problem = PlacementProblem.of(blade_config(overrides={"patches": {"passive": False}}), "actuators")
    blade = problem.reduced(problem.bounds.uniform()[None])
    damping = -blade.dynamics[0, 11:, 11:]
    coriolis = 0.5 * (damping - damping.T)
    assert np.abs(coriolis).max() > np.diag(damping).min()  # else nothing is asked
    backwards = blade.dynamics.copy()
    backwards[0, 11:, 11:] += 2.0 * coriolis
    output = np.linalg.solve(np.linalg.cholesky(blade.input_weight[0]), blade.input[0].T)[None]
    seen = SimpleNamespace(dynamics=backwards, output=output, disturbance_input=np.eye(22)[None])
    S = solve_riccati(*filter_equation(seen, 0.5 * np.eye(22), 1.0))
    P = solve_riccati(*regulator_equation(blade))
    mirror = np.diag(np.repeat([1.0, -1.0], 11))
    assert mirror @ S[0] @ mirror == pytest.approx(P[0], abs=1e-9 * np.abs(P).max())
    unturned = solve_riccati(*filter_equation(SimpleNamespace(**vars(seen) | {"dynamics": blade.dynamics}), 0.5 * np.eye(22), 1.0))
    assert np.trace(unturned[0]) != pytest.approx(np.trace(P[0]), rel=1e-6)


def test_sensors_opposite_the_actuators_see_what_these_move():
    """On an untwisted hoop-wound blade without gyroscopic coupling the top wall mirrors the bottom wall: the filter with the
    regulator's weights for noise has the regulator's trace, at every position."""
    config = blade_config(
        "thesis-untwisted",
        {
            "model": "thesis",
            "beam": {"ply_angles_deg": [0.0] * 6},
            "patches": {"passive": False},
            "gyroscopic": False,
            "modes": 8,
        },
    )
    problem = PlacementProblem.of(config, "actuators", 1)
    positions = np.linspace(0.0, problem.bounds.high, 7)[:, None]
    blades = problem.reduced(positions)
    opposite = PlacementProblem.of(config, "sensors", 1).reduced(positions)
    ratio = np.abs(opposite.output).max() / np.abs(blades.input).max()
    weight = 1e-10
    regulator = solve_riccati(blades.dynamics, blades.input @ blades.input.swapaxes(1, 2) / weight, 0.5 * np.eye(16)[None])
    A, G, _ = filter_equation(opposite, np.eye(2), weight * ratio**2)
    duals = solve_riccati(A, G, 0.5 * np.eye(16)[None])
    assert np.trace(duals, axis1=1, axis2=2) == pytest.approx(np.trace(regulator, axis1=1, axis2=2), rel=1e-8)
