"""Undamped modes that no voltage, no sensor or no load reaches: no law is the optimum then."""

import numpy as np
import pytest

from baselines import (
    clipped_lqg,
    full_order_lqg,
    lqg,
    lqr,
    mpc,
    reference_lqg,
    stationary_cost,
)
from baselines.design.riccati import (
    Unsolved,
    sampled_regulator,
)


def test_a_mode_on_the_unit_circle_out_of_reach_has_no_regulator():
    one, none = np.eye(1), np.zeros((1, 1))
    with pytest.raises(Unsolved):
        sampled_regulator(one, none, one, one)


def out_of_reach(small_plant, **changes):
    """Mode 2 of three undamped and uncoupled ones, which no voltage, no sensor or no load reaches."""
    plant = small_plant()
    omega = np.diag(plant.natural_frequencies)
    kept = {name: getattr(plant, name).copy() for name in ("B", "C", "disturbance_input")}
    for name in changes:
        kept[name][(4, slice(None)) if name != "C" else (slice(None), 4)] = 0.0
    return small_plant(A=np.block([[np.zeros((3, 3)), omega], [-omega, np.zeros((3, 3))]]), **kept)


@pytest.mark.parametrize(
    ("matrix", "words"), [("B", "no voltage reaches"), ("C", "no sensor sees"), ("disturbance_input", "no white load drives")]
)
def test_an_undamped_mode_out_of_reach_is_named(small_plant, matrix, words):
    plant = out_of_reach(small_plant, **{matrix: True})
    laws = [lqg, lambda each: lqg(each, "continuous"), clipped_lqg, mpc, reference_lqg, full_order_lqg]
    for law in laws + [lqr] * (matrix == "B"):
        with pytest.raises(ValueError, match=f"^plant has mode 2 at 260 rad/s, undamped, which {words}") as told:
            law(plant)
        assert "\n" not in str(told.value)


def test_within_reach_undamped_modes_are_held(small_plant):
    plant = out_of_reach(small_plant)
    assert stationary_cost(plant, lqg(plant)) < np.inf
