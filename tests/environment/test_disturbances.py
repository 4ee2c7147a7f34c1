"""White loads and sensor noise: their statistics, and that a seed is an episode."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beamenv.arrays import SomeRows
from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.scenarios.drawing import draw_load_cases
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.simulation.memory import Arrangement
from beamenv.simulation.signals.disturbances import SharedDisturbances, noise_factor
from beamenv.simulation.signals.seeded_disturbances import BLOCK, SeededDisturbances

PLANT = build_plant(blade_config())
SENSORS = len(PLANT.C)


def correlated_plant():
    rng = np.random.default_rng(5)
    root = rng.normal(size=(SENSORS, SENSORS)) * 1e-7
    return replace(PLANT, process_noise=np.array([[4.0, 1.5], [1.5, 1.0]]) * 1e-3, sensor_noise=root @ root.T)


@pytest.mark.parametrize("plant", [PLANT, correlated_plant()])
def test_white_loads_and_sensor_noise_have_the_plants_covariance(plant):
    shared = SharedDisturbances(noise_factor(plant, SCENARIOS["white"]), Arrangement((8, 250)))
    rng = np.random.default_rng(0)
    cases = draw_load_cases(SCENARIOS["white"], plant, rng, 2000)
    shared.begin(Arrangement((8, 250)).those(np.arange(2000)), cases, rng.standard_normal((2000, shared.columns)))
    samples = []
    for _ in range(50):
        loads = np.empty((8, 250, 2))
        shared.loads(loads)
        samples.append(np.concatenate([loads, shared.next(rng)], axis=-1).reshape(2000, -1))
    drawn = np.concatenate(samples)
    for part, intensity in ((drawn[:, :2], plant.process_noise), (drawn[:, 2:], plant.sensor_noise)):
        expected = intensity / plant.control_interval
        np.testing.assert_allclose(part.T @ part / len(part), expected, atol=0.02 * np.abs(expected).max())
    assert np.abs(np.corrcoef(drawn.T)[:2, 2:]).max() < 0.02  # loads and sensors know nothing of each other
    before, after = samples[10][:, 0], samples[11][:, 0]
    assert abs(np.corrcoef(before, after)[0, 1]) < 0.1  # nor does an interval of the one before


def test_both_ways_of_drawing_have_the_same_covariance():
    factor = noise_factor(PLANT, SCENARIOS["white"])
    seeded = SeededDisturbances(factor, Arrangement((1, 100)))
    generators = [np.random.default_rng(seed) for seed in range(100)]
    seeded.begin(SomeRows(np.arange(100), ()), draw_load_cases(SCENARIOS["white"], PLANT, generators, 100), generators)
    loads = np.empty((300, 1, 100, 2))
    noise = np.empty((300, 1, 100, SENSORS))
    for k in range(300):
        seeded.loads(loads[k])
        noise[k] = seeded.next(generators)
    assert loads.std() == pytest.approx(3.0, rel=0.02)
    expected = np.sqrt(PLANT.sensor_noise[0, 0] / PLANT.control_interval)
    assert noise.std() == pytest.approx(expected, rel=0.02)


def test_a_quiet_scenario_is_silent():
    assert not noise_factor(PLANT, SCENARIOS["quiet"]).any()


def tape(seeds, instants, shape=None):
    """(instants, blades, 2 + p) of what seeded disturbances give."""
    generators = [np.random.default_rng(seed) for seed in seeds]
    shape = (1, len(seeds)) if shape is None else shape
    seeded = SeededDisturbances(noise_factor(PLANT, SCENARIOS["nominal"]), Arrangement(shape))
    cases = draw_load_cases(SCENARIOS["nominal"], PLANT, generators, len(seeds))
    noise = [seeded.begin(SomeRows(np.arange(len(seeds)), ()), cases, generators)]
    loads = []
    for _ in range(instants):
        out = np.empty((*shape, 2))
        seeded.loads(out)
        loads.append(out.reshape(-1, 2))
        noise.append(seeded.next(generators).reshape(len(seeds), -1).copy())
    return np.concatenate([loads, noise[:-1]], axis=-1)


@settings(max_examples=10)
@given(st.lists(st.integers(0, 2**32), min_size=2, max_size=6))
def test_a_seed_gives_the_same_bits_in_any_company(seeds):
    together = tape(seeds, 2 * BLOCK + 5)
    for row, seed in enumerate(seeds):
        assert np.array_equal(together[:, row], tape([seed], 2 * BLOCK + 5, shape=())[:, 0])


def test_a_seed_gives_the_same_bits_in_any_layout():
    seeds = list(range(8))
    assert np.array_equal(tape(seeds, 70, (1, 8)), tape(seeds, 70, (2, 4)))


@pytest.mark.parametrize("restart", [1, BLOCK - 1, BLOCK, BLOCK + 1, 100])
@pytest.mark.parametrize("rest", [0, 1])
def test_a_blade_that_begins_again_meets_what_it_would_meet_alone(restart, rest):
    """Whether it begins again at once or after a step of rest, and wherever in its block it was."""

    def second_episode(seeds, row):
        generators = [np.random.default_rng(seed) for seed in seeds]
        shape = (1, len(seeds))
        seeded = SeededDisturbances(noise_factor(PLANT, SCENARIOS["nominal"]), Arrangement(shape))
        cases = draw_load_cases(SCENARIOS["nominal"], PLANT, generators, len(seeds))
        seeded.begin(SomeRows(np.arange(len(seeds)), ()), cases, generators)
        for _ in range(restart):
            seeded.next(generators)
        for _ in range(rest):
            seeded.next(generators, np.array([row]))
        again = draw_load_cases(SCENARIOS["nominal"], PLANT, [generators[row]], 1)
        met = [seeded.begin(SomeRows(np.array([row]), ()), again, generators)[0].copy()]
        for _ in range(BLOCK + 3):
            out = np.empty((*shape, 2))
            seeded.loads(out)
            met.append(np.concatenate([out[0, row], seeded.next(generators)[0, row]]))
        return np.concatenate(met)

    assert np.array_equal(second_episode([3, 4, 5], 1), second_episode([4], 0))
