"""Stability margins against loops whose margins can be written down, and against the guarantees of LQR."""

import numpy as np
import pytest

from baselines import lqg, lqr, no_control, stationary_cost
from baselines.analysis.margins import stability_margins
from baselines.design.linear import static_law
from baselines.laws.velocity_feedback import velocity_feedback


def integrator(scalar_plant, gain, interval=0.5):
    """x⁺ = x + Δt u under u = −k x: L(z) = g/(z − 1) with g = k Δt."""
    plant = scalar_plant(a=0.0, b=1.0, c=1.0, interval=interval)
    return plant, static_law(plant, "proportional", np.array([[-gain / interval]]))


@pytest.mark.parametrize("gain", [0.2, 0.7, 1.5])
@pytest.mark.parametrize("at", ["input", "output"])
def test_sampled_integrator_has_the_margins_by_hand(scalar_plant, gain, at):
    plant, law = integrator(scalar_plant, gain)
    margins = stability_margins(plant, law, at)
    crossover = 2 * np.arcsin(gain / 2)  # |z − 1| = g
    assert margins.gain_margin_db[0] == -np.inf
    assert margins.gain_margin_db[1] == pytest.approx(20 * np.log10(2 / gain), rel=1e-9)  # L(−1) = −g/2
    assert margins.phase_margin_deg == pytest.approx(90 - np.degrees(crossover) / 2, rel=1e-8)
    assert margins.delay_margin == pytest.approx((np.pi / 2 - crossover / 2) / crossover * 0.5, rel=1e-8)
    assert margins.disk_margin == pytest.approx(2 * (2 - gain) / (2 + gain), rel=1e-9)
    assert margins.peak_sensitivity == pytest.approx(2 / (2 - gain), rel=1e-9)  # S(−1) = 2/(2 − g)


def test_an_unstable_first_order_blade_bounds_the_gain_from_below_too(scalar_plant):
    a, interval, gain = 3.0, 1e-3, 7.0
    plant = scalar_plant(a=a, b=1.0, c=1.0, interval=interval)
    law = static_law(plant, "proportional", np.array([[-gain]]))
    phi = np.exp(a * interval)
    b = (phi - 1) / a
    low, high = (phi - 1) / (gain * b), (phi + 1) / (gain * b)  # |φ − k b| = 1
    np.testing.assert_allclose(stability_margins(plant, law).gain_margin_db, 20 * np.log10([low, high]), rtol=1e-9)


def test_lqr_nears_sixty_degrees_half_the_gain_and_unit_sensitivity_as_the_interval_shrinks(small_plant):
    def one_actuator(interval):
        plant = small_plant()
        weight = 1e-3 * plant.input_weight[:1, :1]  # dear enough to matter, cheap enough to cross over
        return small_plant(
            B=plant.B[:, :1],
            D=np.zeros((2, 1)),
            input_weight=weight,
            voltage_limits=plant.voltage_limits[:, :1],
            control_interval=interval,
        )

    excess = []
    for interval, slack in ((1e-5, 0.03), (1e-7, 0.0003)):
        plant = one_actuator(interval)
        margins = stability_margins(plant, lqr(plant))
        assert margins.gain_margin_db[0] < 20 * np.log10(0.5) * (1 - slack)
        assert margins.gain_margin_db[1] > 20
        assert margins.phase_margin_deg > 60 * (1 - slack)
        excess.append(margins.peak_sensitivity - 1)
        assert margins.disk_margin > 2 / 3 * (1 - slack)  # |S| ≤ 1 gives |S − ½| ≤ 3/2
    assert excess[0] < 0.03
    assert excess[1] == pytest.approx(excess[0] / 100, rel=0.1)


@pytest.mark.parametrize("at", ["input", "output"])
def test_margins_are_where_the_loop_turns_unstable(small_plant, at):
    plant = small_plant()
    law = lqg(plant)
    low, high = 10 ** (np.array(stability_margins(plant, law, at).gain_margin_db) / 20)
    assert high < np.inf

    def costs(factor):
        """Cost with one loop after the other multiplied by ``factor``."""
        for loop in range(2):
            factors = np.where(np.arange(2) == loop, factor, 1.0)
            changed = {"B": plant.B * factors} if at == "input" else {"C": plant.C * factors[:, None]}
            yield stationary_cost(small_plant(**changed), law)

    assert max(costs(0.999 * high)) < np.inf
    assert max(costs(1.001 * high)) == np.inf
    if low > 0:
        assert max(costs(1.001 * low)) < np.inf
        assert max(costs(0.999 * low)) == np.inf


def test_the_disk_margin_holds_for_all_loops_at_once(small_plant):
    plant = small_plant()
    law = lqg(plant)
    alpha = stability_margins(plant, law).disk_margin
    gains = np.array([(2 - alpha) / (2 + alpha), (2 + alpha) / (2 - alpha)]) * (1 + 1e-6 * np.array([1, -1]))
    for factors in ((gains[i], gains[j]) for i in (0, 1) for j in (0, 1)):
        assert stationary_cost(small_plant(B=plant.B * factors), law) < np.inf


def test_no_control_cannot_be_made_unstable(small_plant):
    margins = stability_margins(small_plant(), no_control(small_plant()))
    assert margins.gain_margin_db == (-np.inf, np.inf)
    assert margins.phase_margin_deg == margins.delay_margin == np.inf
    assert margins.disk_margin == pytest.approx(2.0)
    assert margins.peak_sensitivity == pytest.approx(1.0)


def test_unstable_loops_and_unknown_places_are_refused_by_name(small_plant):
    plant = small_plant()
    with pytest.raises(ValueError, match="velocity feedback is unstable on this plant"):
        stability_margins(plant, velocity_feedback(plant, gain=-1e12, verify=False))
    with pytest.raises(ValueError, match="^at is 'middle', but must be one of input, output"):
        stability_margins(plant, lqg(plant), "middle")
