"""Feasible layouts, and the nearest of them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import LinearConstraint, minimize

from beamenv.blade.bounds import Bounds
from beamenv.patches import PatchLayout

SPAN = 2.023


def bounds_for(count, limits=None):
    return Bounds.of(PatchLayout(), SPAN, count, limits, "actuators")


def is_feasible(bounds, layout):
    return bounds.checked(layout).shape == (bounds.count,)


@given(st.lists(st.floats(-1.0, 3.0), min_size=1, max_size=8))
def test_repaired_layouts_are_feasible_and_repair_leaves_them_alone(positions):
    bounds = bounds_for(len(positions))
    repaired = bounds.repaired(positions)
    assert is_feasible(bounds, repaired)
    assert bounds.repaired(repaired) == pytest.approx(repaired, abs=1e-12)


@given(st.integers(0, 1000))
def test_repair_moves_patches_no_further_than_it_must(seed):
    bounds = bounds_for(4)
    wanted = np.sort(np.random.default_rng(seed).uniform(0.0, 0.6, 4))
    apart = np.eye(4, k=1)[:-1] - np.eye(4)[:-1]
    nearest = minimize(
        lambda x: np.sum((x - wanted) ** 2) * 1e3,
        bounds.uniform(),
        jac=lambda x: 2e3 * (x - wanted),
        bounds=[(bounds.low, bounds.high)] * 4,
        constraints=LinearConstraint(apart, bounds.length, np.inf),
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    ).x
    assert bounds.repaired(wanted) == pytest.approx(nearest, abs=1e-4)


def test_a_batch_is_repaired_row_by_row():
    bounds = bounds_for(3)
    layouts = np.random.default_rng(0).uniform(-0.2, 1.6, (20, 3))
    assert bounds.repaired(layouts) == pytest.approx(np.stack([bounds.repaired(row) for row in layouts]), abs=1e-12)


def test_random_layouts_are_feasible_and_reach_all_of_the_span():
    bounds = bounds_for(4)
    layouts = bounds.random(np.random.default_rng(0), 2000)
    assert all(is_feasible(bounds, layout) for layout in layouts[:50])
    assert layouts.min() < 0.01 and layouts.max() > bounds.high - 0.01


@pytest.mark.parametrize(
    ("count", "limits", "sentence"),
    [
        (17, None, r"actuators is 17, but must be at most 16, for patches of 0.085 m"),
        (0, None, r"actuators is 0, but must be a whole number not below 1"),
        (True, None, r"actuators is True, but must be a whole number"),
        (2, (0.1, 0.15), r"actuators is 2, but must be at most 1, for patches of 0.085 m"),
        (1, (0.5, 0.4), r"bounds is \(0.5, 0.4\), but must be ascending"),
        (1, (0.0, 1.5), r"bounds is \(0.0, 1.5\), but must be .* between 0 and 1.3311 m"),
        (1, (0.0, float("nan")), r"bounds is \(0.0, nan\), but must be a list of 2 numbers, each a finite"),
        (1, "ab", r"bounds is 'ab', but must be a list of 2 numbers"),
    ],
)
def test_what_does_not_fit_is_refused_in_one_sentence(count, limits, sentence):
    with pytest.raises(ValueError, match=sentence):
        bounds_for(count, limits)


def test_a_patch_longer_than_its_room_is_refused():
    with pytest.raises(ValueError, match=r"too long.*by 0\.08"):
        Bounds.of(PatchLayout(length=1.5), SPAN, 1, None, "sensors")


@pytest.mark.parametrize(
    ("layout", "sentence"),
    [
        ([0.0, np.nan], r"actuators is \[0.0, nan\], but must be 2 finite positions"),
        ([0.0], "must be 2 finite positions"),
        ([0.0, 0.05], "at least a patch, 0.085 m, apart"),
        ([-0.1, 0.5], "must be between 0 and 1.3311 m"),
    ],
)
def test_a_layout_that_is_not_feasible_is_refused(layout, sentence):
    with pytest.raises(ValueError, match=sentence):
        bounds_for(2).checked(layout)
