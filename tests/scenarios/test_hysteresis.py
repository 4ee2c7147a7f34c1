"""The actuators' loop: its width, and what makes a Prandtl–Ishlinskii operator (Brokate and Sprekels 1996)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beamenv import RotatingBeamEnv
from beamenv.simulation.signals.hysteresis import PLAYS, prandtl_ishlinskii

LOW, HIGH = -500.0, 1500.0
OPERATOR = prandtl_ishlinskii(0.2, LOW, HIGH)


def swept(*turning, steps=400, operator=OPERATOR, plays=None):
    """Voltages (k,), the effective ones (k,), and the plays at the end, on straight ways from turning point to turning point."""
    path = np.concatenate([np.linspace(a, b, steps + 1)[1:] for a, b in zip(turning[:-1], turning[1:], strict=True)])
    plays = np.zeros((1, 1, PLAYS)) if plays is None else plays
    effective = []
    for voltage in path:
        out, plays = operator.step(np.full((1, 1), voltage), plays)
        effective.append(out[0, 0])
    return path, np.array(effective), plays


def test_the_loop_of_a_full_sweep_is_a_fifth_of_its_stroke_wide():
    _, _, settled = swept(0.0, HIGH, LOW, HIGH, LOW)
    up, rising, settled = swept(LOW, HIGH, steps=2000, plays=settled)
    down, falling, _ = swept(HIGH, LOW, steps=2000, plays=settled)
    stroke = rising.max() - falling.min()
    assert rising.max() == pytest.approx(HIGH, rel=1e-9)
    middle = 0.5 * (HIGH + LOW)
    width = np.interp(middle, down[::-1], falling[::-1]) - np.interp(middle, up, rising)
    assert width / stroke == pytest.approx(0.2, rel=1e-9)


def test_a_small_voltage_from_rest_acts_with_the_initial_gain():
    """w₀ below the first play's radius of 111 V; the gain 1 at 1500 V."""
    assert OPERATOR.radii[0] == pytest.approx(1000.0 / 9.0)
    path, effective, _ = swept(0.0, 100.0)
    np.testing.assert_allclose(effective, OPERATOR.direct * path)
    assert 0.5 < OPERATOR.direct < 1.0
    assert swept(0.0, HIGH)[1][-1] == pytest.approx(HIGH, rel=1e-9)
    assert OPERATOR.weight > 0.0


def test_a_loop_takes_energy():
    """∮ u dv = 2 w Σ r (stroke − 2r) of the plays, positive: the loop is run through against the clock."""
    _, _, settled = swept(0.0, HIGH, LOW)
    path, effective, _ = swept(LOW, HIGH, LOW, steps=20_000, plays=settled)
    before = np.append(LOW, path[:-1]), np.append(effective[-1], effective[:-1])
    area = 0.5 * np.sum((path + before[0]) * (effective - before[1]))
    expected = 2.0 * OPERATOR.weight * np.sum(OPERATOR.radii * (HIGH - LOW - 2.0 * OPERATOR.radii))
    assert area == pytest.approx(expected, rel=1e-3)
    assert area > 0.0


@pytest.mark.parametrize("turning", [(300.0, 900.0), (-200.0, 400.0)])
def test_minor_loops_between_the_same_voltages_are_congruent(turning):
    low, high = turning
    first, second = (swept(0.0, before, low, high, low, high, low)[1] for before in (HIGH, LOW))
    loops = [effective[-800:] - effective[-801] for effective in (first, second)]
    np.testing.assert_allclose(loops[0], loops[1], atol=1e-9)
    assert not np.allclose(first[-800:], second[-800:])  # at different heights


def test_a_closed_minor_loop_is_forgotten():
    """Return-point memory: after 800 → 200 → 800 the way on is what it would have been without."""
    _, straight, _ = swept(0.0, 800.0, HIGH)
    _, looped, _ = swept(0.0, 800.0, 200.0, 800.0, HIGH)
    np.testing.assert_allclose(looped[-400:], straight[-400:], atol=1e-9)


def test_a_larger_swing_wipes_out_the_smaller_ones_before_it():
    _, _, lively = swept(0.0, 300.0, -100.0, 600.0, 200.0, HIGH, LOW)
    _, _, plain = swept(0.0, HIGH, LOW)
    np.testing.assert_allclose(lively, plain, atol=1e-9)


@given(st.lists(st.floats(LOW, HIGH), min_size=2, max_size=8), st.integers(2, 30))
def test_only_the_turning_points_count_not_the_rate(turning, steps):
    slow, quick = swept(0.0, *turning, steps=steps)[1], swept(0.0, *turning, steps=1)[1]
    np.testing.assert_allclose(slow[steps - 1 :: steps], quick, atol=1e-6)


@given(st.lists(st.floats(LOW, HIGH), min_size=1, max_size=8))
def test_effective_voltages_stay_within_the_drive(turning):
    """|v| ≤ the largest |u| so far: the gain rises with the voltage, to 1."""
    path, effective, _ = swept(0.0, *turning, steps=5)
    assert np.all(np.abs(effective) <= np.maximum.accumulate(np.abs(path)) + 1e-9)


def test_without_a_loop_it_is_the_identity():
    path, effective, _ = swept(0.0, HIGH, LOW, 300.0, operator=prandtl_ishlinskii(0.0, LOW, HIGH))
    np.testing.assert_allclose(effective, path, atol=1e-9)


def test_the_environment_keeps_to_the_data_sheets_limits_and_shows_what_was_asked_for():
    env = RotatingBeamEnv(scenario="hysteresis")
    env.reset(seed=0)
    for action, volts in ((1.0, 1500.0), (-1.0, -500.0), (-0.2, -300.0)):
        *_, info = env.step(np.full(4, action))
        np.testing.assert_allclose(info["volts"], volts)
    plant = env.plant
    np.testing.assert_array_equal(plant.voltage_limits, [[-500.0] * 4, [1500.0] * 4])


def test_the_blade_feels_the_effective_voltage():
    """One step from rest, without loads: x = B v Δt-exactly, v being the operator's of the normalised range."""
    quiet = {"preset": "hysteresis", **dict.fromkeys(("step", "pulse", "deflection", "harmonic"), 0.0), "white_load": False}
    bent, straight = RotatingBeamEnv(scenario=quiet), RotatingBeamEnv(scenario=quiet | {"drive": {"hysteresis": 0.0}})
    operator = prandtl_ishlinskii(0.2, -1.0 / 3.0, 1.0)
    plays = np.zeros((1, 4, PLAYS))
    for env in (bent, straight):
        env.reset(seed=0)
    for k in range(50):
        action = np.random.default_rng(k).uniform(-1.0 / 3.0, 1.0, size=4)
        effective, plays = operator.step(action[None], plays)
        bent.step(action)
        straight.step(effective[0])
        np.testing.assert_allclose(bent.state, straight.state, atol=1e-12)
