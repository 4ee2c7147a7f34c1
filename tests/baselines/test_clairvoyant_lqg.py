"""LQG that is told each episode's truth: the optimum where it can be told, and each blade's own in a batch."""

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import PersistentLoad, RotorHarmonics, clairvoyant_lqg, evaluate, lqg, reference_lqg, roll_out
from baselines.design.time_varying import filter_gains, regulator_gains
from baselines.laws.foreseen_load import LARGEST, foreseen_loads
from beamenv.scenarios.scenario import scenario

SMALL = {"model": "thesis", "modes": 3, "beam": {"terms": 4}}


def made(num_envs, chosen, duration=0.1, **arguments):
    return gymnasium.make_vec(
        beamenv.ENV_ID, num_envs=num_envs, scenario=chosen, dtype="float64", blade=SMALL, duration=duration, **arguments
    )


def law_for(envs):
    return clairvoyant_lqg(envs.unwrapped.task.truth)


def told_mean_cost(law):
    """tr P₀S₀ + Σ tr P⁺W + tr KᵀKʳ(S − LCS), and what the white load itself costs: J of white noise, J s."""
    plan = law._plan
    told = np.array([[0.0, 0.0, *np.ones(4), *np.ones(4), *np.zeros(4)]])
    stage, s, steps = plan.stage(np.zeros(1, dtype=np.int64), told), plan.states, law.known.steps
    costs = [np.zeros((1, s, s))]
    for _ in range(steps):
        costs.append(regulator_gains([stage], costs[-1])[1])
    S, n = plan.beginning(np.zeros(1, dtype=np.int64)), plan.sizes[0]
    total = np.trace(costs[-1][0] @ S[0]) + steps * np.trace(plan.plants.cost[0][n + 4 :, n + 4 :] @ plan.white[0])
    for k in range(steps):
        P, K, L = costs[steps - k - 1], regulator_gains([stage], costs[steps - k - 1])[0][0], filter_gains([stage], S)[0][0]
        left, inner = S - L @ stage.C @ S, stage.R + stage.B.swapaxes(1, 2) @ P @ stage.B
        total += np.trace(P[0] @ stage.W[0]) + np.trace((K.swapaxes(1, 2) @ inner @ K @ left)[0])
        S = filter_gains([stage], S)[1]
    return float(total)


def test_in_white_noise_it_costs_what_theory_says_and_less_than_the_stationary_optimum():
    envs = made(256, "white")
    law, seeds = law_for(envs), range(256)
    costs = roll_out(law, envs, seeds).cost.sum(axis=0)
    error = costs.std() / np.sqrt(len(costs))
    assert costs.mean() == pytest.approx(told_mean_cost(law), abs=4.0 * error)
    assert error < 0.05 * costs.mean()
    stationary = roll_out(lqg(envs.unwrapped.plant), envs, seeds).cost.sum(axis=0)
    assert costs.mean() < stationary.mean()


def test_on_nominal_it_is_ahead_of_lqg_of_the_same_plant():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=32, scenario="nominal", dtype="float64")
    told = evaluate(law_for(envs), envs, range(32))
    known = evaluate(reference_lqg(envs.unwrapped.plant, load=PersistentLoad()), envs, range(32), reference=told.reference)
    assert told.relative_cost.value < known.relative_cost.value < 1.0


@pytest.mark.parametrize(
    "chosen",
    [
        "failure",
        "mid-failure",
        {"drive": {"delay": [0, 3]}, "acquisition": {"dropout": 0.05}},
        {"drive": {"hysteresis": 0.2}},
        {"plants": {"speed_ratio": [0.8, 1.2], "bank": 3}, "rotor": {"harmonics": [3.0, 1.0]}},
        {"plants": {"spin_up": [200.0, 200.5]}},
    ],
    ids=str,
)
def test_in_a_batch_each_blade_is_told_its_own_truth(chosen):
    envs, seeds = made(6, chosen, 0.03), list(range(6))
    together = roll_out(law_for(envs), envs, seeds)
    for seed in (1, 4):
        alone = gymnasium.make(beamenv.ENV_ID, scenario=chosen, dtype="float64", blade=SMALL, duration=0.03)
        own = roll_out(law_for(alone), alone, [seed])
        assert together.voltages[:, seed] == pytest.approx(own.voltages[:, 0], rel=1e-4, abs=0.05)


@pytest.mark.parametrize("delay", [1, 3])
def test_told_of_a_delay_it_stays_near_what_no_delay_costs(delay):
    costs = []
    for chosen in ("white", {"preset": "white", "drive": {"delay": [delay, delay]}}):
        envs = made(64, chosen, 0.2)
        costs.append(evaluate(law_for(envs), envs, range(64)).relative_cost.value)
    assert costs[0] < costs[1] < 1.1 * costs[0]


def test_told_which_actuator_is_dead_it_leaves_it_alone():
    envs = made(8, {"failures": {"dead_actuators": 1}})
    voltages = np.abs(roll_out(law_for(envs), envs, range(8)).voltages).max(axis=0)
    alive = envs.unwrapped.episode_truth[:, 2:6].astype(bool)
    assert voltages[~alive].max() < 1e-3 < voltages[alive].min()


def test_the_truth_of_an_episode_is_what_was_drawn():
    envs = made(5, {"drive": {"delay": [1, 3]}, "failures": {"dead_actuators": 1, "faulty_sensors": 1, "biased_share": 1.0}})
    envs.reset(seed=list(range(5)))
    told, faults = envs.unwrapped.episode_truth, envs.unwrapped._blades.electronics.faults
    assert np.array_equal(told[:, 1], faults.delay)
    assert np.array_equal(told[:, 2:6], faults.actuator_gain)
    assert np.array_equal(told[:, 10:], faults.sensor_bias)
    assert np.abs(told[:, 10:]).max(axis=1).min() > 0.0


def test_in_physical_units_it_does_the_same():
    voltages = []
    for physical in (False, True):
        envs = made(3, "failure", 0.03, physical_units=physical)
        law = law_for(envs)
        voltages.append(roll_out(law.in_physical_units() if physical else law, envs, range(3)).voltages)
    assert voltages[1] == pytest.approx(voltages[0], rel=1e-6, abs=1e-6)


def test_foreseen_loads_are_of_the_sizes_that_are_drawn():
    """A quarter of steps of 15 to 45 N/m in any direction: 11 N/m root mean square in lag and in flap."""
    (lasting,) = foreseen_loads(scenario("nominal"), 200.0)
    assert lasting == PersistentLoad(np.sqrt(0.25 * 975.0 / 2.0), 0.25)
    turbulence, *harmonics = foreseen_loads(scenario("rotor"), 200.0)
    assert turbulence == PersistentLoad(5.0, 0.02)
    draws = 6.0 * np.random.default_rng(0).uniform(0.5, 1.5, 100_000)
    assert harmonics[0] == RotorHarmonics(200.0, (1,), harmonics[0].magnitude, 2.0)
    assert harmonics[0].magnitude == pytest.approx(np.sqrt(np.mean(draws**2) / 4.0), rel=5e-3)
    assert foreseen_loads(scenario("white"), 200.0) == ()
    assert foreseen_loads(scenario("overload"), 200.0)[0].magnitude == LARGEST


def test_plants_that_wander_within_an_episode_are_refused():
    with pytest.raises(ValueError, match="truth has plants that wander within an episode, but allowed are one an episode"):
        law_for(made(1, "gust-speed", 0.02))


def test_what_is_no_truth_is_refused():
    with pytest.raises(ValueError, match="truth is None, but must be a beamenv.knowledge.Truth"):
        clairvoyant_lqg(None)
