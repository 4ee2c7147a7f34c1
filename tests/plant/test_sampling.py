"""The sampled plant against exponentials in eighty digits, an ODE solver and Lyapunov's equation."""

from dataclasses import replace
from itertools import product

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import solve_continuous_lyapunov

from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.plant.plant import sample, sample_all

WITHIN = 1e-10
"""Of what is asked, 1e-9, a tenth. Measured: 3e-12 at ζ = 1e-4, where rounding A alone turns the phase so far; 5e-14 at 0.005."""
EXPONENTS = (1e-6, 1e-3, 1.0, 40.0, 1e3)
"""ζ ω_max Δt."""
INTERVALS = (1e-6, 1e-3, 1.0)
"""s."""


@pytest.fixture(scope="module")
def plant():
    return build_plant(blade_config())


@pytest.fixture(scope="module")
def full_plant():
    return build_plant(replace(blade_config(), modes=60))


def modal_plant(plant, frequencies, damping_ratio, coupling):
    """Modes with gyroscopic coupling, driven by four voltages and two loads through random modal forces."""
    r, generator = len(frequencies), np.random.default_rng(len(frequencies))
    A = np.zeros((2 * r, 2 * r))
    A[:r, r:] = np.diag(frequencies)
    A[r:] = np.hstack([-A[:r, r:], -np.diag(2.0 * damping_ratio * frequencies) - coupling])
    return driven(plant, A, np.vstack([np.zeros((r, 6)), generator.normal(size=(r, 6))]), 0.5 * np.eye(2 * r))


def driven(plant, A, inputs, weight):
    return replace(plant, A=A, B=1e-3 * inputs[:, :4], disturbance_input=inputs[:, 4:], state_weight=weight)


def coupled_modes(plant, modes, damping_ratio, fastest):
    """A plant and the sets of its modes that are coupled: all of a few, pairs far apart of many."""
    frequencies = fastest * np.geomspace(1.0 if modes == 1 else 1.0 / (100.0 * modes), 1.0, modes)
    coupling, generator = np.zeros((modes, modes)), np.random.default_rng(modes)
    sets = [list(range(modes))] if modes < 8 else generator.permutation(modes).reshape(-1, 2).tolist()
    for one in sets:
        random = generator.normal(size=(len(one), len(one)))
        coupling[np.ix_(one, one)] = 0.3 * frequencies[0] * (random - random.T)
    return modal_plant(plant, frequencies, damping_ratio, coupling), [one + [modes + k for k in one] for one in sets]


def exact(plant, sets, interval):
    """[A B E] and the cost by diagonalisation of each set of states in eighty digits: sums of exponentials, integrated by hand."""
    (n, m), inputs = plant.B.shape, np.hstack([plant.B, plant.disturbance_input])
    step, cost = np.zeros((n, n + inputs.shape[1])), np.zeros((n + inputs.shape[1],) * 2)
    for states in sets:
        own = np.ix_(states, states)
        transition, held, *parts = in_eighty_digits(plant.A[own], inputs[states], plant.state_weight[own], interval)
        step[own], step[states, n:] = transition, held
        cost[own], cost[states, n:], cost[n:, states] = parts[0], parts[1], parts[1].T
        cost[n:, n:] += parts[2]
    cost[n : n + m, n : n + m] += plant.input_weight * interval
    return step, cost


def in_eighty_digits(A, B, Q, interval):
    """Φ, Γ and the cost's blocks xx, xu, uu: with A = V Λ V⁻¹ all are sums of ∫exp(st)dt = (exp(sΔt) − 1)/s."""
    with mpmath.workdps(80):
        time, size = mpmath.mpf(float(interval)), range(len(A))
        poles, vectors = mpmath.eig(mpmath.matrix(A.tolist()))
        inverse = vectors**-1
        drive, weight = inverse * mpmath.matrix(B.tolist()), vectors.T * mpmath.matrix(Q.tolist()) * vectors
        once = [integral(s, time) for s in poles]
        blocks = [mpmath.matrix(len(A), len(A)) for _ in range(3)]
        for i in size:
            for j in size:
                both, (a, b) = integral(poles[i] + poles[j], time), (poles[i], poles[j])
                blocks[0][i, j] = weight[i, j] * both
                blocks[1][i, j] = weight[i, j] * (both - once[i]) / b
                blocks[2][i, j] = weight[i, j] * (both - once[i] - once[j] + time) / (a * b)
        found = (
            vectors * mpmath.diag([mpmath.exp(s * time) for s in poles]) * inverse,
            vectors * mpmath.diag(once) * drive,
            inverse.T * blocks[0] * inverse,
            inverse.T * blocks[1] * drive,
            drive.T * blocks[2] * drive,
        )
        return [np.array([[float(mpmath.re(each)) for each in row] for row in part.tolist()]) for part in found]


def integral(pole, time):
    return mpmath.expm1(pole * time) / pole


def error(held, step, cost):
    """Largest error of A (entries up to 1), of [B E] by the largest response to each input, of the cost by its diagonal."""
    n, scale = len(step), np.sqrt(np.diag(cost))
    scale = np.where(scale > 0.0, scale, 1.0)
    found = np.hstack([held.B, held.disturbance_input])
    return max(
        np.abs(held.A - step[:, :n]).max(),
        (np.abs(found - step[:, n:]) / np.abs(step[:, n:]).max(axis=0)).max(),
        (np.abs(held.cost - cost) / np.outer(scale, scale)).max(),
    )


def check(held, step, cost):
    assert error(held, step, cost) < WITHIN
    scale = 1.0 / np.sqrt(np.maximum(np.diag(cost), 1e-300))
    assert np.linalg.eigvalsh(held.cost * np.outer(scale, scale)).min() > -1e-13
    np.testing.assert_array_equal(held.cost, held.cost.T)


@pytest.mark.parametrize(
    ("modes", "interval", "exponent"),
    [*product((1, 4), INTERVALS, EXPONENTS), *product((60,), (1e-3,), EXPONENTS[::2])],
)
def test_step_and_cost_are_exact_for_any_damping_over_an_interval(plant, modes, interval, exponent):
    modal, sets = coupled_modes(plant, modes, 0.005, exponent / 0.005 / interval)
    check(sample(modal, interval), *exact(modal, sets, interval))


@pytest.mark.slow
@pytest.mark.parametrize("exponent", [10.0**k for k in range(-6, 4)])
@pytest.mark.parametrize("damping_ratio", [1e-4, 0.005, 3.0])
@pytest.mark.parametrize("modes", [7, 60])
def test_step_and_cost_are_exact_for_any_modes_damping_and_interval(plant, exponent, damping_ratio, modes):
    for interval in INTERVALS:
        modal, sets = coupled_modes(plant, modes, damping_ratio, exponent / damping_ratio / interval)
        check(sample(modal, interval), *exact(modal, sets, interval))


@pytest.mark.parametrize(("interval", "time_constant"), [(1e-6, 1e-6), (5e-4, 1e-4), (5e-4, 1e-6), (1.0, 1e-6)])
def test_amplifiers_and_filters_far_faster_than_the_blade_do_no_harm(plant, interval, time_constant):
    """Two lagging amplifiers drive the modes, a second-order filter in companion form reads them, with numbers up to 10¹²."""
    modal, [states] = coupled_modes(plant, 4, 0.005, 2700.0)
    r, rate, generator = len(modal.A), 1.0 / time_constant, np.random.default_rng(3)
    A, inputs = np.zeros((r + 4, r + 4)), np.zeros((r + 4, 6))
    A[:r, :r], A[r // 2 : r, r : r + 2] = modal.A, 1e-3 * generator.normal(size=(r // 2, 2))
    A[r, r], A[r + 1, r + 1], A[r + 2, r + 3] = -rate, -1.1 * rate, 1.0
    A[r + 3] = [*np.zeros(r // 2), *rate**2 * generator.normal(size=r // 2), 0.0, 0.0, -(rate**2), -1.4 * rate]
    inputs[:r, 4:], inputs[r, 0], inputs[r + 1, 1] = modal.disturbance_input, rate, 1.1 * rate
    stiff = driven(plant, A, inputs, np.diag([0.5] * r + [0.0] * 4))
    stiff = replace(stiff, input_weight=np.diag(np.diag(plant.input_weight)))
    held, (step, cost) = sample(stiff, interval), exact(stiff, [list(range(r + 4))], interval)
    largest = np.abs(step).max(axis=1, keepdims=True)
    found = np.hstack([held.A, held.B, held.disturbance_input])
    assert (np.abs(found - step) / largest).max() < WITHIN
    seen = np.r_[: r + 2, r + 4 : r + 10]
    assert not held.cost[r + 2 : r + 4].any()  # the cost knows nothing of the filter
    scale = np.sqrt(np.diag(cost)[seen])
    assert (np.abs(held.cost - cost)[np.ix_(seen, seen)] / np.outer(scale, scale)).max() < WITHIN


@pytest.mark.parametrize("exponent", [1.0, 40.0, 400.0])
def test_the_cost_of_sixty_modes_over_a_long_interval_is_what_lyapunovs_equation_leaves(full_plant, exponent):
    """∫₀^Δt = ∫₀^∞ less what is left at Δt: at 40 a single exponential has no digit left, at 400 no number."""
    interval = exponent / (0.005 * full_plant.natural_frequencies[-1])
    held = sample(full_plant, interval)
    endless = solve_continuous_lyapunov(full_plant.A.T, -full_plant.state_weight)
    rest = held.A.T @ endless @ held.A
    np.testing.assert_allclose(held.state_weight, endless - rest, rtol=0.0, atol=1e-10 * np.abs(held.state_weight).max())


def test_the_cost_rate_at_the_end_of_an_interval_is_that_of_the_state_there(full_plant):
    """MᵀP + PM = ΦᵀWΦ − W for inputs too: the integral of a derivative."""
    for interval in (5e-4, 0.1):
        held, (n, m) = sample(full_plant, interval), full_plant.B.shape
        inputs = np.hstack([full_plant.B, full_plant.disturbance_input])
        dynamics, transition, weight = np.zeros_like(held.cost), np.eye(len(held.cost)), np.zeros_like(held.cost)
        dynamics[:n] = np.hstack([full_plant.A, inputs])
        transition[:n] = np.hstack([held.A, held.B, held.disturbance_input])
        weight[:n, :n], weight[n : n + m, n : n + m] = full_plant.state_weight, full_plant.input_weight
        left = dynamics.T @ held.cost + held.cost @ dynamics
        right = transition.T @ weight @ transition - weight
        scale = np.sqrt(np.diag(held.cost)) * np.linalg.norm(full_plant.A, 2) ** 0.5
        assert (np.abs(left - right) / np.outer(scale, scale)).max() < 1e-12


@pytest.mark.parametrize("modes", [11, 60])
def test_held_step_and_its_cost_equal_an_ode_solver_with_the_cost_as_a_state(plant, full_plant, modes):
    plant = {11: plant, 60: full_plant}[modes]
    rng = np.random.default_rng(1)
    held = sample(plant)
    x = rng.normal(size=len(plant.A)) * 1e-2
    u, d = rng.uniform(-1500, 1500, plant.B.shape[1]), rng.uniform(-30, 30, 2)

    def rate(_, z):
        state = z[:-1]
        running = state @ plant.state_weight @ state + u @ plant.input_weight @ u
        return np.append(plant.A @ state + plant.B @ u + plant.disturbance_input @ d, running)

    end = solve_ivp(rate, (0.0, held.interval), np.append(x, 0.0), rtol=1e-12, atol=1e-18, method="DOP853").y[:, -1]
    following = held.A @ x + held.B @ u + held.disturbance_input @ d
    joined = np.concatenate([x, u, d])
    assert following == pytest.approx(end[:-1], rel=1e-9, abs=1e-10 * np.abs(x).max())
    assert joined @ held.cost @ joined == pytest.approx(end[-1], rel=1e-9)


def test_two_half_intervals_make_a_whole_one(plant):
    half, whole = sample(plant, 0.5 * plant.control_interval), sample(plant)
    assert pytest.approx(whole.A, abs=1e-12) == half.A @ half.A
    assert pytest.approx(whole.B, abs=1e-12 * np.abs(whole.B).max()) == half.A @ half.B + half.B


def test_plants_sampled_together_are_those_sampled_alone(plant):
    several = [replace(plant, A=speed * plant.A) for speed in (1.0, 1.01, 40.0, 1.02, 1e-4)]
    for alone, together in zip(map(sample, several), sample_all(several), strict=True):
        for name in ("A", "B", "disturbance_input", "cost"):
            np.testing.assert_array_equal(getattr(together, name), getattr(alone, name))


def test_held_white_load_keeps_the_intensity_of_the_continuous_one(plant):
    """Over many intervals W/Δt held for Δt has the intensity W, whatever Δt is."""
    slow = replace(plant, control_interval=2.0 * plant.control_interval)
    assert sample(slow).process_noise * 2.0 == pytest.approx(sample(plant).process_noise)
    assert sample(plant).process_noise == pytest.approx(9.0 * np.eye(2))


def test_cost_of_an_interval_is_never_negative(plant):
    assert np.linalg.eigvalsh(sample(plant).cost).min() > -1e-15


@pytest.mark.parametrize("interval", [0.0, -1e-3, np.inf, np.nan, "1 ms"])
def test_an_interval_that_is_none_is_refused(plant, interval):
    with pytest.raises(ValueError, match=r"^interval is .*, but must be a positive number"):
        sample(plant, interval)


@pytest.mark.parametrize("A", [np.eye(22) * 1e4, np.full((22, 22), np.nan), np.full((22, 22), np.inf)])
def test_a_plant_without_a_finite_state_is_refused(plant, A):
    for sampling in (lambda each: sample(each, 1.0), lambda each: sample_all([plant, each], 1.0)):
        with pytest.raises(ValueError, match=r"interval = 1.0 s leaves the plant without a finite state"):
            sampling(replace(plant, A=A))
