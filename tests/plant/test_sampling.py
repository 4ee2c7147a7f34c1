"""The sampled plant against quadrature of the continuous one."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.plant.plant import sample


@pytest.fixture(scope="module")
def plant():
    return build_plant(blade_config())


def test_held_step_and_its_cost_equal_an_ode_solver_with_the_cost_as_a_state(plant):
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
    assert following == pytest.approx(end[:-1], rel=1e-9, abs=1e-12 * np.abs(x).max())
    assert joined @ held.cost @ joined == pytest.approx(end[-1], rel=1e-9)


def test_two_half_intervals_make_a_whole_one(plant):
    half, whole = sample(plant, 0.5 * plant.control_interval), sample(plant)
    assert pytest.approx(whole.A, abs=1e-12) == half.A @ half.A
    assert pytest.approx(whole.B, abs=1e-12 * np.abs(whole.B).max()) == half.A @ half.B + half.B


def test_held_white_load_keeps_the_intensity_of_the_continuous_one(plant):
    """Over many intervals W/Δt held for Δt has the intensity W, whatever Δt is."""
    slow = replace(plant, control_interval=2.0 * plant.control_interval)
    assert sample(slow).process_noise * 2.0 == pytest.approx(sample(plant).process_noise)
    assert sample(plant).process_noise == pytest.approx(9.0 * np.eye(2))


def test_cost_of_an_interval_is_never_negative(plant):
    assert np.linalg.eigvalsh(sample(plant).cost).min() > -1e-15
