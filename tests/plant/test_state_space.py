"""Plants from models of any origin: what is given stays, what is not follows by stated rules, what cannot be is refused."""

import json
from dataclasses import replace

import control
import numpy as np
import pytest
from scipy.io import savemat
from scipy.linalg import block_diag, solve_continuous_lyapunov

from baselines import lqg, no_control, reference_lqg, stationary_cost
from beamenv import Plant, blade_config, build_plant, sample
from beamenv.plant import fingerprint
from beamenv.plant.hold import hold
from beamenv.plant.plant import drive_limit
from beamenv.plant.transients import after_sudden
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.simulation.blades import Blades
from tests.plant.two_modes import A, B, C, oscillator


def turn(rotation, radius):
    return radius * np.array([[np.cos(rotation), np.sin(rotation)], [-np.sin(rotation), np.cos(rotation)]])


def markov(A, B, C, count=12):
    return np.array([C @ np.linalg.matrix_power(A, k) @ B for k in range(count)])


def test_what_is_given_stays_as_it_is_in_its_own_coordinates():
    plant = Plant.from_state_space(A, B, C, interval=0.01)
    for name, given in {"A": A, "B": B, "C": C}.items():
        np.testing.assert_array_equal(getattr(plant, name), given)
    assert plant.natural_frequencies == pytest.approx([30.0, 95.0])
    assert not plant.energy_known and plant.control_interval == 0.01


@pytest.mark.parametrize(
    ("dynamics", "further"),
    [
        (block_diag(turn(0.3, 0.99), turn(1.2, 0.97), [[0.5]]), 0),
        (block_diag(turn(0.3, 0.99), [[-0.4]]), 1),
        (block_diag(turn(0.3, 0.99), [[-0.4]], [[-0.9]], [[0.2]]), 2),
        (block_diag(turn(0.3, 0.99), [[0.0]]), 0),
    ],
    ids=["poles of its own", "an alternating pole", "two of them", "a pole at zero"],
)
def test_a_sampled_model_sampled_again_is_the_model(dynamics, further):
    generator = np.random.default_rng(0)
    n = len(dynamics)
    basis = generator.normal(size=(n, n))
    own = basis @ dynamics @ np.linalg.inv(basis)
    inputs, outputs = generator.normal(size=(n, 2)), generator.normal(size=(3, n))
    plant = Plant.from_state_space(own, inputs, outputs, dt=0.02)
    held = sample(plant)
    assert len(plant.A) == n + further
    assert any("alternate" in each for each in plant.assumed) == (further > 0)
    wanted = markov(own, inputs, outputs)
    assert markov(held.A, held.B, held.C) == pytest.approx(wanted, abs=1e-7 * np.abs(wanted).max())


def test_noise_on_the_states_of_a_sampled_model_has_its_covariance():
    generator, dynamics = np.random.default_rng(1), block_diag(turn(0.3, 0.99), turn(1.2, 0.97))
    root = generator.normal(size=(4, 2))
    plant = Plant.from_state_space(dynamics, np.ones(4), np.ones(4), dt=0.02, state_noise=root @ root.T, process_noise=0.0)
    held = sample(plant)
    W = held.disturbance_input @ held.process_noise @ held.disturbance_input.T
    np.testing.assert_allclose(W, root @ root.T, atol=1e-9)
    assert plant.loads == 1 and len(plant.disturbances) == 3


def test_python_controls_systems_are_plants_continuous_and_sampled():
    system = control.ss(A, B, C, np.zeros((2, 1)))
    plant, held = Plant.from_control(system, interval=0.01), Plant.from_control(control.c2d(system, 0.01))
    np.testing.assert_allclose(held.A, plant.A, atol=1e-8)
    np.testing.assert_allclose(held.B, plant.B, atol=1e-8)
    with pytest.raises(ValueError, match=r"^system has dt = True, but must say how long a sample is"):
        Plant.from_control(control.ss(0.5, 1.0, 1.0, 0.0, True))


def test_a_model_is_the_same_in_files_of_every_kind(tmp_path):
    about = {
        "A": A,
        "B": B,
        "C": C,
        "interval": 0.01,
        "sensor_units": ["m/s", "m"],
        "actuator_limits": 20.0,
        "full_scale": [2.0, 0.1],
    }
    energy = 0.5 * np.eye(4)
    plant = Plant.from_state_space(**about, energy=energy)
    np.savez(tmp_path / "model.npz", **about, energy=energy, origin="a bench")
    units = np.array(about["sensor_units"], dtype=object)
    savemat(tmp_path / "model.mat", {**about, "energy": energy, "sensor_units": units})
    lists = {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in about.items()}
    (tmp_path / "model.json").write_text(json.dumps({**lists, "energy": energy.tolist()}))
    for ending in ("npz", "mat", "json"):
        read = Plant.from_file(tmp_path / f"model.{ending}")
        assert fingerprint(read) == fingerprint(plant) and read.sensors == plant.sensors and read.assumed == plant.assumed


def test_rules_do_not_depend_on_coordinates():
    T = np.random.default_rng(2).normal(size=(4, 4))
    back = np.linalg.inv(T)
    plant = Plant.from_state_space(A, B, C, interval=0.01)
    other = Plant.from_state_space(T @ A @ back, T @ B, C @ back, interval=0.01)
    for name in ("sensor_full_scale", "input_weight", "sensor_noise", "process_noise", "reference_load"):
        np.testing.assert_allclose(getattr(other, name), getattr(plant, name), rtol=1e-6)
    assert stationary_cost(other, lqg(other)) == pytest.approx(stationary_cost(plant, lqg(plant)), rel=1e-6)


def test_noise_on_a_mode_in_large_units_is_not_lost():
    """The second mode is counted in 1e8 of the unit of the first, so that their covariances are 1e16 apart."""
    units = np.diag([1e4, 1e4, 1e-4, 1e-4])
    moved = units @ A @ np.linalg.inv(units), units @ B, C @ np.linalg.inv(units)
    plant = Plant.from_state_space(A, B, C, process_noise=0.0, state_noise=1e-4 * np.eye(4))
    same = Plant.from_state_space(*moved, process_noise=0.0, state_noise=1e-4 * units**2)
    assert stationary_cost(same, lqg(same)) == pytest.approx(stationary_cost(plant, lqg(plant)), rel=1e-9)


def test_the_rules_are_what_the_default_blade_has():
    """Its reference load, its price of voltages and its ranges were chosen by hand: what the rules would make of them is near."""
    blade = build_plant(blade_config("thesis"))
    drive, E = drive_limit(blade), blade.disturbance_input
    to_come = solve_continuous_lyapunov(blade.A.T, -blade.state_weight)
    by_drive, by_load = (np.einsum("ik,ij,jk->k", f, to_come, f) for f in (blade.B * drive, E))
    assert np.sqrt(by_drive.sum() / by_load) == pytest.approx(30.0, rel=0.2)
    price = np.diag(blade.input_weight) * drive**2 / after_sudden(blade, 30.0 * E).cost
    assert price == pytest.approx(0.2, rel=0.1)
    largest = np.maximum(after_sudden(blade, 30.0 * E).outputs, after_sudden(blade, blade.B * drive).outputs).max()
    assert blade.sensor_full_scale.max() == pytest.approx(largest, rel=0.1)  # the blade's own has no voltages in it


def test_the_cost_of_outputs_that_feel_voltages_is_theirs():
    D = np.array([[0.3], [0.0]])
    weight = np.array([[2.0, 0.5], [0.5, 1.0]])
    plant = Plant.from_state_space(A, B, C, D, interval=1e-3, output_weight=weight, input_weight=1e-6)
    blades, generator = Blades(plant, SCENARIOS["quiet"], 1, physical_units=True), np.random.default_rng(0)
    blades.begin(generator)
    spent, felt = 0.0, 0.0
    for voltage in generator.uniform(-10.0, 10.0, 300):
        before = blades.state[0]
        spent += blades.step(np.array([[voltage]]), generator).cost_increment[0]
        outputs = np.stack([C @ state + D[:, 0] * voltage for state in (before, blades.state[0])])
        felt += 0.5e-3 * np.einsum("ki,ij,kj->", outputs, weight, outputs) + 1e-9 * voltage**2
    assert spent == pytest.approx(felt, rel=2e-3)  # the trapezoidal rule, 66 instants a period
    law = lqg(plant)
    assert (
        stationary_cost(plant, law) <= stationary_cost(plant, lqg(plant, "continuous")) < stationary_cost(plant, no_control(plant))
    )


def test_scenarios_go_as_slowly_as_the_model():
    plant = Plant.from_state_space(A, B, C, interval=0.01)
    chosen = replace(SCENARIOS["step"], onset=(0.05, 0.05), white_load=False)
    assert plant.time_scale == pytest.approx(2.0 * np.pi / 30.0 / 0.035, rel=1e-6)
    blades, generator = Blades(plant, chosen, 1), np.random.default_rng(0)
    blades.begin(generator)
    instants = 0
    while not blades.coming_loads.any():
        blades.step(np.zeros((1, 1)), generator)
        instants += 1
    assert instants == round(0.05 * plant.time_scale / 0.01)


def test_what_was_assumed_is_told_and_what_was_said_is_not():
    plant = Plant.from_state_space(A, B, C)
    assert len(plant.assumed) == 9 and all(each in repr(plant) for each in plant.assumed)
    known = Plant.from_state_space(
        A,
        B,
        C,
        interval=0.01,
        output_weight=[1.0, 1.0],
        input_weight=0.1,
        disturbance_input=B,
        reference_load=5.0,
        process_noise=0.5,
        sensor_noise=[0.01, 0.02],
        full_scale=1.0,
        actuator_limits=(-5.0, 10.0),
    )
    assert known.assumed == () and "assumed" not in repr(known)
    assert known.sensor_noise == pytest.approx(np.diag([1e-4, 4e-4]) * 0.01)
    assert known.voltage_limits.tolist() == [[-5.0], [10.0]]


def test_laws_are_built_of_a_model_with_accelerometers():
    accelerating = np.vstack([C[0], C[0] @ A])
    plant = Plant.from_state_space(A, B, accelerating, np.array([[0.0], [C[0] @ B[:, 0]]]), sensor_units=["m/s", "m/s²"])
    without = stationary_cost(plant, no_control(plant))
    for build in (lqg, reference_lqg):
        assert stationary_cost(plant, build(plant)) < 0.2 * without


def test_stiff_models_in_any_coordinates_are_reached():
    """Poles from 1 to 5000 rad/s, and coordinates of condition 1e4."""
    generator = np.random.default_rng(4)
    for _ in range(20):
        stiff = block_diag(oscillator(1.0, 0.01), oscillator(40.0, 0.02), oscillator(5000.0, 0.4), [[-2.0]])
        basis = generator.normal(size=(7, 7)) @ np.diag(np.logspace(-2.0, 2.0, 7))
        Plant.from_state_space(basis @ stiff @ np.linalg.inv(basis), basis @ np.ones(7), np.ones(7) @ np.linalg.inv(basis))


def test_a_model_moves_as_python_control_says():
    """Held voltages through control.forced_response, a simulation of its own."""
    system = control.ss(A, B, C, np.zeros((2, 1)))
    plant = Plant.from_control(system, interval=0.01, sensor_noise=0.0, full_scale=1e6)
    blades, generator = Blades(plant, SCENARIOS["quiet"], None, physical_units=True), np.random.default_rng(0)
    voltages = generator.uniform(-10.0, 10.0, 200)
    shown = [blades.begin(generator).observation, *(blades.step(np.array([each]), generator).observation for each in voltages)]
    held = control.forced_response(control.c2d(system, 0.01), inputs=np.append(voltages, 0.0), timepts=0.01 * np.arange(201))
    np.testing.assert_allclose(np.array(shown).T, held.outputs, rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize("ratio", [1e-3, 1e-5, 1e-7])
def test_lightly_damped_modes_are_models(ratio):
    plant = Plant.from_state_space([[0.0, 30.0], [-30.0, -60.0 * ratio]], [0.0, 1.0], [0.0, 1.0])
    assert stationary_cost(plant, lqg(plant)) < 0.2 * stationary_cost(plant, no_control(plant))


def test_continuous_inputs_are_those_that_the_held_model_has():
    plant = Plant.from_state_space(block_diag(turn(0.3, 0.99), turn(1.2, 0.97)), np.ones(4), np.ones(4), dt=0.02)
    transition, inputs = hold(plant.A, plant.B, 0.02)
    assert inputs == pytest.approx(np.ones((4, 1)), abs=1e-9)
    assert np.abs(np.linalg.eigvals(transition)) == pytest.approx([0.99, 0.99, 0.97, 0.97], abs=1e-9)
