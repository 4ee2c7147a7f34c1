"""H∞ control against the scalar problem of the textbooks, its own bound, and LQG as the limit."""

from dataclasses import replace

import numpy as np
import pytest

from baselines import lqg, stationary_cost
from baselines.analysis.frequency_response import h_infinity_norm
from baselines.laws.h_infinity import h_infinity, h_infinity_law, least_attenuation
from beamenv.plant.plant import sample


@pytest.fixture(name="blade", scope="module")
def _blade(small_plant):
    plant = small_plant()
    return plant, least_attenuation(plant)


@pytest.mark.parametrize("a", [-1.0, 0.0, 1.0])
def test_scalar_textbook_problem_has_its_least_gamma_by_hand(scalar_plant, a):
    """ẋ = a x + u + d, y = x + v, z = (x, u): both Riccati equations are 2aP + 1 = (1 − γ⁻²)P², and P = γ gives γ² = 2aγ + 2."""

    def least(interval):
        unit = {"b": 1.0, "c": 1.0, "e": 1.0, "q": 1.0, "r": 1.0, "w": 1.0, "v": 1.0}
        return least_attenuation(scalar_plant(a=a, interval=interval, **unit))

    by_hand = a + np.sqrt(a**2 + 2)
    coarse, fine = least(2e-2), least(1e-2)
    assert 0 < fine - by_hand < coarse - by_hand < 0.02 * by_hand  # sampling costs something
    assert 2 * fine - coarse == pytest.approx(by_hand, rel=2e-4)  # in proportion to the interval


@pytest.mark.parametrize("back_off", [1.001, 1.05, 1.2, 2.0])
def test_the_closed_loop_stays_below_gamma(blade, back_off):
    plant, least = blade
    norm = h_infinity_norm(plant, h_infinity_law(plant, back_off * least))
    assert least * (1 - 1e-5) < norm < back_off * least


def test_at_the_least_gamma_the_bound_is_reached(blade):
    plant, least = blade
    assert h_infinity_norm(plant, h_infinity_law(plant, 1.0001 * least)) == pytest.approx(least, rel=2e-4)


def test_a_gamma_that_does_not_matter_gives_lqg(blade):
    plant, least = blade
    law, limit = h_infinity_law(plant, 1e4 * least), lqg(plant)
    for gain in ("transition", "measurement_input", "voltage_input", "state_gain", "measurement_gain"):
        expected = getattr(limit, gain)
        np.testing.assert_allclose(getattr(law, gain), expected, atol=1e-6 * np.abs(expected).max())


def test_the_worst_case_is_bought_with_the_mean(blade):
    plant, least = blade
    law, optimum = h_infinity_law(plant, 1.2 * least), lqg(plant)
    assert h_infinity_norm(plant, law) < 0.9 * h_infinity_norm(plant, optimum)
    assert stationary_cost(plant, law) > stationary_cost(plant, optimum)


def test_no_perturbed_law_beats_the_least_gamma(blade):
    plant, least = blade
    law, random = h_infinity_law(plant, 1.0001 * least), np.random.default_rng(2)
    for size in np.repeat([1e-4, 1e-3, 1e-2, 1e-1], 10):
        gains = {
            gain: getattr(law, gain) * (1 + size * random.normal(size=getattr(law, gain).shape))
            for gain in ("transition", "measurement_input", "voltage_input", "state_gain", "measurement_gain")
        }
        assert h_infinity_norm(plant, replace(law, **gains)) > least * (1 - 1e-5)


def test_the_estimate_follows_the_voltage_that_was_applied(small_plant):
    plant = small_plant(voltage_limits=np.array([[-1.0, -1.0], [3.0, 3.0]]))
    law, wide = h_infinity(plant), h_infinity(small_plant())
    y, clipped = np.array([0.5, -0.4]), np.array([-1.0, 3.0])
    action, memory = law.predict(y)
    free, wide_memory = wide.predict(y)
    assert set(3.0 * action) <= set(clipped)
    held, excess = sample(plant), 3.0 * action - 1500.0 * free
    np.testing.assert_allclose(memory - wide_memory, law.voltage_input @ excess, rtol=1e-6, atol=1e-12)
    assert np.abs(law.voltage_input - held.B).max() < 0.1 * np.abs(held.B).max()


def test_sensors_next_to_exact_are_no_obstacle(small_plant):
    exact = small_plant(sensor_noise=np.zeros((2, 2)))
    assert h_infinity_norm(exact, h_infinity(exact)) < h_infinity_norm(exact, lqg(exact))


def test_what_is_not_possible_is_refused_by_name(blade, small_plant):
    plant, least = blade
    with pytest.raises(ValueError, match="plant has no white load"):
        h_infinity(small_plant(process_noise=np.zeros((2, 2))))
    with pytest.raises(ValueError, match="attenuation = .* is too little"):
        h_infinity_law(plant, 0.99 * least)
    with pytest.raises(ValueError, match="back_off is 1.0, but must be a number above 1"):
        h_infinity(plant, back_off=1.0)
    with pytest.raises(ValueError, match="back_off is '2', but must be a number above 1"):
        h_infinity(plant, back_off="2")
