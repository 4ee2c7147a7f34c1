"""tr(P) and tr(S) from many layouts together, against the plant built of each; and their exact slopes."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import simpson
from scipy.linalg import eigh, expm, solve_continuous_are

from baselines.design.riccati import kalman_filter, regulator
from baselines.placement import PlacementProblem
from beamenv.blade.build import build_beam, build_plant
from beamenv.blade.presets import blade_config
from beamenv.patches import actuation

CASES = [("thesis", {}), ("thesis", {"patches": {"ganged": True}}), ("thesis", {"gyroscopic": False}), ("chandra-chopra", {})]


def trace_of_the_plant(problem, positions):
    plant = build_plant(problem.configuration(positions))
    if problem.side == "actuators":
        return np.trace(regulator(plant.A, plant.B, plant.state_weight, plant.input_weight).matrix)
    loads = plant.disturbance_input @ plant.process_noise @ plant.disturbance_input.T
    return np.trace(kalman_filter(plant.A, plant.C, loads, plant.sensor_noise).matrix)


@pytest.mark.parametrize("side", ["actuators", "sensors"])
@pytest.mark.parametrize(("preset", "changes"), CASES)
@pytest.mark.parametrize(("model", "within"), [("thesis", 2e-8), ("blade", 0.01)])
def test_cost_is_the_trace_that_the_environments_plant_has(preset, changes, side, model, within):
    """To rounding in the thesis' model; about the bare blade's steady state within 1 %, on the small box, of which patches are a
    greater part, within 8 %: layouts differ by a third."""
    problem = PlacementProblem.of(blade_config(preset, changes | {"model": model}), side)
    layouts = problem.bounds.random(np.random.default_rng(1), 4)
    expected = [trace_of_the_plant(problem, layout) for layout in layouts]
    assert problem.cost(layouts) == pytest.approx(expected, rel=within if preset == "thesis" or model == "thesis" else 8.0 * within)


@pytest.mark.parametrize("side", ["actuators", "sensors"])
@pytest.mark.parametrize(("preset", "changes"), [*CASES, ("thesis", {"patches": {"passive": False}})])
def test_slopes_are_central_differences(preset, changes, side):
    problem = PlacementProblem.of(blade_config(preset, changes), side)
    layout = problem.bounds.random(np.random.default_rng(2), 1)[0]
    cost, slopes = problem.cost_and_slopes(layout)
    step = 1e-4
    numeric = []
    for direction in np.eye(4):
        at = [problem.cost_and_slopes(layout + k * step * direction)[0] for k in (-2, -1, 1, 2)]
        numeric.append((at[0] - 8.0 * at[1] + 8.0 * at[2] - at[3]) / (12.0 * step))
    assert cost == pytest.approx(problem.cost(layout[None])[0], rel=2e-8)
    assert np.abs(slopes - numeric).max() <= 1e-6 * np.abs(slopes).max()


@settings(max_examples=20)
@given(st.permutations(range(4)), st.integers(0, 1000), st.sampled_from(["actuators", "sensors"]))
def test_permuting_patches_changes_nothing(order, seed, side):
    problem = PlacementProblem.of(blade_config(), side)
    layout = problem.bounds.random(np.random.default_rng(seed), 1)
    assert problem.cost(layout[:, list(order)]) == pytest.approx(problem.cost(layout), rel=1e-9)


def test_trace_is_that_of_any_other_coordinates_of_the_same_modes():
    """Mixed modal coordinates q = V z, energies from the blade's own M and K, SciPy's equation: tr(P Wₑ⁻¹), ½xᵀWₑx the energy."""
    problem = PlacementProblem.of(blade_config(overrides={"model": "thesis"}), "actuators")
    layout = problem.bounds.uniform()
    config = problem.configuration(layout)
    beam = build_beam(config)
    stiffness = beam.matrices.stiffness(config.speed)
    squares, shapes = eigh(stiffness, beam.matrices.mass, subset_by_index=(0, config.modes - 1))
    mixed = shapes @ np.random.default_rng(0).standard_normal((config.modes, config.modes))
    mass, modal_stiffness, coupling = (
        mixed.T @ each @ mixed for each in (beam.matrices.mass, stiffness, config.speed * beam.matrices.gyroscopic)
    )
    to_modes = shapes.T @ beam.matrices.mass @ mixed
    damping = coupling + to_modes.T @ np.diag(2.0 * config.damping_ratio * np.sqrt(squares)) @ to_modes
    forces = actuation(beam, config.patches)
    still, same = np.zeros_like(mass), np.eye(len(mass))
    A = np.block([[still, same], [-np.linalg.solve(mass, modal_stiffness), -np.linalg.solve(mass, damping)]])
    B = np.vstack([np.zeros((len(mass), forces.shape[1])), np.linalg.solve(mass, mixed.T @ forces)])
    energy = np.block([[modal_stiffness, still], [still, mass]])
    stored = forces.T @ np.linalg.solve(stiffness, forces)
    effort = config.effort_weight * (stored + 1e-6 * np.trace(stored) / len(stored) * np.eye(len(stored)))
    P = solve_continuous_are(A, 1e3 * B, 0.25 * (energy + energy.T), 5e5 * (effort + effort.T))  # kilovolts scale better
    assert problem.cost(layout[None])[0] == pytest.approx(np.trace(np.linalg.solve(energy, P)), rel=1e-6)


def test_trace_over_modes_is_the_mean_cost_of_a_joule_in_the_free_response():
    """Released with 1 J along each of the 2r states in turn, with u = −Kx: the mean of ∫(½xᵀx + uᵀRu)dt is tr(P)/r."""
    problem = PlacementProblem.of(blade_config(overrides={"model": "thesis"}), "actuators")
    layout = problem.bounds.uniform()
    plant = build_plant(problem.configuration(layout))
    _, gain = regulator(plant.A, plant.B, plant.state_weight, plant.input_weight)
    interval, duration = 2.5e-4, 10.0
    step = expm((plant.A - plant.B @ gain) * interval)
    states = np.sqrt(2.0) * np.eye(len(plant.A))
    rates = []
    for _ in range(round(duration / interval) + 1):
        voltages = gain @ states
        rates.append(0.5 * np.sum(states**2) + np.sum(voltages * (plant.input_weight @ voltages)))
        states = step @ states
    assert rates[-1] < 1e-3 * rates[0]
    mean_cost = simpson(rates, dx=interval) / len(plant.A)
    assert mean_cost == pytest.approx(problem.cost(layout[None])[0] / len(plant.natural_frequencies), rel=1e-4)


def test_more_actuators_among_the_same_cost_no_more():
    config = blade_config(overrides={"patches": {"passive": False, "sensors": 1}})
    four = PlacementProblem.of(config, "actuators", 4)
    layout = four.bounds.uniform()
    costs = [PlacementProblem.of(config, "actuators", k).cost(layout[None, :k])[0] for k in (1, 2, 3, 4)]
    assert np.all(np.diff(costs) < 0.0)


def test_passive_effect_can_be_switched_off():
    layout = np.array([[0.0, 0.3, 0.6, 0.9]])
    with_mass, without = (
        PlacementProblem.of(blade_config(overrides={"patches": {"passive": passive}}), "actuators").cost(layout)[0]
        for passive in (True, False)
    )
    assert with_mass != without
    assert with_mass == pytest.approx(without, rel=1e-2)


def test_the_instrument_stays_when_sensors_move():
    config = blade_config()
    problem = PlacementProblem.of(config, "sensors")
    uniform, moved = (build_plant(problem.configuration(layout)) for layout in (problem.bounds.uniform(), [0.3, 0.5, 0.7, 0.9]))
    assert np.array_equal(uniform.sensor_noise, moved.sensor_noise)
    assert np.array_equal(uniform.sensor_noise, build_plant(config).sensor_noise)
    assert replace(problem.config, sensor_full_scale=None, patches=config.patches) == config


LISTED = {
    "charges": {"sensors": [{"kind": "charge"}]},
    "currents": {"sensors": [{"kind": "current", "noise": 0.05}]},
    "an accelerometer besides": {"sensors": [{"kind": "accelerometer"}, {"kind": "charge"}]},
    "an accelerometer alone": {"patches": {"sensors": []}, "sensors": [{"kind": "accelerometer"}]},
}


@pytest.mark.parametrize(
    ("side", "listed"), [("sensors", "charges"), ("sensors", "currents"), *(("actuators", each) for each in LISTED)]
)
@pytest.mark.parametrize(("preset", "within"), [("thesis", 0.01), ("aluminium-cantilever", 0.12)])
def test_cost_beside_listed_sensors_is_the_trace_that_the_environments_plant_has(side, listed, preset, within):
    """As of currents: on the strip, of whose bending stiffness a sheet is a great part, within 12 %."""
    problem = PlacementProblem.of(blade_config(preset, LISTED[listed]), side)
    layouts = problem.bounds.random(np.random.default_rng(1), 3)
    assert problem.cost(layouts) == pytest.approx([trace_of_the_plant(problem, layout) for layout in layouts], rel=within)
    assert problem.reads == ("charge" if (side, listed) == ("sensors", "charges") else "current")


@pytest.mark.parametrize(("side", "listed"), [("sensors", "charges"), ("actuators", "an accelerometer alone")])
def test_slopes_beside_listed_sensors_are_central_differences(side, listed):
    problem = PlacementProblem.of(blade_config("thesis", LISTED[listed]), side)
    layout, step = problem.bounds.random(np.random.default_rng(2), 1)[0], 1e-4
    numeric = []
    for direction in np.eye(4):
        at = [problem.cost_and_slopes(layout + k * step * direction)[0] for k in (-2, -1, 1, 2)]
        numeric.append((at[0] - 8.0 * at[1] + 8.0 * at[2] - at[3]) / (12.0 * step))
    cost, slopes = problem.cost_and_slopes(layout)
    assert cost == pytest.approx(problem.cost(layout[None])[0], rel=2e-8)
    assert np.abs(slopes - numeric).max() <= 1e-6 * np.abs(slopes).max()


@pytest.mark.parametrize("sensors", [[{"kind": "accelerometer"}], [{"kind": "charge"}, {"kind": "current"}]])
def test_sensor_patches_are_not_placed_where_other_readings_count_too(sensors):
    with pytest.raises(ValueError, match="config.sensors is .*, but must be empty, or one 'current' or 'charge' of the patches"):
        PlacementProblem.of(blade_config("thesis", {"sensors": sensors}), "sensors")
