"""Blades that change within an episode: the course of each, and the motion on the way."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.stats import kstest

from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv
from beamenv.blade.changed import changed_blade
from beamenv.rendering.deformation import Deformation
from beamenv.scenarios.scenario import SCENARIOS, scenario
from beamenv.simulation.blades import Blades
from beamenv.simulation.plants import walks
from beamenv.simulation.plants.banks import build_bank, varied
from beamenv.simulation.plants.spin_up import Cycloid
from beamenv.simulation.plants.walks import COMPONENTS, Drift, Wander, walk_of
from beamenv.task import resolve_task

INTERVAL = 0.5e-3
QUIET = {**dict.fromkeys(("step", "pulse", "deflection", "harmonic"), 0.0), "white_load": False, "sensor_noise": False}
STATIONS = np.linspace(0.0, 2.023, 5)


def test_a_speed_that_wanders_is_stationary_of_the_deviation_and_correlation_stated():
    wander = Wander(0.05, 4.0 * INTERVAL, 128)
    courses = wander.courses(np.random.default_rng(0).random((40_000, COMPONENTS)))
    first, later = (wander.ratios(courses, np.full(len(courses), time)) for time in (0.0, 100.0))  # 50 ms apart
    frequencies = 4.0 * (np.arange(COMPONENTS) + 0.5) / COMPONENTS
    for ratios in (first, later):
        assert ratios.mean() == pytest.approx(1.0, abs=4.0 * 0.05 / 200.0)
        assert ratios.std() == pytest.approx(0.05, rel=0.02)
        assert np.abs(ratios - 1.0).max() <= 0.05 * np.sqrt(2.0 * COMPONENTS)
    expected = np.cos(2.0 * np.pi * frequencies * 0.05).mean()
    assert np.corrcoef(first, later)[0, 1] == pytest.approx(expected, abs=0.02)


def test_a_blade_is_at_the_station_nearest_to_its_speed_at_the_middle_of_each_interval():
    wander = Wander(0.05, 4.0 * INTERVAL, 128)
    courses, stations = wander.courses(np.random.default_rng(1).random((50, COMPONENTS))), wander.stations()
    for elapsed in (0, 77, 999):
        speeds = wander.ratios(courses, np.full(50, elapsed + 0.5))
        places = wander.places(courses, np.full(50, elapsed))
        np.testing.assert_array_equal(places, np.abs(stations - speeds[:, None]).argmin(axis=1))


def test_a_drift_is_still_then_even_then_still():
    drift = walk_of(SCENARIOS["drift"].plants, INTERVAL)
    assert isinstance(drift, Drift)
    uniforms = np.random.default_rng(0).random((5000, drift.draws))
    courses = drift.courses(uniforms)
    course, onset, duration = courses.T
    assert set(course) == set(range(8))
    assert kstest(onset * INTERVAL, "uniform", (0.0, 0.2)).pvalue > 0.001
    assert kstest(duration * INTERVAL, "uniform", (0.1, 0.2)).pvalue > 0.001
    places = np.array([drift.places(courses, np.full(5000, k)) for k in range(1000)]) - 16 * course.astype(int)
    steps = np.diff(places, axis=0)
    assert (steps >= 0).all() and (steps <= 1).all()
    np.testing.assert_array_equal(places[0], 0)
    np.testing.assert_array_equal(places[-1], 15)
    halfway = np.abs((np.arange(1000)[:, None] + 0.5 - onset) / duration - 0.5) < 0.02
    assert np.all((places[halfway] == 7) | (places[halfway] == 8))


def test_the_courses_of_a_drift_lead_from_the_design_to_ends_spread_over_the_ranges():
    plants, config = SCENARIOS["drift"].plants, resolve_task().config
    rows = varied(plants, config).reshape(8, 16, 5)
    np.testing.assert_array_equal(rows[:, 0, :4], 1.0)
    np.testing.assert_array_equal(rows[..., :2], 1.0)
    np.testing.assert_allclose(np.diff(rows, n=2, axis=1), 0.0, atol=1e-14)
    for k, (low, high) in ((2, (0.8, 1.0)), (3, (1.0, 1.15))):
        strata = np.floor((rows[:, -1, k] - low) / (high - low) * 8)
        assert sorted(strata) == list(range(8))
    assert not np.allclose(varied(replace(plants, seed=1), config), rows.reshape(-1, 5))  # agents train on others


@pytest.mark.parametrize("given", [{"mass_drift": 1.15, "modulus_drift": 0.8}, {"speed_wander": 0.05}])
def test_from_plant_to_plant_displacements_and_velocities_go_on(given):
    """Of the blade's first modes, seen along the span by the blades' own shapes; what the electronics hold does not change."""
    task = resolve_task(scenario={"plants": {**given, "bank": 4}})
    bank, blade = task.bank, task.blade.with_fixed_range().with_fixed_order()
    rows = varied(task.scenario.plants, blade.config)
    before, after = (blade.changed(changed_blade(blade.config, *rows[k])) for k in (1, 2))
    n, r = len(task.plant.A), task.plant.blade_states // 2
    state = np.zeros(n)
    state[:4], state[r : r + 4], state[2 * r :] = 1.0, -1.0, np.arange(n - 2 * r)
    moved = state @ bank.axes[1].T @ bank.to_common[1] @ bank.from_common[2] @ bank.axes[2]
    shown, found = before.displacement_operator(STATIONS) @ state, after.displacement_operator(STATIONS) @ moved
    np.testing.assert_allclose(found, shown, rtol=0.0, atol=2e-3 * np.abs(shown).max())
    rates = [
        each.displacement_operator(STATIONS)[..., :r] * each.true_modal.natural_frequencies @ of[r : 2 * r]
        for each, of in ((before, state), (after, moved))
    ]
    np.testing.assert_allclose(rates[1], rates[0], rtol=0.0, atol=2e-3 * np.abs(rates[0]).max())
    np.testing.assert_allclose(moved[2 * r :], state[2 * r :], rtol=1e-12)
    back = moved @ bank.axes[2].T @ bank.to_common[2] @ bank.from_common[1] @ bank.axes[1]
    np.testing.assert_allclose(back, state, rtol=0.0, atol=1e-9)


@dataclass(frozen=True)
class _Along:
    """All blades on one course of speeds, at equally spaced stations."""

    course: Cycloid
    stations: np.ndarray
    draws = 1

    def courses(self, uniforms):
        return uniforms

    def places(self, courses, elapsed):
        speed = self.course.speed((elapsed + 0.5) * INTERVAL)
        return np.abs(self.stations - speed[:, None]).argmin(axis=1)


def test_a_slow_spin_up_is_met_as_by_the_equations_of_a_spin_up():
    """Vibration of a released blade, from 190 to 210 rad/s in 0.5 s: from station to station it is within 1 % of that by the
    time-varying equations about the moving equilibrium. Damping is left out: here it is that of the speed now, there of one speed.
    """
    undamped = {"damping_ratio": 1e-5}
    wandering = resolve_task(blade=undamped, scenario=QUIET | {"plants": {"speed_wander": 0.02, "bank": 65}})
    speeds = 200.0 * Wander(0.02, 0.0, 65).stations()
    bank = replace(wandering.bank, walk=_Along(Cycloid(190.0, 210.0, 0.5), speeds))
    running = resolve_task(blade=undamped, scenario=QUIET | {"plants": {"spin_up": [190.0, 210.0]}})
    tips = []
    for moved in (bank, running.bank):
        blades, generator = Blades(moved, wandering.scenario, 1), np.random.default_rng(0)
        first = 0 if moved is running.bank else int(np.abs(speeds - 190.0).argmin())
        blades.begin(generator, initial_state=30.0 * moved.release[first, 1] @ moved.axes[first])
        tips.append(np.array([blades.step(np.zeros((1, 4)), generator).tip_displacement[0] for _ in range(1000)]))
    np.testing.assert_allclose(tips[0], tips[1], rtol=0.0, atol=0.01 * np.abs(tips[1]).max())
    still = RotatingBeamEnv(blade=undamped, scenario=QUIET, speed=190.0)
    still.reset(seed=0, options={"load": {"case": "deflection", "magnitude": 30.0, "direction_deg": 90.0}})
    constant = np.array([still.step(np.zeros(4))[4]["tip_displacement"] for _ in range(1000)])
    assert np.abs(constant - tips[1]).max() > 0.2 * np.abs(tips[1]).max()  # that the speed changes matters


@pytest.mark.slow
@pytest.mark.parametrize(("name", "stations"), [("gust-speed", 255), ("drift", 31), ("heat", 65)])
def test_twice_as_many_stations_change_the_cost_of_an_episode_by_less_than_a_hundredth(name, stations, monkeypatch):
    few = replace(SCENARIOS[name].plants, bank={"gust-speed": 128, "drift": 16, "heat": 33}[name])
    costs = []
    for bank in (few.bank, stations):
        monkeypatch.setattr(walks, "STATIONS", 16 if bank == 16 else 31)
        task = resolve_task(scenario={"preset": name, "plants": {"bank": bank}})
        banked = build_bank(task.blade, task.design_blade, replace(few, bank=bank), task.steps)
        blades, generator = Blades(banked, task.scenario, 8), np.random.default_rng(5)
        blades.begin(generator)
        costs.append(sum(blades.step(np.zeros((8, 4)), generator).cost_increment for _ in range(task.steps)))
    np.testing.assert_allclose(costs[0], costs[1], rtol=0.02)
    assert costs[0].mean() == pytest.approx(costs[1].mean(), rel=0.01)


def test_a_batch_is_at_the_stations_of_its_blades_alone():
    chosen = {"plants": {"speed_wander": 0.05, "wander_frequency": 20.0, "bank": 16}}
    batch, alone = RotatingBeamVectorEnv(4, scenario=chosen), [RotatingBeamEnv(scenario=chosen) for _ in range(4)]
    batch.reset(seed=[3, 4, 5, 6])
    for seed, env in zip((3, 4, 5, 6), alone, strict=True):
        env.reset(seed=seed)
    met = set()
    for _ in range(300):
        _, rewards, *_ = batch.step(np.zeros((4, 4)))
        expected = [env.step(np.zeros(4))[1] for env in alone]
        np.testing.assert_array_equal(batch._blades.index, [int(env._blade.index[0]) for env in alone])
        np.testing.assert_allclose(rewards, expected, rtol=1e-9)
        met.update(batch._blades.index.tolist())
    assert len(met) > 8


def test_pictures_follow_the_plant_that_moves():
    """What is drawn is the tip displacement that info tells, whichever station the blade has come to."""
    env = RotatingBeamEnv(scenario={"plants": {"mass_drift": 1.3, "drift_duration": 0.02, "bank": 8}}, duration=0.03)
    env.reset(seed=0, options={"load": {"case": "deflection", "magnitude": 30.0, "direction_deg": 60.0}})
    drawn, places = Deformation(env.task, np.array([env.task.config.beam.length])), set()
    for _ in range(50):
        *_, info = env.step(np.zeros(4))
        place = int(env._blade.index[0])
        places.add(place)
        lag, flap, _ = drawn.displacement(env.state, place)[:, 0]
        np.testing.assert_allclose([lag, flap], info["tip_displacement"], rtol=0.0, atol=1e-8)
    assert len(places) == 8


def test_no_tachometer_follows_a_speed_that_wanders():
    env = RotatingBeamEnv(scenario={"plants": {"speed_wander": 0.1, "wander_frequency": 20.0, "bank": 16}}, duration=0.05)
    env.reset(seed=0)
    places = set()
    for _ in range(99):
        env.step(np.zeros(4))
        places.add(int(env._blade.index[0]))
        assert env.rotor_speed == 200.0
    assert len(places) > 3


@pytest.mark.parametrize(
    ("plants", "sentence"),
    [
        ({"speed_wander": 0.2}, "scenario.plants.speed_wander is 0.2, but must be a number from 0 to 0.1"),
        ({"speed_wander": 0.1, "mass_drift": 1.1}, "scenario.plants.speed_wander is 0.1, but must be 0 where other plants"),
        ({"speed_wander": 0.1, "damping_ratio": 0.1}, "scenario.plants.speed_wander is 0.1, but must be 0 where other plants"),
        ({"mass_drift": 1.1, "mass_ratio": 1.1}, r"scenario.plants.mass_drift is \[1.1, 1.1\], but must be 1 where other plants"),
        ({"modulus_drift": 1.1, "bank": 1}, "scenario.plants.bank is 1, but must be at least 2 where the blade changes"),
        ({"mass_drift": 1.1, "spin_up": [190.0, 200.0]}, "scenario.plants.spin_up is .* but must be None where other plants"),
        ({"speed_wander": 0.1, "truth": "solid-blade"}, "scenario.plants.truth is .* but must be None where other plants"),
        ({"temperature": 300.0, "mass_drift": 1.1}, "scenario.plants.temperature is .* but must be None where other plants"),
        ({"temperature": 300.0, "bank": 1}, "scenario.plants.bank is 1, but must be at least 2"),
        ({"temperature_change": 3.0}, "scenario.plants.temperature_change is .* but must be 0 where no temperature is drawn"),
        ({"pyroelectric": True}, "scenario.plants.pyroelectric is True, but must be False where no temperature is drawn"),
        ({"temperature": 300.0, "truth": "solid-blade"}, "scenario.plants.truth is .* but must be None where other plants"),
        ({"drift_onset": -1.0}, "scenario.plants.drift_onset is -1.0, but must be a number or a range"),
    ],
)
def test_what_cannot_change_together_is_refused_in_one_sentence(plants, sentence):
    with pytest.raises(ValueError, match=sentence):
        scenario({"plants": plants})
