"""What chapter 6 of the thesis concludes, as our blade has it."""

import numpy as np
import pytest

from train.reproduce.studies.chapter6_layouts import placed_blade
from train.reproduce.studies.placement_study import (
    convergence,
    depth,
    descents,
    gathering_at_the_root,
    initial_and_optimal,
    placed,
    poles,
    shift_with_speed,
    starts_that_fail,
    table_row,
    together_against_alone,
    variants,
)
from train.reproduce.thesis import Model

UNTWISTED = placed_blade(Model())


@pytest.fixture(scope="module")
def rows():
    return {(side, speed): table_row(side, 2, speed, UNTWISTED) for side in ("actuators", "sensors") for speed in (0.0, 200.0)}


@pytest.fixture(scope="module")
def layouts():
    return initial_and_optimal(UNTWISTED, table_row("actuators", 4, UNTWISTED.speed, UNTWISTED))


def test_actuators_shift_towards_the_root_with_speed(rows):
    at_rest, rotating = shift_with_speed([rows["actuators", 0.0], rows["actuators", 200.0]])[2]
    assert rotating < at_rest


def test_sensors_lie_nearer_the_root_than_actuators_at_rest(rows):
    ((_, _, sensors, actuators),) = gathering_at_the_root([rows["sensors", 0.0]], [rows["actuators", 0.0]])
    assert sensors < actuators
    assert rows["sensors", 0.0].both.positions == pytest.approx((0.0, 0.085), abs=1e-6)  # as close to the root as they can be


def test_genetic_algorithm_then_sqp_is_never_dearer_than_either(rows):
    for ga, sqp in together_against_alone(list(rows.values())):
        assert ga >= 0.0 and sqp >= -1e-9
    assert max(sqp for _, sqp in together_against_alone(list(rows.values()))) > 0.2  # two actuators, 200 rad/s


def test_sqp_depends_on_its_start():
    found = descents("actuators", 2, 200.0, UNTWISTED, starts=8)
    assert starts_that_fail(found, placed("actuators", 2, UNTWISTED).cost) > 0.0


def test_fitness_falls_from_generation_to_generation():
    for curve in (convergence(UNTWISTED, size, generations=5) for size in (6, 12)):
        assert len(curve) == 5
        assert np.all(np.diff(curve) <= 0.0)  # the best so far cannot rise; it must fall too
        assert curve[-1] < curve[0]


def test_placed_patches_push_the_slowest_poles_deeper(layouts):
    shown = poles(layouts)
    for side in ("actuators", "sensors"):
        assert depth(shown[side, "optimal"])[0] > depth(shown[side, "initial"])[0]


@pytest.mark.slow
def test_optimal_locations_depend_on_speed_twist_presetting_and_number():
    as_it_is, *others = (np.array(placed("actuators", count, blade).positions) for blade, count in variants(UNTWISTED).values())
    assert all(np.abs(other[:2] - as_it_is).max() > 1e-3 for other in others)
