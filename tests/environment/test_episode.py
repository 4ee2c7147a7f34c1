"""One episode of the single environment: physics, timing, cost and how it ends."""

import gymnasium
import numpy as np
import pytest
from scipy.linalg import expm

import beamenv
from beamenv import RotatingBeamEnv
from beamenv.patches.material import MFC_STRAIN
from beamenv.scenarios.load_cases import static_deflection
from beamenv.simulation.blades import reward_scale


def quiet(**arguments):
    return RotatingBeamEnv(scenario="quiet", **arguments)


def some_state(plant, energy=1e-3, seed=0):
    """Of a blade with this energy behind electronics in some state, within a tenth of what they can show or drive."""
    blade, electronics = np.split(np.random.default_rng(seed).normal(size=len(plant.A)), [plant.blade_states])
    return np.concatenate([blade * np.sqrt(2.0 * energy / (blade @ blade)), 0.1 * np.tanh(electronics)])


def energy_of(plant, state):
    return 0.5 * float((state[: plant.blade_states] ** 2).sum())


def held_response(plant, state, volts, load, time):
    """State at ``time`` under held inputs, by the exponential of the augmented system."""
    n = len(state)
    augmented = np.zeros((n + 1, n + 1))
    augmented[:n, :n] = plant.A
    augmented[:n, n] = plant.B @ volts + plant.disturbance_input @ load
    return (expm(augmented * time) @ np.append(state, 1.0))[:n]


def held_cost(plant, state, volts, load):
    """∫(xᵀQx + uᵀRu)dt over one interval, by Gauss quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(16)
    time = 0.5 * plant.control_interval * (nodes + 1.0)
    states = [held_response(plant, state, volts, load, each) for each in time]
    running = [x @ plant.state_weight @ x + volts @ plant.input_weight @ volts for x in states]
    return 0.5 * plant.control_interval * weights @ running


def test_steps_are_the_exact_solution_with_its_exact_cost():
    env = quiet()
    plant = env.plant
    state = some_state(plant)
    load = {"case": "step", "magnitude": 30.0, "direction_deg": 60.0, "onset": 0.0}
    env.reset(seed=0, options={"load": load, "initial_state": state})
    line_load = 30.0 * np.array([np.cos(np.pi / 3), np.sin(np.pi / 3)])
    actions = np.random.default_rng(1).uniform(-1.0, 1.0, size=(20, 4))
    for action in actions:
        observation, reward, _, _, info = env.step(action)
        cost = held_cost(plant, state, 1500.0 * action, line_load)
        state = held_response(plant, state, 1500.0 * action, line_load, plant.control_interval)
        np.testing.assert_allclose(env.state, state, atol=1e-12)
        np.testing.assert_allclose(observation, np.clip(plant.C @ state / plant.sensor_full_scale, -1.0, 1.0), atol=1e-9)
        np.testing.assert_allclose(info["tip_displacement"], plant.tip_displacement @ state, atol=1e-14)
        assert info["energy"] == pytest.approx(energy_of(plant, state), rel=1e-9)
        assert info["cost_increment"] == pytest.approx(cost, rel=1e-9)
        assert reward == pytest.approx(-cost / reward_scale(plant), rel=1e-9)
        volts = info["volts"]
        assert info["effort"] == pytest.approx(volts @ plant.input_weight @ volts * plant.control_interval, rel=1e-9)


def test_the_first_reading_is_that_of_the_first_state_and_none_comes_late():
    env = quiet()
    plant, state = env.plant, some_state(env.plant, 1e-4)
    observation, _ = env.reset(options={"initial_state": state})
    np.testing.assert_allclose(observation, plant.C @ state / plant.sensor_full_scale, atol=1e-12)
    observation, *_ = env.step(np.zeros(4))
    after = held_response(plant, state, np.zeros(4), np.zeros(2), plant.control_interval)
    np.testing.assert_allclose(observation, plant.C @ after / plant.sensor_full_scale, atol=1e-9)


def test_an_undamped_blade_left_alone_keeps_its_energy():
    env = quiet(blade={"damping_ratio": 0.0})
    env.reset(options={"initial_state": some_state(env.plant)[: env.plant.blade_states]})  # the electronics at rest
    for _ in range(1000):
        *_, info = env.step(np.zeros(4))
    assert info["energy"] == pytest.approx(1e-3, rel=1e-9)


def test_damping_never_adds_energy_and_the_cost_of_no_effort_is_the_integral_of_energy():
    env = quiet()
    env.reset(options={"initial_state": some_state(env.plant)[: env.plant.blade_states]})
    energies, costs = [1e-3], []
    for _ in range(300):
        *_, info = env.step(np.zeros(4))
        energies.append(info["energy"])
        costs.append(info["cost_increment"])
    assert np.all(np.diff(energies) < 0.0)
    interval = env.plant.control_interval
    assert np.all(np.array(costs) <= interval * np.array(energies[:-1]))
    assert np.all(np.array(costs) >= interval * np.array(energies[1:]))


def test_a_released_deflection_swings_from_where_it_was_held():
    env = quiet()
    _, info = env.reset(options={"load": {"case": "deflection", "magnitude": 30.0, "direction_deg": 90.0}})
    held = env.plant.tip_displacement @ static_deflection(env.plant, [0.0, 30.0])
    np.testing.assert_allclose(info["tip_displacement"], held, rtol=1e-9)
    tips = [env.step(np.zeros(4))[4]["tip_displacement"][1] for _ in range(100)]
    assert min(tips) < -0.5 * held[1]


def test_a_blade_that_holds_the_reference_deflection_earns_minus_one_a_step():
    env = quiet()
    env.reset(options={"load": {"case": "step", "magnitude": 30.0, "direction_deg": 90.0, "onset": 0.0}})
    env.reset(
        options={
            "load": {"case": "step", "magnitude": 30.0, "direction_deg": 90.0, "onset": 0.0},
            "initial_state": static_deflection(env.plant, [0.0, 30.0]),
        }
    )
    _, reward, *_ = env.step(np.zeros(4))
    assert reward == pytest.approx(-1.0, rel=1e-9)


def test_without_control_a_default_episode_costs_about_one_a_step():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=1000)
    envs.reset(seed=0)
    total = sum(envs.step(np.zeros((1000, 4)))[1].mean() for _ in range(999))
    assert -1.3 < total / 999 < -0.8


@pytest.mark.parametrize(("action", "volts"), [(1.0, 1500.0), (0.2, 300.0), (-0.2, -300.0), (-1.0, -500.0), (7.0, 1500.0)])
def test_voltages_saturate_at_the_limits_of_the_drive(action, volts):
    env = quiet(blade={"voltage_limits": (-500.0, 1500.0)})
    env.reset()
    *_, info = env.step(np.full(4, action))
    np.testing.assert_allclose(info["volts"], volts)
    *_, forced = env.step(np.full(4, volts / 1500.0))
    np.testing.assert_allclose(forced["volts"], volts)


def test_readings_are_clipped_to_full_scale():
    env = quiet()
    env.reset(options={"initial_state": some_state(env.plant, energy=1.0)})
    observation, *_ = env.step(np.zeros(4))
    assert np.abs(observation).max() == 1.0
    assert observation in env.observation_space


def test_sensor_noise_is_two_per_cent_of_full_scale():
    env = RotatingBeamEnv(scenario={"preset": "quiet", "sensor_noise": True}, duration=1.0)
    first, _ = env.reset(seed=0)
    readings = np.array([first] + [env.step(np.zeros(4))[0] for _ in range(1999)])
    np.testing.assert_allclose(readings.std(axis=0), 0.02, rtol=0.06)
    assert np.abs(readings.mean(axis=0)).max() < 0.002


def test_physical_units_are_the_same_episode_in_volts_and_amperes():
    env, physical = RotatingBeamEnv(dtype="float64"), RotatingBeamEnv(physical_units=True, dtype="float64")
    full_scale = env.plant.sensor_full_scale
    observation, _ = env.reset(seed=4)
    amperes, _ = physical.reset(seed=4)
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, size=(30, 4))
    for action in actions:
        np.testing.assert_allclose(amperes, observation * full_scale, rtol=1e-9, atol=1e-15)
        assert amperes in physical.observation_space
        observation, reward, *_ = env.step(action)
        amperes, same_reward, *_, info = physical.step(1500.0 * action)
        assert reward == pytest.approx(same_reward, rel=1e-9)
        np.testing.assert_allclose(info["volts"], 1500.0 * action, rtol=1e-12)
    np.testing.assert_array_equal(physical.action_space.high, 1500.0)


def test_the_time_limit_truncates_and_does_not_terminate():
    env = RotatingBeamEnv(duration=0.01)
    env.reset(seed=0)
    ends = [env.step(np.zeros(4))[2:4] for _ in range(20)]
    assert ends == [(False, False)] * 19 + [(False, True)]
    assert all(type(flag) is bool for end in ends for flag in end)


def test_gymnasiums_own_time_limit_works_on_top():
    env = gymnasium.make(beamenv.ENV_ID, max_episode_steps=3)
    env.reset(seed=0)
    assert [env.step(np.zeros(4))[3] for _ in range(3)] == [False, False, True]


def test_the_episode_terminates_when_the_blade_is_strained_beyond_failure():
    env = quiet()
    load = {"case": "step", "magnitude": 8000.0, "direction_deg": 0.0, "onset": 0.0}
    env.reset(options={"load": load})
    for _ in range(1000):
        observation, _, terminated, truncated, _ = env.step(np.zeros(4))
        strain = np.abs(env.plant.strain @ env.state).max()
        assert terminated == (strain > MFC_STRAIN)
        assert observation in env.observation_space
        if terminated:
            break
    assert terminated
    assert not truncated


def test_default_episodes_stay_far_from_failure():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=1000)
    envs.reset(seed=0)
    strains = []
    for _ in range(300):
        envs.step(np.zeros((1000, 4)))
        strains.append(np.abs(envs.unwrapped.state @ envs.unwrapped.plant.strain.T).max())
    assert 10.0 * max(strains) < MFC_STRAIN


def rollout(env, seed, steps=80):
    results = [env.reset(seed=seed)[0]]
    for k in range(steps):
        observation, reward, *_ = env.step(np.full(4, np.sin(0.3 * k)))
        results.append(np.append(observation, reward))
    return np.concatenate(results)


def test_a_seed_gives_identical_bits():
    assert np.array_equal(rollout(RotatingBeamEnv(), 9), rollout(RotatingBeamEnv(), 9))
    assert not np.array_equal(rollout(RotatingBeamEnv(), 9), rollout(RotatingBeamEnv(), 10))


def test_a_reset_without_seed_goes_on_with_the_same_generator():
    def two_episodes(env):
        first = rollout(env, 1)
        return first, rollout(env, None)

    first, second = two_episodes(RotatingBeamEnv())
    _, again = two_episodes(RotatingBeamEnv())
    assert np.array_equal(second, again)
    assert not np.array_equal(first, second)


def test_the_design_blade_is_the_true_one_unless_said_otherwise():
    env = RotatingBeamEnv()
    assert env.task.design_blade is env.task.blade
    assert env.design_plant is env.task.blade.plant
    assert env.plant is env.task.blade.truth
    thesis = RotatingBeamEnv(blade={"model": "thesis"})
    assert thesis.plant is thesis.design_plant
    env = RotatingBeamEnv(blade={"damping_ratio": 0.03}, design={}, speed=150.0)
    assert env.task.config.damping_ratio == 0.03
    assert env.task.design_config.damping_ratio == 0.01
    assert env.task.design_config.speed == 150.0
    assert RotatingBeamEnv(design="thesis-untwisted").task.design_config.beam.pretwist_deg == 0.0
    assert RotatingBeamEnv(speed=150.0, design={"speed": 180.0}).task.design_config.speed == 180.0


def test_returned_arrays_are_the_callers_own():
    env, spoilt = RotatingBeamEnv(), RotatingBeamEnv()
    env.reset(seed=2)
    observation, info = spoilt.reset(seed=2)
    for _ in range(5):
        for array in (observation, info["volts"], info["tip_displacement"]):
            array[:] = np.nan
        action = np.full(4, 0.5)
        expected = env.step(action)[0]
        observation, *_, info = spoilt.step(action)
        assert np.array_equal(observation, expected)
        assert np.array_equal(action, np.full(4, 0.5))
