"""The reference LQG: on the blade with all its modes, near the best of any order; and the fate of laws that know eleven."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import minimize

from baselines import (
    PersistentLoad,
    full_order_lqg,
    h_infinity,
    lqg,
    no_control,
    positive_position_feedback,
    reference_lqg,
    stationary_cost,
    velocity_feedback,
)
from baselines.design.loop import closed_loop
from baselines.design.rate_penalty import with_rate_penalty
from baselines.laws.lqg import sampled_with_loads
from baselines.laws.reduction import reduced, truncations
from beamenv.blade.build import Blade
from beamenv.blade.presets import PRESETS, blade_config
from beamenv.plant.plant import sample


@cache
def blade():
    return Blade(blade_config("thesis"))


@cache
def reference():
    return reference_lqg(blade().truth)


def spectral_radius(plant, law):
    return np.abs(np.linalg.eigvals(closed_loop(sample(plant), law)[0])).max()


def test_reference_is_within_one_per_cent_of_the_optimum_of_any_order():
    truth = blade().truth
    optimum = stationary_cost(truth, lqg(truth))
    assert optimum < stationary_cost(truth, reference()) < 1.01 * optimum
    assert spectral_radius(truth, reference()) < 1.0
    assert reference().order <= 2 * len(blade().plant.natural_frequencies)


class LawsOfOneOrder:
    """Cost and gradient of laws ξ⁺ = (F + HM) ξ + (G + HT) y, u = M ξ + T y of a fixed order, their entries in one row."""

    def __init__(self, plant, law):
        self.held = sample(plant)
        n, m = self.held.B.shape
        s, p, k = law.order, len(self.held.C), self.held.disturbance_input.shape[1]
        H = law.voltage_input
        self.first = np.block(
            [[law.transition + H @ law.state_gain, law.measurement_input + H @ law.measurement_gain],
             [law.state_gain, law.measurement_gain]]
        )  # fmt: skip
        self.shape, self.scale = self.first.shape, 0.0
        # X = [x; ξ]: Φ = Φ₀ + b Θ c with Θ = [[F, G], [M, T]]
        self.still = np.zeros((n + s, n + s))
        self.still[:n, :n] = self.held.A
        self.b = np.zeros((n + s, s + m))
        self.b[:n, s:], self.b[n:, :s] = self.held.B, np.eye(s)
        self.c = np.zeros((s + p, n + s))
        self.c[:s, n:], self.c[s:, :n] = np.eye(s), self.held.C
        self.load = np.vstack([self.held.disturbance_input, np.zeros((s, k))])
        self.read = np.vstack([np.zeros((s, p)), np.eye(p)])
        self.into_u = np.hstack([np.zeros((m, s)), np.eye(m)])
        self.sizes = n, m, s, p, k

    def cost_and_gradient(self, theta):
        n, m, s, p, k = self.sizes
        held, Wd, V = self.held, self.held.process_noise, self.held.sensor_noise
        phi = self.still + self.b @ theta @ self.c
        noise = self.b @ theta @ self.read
        N = self.load @ Wd @ self.load.T + noise @ V @ noise.T
        Zx = np.vstack([np.eye(n, n + s), self.into_u @ theta @ self.c, np.zeros((k, n + s))])
        Zv = np.vstack([np.zeros((n, p)), self.into_u @ theta @ self.read, np.zeros((k, p))])
        Zd = np.vstack([np.zeros((n + m, k)), np.eye(k)])
        weight = Zx.T @ held.cost @ Zx
        spread, say = doubled(phi, N), doubled(phi.T, weight)
        if spread is None or say is None:
            return np.inf, np.zeros_like(theta)
        cost = np.sum(weight * spread) + np.sum(held.cost * (Zv @ V @ Zv.T + Zd @ Wd @ Zd.T))
        u = slice(n, n + m)
        gradient = 2.0 * self.b.T @ say @ (phi @ spread @ self.c.T + noise @ V @ self.read.T)
        gradient += 2.0 * self.into_u.T @ held.cost[u] @ (Zx @ spread @ self.c.T + Zv @ V @ self.read.T)
        return cost / held.interval, gradient / held.interval


def doubled(phi, added):
    """Σ φᵏ N φᵏᵀ, or None."""
    for _ in range(40):
        added, phi = added + phi @ added @ phi.T, phi @ phi
        size = np.abs(phi).max()
        if size < 1e-18:
            return added
        if not size < 1e18:
            return None
    return None


@cache
def searched(steps=300):
    """(start, gradient check, found): the reference's own cost, and the least of its order that L-BFGS finds from there."""
    truth, law = blade().truth, reference()
    # coordinates of the memory in which its spread is the identity, and signals in their own scale: the search is well posed
    held = sample(truth)
    transition, noise_input, _, _, covariance = closed_loop(held, law)
    spread = doubled(transition, noise_input @ covariance @ noise_input.T)
    n = len(held.A)
    root = np.linalg.cholesky(spread[n:, n:])
    back = np.linalg.inv(root)
    law = replace(
        law,
        transition=back @ law.transition @ root,
        measurement_input=back @ law.measurement_input,
        voltage_input=back @ law.voltage_input,
        state_gain=law.state_gain @ root,
    )
    laws = LawsOfOneOrder(truth, law)
    s = law.order
    reading = np.sqrt(np.diag(held.C @ spread[:n, :n] @ held.C.T + held.sensor_noise))
    voltage = np.sqrt(np.diag(law.state_gain @ law.state_gain.T))
    unit = np.outer(np.concatenate([np.ones(s), voltage]), np.concatenate([np.ones(s), 1.0 / reading]))
    start, _ = laws.cost_and_gradient(laws.first)

    def scaled(change):
        cost, gradient = laws.cost_and_gradient(laws.first + unit * change.reshape(laws.shape))
        if not np.isfinite(cost):
            return 1e3, np.zeros(change.size)
        return cost / start, (unit * gradient).ravel() / start

    found = minimize(scaled, np.zeros(laws.first.size), jac=True, method="L-BFGS-B", options={"maxiter": steps, "maxcor": 30})
    return start, scaled, found


def test_no_search_from_the_reference_finds_one_per_cent_less_at_its_order():
    """Three hundred steps over all entries of the law, down the exact gradient of the cost."""
    start, scaled, found = searched()
    assert start == pytest.approx(stationary_cost(blade().truth, reference()), rel=1e-6)
    direction = np.random.default_rng(0).normal(size=found.x.size)
    step = 1e-6
    slope = (scaled(step * direction)[0] - scaled(-step * direction)[0]) / (2.0 * step)
    assert scaled(0.0 * direction)[1] @ direction == pytest.approx(slope, rel=1e-3)
    assert found.nit > 30  # it did search
    assert 0.99 < found.fun < 1.0
    assert found.fun * start > stationary_cost(blade().truth, lqg(blade().truth))  # no order costs less


@pytest.mark.parametrize("preset", sorted(PRESETS))
def test_every_preset_has_a_stable_reference(preset):
    truth = Blade(blade_config(preset)).truth
    assert stationary_cost(truth, reference_lqg(truth)) < stationary_cost(truth, no_control(truth))


def test_order_of_the_reference_is_the_least_even_one_that_adds_half_a_per_cent():
    truth = blade().truth
    whole = full_order_lqg(truth)
    allowed = 1.005 * stationary_cost(truth, whole)
    assert stationary_cost(truth, reference()) <= allowed
    assert stationary_cost(truth, truncations(truth, whole)(reference().order - 2)) > allowed


def test_a_law_in_balanced_coordinates_is_the_same_law(small_plant):
    plant = small_plant()
    law = lqg(plant)
    balanced = truncations(plant, law)(law.order)
    readings = 0.3 * np.random.default_rng(1).normal(size=(50, 2))
    memory = other = None
    for reading in readings:
        action, memory = law.predict(reading, memory)
        same, other = balanced.predict(reading, other)
        np.testing.assert_allclose(same, action, rtol=1e-8, atol=1e-12)
    assert np.abs(memory - other).max() > 1e-3 * np.abs(memory).max()
    assert stationary_cost(plant, balanced) == pytest.approx(stationary_cost(plant, law), rel=1e-10)


def test_the_less_a_law_remembers_the_more_it_costs():
    truth = blade().truth
    whole = full_order_lqg(truth)
    costs = [stationary_cost(truth, reduced(truth, whole, order)) for order in (20, 24, 32, 40)]
    assert costs == sorted(costs, reverse=True)
    assert costs[-1] == pytest.approx(stationary_cost(truth, whole), rel=1e-4)


def test_what_cannot_be_reduced_is_refused_by_name(small_plant):
    plant = small_plant()
    with pytest.raises(ValueError, match="^order is 6, but must be a whole number from 1 to 5"):
        reduced(plant, lqg(plant), 6)
    with pytest.raises(ValueError, match="law = LQG is unstable on the plant, and cannot be reduced there"):
        reduced(blade().truth, lqg(blade().plant), 10)
    with pytest.raises(ValueError, match="rate_weight is -1.0, but must be"):
        reference_lqg(plant, -1.0)


def test_price_of_changes_is_the_sum_over_the_steps(small_plant):
    held, weight, random = sample(small_plant()), 0.7, np.random.default_rng(2)
    priced = with_rate_penalty(held, weight)
    (n, m), R = held.B.shape, np.diag(np.diagonal(held.input_weight))
    x, before, extended = random.normal(size=n), np.zeros(m), np.zeros(n + m)
    extended[:n] = x
    by_steps = by_form = 0.0
    for _ in range(40):
        u, d = 100.0 * random.normal(size=m), random.normal(size=2)
        z = np.concatenate([x, u, d])
        by_steps += z @ held.cost @ z + weight * (u - before) @ R @ (u - before)
        extended_z = np.concatenate([extended, u, d])
        by_form += extended_z @ priced.cost @ extended_z
        np.testing.assert_allclose(priced.C @ extended, held.C @ x)
        x, before = held.A @ x + held.B @ u + held.disturbance_input @ d, u
        extended = priced.A @ extended + priced.B @ u + priced.disturbance_input @ d
        np.testing.assert_allclose(extended, np.concatenate([x, u]), rtol=1e-12, atol=1e-15)
    assert by_form == pytest.approx(by_steps, rel=1e-12)


@pytest.mark.parametrize("weight", [0.3, 3.0])
def test_no_perturbed_law_costs_less_where_changes_have_a_price(small_plant, weight):
    plant = small_plant()
    priced, law, random = with_rate_penalty(sample(plant), weight), full_order_lqg(plant, weight), np.random.default_rng(3)
    least = stationary_cost(priced, law)
    assert least < stationary_cost(priced, lqg(plant))
    assert stationary_cost(plant, law) > stationary_cost(plant, lqg(plant))
    for size in np.repeat([1e-3, 0.03, 0.3], 20):
        for name in ("transition", "measurement_input", "voltage_input", "state_gain", "measurement_gain"):
            gain = getattr(law, name)
            changed = replace(law, **{name: gain * (1.0 + size * random.normal(size=gain.shape))})
            assert stationary_cost(priced, changed) >= least * (1.0 - 1e-9)


def test_without_a_price_the_full_order_law_is_lqg(small_plant):
    plant = small_plant()
    law, plain = full_order_lqg(plant, 0.0), lqg(plant)
    for name in ("transition", "measurement_input", "voltage_input", "state_gain", "measurement_gain"):
        np.testing.assert_array_equal(getattr(law, name), getattr(plain, name))
    assert stationary_cost(plant, full_order_lqg(plant, 1e-9)) == pytest.approx(stationary_cost(plant, plain), rel=1e-9)


def test_a_load_that_can_be_foreseen_stays_in_the_reduced_memory():
    """Reduced under white noise alone it would be forgotten."""
    truth, load = blade().truth, PersistentLoad()
    loaded = sampled_with_loads(truth, load)
    law = reference_lqg(truth, load=load, name="LQG with load estimate")
    assert law.order < 40
    assert stationary_cost(loaded, law) < 1.006 * stationary_cost(loaded, lqg(truth, persistent_load=load))
    assert stationary_cost(loaded, law) < 0.99 * stationary_cost(loaded, reference())
    assert stationary_cost(truth, law) < 1.15 * stationary_cost(truth, reference())


OF_ELEVEN_MODES = {
    "LQG": (lqg, 1.1598),
    "LQG (thesis)": (lambda plant: lqg(plant, "continuous"), 1.1969),
    "LQG with load estimate": (lambda plant: lqg(plant, persistent_load=PersistentLoad()), 1.3678),
    "H∞": (h_infinity, 1.2585),
    "positive position feedback": (positive_position_feedback, 1.01059),
    "velocity feedback": (velocity_feedback, 1.00690),
}
"""Laws by what they know, and the spectral radius of their loop on the blade with all its modes, amplifiers and filters."""


@pytest.mark.parametrize("name", OF_ELEVEN_MODES)
def test_what_knows_eleven_modes_is_stable_on_them_and_unstable_on_the_blade(name):
    build, radius = OF_ELEVEN_MODES[name]
    law = build(blade().plant)
    assert law.name == name
    assert spectral_radius(blade().plant, law) < 1.0
    beyond = spectral_radius(blade().truth, law) - 1.0
    assert beyond == pytest.approx(radius - 1.0, rel=0.02)


def test_the_thesis_compensator_is_stable_in_the_thesis_world():
    world = Blade(blade_config("thesis", {"model": "thesis"}))
    assert world.truth is world.plant
    for design in ("sampled", "continuous"):
        assert spectral_radius(world.truth, lqg(world.plant, design)) == pytest.approx(0.993, abs=5e-4)
