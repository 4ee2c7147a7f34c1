"""The reduced plant against the full Galerkin model."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade.build import Blade, build_beam, build_plant, displacement_operator
from beamenv.blade.presets import blade_config
from beamenv.patches import actuation, sensing
from beamenv.plant.plant import sample
from beamenv.plant.reduction import truncate
from beamenv.plant.signals import REFERENCE_LOAD
from beamenv.structure.modes import normal_modes
from beamenv.structure.newmark import NewmarkScheme, newmark

CONFIG = blade_config()


def undamped_full_model(config):
    """M, G + C_d, K of all modes with the modal damping of the plant."""
    beam = build_beam(config)
    point = beam.at(config.speed)
    frequencies, shapes = normal_modes(point.mass, point.stiffness)
    modal = point.mass @ shapes
    damping = point.gyroscopic + modal @ np.diag(2 * config.damping_ratio * frequencies) @ modal.T
    return beam, point.mass, damping, point.stiffness


def plant_tip_response(plant, load, steps):
    held = sample(plant)
    x, tips = np.zeros(len(plant.A)), []
    for _ in range(steps + 1):
        tips.append(plant.tip_displacement @ x)
        x = held.A @ x + held.disturbance_input @ load
    return np.array(tips)


def test_plant_and_newmark_on_the_full_model_agree_for_a_step_load():
    """Average acceleration on all coordinates at 10 µs against 11 modes propagated exactly: 0.2 % of the peak is truncation."""
    load = np.array([0.0, REFERENCE_LOAD])
    beam, mass, damping, stiffness = undamped_full_model(CONFIG)
    force = beam.line_load() @ load
    fine, ratio, steps = 1e-5, 50, 200
    history = newmark(mass, damping, stiffness, lambda t: force, fine, ratio * steps)
    tip = beam.displacements(np.array([beam.length]))
    full = history[::ratio] @ np.vstack([tip["u"], tip["v"]]).T
    reduced = plant_tip_response(build_plant(CONFIG), load, steps)
    peak = np.abs(full).max()
    assert peak == pytest.approx(1.79e-4, rel=0.02)
    assert np.abs(full - reduced).max() < 2e-3 * peak


def test_all_modes_and_a_fine_newmark_agree_to_its_time_error():
    """With nothing truncated what is left is Newmark's error: it falls with the square of the interval."""
    load = np.array([REFERENCE_LOAD, 0.0])
    beam, mass, damping, stiffness = undamped_full_model(CONFIG)
    force = beam.line_load() @ load
    tip = beam.displacements(np.array([beam.length]))["u"]
    exact = plant_tip_response(build_plant(replace(CONFIG, modes=beam.space.size)), load, 40)[:, 0]
    errors = []
    for ratio in (25, 50):
        history = newmark(mass, damping, stiffness, lambda t: force, 5e-4 / ratio, ratio * 40)
        errors.append(np.abs(history[::ratio] @ tip[0] - exact).max() / np.abs(exact).max())
    assert errors[1] < 1e-4
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.4)


def test_newmark_of_the_thesis_lengthens_the_period_more_than_average_acceleration():
    """One oscillator at ωΔt = 0.3 has cos(ω̃Δt) = 1 − ½(ωΔt)²/(1 + α(ωΔt)²): its period is 0.746 % and 2.955 % too long."""
    omega, interval = 1.0, 0.3
    one = np.ones((1, 1))
    periods = []
    for alpha in (0.25, 0.75):
        history = (
            newmark(one, 0 * one, omega**2 * one, lambda t: np.ones(1), interval, 2000, NewmarkScheme(alpha=alpha))[:, 0] - 1.0
        )
        crossings = np.flatnonzero((history[:-1] < 0) & (history[1:] >= 0))
        times = crossings + history[crossings] / (history[crossings] - history[crossings + 1])
        periods.append(np.diff(times).mean() * interval / (2 * np.pi))
    exact = [interval / np.arccos(1 - 0.5 * interval**2 / (1 + alpha * interval**2)) for alpha in (0.25, 0.75)]
    assert periods == pytest.approx(exact, rel=1e-4)
    assert periods == pytest.approx([1.00746, 1.02955], abs=1e-5)


def test_newmark_of_many_blades_is_that_of_each_to_the_last_bit():
    _, mass, damping, stiffness = undamped_full_model(CONFIG)
    scales, force = (1.0, 2.0, 3.0), np.linspace(-1.0, 1.0, len(mass))
    several = [[scale * each for scale in scales] for each in (mass, damping, stiffness)]
    loads = np.array([scale**2 * force for scale in scales])
    together = newmark(*map(np.array, several), lambda t: t * loads, 1e-4, 50)
    for k, matrices in enumerate(zip(*several, strict=True)):
        assert np.array_equal(together[:, k], newmark(*matrices, lambda t, k=k: t * loads[k], 1e-4, 50))
    assert np.ptp(together[-1]) > 0.0


def test_half_the_squared_state_is_the_vibration_energy():
    """½ xᵀx of the plant equals ½ q̇ᵀMq̇ + ½ qᵀKq of the blade whose modal coordinates it stands for."""
    rng = np.random.default_rng(0)
    beam = build_beam(CONFIG)
    modal = truncate(beam, CONFIG.speed, CONFIG.modes)
    x = rng.normal(size=2 * CONFIG.modes)
    q = modal.mode_shapes @ (x[:11] / modal.natural_frequencies)
    velocity = modal.mode_shapes @ x[11:]
    point = beam.at(CONFIG.speed)
    energy = 0.5 * velocity @ point.mass @ velocity + 0.5 * q @ point.stiffness @ q
    plant = build_plant(CONFIG)
    assert x @ plant.state_weight @ x == pytest.approx(energy, rel=1e-10)


def test_effort_is_the_energy_that_the_actuators_store_in_the_blade_at_rest():
    """By the trial functions, as the thesis would: uᵀRu = ½ fᵀK⁻¹f for the default weight ½ (to the regularisation, 1e-6)."""
    config = replace(CONFIG, model="thesis")
    beam, plant = build_beam(config), build_plant(config)
    volts = np.array([1500.0, -300.0, 700.0, 100.0])
    force = actuation(beam, config.patches) @ volts
    stored = 0.5 * force @ np.linalg.solve(beam.matrices.stiffness(config.speed), force)
    assert volts @ plant.input_weight @ volts == pytest.approx(stored, rel=1e-5)


def test_power_of_the_voltages_is_what_the_energy_gains():
    """d/dt ½xᵀx = xᵀBu − dissipation: B is the actuators' modal force, C its mirror image for the sensors."""
    beam, plant = build_beam(CONFIG), build_plant(CONFIG)
    modal = Blade(CONFIG).modal
    assert plant.B[11:] == pytest.approx(modal.mode_shapes.T @ actuation(beam, CONFIG.patches, CONFIG.speed))
    assert plant.C[:, 11:] == pytest.approx(sensing(beam, CONFIG.patches, CONFIG.speed) @ modal.mode_shapes)
    symmetric = plant.A + plant.A.T
    assert symmetric[11:, 11:] == pytest.approx(np.diag(-4 * CONFIG.damping_ratio * plant.natural_frequencies), abs=1e-9)
    assert np.abs(symmetric[:11]).max() < 1e-9


def test_five_hundred_newtons_per_metre_bend_the_tip_by_one_and_a_half_millimetres():
    plant = build_plant(CONFIG)
    deflection = -plant.tip_displacement @ np.linalg.solve(plant.A, plant.disturbance_input[:, 1] * 500.0)
    assert deflection[1] == pytest.approx(1.46e-3, rel=0.01)


def test_displacement_operator_ends_in_the_tip_displacement():
    plant = Blade(CONFIG).truth
    operator = displacement_operator(CONFIG, [0.0, 1.0, 2.023])
    assert operator[:, 0] == pytest.approx(0.0, abs=1e-15)
    assert operator[:2, -1] == pytest.approx(plant.tip_displacement)


def test_speed_past_the_critical_one_is_refused_by_name_and_value():
    with pytest.raises(ValueError, match=r"speed is 30000\.0, but must be at least 0 and below the critical speed, 26851[.]9"):
        build_plant(blade_config(speed=30000.0))
    with pytest.raises(ValueError, match=r"^speed is 1600\.0, but must be a speed at which the blade has a steady state[.]$"):
        build_plant(blade_config(speed=1600.0))


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        ({"beam": {"thickness": -0.01}}, "blade.beam.thickness is -0.01"),
        ({"patches": {"actuators": [0.0, 0.05]}}, "blade.patches.actuators is .* apart so that patches do not overlap"),
        ({"patches": {"sensors": [1.9]}}, "blade.patches.sensors is .* lies within 0 and 0.7"),
        ({"modes": 0}, "blade.modes is 0"),
        ({"damping_ratio": float("nan")}, "blade.damping_ratio is nan"),
        ({"beam": {"chord": 1.0}}, "blade.beam has no field 'chord'"),
        ({"voltage_limits": [0.0, 1.0]}, "voltage_limits"),
        ({"beam": {"ply_angles_deg": "thirty"}}, "blade.beam.ply_angles_deg is 'thirty'"),
    ],
)
def test_a_bad_configuration_names_the_argument_and_its_value(overrides, words):
    with pytest.raises(ValueError, match=words):
        build_plant(blade_config("thesis", overrides))


def test_unknown_preset_lists_the_known_ones():
    with pytest.raises(ValueError, match=r"preset is 'helicopter', but must be one of thesis, .*chandra-chopra"):
        blade_config("helicopter")
