"""Plants as python-control has systems: its own simulations are those of the plant, and what comes back is the plant."""

from dataclasses import asdict, fields, replace

import numpy as np
import pytest
from scipy.io import loadmat, savemat
from scipy.linalg import expm

from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.plant.fingerprint import fingerprint
from beamenv.plant.plant import Plant, SampledPlant, sample
from beamenv.plant.poles import damping_ratios, poles_of_sampled

control = pytest.importorskip("control")


@pytest.fixture(scope="module")
def plant():
    return build_plant(blade_config())


def relative(found, expected):
    return np.abs(found - expected).max() / np.abs(expected).max()


def test_python_control_simulates_the_sampled_plant(plant):
    held, rng = sample(plant), np.random.default_rng(0)
    inputs = np.vstack([rng.uniform(-1500.0, 1500.0, (4, 200)), rng.uniform(-30.0, 30.0, (2, 200))])
    system = held.to_control()
    assert system.dt == held.interval
    assert system.input_labels[3:5] == ["voltage3", "load_lag"]
    response = control.forced_response(system, None, inputs)
    state, states = np.zeros(22), []
    for column in inputs.T:
        states.append(state)
        state = held.A @ state + held.B @ column[:4] + held.disturbance_input @ column[4:]
    assert relative(response.outputs, held.C @ np.array(states).T) < 1e-11


def test_python_control_samples_the_plant_as_we_do(plant):
    system, held = control.sample_system(plant.to_control(), plant.control_interval, method="zoh"), sample(plant)
    assert relative(system.A, held.A) < 1e-11
    assert relative(system.B[:, :4], held.B) < 1e-11
    assert relative(system.B[:, 4:], held.disturbance_input) < 1e-11


def test_python_control_lets_the_plant_ring_down_as_the_matrix_exponential_does(plant):
    start, times = np.linspace(-1e-2, 1e-2, 22), np.linspace(0.0, 0.05, 101)
    response = control.initial_response(plant.to_control(), times, start)
    exact = np.stack([expm(plant.A * time) @ start for time in times], axis=1)
    assert relative(response.outputs[4:], plant.tip_displacement @ exact) < 1e-11
    assert relative(response.outputs[:4], plant.C @ exact) < 1e-11


def test_what_comes_back_from_python_control_is_the_plant(plant):
    back = Plant.from_control(plant.to_control(), like=plant)
    for each in fields(Plant):
        if each.name != "natural_frequencies":
            np.testing.assert_array_equal(getattr(back, each.name), getattr(plant, each.name))


def test_natural_frequencies_are_the_magnitudes_of_the_poles():
    """Without gyroscopic coupling they are those of the modes, whatever the damping."""
    plant = build_plant(blade_config(overrides={"gyroscopic": False, "damping_ratio": 0.1}))
    back = Plant.from_control(plant.to_control(), like=plant)
    assert relative(back.natural_frequencies, plant.natural_frequencies) < 1e-10
    assert fingerprint(replace(back, natural_frequencies=plant.natural_frequencies)) == fingerprint(plant)


def test_a_plant_of_fewer_states_brings_its_own_strain(plant):
    few = build_plant(blade_config(overrides={"modes": 5}))
    back = Plant.from_control(few.to_control(), like=plant, strain=few.strain, control_interval=1e-3)
    assert repr(back).startswith("Plant(10 states, 4 voltages, 4 sensors;")
    assert back.control_interval == 1e-3
    np.testing.assert_array_equal(back.state_weight, 0.5 * np.eye(10))
    np.testing.assert_array_equal(back.voltage_limits, plant.voltage_limits)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda plant: sample(plant).to_control(), "system has dt = 0.0005, but must be in continuous time"),
        (lambda plant: plant.to_control()[:, :4], "system has 4 inputs and 6 outputs, but must have 6"),
        (lambda plant: plant.to_control() + np.ones((6, 6)), "system has a feedthrough from line loads"),
        (
            lambda plant: build_plant(blade_config(overrides={"modes": 5})).to_control(),
            "strain has shape .*, but must have rows of 10",
        ),
    ],
)
def test_a_system_that_is_no_plant_is_refused_in_one_sentence(plant, change, told):
    with pytest.raises(ValueError, match=told):
        Plant.from_control(change(plant), like=plant)


def test_damping_ratios_are_of_one_of_each_pair_and_of_every_second_real_pole():
    pairs = np.array([-1 + 10j, -1 - 10j, -3.0, -5.0, -6 + 8j, -6 - 8j])
    np.testing.assert_allclose(damping_ratios(pairs), [1.0, 0.6, 1.0 / np.sqrt(101.0)])
    sampled = poles_of_sampled(expm(np.array([[0.0, 10.0], [-10.0, -4.0]]) * 1e-2), 1e-2)
    np.testing.assert_allclose(damping_ratios(sampled), [0.2])


def test_a_sampled_plant_comes_back_as_it_was(plant):
    held = sample(plant)
    back = SampledPlant.from_control(held.to_control(), like=held)
    for each in fields(SampledPlant):
        np.testing.assert_array_equal(getattr(back, each.name), getattr(held, each.name), err_msg=each.name)


def test_a_system_that_is_no_such_sampled_plant_is_refused(plant):
    held = sample(plant)
    with pytest.raises(ValueError, match=r"^system has dt = 0, but must be sampled as like is, every 0.0005 s"):
        SampledPlant.from_control(plant.to_control(), like=held)
    with pytest.raises(ValueError, match="^system has dt = 0.001, but must be sampled as like is"):
        SampledPlant.from_control(sample(plant, 1e-3).to_control(), like=held)
    with pytest.raises(ValueError, match="^system is None, but must be a control.StateSpace"):
        SampledPlant.from_control(None, like=held)
    with pytest.raises(ValueError, match="^system has 6 inputs and 3 outputs"):
        SampledPlant.from_control(held.to_control()[:3, :], like=held)
    other = sample(build_plant(blade_config("thesis", {"modes": 3}))).to_control()
    with pytest.raises(ValueError, match=r"^cost has shape \(28, 28\), but must have 12 rows"):
        SampledPlant.from_control(other, like=held)


def test_a_mat_file_holds_a_plant_by_its_fields(plant, tmp_path):
    file = tmp_path / "blade.mat"
    savemat(file, {"plant": asdict(plant)})
    read = loadmat(file, simplify_cells=True)["plant"]
    assert set(read) == {each.name for each in fields(Plant)}
    np.testing.assert_array_equal(read["A"], plant.A)
    assert read["control_interval"] == plant.control_interval
