"""Every search: feasible, never worse than its start, the same for the same seed, close to the best of all layouts."""

from functools import lru_cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from baselines.placement import METHODS, PlacementProblem, place, reach
from baselines.placement.search.evolution import Evolution
from baselines.placement.search.genetic import Genetic, decoded, encoded
from baselines.placement.search.grid import Grid
from baselines.placement.search.search import InTurn
from baselines.placement.search.sqp import MultiStart, SequentialQuadratic
from beamenv.blade.presets import blade_config

QUICK = {
    "ga": Genetic(population=10, generations=4),
    "sqp": SequentialQuadratic(),
    "ga+sqp": InTurn((Genetic(population=10, generations=4), SequentialQuadratic())),
    "multistart": MultiStart(candidates=20, starts=2),
    "cma-es": Evolution(population=8, evaluations=80),
}


@lru_cache
def problem_of(side, count, preset="thesis", speed=200.0, model="blade"):
    return PlacementProblem.of(
        blade_config(preset, {"model": model, "beam": {"shear_flow": "consistent"}}, speed=speed), side, count
    )


@lru_cache
def grid_optimum(side, count):
    return place(problem_of(side, count), Grid(points=(201, 41)))


@settings(max_examples=3)
@given(st.integers(0, 10_000), st.sampled_from(["actuators", "sensors"]), st.integers(1, 4))
@pytest.mark.parametrize("method", QUICK)
def test_found_layouts_are_feasible_and_never_dearer_than_the_start(method, seed, side, count):
    problem = problem_of(side, count)
    start = problem.bounds.random(np.random.default_rng(seed), 1)[0]
    found = place(problem, QUICK[method], seed, start)
    assert problem.bounds.checked(found.positions).tolist() == list(found.positions)
    assert found.cost <= found.start_cost
    assert found.cost == pytest.approx(problem.cost(np.array([found.positions]))[0], rel=2e-8)
    assert found.start == pytest.approx(tuple(np.sort(start)))


@pytest.mark.parametrize("method", QUICK)
def test_the_same_seed_finds_the_same_layout_and_touches_no_global_generator(method):
    before = np.random.get_state()[1].copy()  # noqa: NPY002 - what must not change
    first, second = (place(problem_of("actuators", 3), QUICK[method], seed=5) for _ in range(2))
    assert first.positions == second.positions
    assert first.history == second.history
    assert np.array_equal(np.random.get_state()[1], before)  # noqa: NPY002


@pytest.mark.parametrize("side", ["actuators", "sensors"])
@pytest.mark.parametrize("method", ["ga+sqp", "multistart", "cma-es"])
def test_one_patch_is_put_where_the_grid_puts_it(method, side):
    found, best = place(problem_of(side, 1), method), grid_optimum(side, 1)
    assert found.cost == pytest.approx(best.cost, rel=1e-6)
    assert found.positions == pytest.approx(best.positions, abs=1e-3)


@pytest.mark.parametrize(("method", "within"), [("ga+sqp", 0.02), ("multistart", 1e-6)])
def test_two_patches_are_put_where_the_grid_puts_them(method, within):
    """The thesis' GA and SQP end in another valley now and then: here in one that is 1.3 % higher."""
    assert place(problem_of("actuators", 2), method).cost == pytest.approx(grid_optimum("actuators", 2).cost, rel=within)


@pytest.mark.slow
def test_sqp_betters_what_the_genetic_algorithm_found():
    """Thesis §6.6: the two together are superior to either."""
    alone, together = place(problem_of("actuators", 4), "ga"), place(problem_of("actuators", 4), "ga+sqp")
    assert together.cost < alone.cost
    assert together.cost <= place(problem_of("actuators", 4), "sqp").cost * (1.0 + 1e-9)


def test_optimal_actuator_shifts_towards_the_root_with_speed():
    """Thesis Table 6.3, one actuator: 0.194 m at rest, 0.002 m at 200 rad/s (untwisted); in its model ours 0.176 and 0.039 m. With
    the energy that the patch stores itself, the same wherever it is, the clamp is best at either speed."""
    at_rest, rotating = (
        place(problem_of("actuators", 1, "thesis-untwisted", speed, "thesis"), "multistart") for speed in (0.0, 200.0)
    )
    assert at_rest.positions[0] > rotating.positions[0] + 0.1
    assert at_rest.positions == pytest.approx([0.176], abs=0.002)  # own output: guards, does not prove
    assert rotating.positions == pytest.approx([0.039], abs=0.002)  # own output: guards, does not prove


def test_history_counts_up_while_the_cost_comes_down():
    told = []
    found = place(problem_of("actuators", 2), QUICK["ga+sqp"], progress=lambda done, cost: told.append((done, cost)))
    evaluations, costs = np.array(found.history).T
    assert np.all(np.diff(evaluations) >= 0) and np.all(np.diff(costs) <= 0.0)
    assert evaluations[-1] <= found.evaluations and costs[-1] == found.cost
    assert [cost for _, cost in told] == costs.tolist()
    assert told[-1][0] == pytest.approx(1.0)


@given(st.integers(0, 1000))
def test_strings_of_bits_hold_positions_to_a_third_of_a_millimetre(seed):
    bounds = problem_of("actuators", 3).bounds
    layout = bounds.random(np.random.default_rng(seed), 4)
    again = decoded(encoded(layout, bounds, 12), bounds, 12)
    assert np.abs(again - layout).max() <= 0.5 * bounds.high / (2**12 - 1) + 1e-12


def test_methods_are_known_by_name():
    assert set(METHODS) == {"ga+sqp", "ga", "sqp", "multistart", "cma-es", "grid"}
    with pytest.raises(ValueError, match="method is 'magic', but must be one of multistart, ga"):
        place(problem_of("actuators", 1), "magic")


def test_grid_serves_one_or_two_patches():
    with pytest.raises(ValueError, match="serves one or two patches, not 3"):
        place(problem_of("actuators", 3), "grid")


def test_an_infeasible_start_is_refused():
    with pytest.raises(ValueError, match="at least a patch"):
        place(problem_of("actuators", 2), "sqp", start=[0.0, 0.01])


def test_a_mode_beyond_reach_is_named():
    """On an untwisted hoop-wound blade at rest a patch in the middle of the top wall cannot move lag."""
    config = blade_config("thesis-untwisted", {"beam": {"ply_angles_deg": [0.0] * 6}}, speed=0.0)
    with pytest.raises(ValueError, match=r"actuators = \(.*\) m cannot move mode 2 \(lag, 13\d\.\d rad/s\)"):
        place(PlacementProblem.of(config, "actuators", 2), "sqp")
    with pytest.raises(ValueError, match=r"sensors = \(.*\) m cannot sense mode 2 \(lag, "):
        place(PlacementProblem.of(config, "sensors", 2), "sqp")


def test_gyroscopic_coupling_brings_lag_within_reach():
    config = blade_config("thesis-untwisted", {"beam": {"ply_angles_deg": [0.0] * 6}}, speed=200.0)
    problem = PlacementProblem.of(config, "actuators", 2)
    assert reach(problem, problem.bounds.uniform()).min() > 1e-3


@pytest.mark.parametrize("name", ["white_load", "sensor_noise_fraction"])
def test_sensors_need_noise_to_be_placed(name):
    with pytest.raises(ValueError, match=f"{name} = 0.0 must be positive"):
        PlacementProblem.of(blade_config(overrides={name: 0.0}), "sensors")


def test_an_unknown_side_is_refused():
    with pytest.raises(ValueError, match="side is 'top', but must be one of actuators, sensors"):
        PlacementProblem.of(blade_config(), "top")


def test_modes_beyond_reach_may_be_left_to_their_own_damping():
    config = blade_config("thesis-untwisted", {"beam": {"ply_angles_deg": [0.0] * 6}}, speed=0.0)
    found = place(PlacementProblem.of(config, "actuators", 2), "sqp", leave_unreached=True)
    assert np.isfinite(found.cost)
    assert found.cost < found.start_cost
