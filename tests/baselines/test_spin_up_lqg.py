"""LQG along a spin-up that is known: it costs what theory says, and less than any LQG of one speed."""

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import clairvoyant_lqg, full_order_lqg, roll_out, spin_up_lqg
from baselines.design.time_varying import filter_gains, regulator_gains
from beamenv.blade.build import Blade

SMALL = {"model": "thesis", "modes": 3, "beam": {"terms": 4}}
UNLIMITED = {**SMALL, "voltage_limits": [-1e6, 1e6], "sensor_full_scale": 1e-3}
SPIN_UP = {"preset": "white", "plants": {"spin_up": [120.0, 220.0]}}


def made(num_envs, chosen, duration=0.15, blade=SMALL):
    return gymnasium.make_vec(beamenv.ENV_ID, num_envs=num_envs, scenario=chosen, dtype="float64", blade=blade, duration=duration)


def foretold(law):
    """x₀ᵀP₀x₀ + Σ tr P⁺W + tr KᵀKʳ(S − LCS) along the spin-up, and what the white load itself costs: J of white noise, J s."""
    plan, steps = law._plan, law.known.steps
    _, told = law.told(np.zeros((1, plan.sizes[2])))
    stages = [plan.stage(np.array([k]), told) for k in range(steps)]
    costs = [np.zeros((1, plan.states, plan.states))]
    for stage in stages[::-1]:
        costs.append(regulator_gains([stage], costs[-1])[1])
    costs.reverse()
    start, n = plan.known.bank.start[0], plan.sizes[0]
    S, total = np.zeros_like(costs[0]), float(start @ costs[0][0][:n, :n] @ start)
    for k, stage in enumerate(stages):
        P, K, L = costs[k + 1], regulator_gains([stage], costs[k + 1])[0][0], filter_gains([stage], S)[0][0]
        left, inner = S - L @ stage.C @ S, stage.R + stage.B.swapaxes(1, 2) @ P @ stage.B
        total += np.trace(P[0] @ stage.W[0]) + np.trace((K.swapaxes(1, 2) @ inner @ K @ left)[0])
        total += np.trace(plan.plants.cost[k][n + 4 :, n + 4 :] @ plan.white[0])
        S = filter_gains([stage], S)[1]
    return total


def test_along_a_spin_up_it_costs_what_theory_says_and_less_than_the_lqg_of_any_speed():
    """Most of it is what the start of the spin-up excites, which is no chance: 3 digits with few blades."""
    envs = made(24, SPIN_UP, blade=UNLIMITED)
    law = spin_up_lqg(envs.unwrapped.task.prior)
    costs = roll_out(law, envs, range(24)).cost.sum(axis=0)
    error = costs.std() / np.sqrt(len(costs))
    assert costs.mean() == pytest.approx(foretold(law), abs=4.0 * error)
    assert error < 2e-3 * costs.mean()
    for speed in (120.0, 170.0, 220.0):
        fixed = full_order_lqg(Blade(beamenv.blade_config("thesis", UNLIMITED, speed)).truth, 0.0)
        assert costs.mean() < 0.8 * roll_out(fixed, envs, range(24)).cost.sum(axis=0).mean()


@pytest.mark.parametrize(
    "chosen", [{"plants": {"spin_up": [200.0, 200.5]}}, "white", {"drive": {"hysteresis": 0.2, "delay": 1}}], ids=str
)
def test_where_nothing_is_drawn_it_is_as_good_as_told_the_truth(chosen):
    envs = made(3, chosen, 0.04)
    task = envs.unwrapped.task
    own, told = (roll_out(law, envs, range(3)).voltages for law in (spin_up_lqg(task.prior), clairvoyant_lqg(task.truth)))
    assert own == pytest.approx(told, rel=1e-6, abs=1e-3)


def test_of_plants_that_are_drawn_it_knows_the_one_that_they_depart_from():
    drawn, nominal = (made(1, chosen, 0.02) for chosen in ({"plants": {"speed_ratio": [0.8, 1.2], "bank": 3}}, "nominal"))
    laws = [spin_up_lqg(each.unwrapped.task.prior) for each in (drawn, nominal)]
    reading = np.array([0.1, -0.2, 0.3, 0.0])
    assert laws[0].predict(reading)[0] == pytest.approx(laws[1].predict(reading)[0], rel=1e-9)


def test_what_is_no_prior_is_refused():
    with pytest.raises(ValueError, match="^prior is None, but must be a beamenv.Prior"):
        spin_up_lqg(None)
