"""The true plant: modes up to the Nyquist frequency, what the others follow at once, amplifiers and anti-aliasing filters."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.signal import butter

from beamenv.blade.build import Blade
from beamenv.blade.presets import PRESETS, blade_config
from beamenv.plant.electronics import butterworth, static_residual
from beamenv.plant.plant import Plant, drive_limit, sample
from beamenv.structure.modes import normal_modes

TRUE = Blade(blade_config())
OFF = {"amplifier_bandwidth": None, "filter_cutoff": None}
FIELDS = [name for name in Plant.__dataclass_fields__ if name not in ("control_interval", "electronic_states")]


def truth(**changes):
    return Blade(blade_config(overrides=changes)).truth


def response(plant, frequency):
    """Currents (p, m) per volt at a frequency in rad/s."""
    return plant.C @ np.linalg.solve(1j * frequency * np.eye(len(plant.A)) - plant.A, plant.B.astype(complex)) + plant.D


@pytest.mark.parametrize("preset", sorted(PRESETS))
def test_every_mode_up_to_the_nyquist_frequency_moves(preset):
    blade = Blade(blade_config(preset))
    config, point = blade.config, blade.beam.at(blade.config.speed)
    every, _ = normal_modes(point.mass, point.stiffness)
    count = max(config.modes, int((every <= np.pi / config.control_interval).sum()))
    np.testing.assert_allclose(blade.truth.natural_frequencies, every[:count], rtol=1e-8)
    assert len(blade.plant.natural_frequencies) == config.modes


@pytest.mark.parametrize(("interval", "modes"), [(1e-6, None), (1e-4, None), (0.1, 11), (1.0, 11)])
def test_any_control_interval_has_a_true_plant_that_can_be_sampled(interval, modes):
    """As many modes as the trial functions have at most, and the design's at least; J and state stay finite and stable."""
    plant = truth(control_interval=interval)
    assert 30 <= len(plant.natural_frequencies) <= TRUE.beam.space.size if modes is None else plant.blade_states == 2 * modes
    held = sample(plant)
    assert np.abs(np.linalg.eigvals(held.A)).max() < 1.0
    assert np.linalg.eigvalsh(held.cost).min() > -1e-12 * np.abs(held.cost).max()


def test_in_the_thesis_world_the_truth_is_the_design():
    blade = Blade(blade_config(overrides={"model": "thesis"}))
    assert blade.truth is blade.plant
    assert blade.truth.electronic_states == 0


def test_without_electronics_the_truth_of_eleven_modes_is_the_design():
    plain = truth(electronics=OFF, truth_modes=11)
    for name in FIELDS:
        np.testing.assert_array_equal(getattr(plain, name), getattr(TRUE.plant, name))


def test_the_first_states_are_the_blades_and_have_all_the_energy():
    plant = TRUE.truth
    b = plant.blade_states
    assert (b, plant.electronic_states) == (2 * len(plant.natural_frequencies), 4 * 2 + 4)
    np.testing.assert_array_equal(plant.state_weight, 0.5 * np.diag(np.arange(len(plant.A)) < b))
    assert not plant.strain[:, b:].any()
    assert not plant.disturbance_input[b:].any()
    assert not plant.A[:b, b:-4].any()  # filters look on
    damping = plant.A[:b, :b] + plant.A[:b, :b].T
    assert np.linalg.eigvalsh(damping).max() < 1e-9 * np.abs(plant.A).max()


@pytest.mark.parametrize("modes", [5, 11, 20, 40])
def test_the_static_gain_of_any_truth_is_that_of_the_full_model(modes):
    """Tip displacement per volt: u → v → modes and residual; F, K and the tip rows of all trial functions without any modes."""
    plant = truth(truth_modes=modes)
    expected = TRUE.full.tip @ np.linalg.solve(TRUE.beam.at(200.0).stiffness, TRUE.full.forces)
    found = -plant.tip_displacement @ np.linalg.solve(plant.A, plant.B)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("modes", [5, 20])
def test_a_step_of_voltage_brings_the_charge_of_the_full_model(modes):
    """∫ i dt from rest to rest is C_s K⁻¹ F u, through amplifiers and filters: integrated over 5 s. At rest it is local."""
    blade = Blade(blade_config(overrides={"truth_modes": modes, "damping_ratio": 0.1}, speed=0.0))
    plant, expected = blade.truth, blade.full.response.charges
    n, m = plant.B.shape
    integrating = np.block([[plant.A, np.zeros((n, 4)), plant.B], [plant.C, np.zeros((4, 4 + m))], [np.zeros((m, n + 4 + m))]])
    after = expm(5.0 * integrating)
    np.testing.assert_allclose(after[n : n + 4, n + 4 :], expected, rtol=1e-6, atol=1e-8 * np.abs(expected).max())


def test_modes_left_out_are_missed_at_low_frequency_but_for_their_residual():
    """Charge per volt at half the first mode, from 11 modes with residual and from all 60: as 1 to (ω/ω₁₂)²."""
    every, eleven = (truth(truth_modes=modes, damping_ratio=0.0, gyroscopic=False) for modes in (60, 11))
    without = truth(truth_modes=11, electronics={"amplifier_bandwidth": None}, damping_ratio=0.0, gyroscopic=False)
    frequency = 90.0
    exact, found, missed = (response(plant, frequency) for plant in (every, eleven, without))
    largest = np.abs(exact).max()
    assert np.abs(found - exact).max() < 2.0 * (frequency / 3597.0) ** 2 * largest
    assert np.abs(missed - exact).max() > 0.2 * largest


def test_a_residual_of_all_modes_is_nothing():
    rng = np.random.default_rng(0)
    root = rng.normal(size=(6, 6))
    omega, shapes = normal_modes(np.eye(6), root @ root.T)
    rows, forces = rng.normal(size=(3, 6)), rng.normal(size=(6, 2))
    static = rows @ np.linalg.solve(root @ root.T, forces)
    whole = static_residual(static, rows @ shapes, shapes.T @ forces, omega)
    np.testing.assert_allclose(whole, 0.0, atol=1e-9 * np.abs(static).max())
    some = static_residual(static, (rows @ shapes)[:, :2], (shapes.T @ forces)[:2], omega[:2])
    beyond = sum(np.outer((rows @ shapes)[:, k], (shapes.T @ forces)[k]) / omega[k] ** 2 for k in range(2, 6))
    np.testing.assert_allclose(some, beyond, rtol=1e-9)


@pytest.mark.parametrize("order", range(1, 9))
def test_filters_are_butterworths(order):
    """Poles as SciPy has them, gain 1 at rest and −3 dB at the cutoff, −6 dB an octave and order beyond."""
    cutoff = 5000.0
    dynamics, gain = butterworth(order, cutoff)
    poles = butter(order, cutoff, analog=True, output="zpk")[1]
    np.testing.assert_allclose(np.sort_complex(np.linalg.eigvals(dynamics)), np.sort_complex(poles), rtol=1e-6)
    shown = [abs(np.linalg.solve(1j * w * np.eye(order) - dynamics, gain)[0]) for w in (0.0, cutoff, 100.0 * cutoff)]
    np.testing.assert_allclose(shown, [1.0, np.sqrt(0.5), 100.0**-order], rtol=1e-3)
    assert shown[1] == pytest.approx(np.sqrt(0.5), rel=1e-9)


def test_a_current_passes_its_filter_and_a_voltage_its_amplifier():
    """Each is the product of transfer functions: without the residual, which bypasses the blade."""
    cutoff, pole = 2.0 * np.pi * 800.0, 2.0 * np.pi * 7500.0
    bare, filtered = truth(electronics=OFF), truth(electronics={"amplifier_bandwidth": None})
    driven = truth(electronics={"filter_cutoff": None})
    for frequency in (10.0, 1000.0, cutoff, 20000.0):
        s = 1j * frequency / cutoff
        expected = response(bare, frequency)
        np.testing.assert_allclose(response(filtered, frequency), expected / (1.0 + np.sqrt(2.0) * s + s**2), rtol=1e-9)
        np.testing.assert_allclose(response(driven, frequency), expected / (1.0 + 1j * frequency / pole), rtol=1e-9)


def test_an_amplifier_has_lost_3_db_and_45_degrees_at_its_bandwidth():
    plant = TRUE.truth
    m, frequency = plant.B.shape[1], 2.0 * np.pi * 7500.0
    voltage = np.linalg.solve(1j * frequency * np.eye(m) - plant.A[-m:, -m:], plant.B[-m:]) * drive_limit(plant)
    np.testing.assert_allclose(np.diag(voltage), np.sqrt(0.5) * np.exp(-0.25j * np.pi), rtol=1e-9)


def test_the_residual_current_is_the_rate_of_the_voltage_through_the_filter():
    """What all patches together show within the first 20 µs of a step, before the blade moves: C_r a e^{−at} through the filter."""
    blade = Blade(blade_config(speed=0.0))
    plant, full, modal = blade.truth, blade.full, blade.true_modal
    shapes = modal.mode_shapes
    residual = static_residual(full.response.charges, full.charges @ shapes, shapes.T @ full.forces, modal.natural_frequencies)
    time, pole, cutoff = 20e-6, 2.0 * np.pi * 7500.0, 2.0 * np.pi * 800.0
    n, m = plant.B.shape
    shown = plant.C @ expm(time * np.block([[plant.A, plant.B], [np.zeros((m, n + m))]]))[:n, n:]
    dynamics, gain = butterworth(2, cutoff)
    chain = np.zeros((4, 4))
    chain[:2, :2], chain[:2, 2], chain[2, 2] = dynamics, pole * gain, -pole
    impulse = (expm(time * chain) @ [0.0, 0.0, 1.0, 0.0])[0]
    assert np.abs(shown - impulse * residual).max() < 0.05 * np.abs(shown).max()


ALUMINIUM = {"E1": 70e9, "E2": 70e9, "G12": 26.9e9, "G13": 26.9e9, "G23": 26.9e9, "nu12": 0.3, "density": 2700.0}
WATCHED = {
    "thesis": {},
    "balanced plies": {"ply_angles_deg": [45, -45] * 3},
    "balanced plies at 60°": {"ply_angles_deg": [60, -60] * 3},
    "fibres along the span": {"ply_angles_deg": [90] * 6},
    "tapered": {"taper": 2.0},
    "aluminium": {"material": ALUMINIUM, "ply_angles_deg": [0]},
    "aluminium, tapered and twisted": {"material": ALUMINIUM, "ply_angles_deg": [0], "taper": 2.0, "pretwist_deg": 60.0},
}


@pytest.mark.parametrize("beam", WATCHED.values(), ids=WATCHED)
def test_the_largest_strain_of_every_mode_and_of_the_steady_state_is_watched(beam):
    """Within 6.5 % and 0.2 % of the largest at any of forty-one places along the span."""
    blade = Blade(blade_config(overrides={"beam": beam}))
    z, shapes = blade.beam.length * np.maximum(np.linspace(0.0, 1.0, 41), 1e-6), blade.modal.mode_shapes
    everywhere = np.abs(blade.beam.surface_strain(z, blade.config.speed) @ shapes).max(axis=(0, 1))
    assert np.all(np.abs(blade.full.strain @ shapes).max(axis=0) >= 0.935 * everywhere)
    assert np.abs(blade.full.steady_strain).max() == pytest.approx(abs(blade.full.steady.strain), rel=2e-3)
