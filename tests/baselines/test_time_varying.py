"""Riccati recursions over an episode: they tend to the stationary gains, and nothing costs less."""

from dataclasses import replace

import numpy as np
import pytest

from baselines import lqg, stationary_cost
from baselines.design.time_varying import Stage, filter_gains, regulator_gains
from baselines.laws.lqg import compensator, sampled_design
from beamenv.plant.plant import sample

ROUNDING = 1e-6
"""Gains are kept in single precision."""


def stage_of(plant):
    held = sample(plant)
    E = held.disturbance_input
    return Stage(
        A=held.A,
        B=held.B,
        C=held.C,
        Q=held.state_weight,
        N=held.cross_weight,
        R=held.input_weight,
        W=E @ held.process_noise @ E.T,
        V=held.sensor_noise,
    )


def test_a_scalar_recursion_is_the_quadratic_step_by_step(scalar_plant):
    plant = scalar_plant()
    stage, P = stage_of(plant), 0.3
    a, b, q, n, r = (getattr(stage, name).item() for name in "ABQNR")
    gains, first = regulator_gains([stage] * 4, np.array([[P]]))
    for gain in gains[::-1, 0, 0]:
        assert gain == pytest.approx((a * P * b + n) / (r + b * P * b), rel=ROUNDING)
        P = a * P * a + q - (a * P * b + n) ** 2 / (r + b * P * b)
    assert first.item() == pytest.approx(P, rel=1e-12)


def test_of_a_long_episode_the_first_gain_and_the_last_filter_are_the_stationary_optimum(small_plant):
    plant = small_plant()
    stage, n = stage_of(plant), len(plant.A)
    feedback, _ = regulator_gains([stage] * 6000, np.zeros((n, n)))
    gain, left = filter_gains([stage] * 6000, np.zeros((n, n)))
    held, regulated, filtered = sampled_design(plant)
    assert feedback[0] == pytest.approx(regulated.gain, rel=1e-4, abs=1e-5 * np.abs(regulated.gain).max())
    assert left == pytest.approx(filtered.matrix, rel=1e-4, abs=1e-6 * np.abs(filtered.matrix).max())
    law = compensator(plant, "limit", held, feedback[0].astype(float), gain[-1].astype(float))
    assert stationary_cost(plant, law) == pytest.approx(stationary_cost(plant, lqg(plant)), rel=1e-8)


def mean_cost(stage, feedback, gain, begun):
    """Of an episode, by the covariance of state and belief: nothing here knows where the gains are from."""
    n = len(begun)
    spread, total = np.zeros((2 * n, 2 * n)), 0.0
    spread[:n, :n] = begun
    for K, L in zip(feedback.astype(float), gain.astype(float), strict=True):
        # belief x̂ ← x̂ + L (C x + v − C x̂), then u = −K x̂
        seen = np.block([[np.eye(n), np.zeros((n, n))], [L @ stage.C, np.eye(n) - L @ stage.C]])
        spread = seen @ spread @ seen.T
        spread[n:, n:] += L @ stage.V @ L.T
        act = np.block([[np.eye(n), np.zeros((n, n))], [np.zeros((len(K), n)), -K]])
        weight = np.block([[stage.Q, stage.N], [stage.N.T, stage.R]])
        total += np.trace(weight @ act @ spread @ act.T)
        onward = np.block([[stage.A, -stage.B @ K], [np.zeros((n, n)), stage.A - stage.B @ K]])
        spread = onward @ spread @ onward.T
        spread[:n, :n] += stage.W
    return total


def test_over_an_episode_nothing_costs_less_than_the_recursions_and_they_cost_what_theory_says(small_plant):
    """J = tr P₀S₀ + Σ tr P⁺W + tr KᵀKʳ(S − LCS), the separation theorem's sum, and no other gains come below."""
    plant = small_plant()
    stage, n, steps = stage_of(plant), len(plant.A), 60
    begun = 1e-3 * np.diag(np.arange(1.0, n + 1.0))
    feedback, first = regulator_gains([stage] * steps, np.zeros((n, n)))
    gain, _ = filter_gains([stage] * steps, begun)
    least = mean_cost(stage, feedback, gain, begun)
    costs = [np.zeros((n, n))]
    for _ in range(steps):
        costs.append(regulator_gains([stage], costs[-1])[1])
    S, theory = begun, np.trace(first @ begun)
    for k in range(steps):
        P, L = costs[steps - k - 1], filter_gains([stage], S)[0][0].astype(float)
        K = feedback[k].astype(float)
        left = S - L @ stage.C @ S
        theory += np.trace(P @ stage.W) + np.trace(K.T @ (stage.R + stage.B.T @ P @ stage.B) @ K @ left)
        S = filter_gains([stage], S)[1]
    assert least == pytest.approx(theory, rel=ROUNDING)
    generator = np.random.default_rng(0)
    for _ in range(5):
        others = [each * (1.0 + 0.02 * generator.standard_normal(each.shape)) for each in (feedback, gain)]
        assert mean_cost(stage, others[0], gain, begun) > least
        assert mean_cost(stage, feedback, others[1], begun) > least


def test_plants_side_by_side_have_the_gains_of_each_alone(small_plant):
    plant = small_plant()
    stages = [stage_of(plant), stage_of(replace(plant, B=2.0 * plant.B))]
    both = Stage(*(np.stack([getattr(each, name) for each in stages]) for name in ("A", "B", "C", "Q", "N", "R", "W", "V")))
    n = len(plant.A)
    together, _ = regulator_gains([both] * 5, np.zeros((2, n, n)))
    for k, stage in enumerate(stages):
        assert together[:, k] == pytest.approx(regulator_gains([stage] * 5, np.zeros((n, n)))[0], rel=1e-5)
