"""Model-predictive control: LQG while no limit is in sight, else the optimum within the limits, found by other means."""

from concurrent.futures import ThreadPoolExecutor

import gymnasium
import numpy as np
import pytest
from scipy.optimize import lsq_linear

import beamenv
from baselines import Detuning, PersistentLoad, detuned_lqg, evaluate, informed_lqg, informed_mpc, lqg, mpc
from baselines.design.delay import with_delay
from baselines.laws.lqg import sampled_design
from baselines.laws.mpc import doubling_blocks
from beamenv.plant.plant import sample
from beamenv.task import resolve_task

LOADS = {"no load estimate": None, "load estimate": PersistentLoad()}
BLOCKS = {"every interval": [1] * 6, "blocks": [1, 1, 2, 3], "one move held": [4]}


@pytest.fixture(params=LOADS, name="load")
def _load(request):
    return LOADS[request.param]


@pytest.fixture(params=BLOCKS, name="blocks")
def _blocks(request):
    return BLOCKS[request.param]


def states(count, order, size=0.004):
    """(count, order), √J, that ask the small plant's regulator for 800 and 2800 V (median); then line loads of some 3 N/m."""
    return np.random.default_rng(1).normal(size=(count, order)) * np.where(np.arange(order) < 6, size, 3.0)


def decide(law, state):
    """Voltage (N, m) when the filter's estimate is ``state`` (N, s): the reading is what the filter expects."""
    expected = np.clip(state @ law.output.T, -law.sensor_full_scale, law.sensor_full_scale)
    return law.predict(expected / law.instruments.measurement_scale, state)[0] * law.instruments.voltage_scale


def square_root(weight):
    """Matrix with rootᵀ root = weight."""
    values, vectors = np.linalg.eigh(weight)
    assert values[0] > -1e-12 * values[-1]
    return np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T


def least_squares(held, P, state, blocks):
    """Matrix and offset whose |matrix u + offset|² is the cost of the moves u, instant by instant from the sampled cost itself."""
    n, m = held.B.shape
    unit = np.concatenate([np.ones(n), np.full(m, 1500.0)])
    stage = square_root(held.cost[: n + m, : n + m] * np.outer(unit, unit)) / unit
    free, forced, matrix, offset = state, np.zeros((n, m * len(blocks))), [], []
    for move, length in enumerate(blocks):
        voltage = np.zeros((m, m * len(blocks)))
        voltage[:, m * move : m * (move + 1)] = np.eye(m)
        for _ in range(length):
            matrix.append(stage @ np.vstack([forced, voltage]))
            offset.append(stage @ np.concatenate([free, np.zeros(m)]))
            free, forced = held.A @ free, held.A @ forced + held.B @ voltage
    root = square_root(P)
    return np.vstack([*matrix, root @ forced]), np.concatenate([*offset, root @ free])


def test_without_a_limit_in_sight_it_is_lqg(small_plant, load):
    plant = small_plant(voltage_limits=np.array([[-1e6, -1e6], [1e6, 1e6]]))
    law, reference = mpc(plant, load), lqg(plant, persistent_load=load)
    memory = reference_memory = None
    for observation in 0.05 * np.random.default_rng(0).normal(size=(200, 3, 2)):
        action, memory = law.predict(observation, memory)
        expected, reference_memory = reference.predict(observation, reference_memory)
        np.testing.assert_allclose(action, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("delay", [1, 3])
def test_told_of_a_delay_it_is_the_lqg_of_that_delay_without_a_limit_in_sight(small_plant, delay):
    """And that is the optimum of the delayed plant, which `test_informed_lqg` shows."""
    plant, seen = small_plant(), 1e-3 * np.random.default_rng(3).normal(size=(30, 4, 2))
    laws = mpc(plant, rate_weight=1.0, delay=delay), detuned_lqg(plant, Detuning(delay=delay))
    memories = [None, None]
    for each in seen:
        (planned, memories[0]), (linear, memories[1]) = (
            law.predict(each, memory) for law, memory in zip(laws, memories, strict=True)
        )
        assert np.abs(linear).max() < 0.3
        assert planned == pytest.approx(linear, rel=1e-9, abs=1e-12)
    assert laws[0].solver_failures == 0


def test_told_of_a_delay_its_plan_is_the_best_within_the_limits_for_voltages_that_come_late(small_plant):
    """Against bounded least squares over the voltages asked for, with the blade simulated two intervals behind them."""
    plant, blocks, delay = small_plant(), [1] * 5, 2
    law, held = mpc(plant, None, blocks, delay=delay), sample(plant)
    P = sampled_design(plant, delay=delay)[1].matrix
    late = with_delay(held, delay)
    root, last = square_root(late.cost[: len(late.A) + 2, : len(late.A) + 2]), square_root(P)
    begin = np.concatenate([states(1, 6)[0], 200.0, -100.0, 300.0, 50.0], axis=None)

    def residual(moves):
        x, coming, rows = begin[:6], [begin[6:8], begin[8:10]], []
        for u in moves.reshape(-1, 2):
            rows.append(root @ np.concatenate([x, *coming, u]))
            x, coming = held.A @ x + held.B @ coming[-1], [u, coming[0]]
        return np.concatenate([*rows, last @ np.concatenate([x, *coming])])

    offset = residual(np.zeros(10))
    matrix = np.stack([residual(each) - offset for each in np.eye(10)], axis=1)
    bounds = tuple(np.tile(limit, 5) for limit in plant.voltage_limits)
    best = lsq_linear(matrix, -offset, bounds, tol=1e-14).x[:2]
    assert decide(law, begin[None])[0] == pytest.approx(best, abs=0.5)


def test_one_move_of_one_voltage_is_lqg_clipped(scalar_plant):
    """Least (u + Kx)² (R + BᵀPB) on an interval."""
    plant = scalar_plant()
    held, (_, K), _ = sampled_design(plant)
    state = np.linspace(-3.0, 3.0, 13)[:, None]
    voltage = decide(mpc(plant, move_blocks=[1]), state)
    np.testing.assert_allclose(voltage, np.clip(-state @ K.T, -1500.0, 1500.0), rtol=1e-9)
    assert np.abs(state @ K.T).max() > 1500.0 > np.abs(state @ K.T)[5]


def test_one_move_of_two_voltages_lets_the_free_one_help_the_bound_one(small_plant):
    """With S = R + BᵀPB: u₂ = −(Kx)₂ − S₂₁/S₂₂ (u₁ + (Kx)₁), where u₁ is at its limit and u₂ is not."""
    plant = small_plant(voltage_limits=np.array([[-500.0, -1e5], [1500.0, 1e5]]))
    held, (P, K), _ = sampled_design(plant)
    S = held.input_weight + held.B.T @ P @ held.B
    state = states(20, 6)
    wanted, voltage = -state @ K.T, decide(mpc(plant, move_blocks=[1]), state)
    first = np.clip(wanted[:, 0], -500.0, 1500.0)
    assert (first != wanted[:, 0]).sum() > 5
    np.testing.assert_allclose(voltage[:, 0], first, rtol=1e-9)
    np.testing.assert_allclose(voltage[:, 1], wanted[:, 1] - S[1, 0] / S[1, 1] * (first - wanted[:, 0]), rtol=1e-9)


def test_moves_are_the_bounded_least_squares_solution(small_plant, load, blocks):
    plant = small_plant()
    law, (held, (P, _), _) = mpc(plant, load, blocks), sampled_design(plant, load)
    drive, bounds = 1500.0, (np.tile([-1 / 3, -1 / 3], len(blocks)), np.ones(2 * len(blocks)))
    bound = free = 0
    for state in states(20, len(held.A)):
        matrix, offset = least_squares(held, P, state, blocks)
        scale = np.linalg.norm(matrix * drive)
        best = lsq_linear(matrix * drive / scale, -offset / scale, bounds, method="bvls", tol=1e-14)
        moves = law.program.minimise((law.program_gradient @ state)[None])[0] / drive
        np.testing.assert_allclose(moves, best.x, atol=1e-6)
        np.testing.assert_allclose(decide(law, state[None])[0] / drive, best.x[:2], atol=1e-6)
        bound += np.count_nonzero(best.active_mask)
        free += np.count_nonzero(best.active_mask == 0)
    assert bound > 5
    assert free > 5
    assert law.solver_failures == 0


def test_moves_fulfil_the_conditions_of_karush_kuhn_and_tucker(small_plant, load):
    """Uphill at a lower limit, downhill at an upper one, level between: the asymmetric limits are all met."""
    law = mpc(small_plant(), load)
    gradient = states(200, len(law.transition)) @ law.program_gradient.T
    moves = law.program.minimise(gradient)
    slope = (moves @ law.program.hessian + gradient) / np.abs(gradient).max()
    low, high = moves < -500.0 + 1e-9, moves > 1500.0 - 1e-9
    assert low.any(axis=0).all()
    assert high.any(axis=0).all()
    assert moves.min() == -500.0
    assert moves.max() == 1500.0
    assert slope[low].min() > -1e-12
    assert slope[high].max() < 1e-12
    assert np.abs(slope[~low & ~high]).max() < 1e-12


def test_a_reading_at_full_scale_tells_nothing_to_a_filter_that_expects_more(small_plant):
    law = mpc(small_plant())
    state = 3.0 * law.sensor_full_scale @ np.linalg.pinv(law.output).T
    action, memory = law.predict(np.ones(2), state)
    np.testing.assert_allclose(memory, law.transition @ state + law.voltage_input @ (1500.0 * action), rtol=1e-12)
    _, surprised = law.predict(np.array([0.9, 1.0]), state)
    assert np.abs(surprised - memory).max() > 1e-3 * np.abs(memory).max()


def test_the_solver_is_left_alone_while_the_plan_keeps_within_the_limits(small_plant, monkeypatch):
    law = mpc(small_plant())
    solved = []
    monkeypatch.setattr(type(law.program), "minimise", lambda self, f: solved.append(len(f)) or np.zeros_like(f))
    state = np.vstack([1e-3 * states(4, 6), states(1, 6)])
    decide(law, state)
    assert solved == [1]


def test_where_the_solver_gives_up_the_voltage_is_lqgs_clipped_and_counted(small_plant):
    plant = small_plant()
    law, (_, (_, K), _) = mpc(plant), sampled_design(plant)
    model, _ = law.program._solver()
    model.settings = {**model.settings, "iter_limit": 1}
    state = states(10, 6, size=0.5)
    np.testing.assert_allclose(decide(law, state), np.clip(-state @ K.T, -500.0, 1500.0), rtol=1e-9)
    assert law.solver_failures == 10


def test_moves_double_in_length_up_to_one_period_of_the_slowest_mode(small_plant):
    assert doubling_blocks(small_plant()) == [1, 1, 2, 2, 4, 4, 8, 8, 16, 16, 8]  # 2π / (180 rad/s × 0.5 ms) = 69.8
    assert doubling_blocks(small_plant(natural_frequencies=np.array([1e5]))) == [1]


@pytest.mark.parametrize("blocks", [[], [1, 0], [1.5], [True]])
def test_blocks_that_are_not_positive_whole_numbers_are_refused(small_plant, blocks):
    with pytest.raises(ValueError, match="move_blocks is .*, but must be a list of one or more counts, each a whole number"):
        mpc(small_plant(), move_blocks=blocks)


@pytest.mark.parametrize("blocks", [[10**8], [1001], [600, 600], [1] * 201])
def test_a_horizon_that_no_plan_needs_is_refused_at_once(small_plant, blocks):
    with pytest.raises(ValueError, match="^move_blocks is .*, but must be .*(from 1 to 1000|200 counts .* is at most 1000).$"):
        mpc(small_plant(), move_blocks=blocks)
    assert mpc(small_plant(), move_blocks=[1, 999]).unconstrained_plan.shape == (2000, 6)


def test_under_deep_saturation_it_costs_less_than_lqg_clipped(load):
    scenario = {"preset": "deflection", "magnitude": 300.0}
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=8, scenario=scenario, blade={"model": "thesis"})
    plant = envs.unwrapped.design_plant
    clipped = evaluate(lqg(plant, persistent_load=load), envs, range(8))
    law = mpc(plant, load)
    planned = evaluate(law, envs, range(8), reference=clipped.reference)
    assert clipped.saturation.value > 0.3
    assert planned.cost.value < clipped.cost.value
    assert law.solver_failures == 0


def test_one_law_in_eight_threads_drives_each_blade_as_if_alone(small_plant):
    law = mpc(small_plant())
    memories = states(8 * 64, 6, size=0.5).reshape(8, 64, 6)
    alone = [decide(law, memory) for memory in memories]
    with ThreadPoolExecutor(8) as threads:
        for _ in range(5):
            np.testing.assert_array_equal(list(threads.map(lambda memory: decide(law, memory), memories)), alone)
    assert law.solver_failures == 0


def test_informed_it_is_the_informed_lqg_without_a_limit_in_sight():
    prior = resolve_task(scenario="delay").prior
    laws, reading = (informed_mpc(prior), informed_lqg(prior)), np.array([1e-3, -2e-3, 0.0, 1e-3])
    memories = [None, None]
    for _ in range(10):
        (planned, memories[0]), (linear, memories[1]) = (
            law.predict(reading, memory) for law, memory in zip(laws, memories, strict=True)
        )
        assert planned == pytest.approx(linear, rel=1e-6, abs=1e-9)
    with pytest.raises(ValueError, match="^prior is None, but must be a beamenv.Prior"):
        informed_mpc(None)
