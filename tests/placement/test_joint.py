"""Actuators and sensors placed together by the stationary cost of LQG."""

from dataclasses import replace

import numpy as np
import pytest

from baselines.analysis.stationary import stationary_cost
from baselines.design.riccati import kalman_filter, regulator
from baselines.laws.lqg import lqg
from baselines.placement import JointProblem, place_jointly
from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config

CASES = [
    ("thesis", {}),
    ("thesis", {"model": "thesis", "patches": {"ganged": True}}),
    ("aluminium-cantilever", {"sensors": [{"kind": "charge"}]}),
]


def layout_of(problem, seed=0):
    generator = np.random.default_rng(seed)
    return np.concatenate([bounds.random(generator, 1)[0] for bounds in problem.bounds])


def equations_of(plant):
    regulated = regulator(plant.A, plant.B, plant.state_weight, plant.input_weight)
    loads = plant.disturbance_input @ plant.process_noise @ plant.disturbance_input.T
    return regulated, kalman_filter(plant.A, plant.C, loads, plant.sensor_noise), loads


def test_cost_is_that_of_the_environments_plant_by_either_formula():
    """tr(PW̄) + tr(S KᵀRK) = tr(QS) + tr(P LVLᵀ) (Kwakernaak and Sivan, Theorem 5.4), within the 1 % of the model of layouts."""
    problem = JointProblem.of(blade_config())
    layout = layout_of(problem)
    plant = build_plant(problem.configuration(layout))
    (P, K), (S, L), loads = *map(tuple, equations_of(plant)[:2]), equations_of(plant)[2]
    by_states = np.trace(P @ loads) + np.trace(S @ K.T @ plant.input_weight @ K)
    by_readings = np.trace(plant.state_weight @ S) + np.trace(P @ L @ plant.sensor_noise @ L.T)
    assert by_states == pytest.approx(by_readings, rel=1e-7)
    assert problem.cost(layout[None])[0] == pytest.approx(by_states, rel=0.01)


def test_cost_is_what_sampled_lqg_costs_in_the_long_run():
    """By the second moments of the sampled loop, which knows nothing of Riccati equations; sampling at 2 kHz is worth 1 %."""
    problem = JointProblem.of(blade_config())
    plant = build_plant(problem.configuration(layout_of(problem)))
    assert problem.cost(layout_of(problem)[None])[0] == pytest.approx(stationary_cost(plant, lqg(plant)), rel=0.02)


@pytest.mark.parametrize(("preset", "changes"), CASES)
def test_slopes_are_central_differences(preset, changes):
    problem = JointProblem.of(blade_config(preset, changes))
    layout, step = layout_of(problem, 1), 1e-4
    cost, slopes = problem.cost_and_slopes(layout)
    numeric = []
    for direction in np.eye(len(layout)):
        at = [problem.cost_and_slopes(layout + k * step * direction)[0] for k in (-2, -1, 1, 2)]
        numeric.append((at[0] - 8.0 * at[1] + 8.0 * at[2] - at[3]) / (12.0 * step))
    assert cost == pytest.approx(problem.cost(layout[None])[0], rel=2e-8)
    assert np.abs(slopes - numeric).max() <= 1e-5 * np.abs(slopes).max()


def test_together_is_never_dearer_than_one_side_after_the_other_and_mostly_cheaper():
    """On the sound blade with two actuators and one sensor."""
    problem = JointProblem.of(blade_config("sound-blade"), 2, 1)
    found = place_jointly(problem)
    in_turn = np.array([[*found.in_turn["actuators"], *found.in_turn["sensors"]]])
    assert found.in_turn_cost == problem.cost(in_turn)[0]
    assert found.cost == pytest.approx(problem.cost(np.array([[*found.actuators, *found.sensors]]))[0], rel=1e-9)
    assert found.gain > 0.01
    assert problem.checked([*found.actuators, *found.sensors]).tolist() == [*found.actuators, *found.sensors]


def test_bad_input_is_one_sentence():
    problem = JointProblem.of(blade_config(), 1, 1)
    with pytest.raises(ValueError, match=r"sensors\.side is 'actuators', but must be 'sensors'"):
        JointProblem(problem.actuators, problem.actuators)
    with pytest.raises(ValueError, match=r"sensors\.config is .* but must be that of actuators"):
        JointProblem(problem.actuators, replace(problem.sensors, config=replace(problem.config, speed=10.0)))
    with pytest.raises(ValueError, match="positions is .* but must be a list of 2 numbers"):
        problem.configuration([0.1])
    with pytest.raises(ValueError, match="actuators is 40, but must be at most 16"):
        JointProblem.of(blade_config(), 40)
