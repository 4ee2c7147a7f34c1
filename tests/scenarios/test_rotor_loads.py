"""Turbulence and loads per revolution: their statistics."""

import numpy as np
import pytest
from scipy.stats import kstest

from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.scenarios.drawing import draw_load_cases
from beamenv.scenarios.scenario import SCENARIOS, scenario
from beamenv.simulation.memory import Arrangement
from beamenv.simulation.signals.disturbances import SharedDisturbances, Turbulence, noise_factor
from beamenv.simulation.signals.seeded_disturbances import SeededDisturbances

PLANT = build_plant(blade_config())
ROTOR = SCENARIOS["rotor"].rotor
GUSTS = scenario(
    {**dict.fromkeys(("step", "pulse", "deflection", "harmonic"), 0.0), "white_load": False, "rotor": {"turbulence": 5.0}}
)


def loads_of(chosen, kind, blades, instants):
    """(instants, blades, 2) N/m."""
    shape = (1, blades)
    disturbances = kind(noise_factor(PLANT, chosen), Arrangement(shape), Turbulence.of(PLANT, chosen))
    generators = np.random.default_rng(0)
    if kind is SeededDisturbances:
        generators = [np.random.default_rng(seed) for seed in range(blades)]
    cases = draw_load_cases(chosen, PLANT, generators, blades, np.full(blades, 200.0))
    begins = generators if kind is SeededDisturbances else generators.standard_normal((blades, disturbances.columns))
    disturbances.begin(Arrangement(shape).those(np.arange(blades)), cases, begins)
    found = np.empty((instants, *shape, 2))
    for out in found:
        disturbances.loads(out)
        disturbances.next(generators)
    return found[:, 0]


@pytest.mark.parametrize("kind", [SharedDisturbances, SeededDisturbances])
def test_turbulence_has_its_variance_from_the_first_instant_on_and_forgets_exponentially(kind):
    """Standard deviation σ = 5 N/m and autocorrelation exp(−t/τ), τ = 20 ms, within four standard errors."""
    loads = loads_of(GUSTS, kind, 2000, 200)
    for instant in (0, 1, 64, 199):
        assert loads[instant].std() == pytest.approx(5.0, rel=4.0 / np.sqrt(2.0 * 4000))
    first = loads[10]
    for lag in (1, 20, 40, 80):
        correlation = np.mean(first * loads[10 + lag]) / 25.0
        expected = np.exp(-lag * PLANT.control_interval / 0.02)
        assert correlation == pytest.approx(expected, abs=4.0 * np.sqrt((1.0 + expected**2) / 4000))
    assert abs(np.mean(first[:, 0] * first[:, 1])) / 25.0 < 4.0 / np.sqrt(2000)  # lag knows nothing of flap


def test_turbulence_has_drydens_longitudinal_spectrum():
    """S(ω) = 2σ²τ/(1 + (ωτ)²) from averaged periodograms, 8 to 250 Hz: 10 % a bin, 2 % over all."""
    blades, instants, interval = 400, 4096, PLANT.control_interval
    loads = loads_of(GUSTS, SharedDisturbances, blades, instants)[:, :, 0]
    window = np.hanning(instants)[:, None]
    spectrum = (np.abs(np.fft.rfft(loads * window, axis=0)) ** 2).mean(axis=1) * interval / np.sum(window**2)
    omega = 2.0 * np.pi * np.fft.rfftfreq(instants, interval)
    band = (omega > 50.0) & (omega < 1600.0)
    decay = np.exp(-interval / 0.02)
    sampled = 25.0 * (1.0 - decay**2) * interval / np.abs(1.0 - decay * np.exp(-1j * omega * interval)) ** 2  # with its aliases
    ratio = (spectrum / sampled)[band]
    assert ratio.mean() == pytest.approx(1.0, abs=0.02)
    slow = omega < 400.0
    dryden = 2.0 * 25.0 * 0.02 / (1.0 + (omega * 0.02) ** 2)
    assert (spectrum / dryden)[band & slow].mean() == pytest.approx(1.0, abs=0.03)


def harmonics(blades=4000, seed=0):
    """Complex amplitudes (blades, orders, 2)."""
    cases = draw_load_cases(SCENARIOS["rotor"], PLANT, np.random.default_rng(seed), blades, np.full(blades, 200.0))
    return cases, cases.cosine - 1j * cases.sine


def test_harmonics_come_at_whole_multiples_of_the_revolution():
    """Least squares on cos and sin of h Ω t, h = 1 … 4, leaves nothing of 1000 intervals at each blade's own speed."""
    speeds = np.array([140.0, 200.0, 260.0])
    cases = draw_load_cases(SCENARIOS["rotor"], PLANT, np.random.default_rng(1), 3, speeds)
    time = PLANT.control_interval * np.arange(1000)
    loads = cases.of_rotor(np.arange(1000)[:, None])
    for row, speed in enumerate(speeds):
        angle = speed * time[:, None] * np.arange(1, 5)
        basis = np.hstack([np.cos(angle), np.sin(angle)])
        found, residual, *_ = np.linalg.lstsq(basis, loads[:, row], rcond=None)
        np.testing.assert_allclose(residual, 0.0, atol=1e-18)
        np.testing.assert_allclose(found[:4], cases.cosine[row], atol=1e-9)
        np.testing.assert_allclose(found[4:], cases.sine[row], atol=1e-9)


def test_amplitudes_are_uniform_between_half_and_one_and_a_half_of_their_means():
    _, amplitude = harmonics()
    size = np.sqrt((np.abs(amplitude) ** 2).sum(axis=2))
    for order, mean in enumerate((6.0, 4.0, 2.0, 1.0)):
        assert kstest(size[:, order] / mean - 0.5, "uniform").pvalue > 0.001


def test_phases_and_directions_are_uniform_and_independent():
    cases, amplitude = harmonics()
    turn = np.where(np.abs(amplitude[..., 0]) > np.abs(amplitude[..., 1]), amplitude[..., 0], amplitude[..., 1])
    phase = np.angle(turn**2) / (2.0 * np.pi) % 1.0  # of the double angle: a direction's sign is half a turn
    for order in range(4):
        assert kstest(phase[:, order], "uniform").pvalue > 0.001
    unit = np.exp(2j * np.pi * phase)
    coherence = np.abs(unit.T @ unit.conj()) / len(unit)
    assert np.abs(coherence - np.eye(4)).max() < 4.0 / np.sqrt(len(unit))
    ratio = np.abs(amplitude[..., 1]) ** 2 / (np.abs(amplitude) ** 2).sum(axis=2)
    assert ratio.mean() == pytest.approx(0.5, abs=0.02)  # no direction is preferred


def test_speed_leaves_the_draws_as_they_are():
    slow, fast = (
        draw_load_cases(SCENARIOS["rotor"], PLANT, np.random.default_rng(2), 5, np.full(5, speed)) for speed in (150.0, 250.0)
    )
    np.testing.assert_array_equal(slow.cosine, fast.cosine)
    np.testing.assert_allclose(slow.revolution, 150.0 * PLANT.control_interval)
    np.testing.assert_allclose(fast.revolution, 250.0 * PLANT.control_interval)
