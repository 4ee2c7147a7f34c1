"""LQG with rotor harmonics: the internal model principle."""

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from baselines import PersistentLoad, evaluate, full_order_lqg, lqg, stationary_cost
from baselines.analysis.frequency_response import cost_response
from baselines.design.load_model import with_load
from baselines.laws.rotor_lqg import RotorHarmonics, rotor_lqg
from beamenv.plant.plant import sample

SPEED = 100.0


def exact_plant(small_plant):
    """Next to no noise, and voltages that cost next to nothing."""
    plant = small_plant()
    return small_plant(
        voltage_limits=np.array([[-1e6, -1e6], [1e6, 1e6]]),
        process_noise=1e-4 * plant.process_noise,
        sensor_noise=1e-4 * plant.sensor_noise,
        input_weight=1e-4 * plant.input_weight,
    )


def test_two_per_revolution_is_recognised_for_what_it_is(small_plant):
    plant = exact_plant(small_plant)
    law = rotor_lqg(plant, RotorHarmonics(SPEED, orders=(1, 2), duration=100.0))
    held, lasting = sample(plant), RotorHarmonics(SPEED, orders=(1, 2)).model(plant.control_interval)
    x, memory = np.zeros(6), None
    for k in range(8000):
        load = np.array([3.0, -2.0]) * np.sin(2 * SPEED * k * held.interval + np.array([0.3, 1.1]))
        if memory is not None:
            estimate = lasting.output @ memory[6:]
        action, memory = law.predict(held.C @ x / plant.sensor_full_scale, memory)
        voltage = action * law.instruments.voltage_scale
        x = held.A @ x + held.B @ voltage + held.disturbance_input @ load
    assert np.abs(voltage).max() < 1e6
    np.testing.assert_allclose(estimate, load, atol=0.01 * np.hypot(3.0, 2.0))


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_loads_at_each_harmonic_cost_less_than_under_lqg(small_plant, order):
    plant = small_plant()
    knowing = rotor_lqg(plant, RotorHarmonics(SPEED))
    gains = [np.linalg.norm(cost_response(plant, law, order * SPEED)[0, :, :2], ord=2) for law in (lqg(plant), knowing)]
    assert gains[1] < 0.9 * gains[0]
    between = [np.linalg.norm(cost_response(plant, law, (order + 0.5) * SPEED)[0, :, :2], ord=2) for law in (lqg(plant), knowing)]
    assert between[1] / between[0] > gains[1] / gains[0]


def test_harmonics_too_small_to_matter_leave_lqg(small_plant):
    plant = small_plant()
    optimum = stationary_cost(plant, lqg(plant))
    costs = [stationary_cost(plant, rotor_lqg(plant, RotorHarmonics(SPEED, magnitude=size))) for size in (1e-3, 1.5)]
    assert costs[0] == pytest.approx(optimum, rel=1e-5)
    assert costs[1] > optimum * (1 + 1e-3)


def test_a_harmonic_has_the_magnitude_and_the_frequency_it_is_said_to_have():
    model, interval = RotorHarmonics(SPEED, orders=(3,), magnitude=5.0, duration=0.2).model(5e-4), 5e-4
    decay = np.exp(-interval / 0.2)
    np.testing.assert_allclose(model.noise / (1 - decay**2), 25.0 * np.eye(4))
    poles = np.log(np.linalg.eigvals(model.transition)) / interval
    np.testing.assert_allclose(np.sort_complex(poles), np.sort_complex([-5 - 300j, -5 - 300j, -5 + 300j, -5 + 300j]))


def test_turbulence_stands_beside_the_harmonics(small_plant):
    plant = small_plant()
    both = RotorHarmonics(SPEED).model(5e-4) + PersistentLoad().model(5e-4)
    assert with_load(sample(plant), both).A.shape == (6 + 16 + 2,) * 2
    assert len(rotor_lqg(plant, RotorHarmonics(SPEED), PersistentLoad()).transition) == 24


def test_impossible_harmonics_are_refused_by_name(small_plant):
    with pytest.raises(ValueError, match="harmonics.speed is 0.0, but must be a positive number"):
        RotorHarmonics(0.0)
    with pytest.raises(
        ValueError, match=r"harmonics.orders is \(1.5,\), but must be a list of one or more orders, each a whole number"
    ):
        RotorHarmonics(SPEED, orders=(1.5,))
    with pytest.raises(ValueError, match="order 80 at 100 rad/s.*below 6283.19 rad/s"):
        rotor_lqg(small_plant(), RotorHarmonics(SPEED, orders=(80,)))


@pytest.fixture(name="under_rotor_loads", scope="module")
def _under_rotor_loads():
    """J / J₀ of the reference with some loads in its state, in the scenario "rotor"."""
    envs, seeds = gym.make_vec(beamenv.ENV_ID, num_envs=48, scenario="rotor"), range(48)
    plant = envs.unwrapped.design.full_plant
    uncontrolled = evaluate(full_order_lqg(plant), envs, seeds=seeds).reference

    def relative_cost(*loads):
        return evaluate(full_order_lqg(plant, load=loads), envs, seeds=seeds, reference=uncontrolled).relative_cost.value

    return relative_cost


@pytest.mark.slow
def test_a_lasting_load_beside_the_harmonics_lowers_the_cost(under_rotor_loads):
    assert under_rotor_loads(RotorHarmonics(200.0), PersistentLoad()) < under_rotor_loads(RotorHarmonics(200.0)) - 0.01


@pytest.mark.slow
def test_true_turbulence_pays_in_full_only_beside_harmonics_of_true_size(under_rotor_loads):
    turbulence, large = PersistentLoad(magnitude=5.0, duration=0.02), RotorHarmonics(200.0, magnitude=3.5, duration=2.0)
    both = under_rotor_loads(large, turbulence)
    assert both < under_rotor_loads(RotorHarmonics(200.0), turbulence) - 0.005
    assert both < under_rotor_loads(RotorHarmonics(200.0, magnitude=3.5)) - 0.03


def test_several_loads_are_all_in_the_state(small_plant):
    plant = small_plant()
    law = full_order_lqg(plant, load=[RotorHarmonics(SPEED), PersistentLoad()])
    assert law.order == 6 + 16 + 2 + 2  # blade, four harmonics, lasting load, voltages before
    with pytest.raises(ValueError, match="^load is .*, but must be None, a load that can be foreseen"):
        full_order_lqg(plant, load=[RotorHarmonics(SPEED), None])
