"""A blade whose temperature the design does not know: courses, what moves, and what patches show of their own warming."""

import numpy as np
import pytest
from scipy.stats import kstest

from beamenv import Lamina, RotatingBeamEnv, RotatingBeamVectorEnv
from beamenv.blade.config import BeamConfig, BladeConfig
from beamenv.patches.operators import charge_per_kelvin
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.simulation.plants.banks import varied, varied_blades
from beamenv.simulation.plants.walks import Warming, walk_of
from beamenv.task import resolve_task

INTERVAL = 0.5e-3
QUIET = {**dict.fromkeys(("step", "pulse", "deflection", "harmonic"), 0.0), "white_load": False, "sensor_noise": False}
RISING = {"temperature": 300.0, "temperature_change": 1.0, "drift_onset": 0.01, "drift_duration": 0.02, "bank": 3}


def test_temperatures_are_drawn_and_change_evenly_on_the_way():
    walk = walk_of(SCENARIOS["heat"].plants, INTERVAL)
    assert isinstance(walk, Warming)
    courses = walk.courses(np.random.default_rng(0).random((5000, walk.draws)))
    assert kstest(courses[:, 0], "uniform", (223.15, 150.0)).pvalue > 0.001
    assert kstest(courses[:, 1], "uniform", (-3.0, 6.0)).pvalue > 0.001
    warmed = np.array([walk.warmed(courses, np.full(5000, time)) for time in np.arange(1001.0)])
    np.testing.assert_array_equal(warmed[0], 0.0)
    np.testing.assert_array_equal(warmed[-1], courses[:, 1])
    middle = courses[:, 2] + 0.5 * courses[:, 3]
    np.testing.assert_allclose(walk.warmed(courses, middle), 0.5 * courses[:, 1], rtol=1e-12)
    rates = np.array([walk.warming(courses, np.full(5000, time))[:, 0] for time in range(1001)])
    np.testing.assert_allclose(rates.sum(axis=0), courses[:, 1], rtol=1e-9)


def test_a_blade_is_at_the_station_nearest_to_its_temperature():
    walk = walk_of(SCENARIOS["heat"].plants, INTERVAL)
    stations = walk.stations()
    assert (stations[0], stations[-1], len(stations)) == (220.15, 376.15, 33)
    courses = walk.courses(np.random.default_rng(1).random((50, walk.draws)))
    for elapsed in (0, 300, 999):
        temperatures = courses[:, 0] + walk.warmed(courses, np.full(50, elapsed + 0.5))
        nearest = np.abs(stations - temperatures[:, None]).argmin(axis=1)
        np.testing.assert_array_equal(walk.places(courses, np.full(50, elapsed)), nearest)


def test_the_plants_are_the_blade_at_the_stations_and_the_design_knows_of_none():
    task, nominal = (resolve_task(scenario={"plants": plants}) for plants in ({"temperature": [230.0, 370.0], "bank": 3}, {}))
    rows = varied(task.scenario.plants, task.config)
    np.testing.assert_array_equal(rows[:, 5], [230.0, 300.0, 370.0])
    np.testing.assert_array_equal(rows[:, :4], 1.0)
    for name in ("A", "B", "C", "sensor_full_scale"):
        np.testing.assert_array_equal(getattr(task.design_blade.plant, name), getattr(nominal.design_blade.plant, name))
    stored = np.trace(task.bank.effort_weight, axis1=1, axis2=2)
    warm = 1.0 + 4e-3 * (rows[:, 5] - 300.0)
    assert np.all(np.diff(stored / warm) > 0.0)  # as d squared, which is as permittivity, and the more the softer the walls are


def test_a_current_of_pyroelectric_charge_flows_while_the_blade_warms():
    """In the middle of the drift, and none before and after."""
    env = RotatingBeamEnv(scenario=QUIET | {"plants": RISING | {"pyroelectric": True}}, duration=0.04, dtype="float64")
    still = RotatingBeamEnv(scenario=QUIET | {"plants": RISING}, duration=0.04, dtype="float64")
    readings = [[each.reset(seed=0)[0]] for each in (env, still)]
    for shown, each in zip(readings, (env, still), strict=True):
        shown += [each.step(np.zeros(4))[0] for _ in range(79)]
    current = (np.array(readings[0]) - np.array(readings[1])) * env.task.design_blade.plant.sensor_full_scale
    np.testing.assert_allclose(current[25:55], np.tile(charges() * 1.0 / 0.02, (30, 1)), rtol=1e-9)
    np.testing.assert_allclose(current[:20], 0.0, atol=1e-12)
    np.testing.assert_allclose(current[62:], 0.0, atol=1e-12)


def charges():
    """C/K of the default blade's sensors."""
    config = BladeConfig(beam=BeamConfig(temperature=300.0))
    return charge_per_kelvin(config.beam.build(config.patches), config.patches.only("sensors"))


def test_a_charge_amplifier_shows_the_charge_gathered():
    blade = {"sensors": [{"kind": "charge", "range": 1e-4}, {"kind": "displacement", "range": 1.0}]}
    env = RotatingBeamEnv(blade=blade, scenario=QUIET | {"plants": RISING | {"pyroelectric": True}}, duration=0.04, dtype="float64")
    still = RotatingBeamEnv(blade=blade, scenario=QUIET | {"plants": RISING}, duration=0.04, dtype="float64")
    for each in (env, still):
        each.reset(seed=0)
    last = [[each.step(np.zeros(4))[0] for _ in range(79)][-1] for each in (env, still)]
    np.testing.assert_allclose((last[0] - last[1])[:4] * 1e-4, charges() * 1.0, rtol=1e-9)
    assert last[0][4] == last[1][4]


def test_a_batch_reads_what_its_blades_alone_do():
    chosen = {
        "preset": "heat",
        "plants": {
            "bank": 4,
            "drift_onset": 0.0,
            "drift_duration": 0.02,
            "temperature": 300.0,
            "temperature_change": [-90.0, 70.0],
        },
    }
    batch, alone = RotatingBeamVectorEnv(3, scenario=chosen), [RotatingBeamEnv(scenario=chosen) for _ in range(3)]
    batch.reset(seed=[3, 4, 5])
    for seed, env in zip((3, 4, 5), alone, strict=True):
        env.reset(seed=seed)
    met = set()
    for _ in range(60):
        readings, rewards, *_ = batch.step(np.zeros((3, 4)))
        each = [env.step(np.zeros(4)) for env in alone]
        np.testing.assert_array_equal(batch._blades.index, [int(env._blade.index[0]) for env in alone])
        np.testing.assert_allclose(rewards, [step[1] for step in each], rtol=1e-9)
        np.testing.assert_allclose(readings, np.stack([step[0] for step in each]), rtol=1e-5, atol=1e-7)
        met.update(batch._blades.index.tolist())
    assert len(met) > 2


def test_pyroelectricity_that_no_sensor_would_show_is_refused_in_a_sentence():
    plants = {"temperature": 300.0, "pyroelectric": True, "bank": 2}
    with pytest.raises(ValueError, match="scenario.plants.pyroelectric is True, but must be False where no currents"):
        _ = resolve_task(blade={"sensors": [{"kind": "displacement"}]}, scenario={"plants": plants}).bank


def test_a_blade_too_hot_for_its_patches_is_refused_in_a_sentence():
    with pytest.raises(
        ValueError, match=r"scenario.plants.temperature is \[300.0, 450.0\], but must be two numbers from 173.15 to 403.15 \(K\)"
    ):
        _ = resolve_task(
            blade={"beam": {"material": "aluminium"}}, scenario={"plants": {"temperature": [300.0, 450.0], "bank": 2}}
        ).bank


def test_a_change_beyond_the_data_is_refused_with_what_it_reaches():
    plants = {"temperature": 370.0, "temperature_change": [0.0, 30.0], "bank": 2}
    with pytest.raises(ValueError, match=r"scenario.plants.temperature is \[370.0, 370.0\].* with its change it reaches 400 K"):
        _ = resolve_task(scenario={"plants": plants}).bank


def test_a_material_of_unknown_expansion_is_refused_as_the_material():
    material = {"inner": Lamina.isotropic(69e9, 0.33, 2700.0), "outer": "aluminium", "exponent": 1.0}
    plants = {"temperature": 310.0, "bank": 2}
    with pytest.raises(ValueError, match="blade.beam.material.inner.alpha1 is None, but must be a number"):
        _ = resolve_task(blade={"beam": {"material": material}}, scenario={"plants": plants}).bank


def test_charge_is_asked_for_where_the_materials_have_data():
    hot = Lamina.isotropic(69e9, 0.33, 2700.0, 23e-6, curves={"E1": [(350.0, 1.0), (420.0, 0.95)]})
    plants = {"temperature": [360.0, 390.0], "bank": 2, "pyroelectric": True}
    assert resolve_task(blade={"beam": {"material": hot}}, scenario={"plants": plants}).bank.pyroelectric.any()


def test_the_plant_of_an_interval_is_that_of_its_middle():
    """10 K an interval, stations every 5 K: 5 K beyond where it begins."""
    walk = Warming((300.0, 300.0), (60.0, 60.0), (0.0, 0.0), (6.0, 6.0), 13)
    courses = walk.courses(np.zeros((6, walk.draws)))
    np.testing.assert_array_equal(walk.places(courses, np.arange(6.0)), [1, 3, 5, 7, 9, 11])


def test_a_temperature_that_is_drawn_takes_the_place_of_a_table():
    plants = {"temperature": [305.0, 315.0], "bank": 2}
    beams = ({"temperature_table": [[0.0, 300.0], [1.0, 330.0]]}, {"temperature": 340.0})
    tabled, even = (resolve_task(blade={"beam": beam}, scenario={"plants": plants}) for beam in beams)
    either = [[each.beam for each in varied_blades(task.design_blade, task.scenario.plants)] for task in (tabled, even)]
    for one, other in zip(*either, strict=True):
        np.testing.assert_array_equal(one.natural_frequencies(), other.natural_frequencies())


def test_what_a_blade_warms_is_the_mean_of_the_interval_around_a_reading():
    walk = Warming((300.0, 300.0), (4.0, 4.0), (2.0, 2.0), (4.0, 4.0), 2)
    courses = walk.courses(np.zeros((9, walk.draws)))
    rates, since = walk.warming(courses, np.arange(9.0)).T
    np.testing.assert_allclose(rates, [0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 0.5, 0.0, 0.0])
    np.testing.assert_allclose(since, [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0, 4.0])
