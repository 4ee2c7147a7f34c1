"""The exact mean cost: hand-solved, against the separation principle, and never below the sampled optimum."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from baselines import lqg, lqr, no_control, velocity_feedback
from baselines.analysis.stationary import closed_loop_poles, stationary_cost
from baselines.design.riccati import sampled_kalman_filter, sampled_regulator
from beamenv.plant.plant import sample

GAINS = ("transition", "measurement_input", "voltage_input", "state_gain", "measurement_gain")


def separated_costs(plant):
    """Cost per second of regulating the known state, and what not knowing it adds."""
    held = sample(plant)
    E, W = held.disturbance_input, held.process_noise
    P, K = sampled_regulator(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight)
    S, L = sampled_kalman_filter(held.A, held.C, E @ W @ E.T, held.sensor_noise)
    n, m = held.B.shape
    load_weight = held.cost[n + m :, n + m :]
    known = np.trace(P @ E @ W @ E.T) + np.trace(load_weight @ W)
    estimation = np.trace((held.input_weight + held.B.T @ P @ held.B) @ K @ (S - L @ held.C @ S) @ K.T)
    return known / held.interval, estimation / held.interval


def test_white_load_on_one_decaying_state_costs_what_the_hand_says(scalar_plant):
    a, e, q, w, interval = -40.0, 0.5, 0.5, 4.5e-3, 5e-4
    plant = scalar_plant(a=a, e=e, q=q, w=w, interval=interval)
    phi = np.exp(a * interval)
    held_load = e * (phi - 1) / a
    variance = held_load**2 * w / interval / (1 - phi**2)
    spread_within = (phi**2 - 1) / (2 * a)
    load_within = (e / a) ** 2 * (spread_within - 2 * (phi - 1) / a + interval)
    by_hand = q * (variance * spread_within + w / interval * load_within) / interval
    assert stationary_cost(plant, no_control(plant)) == pytest.approx(by_hand, rel=1e-9)


def test_scalar_lqr_costs_the_root_of_its_quadratic(scalar_plant):
    plant = scalar_plant()
    held = sample(plant)
    A, B, q, r, cross = (m[0, 0] for m in (held.A, held.B, held.state_weight, held.input_weight, held.cross_weight))
    A_bar, q_bar = A - B * cross / r, q - cross**2 / r
    middle = r - r * A_bar**2 - B**2 * q_bar
    P = (-middle + np.sqrt(middle**2 + 4 * B**2 * r * q_bar)) / (2 * B**2)
    e, w = held.disturbance_input[0, 0], held.process_noise[0, 0]
    by_hand = (P * e**2 * w + held.cost[2, 2] * w) / held.interval
    assert stationary_cost(plant, lqr(plant)) == pytest.approx(by_hand, rel=1e-9)


def test_lqg_costs_what_lqr_costs_and_what_estimation_adds(small_plant):
    plant = small_plant()
    known, estimation = separated_costs(plant)
    assert stationary_cost(plant, lqr(plant)) == pytest.approx(known, rel=1e-8)
    assert stationary_cost(plant, lqg(plant)) == pytest.approx(known + estimation, rel=1e-8)
    assert estimation > 0


def test_controllers_rank_as_theory_says(small_plant):
    plant = small_plant()
    cost = {law.name: stationary_cost(plant, law) for law in (no_control(plant), velocity_feedback(plant), lqr(plant), lqg(plant))}
    assert cost["LQR (full state)"] < cost["LQG"] < cost["velocity feedback"] < cost["no control"]


def test_thesis_design_nears_the_sampled_optimum_as_the_interval_shrinks(small_plant):
    excess = []
    for interval in (4e-4, 1e-4, 2.5e-5):
        plant = small_plant(control_interval=interval)
        excess.append(stationary_cost(plant, lqg(plant, "continuous")) / stationary_cost(plant, lqg(plant)) - 1)
    assert 0 < excess[2] < excess[1] < excess[0]
    assert excess[2] < 0.01


@pytest.fixture(scope="module")
def blade(small_plant):
    return small_plant()


@pytest.fixture(scope="module")
def lqg_optimum(blade):
    law = lqg(blade)
    return law, stationary_cost(blade, law)


@pytest.fixture(scope="module")
def lqr_optimum(blade):
    law = lqr(blade)
    return law, stationary_cost(blade, law)


@given(
    seed=st.integers(0, 2**32 - 1),
    size=st.floats(1e-3, 0.5),
    gains=st.sets(st.sampled_from(GAINS), min_size=1),
    turn=st.booleans(),
)
@settings(max_examples=100)
def test_no_perturbed_compensator_beats_the_sampled_lqg(blade, lqg_optimum, seed, size, gains, turn):
    optimum, least = lqg_optimum
    random = np.random.default_rng(seed)
    changed = {}
    for name in sorted(gains):
        gain = getattr(optimum, name)
        noise = random.normal(size=gain.shape)
        changed[name] = gain * (1 + size * noise) if not turn else gain + size * np.abs(gain).mean() * noise
    assert stationary_cost(blade, replace(optimum, **changed)) >= least * (1 - 1e-9)


@given(seed=st.integers(0, 2**32 - 1), size=st.floats(1e-3, 0.5))
@settings(max_examples=100)
def test_no_perturbed_state_feedback_beats_lqr(blade, lqr_optimum, seed, size):
    optimum, least = lqr_optimum
    gain = optimum.measurement_gain * (1 + size * np.random.default_rng(seed).normal(size=optimum.measurement_gain.shape))
    assert stationary_cost(blade, replace(optimum, measurement_gain=gain)) >= least * (1 - 1e-9)


def test_closed_loop_poles_of_lqg_are_those_of_regulator_and_filter(small_plant):
    plant = small_plant()
    held = sample(plant)
    _, K = sampled_regulator(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight)
    E = held.disturbance_input
    _, L = sampled_kalman_filter(held.A, held.C, E @ held.process_noise @ E.T, held.sensor_noise)
    sampled = np.concatenate([np.linalg.eigvals(held.A - held.B @ K), np.linalg.eigvals(held.A @ (np.eye(6) - L @ held.C))])
    expected = np.sort_complex(np.log(sampled.astype(complex)) / held.interval)
    np.testing.assert_allclose(np.sort_complex(closed_loop_poles(plant, lqg(plant))), expected, rtol=1e-6)


def test_poles_without_control_are_the_blades_own(small_plant):
    plant = small_plant()
    poles = closed_loop_poles(plant, no_control(plant))
    np.testing.assert_allclose(np.sort_complex(poles), np.sort_complex(np.linalg.eigvals(plant.A)), rtol=1e-9)


def test_an_unstable_loop_costs_infinitely_much(small_plant):
    plant = small_plant()
    assert stationary_cost(plant, velocity_feedback(plant, gain=-1e12, verify=False)) == np.inf
