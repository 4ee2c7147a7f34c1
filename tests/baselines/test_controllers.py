"""How every law behaves as a controller: SB3's predict, batches, memory, limits and bad input."""

from dataclasses import replace

import numpy as np
import pytest

from baselines import (
    RotorHarmonics,
    clipped_lqg,
    closed_loop_poles,
    h_infinity,
    h_infinity_norm,
    lqg,
    lqr,
    mpc,
    no_control,
    positive_position_feedback,
    rotor_lqg,
    stability_margins,
    stationary_cost,
    velocity_feedback,
)
from baselines.design.controller import Controller
from baselines.design.load_model import with_load
from baselines.design.persistent_load import PersistentLoad
from baselines.design.riccati import sampled_kalman_filter, sampled_regulator
from beamenv.plant.plant import sample

LAWS = {
    "no control": no_control,
    "velocity feedback": velocity_feedback,
    "LQR (full state)": lqr,
    "LQR with load estimate (full state)": lambda plant: lqr(plant, persistent_load=PersistentLoad()),
    "LQG": lqg,
    "LQG (thesis)": lambda plant: lqg(plant, "continuous"),
    "LQG with load estimate": lambda plant: lqg(plant, persistent_load=PersistentLoad()),
    "LQG with rotor harmonics": lambda plant: rotor_lqg(plant, RotorHarmonics(speed=200.0)),
    "LQG, clipping known": clipped_lqg,
    "H∞": h_infinity,
    "positive position feedback": positive_position_feedback,
    "MPC": mpc,
    "MPC with load estimate": lambda plant: mpc(plant, PersistentLoad()),
}


@pytest.fixture(params=LAWS, name="law", scope="module")
def _law(request, small_plant):
    law = LAWS[request.param](small_plant())
    assert law.name == request.param
    return law


def observations(law, steps=20, blades=5, size=0.05):
    return size * np.random.default_rng(3).normal(size=(steps, blades, law.instruments.measurement_scale.size))


def test_a_batch_is_its_blades_one_by_one(law):
    assert isinstance(law, Controller)
    batched = single = None
    for row in observations(law):
        batch, batched = law.predict(row, batched)
        one, single = law.predict(row[2], single)
        assert batch.shape == (5, 2)
        np.testing.assert_allclose(one, batch[2], rtol=1e-12, atol=1e-15)


def test_an_episode_start_forgets_that_blade_alone(law):
    rows = observations(law)
    memory = None
    for row in rows[:10]:
        _, memory = law.predict(row, memory)
    begins = np.array([False, True, False, False, True])
    action, _ = law.predict(rows[10], memory, episode_start=begins)
    kept, _ = law.predict(rows[10], memory)
    fresh, _ = law.predict(rows[10])
    np.testing.assert_array_equal(action, np.where(begins[:, None], fresh, kept))


def test_voltages_never_leave_asymmetric_limits(law):
    memory = None
    for row in observations(law, size=50.0):
        action, memory = law.predict(row, memory)
        assert action.min() >= -1 / 3
        assert action.max() <= 1.0


def test_an_observation_of_another_length_is_refused_by_name(law):
    with pytest.raises(ValueError, match=r"observation has shape \(4, 9\).*length [26]"):
        law.predict(np.zeros((4, 9)))


def test_physical_units_give_the_same_voltages(law):
    physical = law.in_physical_units()
    memory = physical_memory = None
    for row in observations(law):
        action, memory = law.predict(row, memory)
        volts, physical_memory = physical.predict(row * law.instruments.measurement_scale, physical_memory)
        np.testing.assert_allclose(volts, action * law.instruments.voltage_scale, rtol=1e-12, atol=1e-12)


def test_the_filter_predicts_with_the_clipped_voltage(small_plant):
    plant = small_plant(voltage_limits=np.array([[-1.0, -1.0], [3.0, 3.0]]))
    held = sample(plant)
    E = held.disturbance_input
    _, K = sampled_regulator(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight)
    _, L = sampled_kalman_filter(held.A, held.C, E @ held.process_noise @ E.T, held.sensor_noise)
    law, estimate, memory = lqg(plant), np.zeros(6), None
    clipped = 0
    for observation in observations(law, blades=1)[:, 0]:
        action, memory = law.predict(observation, memory)
        estimate = estimate + L @ (observation * plant.sensor_full_scale - held.C @ estimate)
        voltage = np.clip(-K @ estimate, -1.0, 3.0)
        clipped += np.any(np.isin(voltage, (-1.0, 3.0)))
        np.testing.assert_allclose(3.0 * action, voltage, rtol=1e-9, atol=1e-9)
        estimate = held.A @ estimate + held.B @ voltage
    assert clipped > 0


def test_velocity_feedback_takes_energy_out_of_every_mode(small_plant):
    plant = small_plant()
    gain = velocity_feedback(plant).measurement_gain
    loop = plant.A + plant.B @ gain @ plant.C
    assert gain[0, 1] == gain[1, 0] == 0.0
    assert np.linalg.eigvals(loop).real.max() < np.linalg.eigvals(plant.A).real.max()
    assert np.linalg.eigvalsh(plant.B @ gain @ plant.C).max() <= 1e-12


def test_ganged_velocity_feedback_answers_the_mean_current(small_plant):
    separate = small_plant()
    plant = small_plant(
        B=separate.B.sum(axis=1, keepdims=True),
        D=np.zeros((2, 1)),
        input_weight=np.array([[separate.input_weight.sum()]]),
        voltage_limits=separate.voltage_limits[:, :1],
    )
    gain = velocity_feedback(plant).measurement_gain
    assert gain.shape == (1, 2)
    assert gain[0, 0] == gain[0, 1] < 0


def test_velocity_feedback_refuses_what_it_cannot_pair(small_plant):
    plant = small_plant()
    with pytest.raises(ValueError, match="2 actuators and 1 sensors.*cannot pair"):
        velocity_feedback(small_plant(C=plant.C[:1], sensor_full_scale=plant.sensor_full_scale[:1]))


def test_lqg_refuses_unknown_designs_by_name(small_plant):
    with pytest.raises(ValueError, match="^design is 'analog', but must be one of sampled, continuous"):
        lqg(small_plant(), "analog")
    with pytest.raises(ValueError, match='persistent_load.*needs design="sampled"'):
        lqg(small_plant(), "continuous", persistent_load=PersistentLoad())
    with pytest.raises(ValueError, match="persistent_load.duration is 0.0, but must be a number from 1e-06 to 1000"):
        PersistentLoad(duration=0.0)
    with pytest.raises(ValueError, match="persistent_load.magnitude is True"):
        PersistentLoad(True)


@pytest.mark.parametrize("design", ["sampled", "continuous"])
def test_lqg_of_a_calm_blade_leaves_it_in_peace(small_plant, design):
    calm = small_plant(process_noise=np.zeros((2, 2)))
    assert stationary_cost(calm, lqg(calm, design)) == pytest.approx(0.0, abs=1e-15)


def test_sampled_lqg_copes_with_noiseless_sensors_where_the_thesis_filter_outruns_the_sampling(small_plant):
    exact = small_plant(sensor_noise=np.zeros((2, 2)))
    assert stationary_cost(exact, lqg(exact)) < 1.01 * stationary_cost(exact, lqr(exact))
    assert stationary_cost(exact, lqg(exact, "continuous", verify=False)) == np.inf


def test_true_states_reveal_the_load_that_lasts(small_plant):
    plant = small_plant(voltage_limits=np.array([[-1e5, -1e5], [1e5, 1e5]]))
    held, load = sample(plant), np.array([4.0, -7.0])
    law = lqr(plant, persistent_load=PersistentLoad(magnitude=10.0, duration=10.0))
    x, memory = np.zeros(6), None
    for _ in range(2000):
        action, memory = law.predict(x, memory)
        x = held.A @ x + held.B @ (1e5 * action) + held.disturbance_input @ load
    _, memory = law.predict(x, memory)
    np.testing.assert_allclose(memory[6:], load, rtol=0.02)


def test_a_persistent_load_adds_its_own_states_and_keeps_the_cost(small_plant):
    held = sample(small_plant())
    augmented = with_load(held, PersistentLoad(magnitude=12.0, duration=0.3).model(held.interval))
    random = np.random.default_rng(0)
    x, u, lasting, white = random.normal(size=6), random.normal(size=2), random.normal(size=2), random.normal(size=2)
    z, z_augmented = np.concatenate([x, u, lasting + white]), np.concatenate([x, lasting, u, white, np.zeros(2)])
    assert z_augmented @ augmented.cost @ z_augmented == pytest.approx(z @ held.cost @ z)
    following = augmented.A @ z_augmented[:8] + augmented.B @ u + augmented.disturbance_input @ z_augmented[10:]
    np.testing.assert_allclose(following[:6], held.A @ x + held.B @ u + held.disturbance_input @ (lasting + white))
    decay = augmented.A[6, 6]
    assert augmented.process_noise[2, 2] / (1 - decay**2) == pytest.approx(12.0**2)


def test_a_law_is_told_in_one_line(law):
    line = repr(law)
    assert "\n" not in line
    assert len(line) < 160
    assert repr(law.name) in line
    assert f"order {law.order}" in line
    assert (
        f"; {law.observes} ({law.instruments.measurement_scale.size}), 2 voltages; 0.5 ms; -500 … 1500 V; normalised units" in line
    )
    assert "physical units" in repr(law.in_physical_units())


@pytest.mark.parametrize("analysis", [closed_loop_poles, stationary_cost, stability_margins, h_infinity_norm])
def test_what_is_said_of_linear_loops_is_not_said_of_other_laws(small_plant, analysis):
    for law, name in ((clipped_lqg(small_plant()), "LQG, clipping known"), (mpc(small_plant()), "MPC")):
        with pytest.raises(ValueError, match=rf"controller = {name} \({type(law).__name__}\) is not linear"):
            analysis(small_plant(), law)
    one_sensor = small_plant(C=small_plant().C[:1], sensor_noise=np.eye(1) * 1e-16, sensor_full_scale=np.array([2e-5]))
    with pytest.raises(ValueError, match="takes 1 measurements and gives 2 voltages, but the plant has 2 and 2"):
        analysis(small_plant(), lqg(replace(one_sensor, D=np.zeros((1, 2)))))
