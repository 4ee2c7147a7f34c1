"""The small-gain theorem: what it says of one loop by hand, that it never errs, and why it says little of lightly damped blades."""

from dataclasses import replace

import numpy as np
import pytest

from baselines import Detuning, detuned_lqg, lqg, no_control, small_gain, stationary_cost
from baselines.design.linear import static_law


def off(plant, share):
    """The plant with every gain from voltages to readings larger by a share."""
    return replace(plant, B=plant.B * (1.0 + share))


def test_of_one_state_and_a_constant_gain_it_is_what_a_pencil_says(scalar_plant):
    """G = cb'/(z − a'), K S = −g/(1 + g G), largest at z = 1 where b' = b (1 − a')/−a of the held plant."""
    plant, gain = scalar_plant(), 2.0e4
    law = static_law(plant, "mine", np.array([[-gain]]))
    at_rest = plant.C[0, 0] * plant.B[0, 0] / -plant.A[0, 0]
    expected = 0.3 * at_rest * gain / (1.0 + gain * at_rest)
    assert small_gain(plant, law, [off(plant, 0.3)]) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("rate", [0.0, 10.0])
def test_a_loop_that_passes_is_stable_on_every_plant_within_the_bound(small_plant, rate):
    plant, generator = small_plant(), np.random.default_rng(0)
    law, passed, unstable = detuned_lqg(plant, Detuning(rate=rate)), 0, 0
    for size in np.geomspace(1e-4, 3.0, 25):
        A = plant.A.copy()
        omega = plant.natural_frequencies * (1.0 + 0.05 * size * generator.uniform(-1.0, 1.0, 3))
        A[:3, 3:], A[3:, :3] = np.diag(omega), -np.diag(omega)
        other = replace(plant, A=A, B=plant.B * (1.0 + size * generator.normal(size=plant.B.shape)))
        stable = np.isfinite(stationary_cost(other, law))
        if small_gain(plant, law, [other]) < 1.0:
            passed += 1
            assert stable
        unstable += not stable
    assert passed > 2
    assert unstable > 2


def test_no_control_holds_everything_and_an_unstable_loop_nothing(small_plant):
    plant = small_plant()
    assert small_gain(plant, no_control(plant), [off(plant, 0.5)]) == 0.0
    assert small_gain(plant, static_law(plant, "mine", 1e12 * np.eye(2)), [off(plant, 0.1)]) == np.inf


def test_a_mode_that_is_off_by_more_than_its_half_power_width_is_only_held_by_leaving_it_alone(small_plant):
    """The bound covers a plant that answers with the opposite sign there, though no such plant is meant."""
    plant = small_plant()
    omega = 1.04 * plant.natural_frequencies  # of 1 % damping: two half-power widths
    A = plant.A.copy()
    A[:3, 3:], A[3:, :3] = np.diag(omega), -np.diag(omega)
    other, law = replace(plant, A=A), lqg(plant)
    assert np.isfinite(stationary_cost(other, law))
    assert small_gain(plant, law, [other]) > 1.0
    timid = lqg(plant, R=1e4 * plant.input_weight)
    assert small_gain(plant, timid, [other]) < 1.0
    assert stationary_cost(plant, timid) > 2.0 * stationary_cost(plant, law)


def test_what_are_no_plants_of_the_same_kind_are_refused(small_plant, scalar_plant):
    plant = small_plant()
    with pytest.raises(ValueError, match="^others is None, but must be a list of one or more beamenv.Plant"):
        small_gain(plant, lqg(plant), None)
    with pytest.raises(ValueError, match="^others have other voltages"):
        small_gain(plant, lqg(plant), [scalar_plant()])
