"""Loads of one's own: where they act is what handbooks say of a cantilever, and their course is what was asked for."""

import copy
import pickle
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest
from scipy.signal import welch

import beamenv
from beamenv.blade import Blade, blade_config
from beamenv.blade.load_shapes import LoadShape
from beamenv.scenarios.own_loads import Load
from beamenv.scenarios.scenario import load_scenario
from beamenv.scenarios.series import interval_means
from beamenv.simulation.signals.own_loads import noise_of
from beamenv.task import resolve_task

LENGTH, WIDTH, THICKNESS, E, DENSITY = 0.3, 0.03, 0.002, 68.9e9, 2700.0
STIFFNESS = E * WIDTH * THICKNESS**3 / 12.0
INTERVAL = 0.5e-3
PATCHES = blade_config("aluminium-cantilever").patches
BARE = replace(
    blade_config("aluminium-cantilever"),
    patches=replace(
        PATCHES,
        actuators=tuple(replace(group, passive=False) for group in PATCHES.actuators),
        sensors=tuple(replace(group, passive=False) for group in PATCHES.sensors),
    ),
    truth_modes=40,
)


def under(*shapes, **changes):
    return Blade(replace(BARE, loads=tuple(LoadShape(**shape) for shape in shapes), **changes)).truth


def tip(plant):
    """(2, k), m: static, per unit of each disturbance."""
    return plant.tip_displacement @ np.linalg.solve(-plant.A, plant.disturbance_input)


def make(*loads, preset="quiet", **arguments):
    chosen = {"preset": preset, "loads": list(loads)}
    return gym.make(beamenv.ENV_ID, preset="aluminium-cantilever", scenario=chosen, dtype="float64", **arguments)


def acting(env, steps=200, seed=0):
    """(steps, loads)."""
    env.reset(seed=seed)
    found = []
    for _ in range(steps):
        found.append(env.unwrapped._blade.coming_loads[2:].copy())
        env.step(np.zeros(1))
    return np.array(found)


def test_a_force_bends_a_cantilever_as_handbooks_say():
    """F a² (3L − a)/6EI at the tip."""
    plant = under({"position": 0.2}, {})
    for k, a in ((2, 0.2), (3, LENGTH)):
        wanted = a**2 * (3.0 * LENGTH - a) / (6.0 * STIFFNESS)
        assert tip(plant)[1, k] == pytest.approx(wanted, rel=0.025)  # the clamp keeps the strip flat across


def test_a_line_load_over_all_the_span_is_the_uniform_one():
    whole = {}, {"direction": [2.0, 0.0, 0.0]}
    differing = *whole, {"profile": [1.0, 0.0]}, {"profile": [0.0, 1.0]}, {"span": [0.0, 0.1]}, {"span": [0.1, 0.3]}
    plant = under(*({"shape": "line", **each} for each in differing))
    lag, flap, all_over, edgewise, falling, rising, inner, outer = plant.disturbance_input.T
    scale = np.abs(flap).max()
    for one, other in ((all_over, flap), (edgewise, lag), (falling + rising, flap), (inner + outer, flap)):
        np.testing.assert_allclose(one, other, atol=1e-9 * scale)
    assert [each.unit for each in plant.disturbances] == ["N/m"] * 8
    assert plant.loads == 2
    assert np.array_equal(plant.process_noise[2:], np.zeros((6, 8)))


def test_a_force_beside_the_axis_twists_and_bends():
    plant = under({"position": 0.2, "point": [0.01, 0.0]}, {"position": 0.2, "point": [-0.01, 0.0]}, {"position": 0.2})
    right, left, middle = plant.disturbance_input[:, 2:].T
    np.testing.assert_allclose(0.5 * (right + left), middle, atol=1e-9 * np.abs(middle).max())
    assert np.abs(right - left).max() > 0.01 * np.abs(middle).max()


def test_an_accelerated_base_loads_a_strip_by_its_mass():
    plant = under({"shape": "base"})
    lag, flap, base = plant.disturbance_input.T
    np.testing.assert_allclose(base, -DENSITY * WIDTH * THICKNESS * flap, rtol=1e-6, atol=1e-9 * np.abs(base).max())


def test_an_accelerometer_feels_the_base_and_a_vibrometer_the_blade_against_it():
    config = blade_config("aluminium-cantilever", {"sensors": [{"kind": "accelerometer"}, {"kind": "velocity"}]})
    plant = Blade(replace(config, loads=(LoadShape(shape="base"),))).truth
    slowly = plant.C @ np.linalg.solve(-plant.A, plant.disturbance_input[:, 2])
    assert slowly == pytest.approx([1.0, 0.0], abs=1e-9)


def test_what_is_left_to_the_blade_goes_by_its_reference_load():
    task = resolve_task(
        "aluminium-cantilever", scenario={"loads": [{}, {"shape": "line", "course": "harmonic"}, {"shape": "base"}]}
    )
    point, line, base = (load.magnitude[0] for load in task.scenario.loads)
    reference = task.blade.reference_load
    assert point == pytest.approx(0.375 * reference * LENGTH)
    assert line == pytest.approx(0.1 * reference)
    sheets = 2.0 * 7800.0 * 0.05 * 0.025 * 0.5e-3
    assert base == pytest.approx(reference * LENGTH / (DENSITY * WIDTH * THICKNESS * LENGTH + sheets), rel=1e-3)


def test_steps_pulses_and_sines_are_what_was_asked_for():
    found = acting(make(
        {"magnitude": 2.0, "onset": 0.01},
        {"course": "pulse", "magnitude": -1.0, "onset": 0.005, "duration": 0.002},
        {"course": "harmonic", "magnitude": 3.0, "frequency": 25.0, "phase_deg": 90.0},
    ))  # fmt: skip
    k = np.arange(200)
    assert np.array_equal(found[:, 0], 2.0 * (k >= 20))
    assert np.array_equal(found[:, 1], -1.0 * ((k >= 10) & (k < 14)))
    np.testing.assert_allclose(found[:, 2], 3.0 * np.cos(2.0 * np.pi * 25.0 * (k + 0.5) * INTERVAL), atol=1e-12)


def test_a_function_is_taken_at_the_middle_of_each_interval_one_by_one_or_at_once():
    whole = acting(make({"course": "function", "function": lambda t: np.sin(60.0 * t), "onset": 0.01}))[:, 0]
    single = acting(make({"course": "function", "function": lambda t: float(np.sin(60.0 * float(t))), "onset": 0.01}))[:, 0]
    past = np.arange(200) - 20
    np.testing.assert_allclose(whole, np.where(past < 0, 0.0, np.sin(60.0 * (past + 0.5) * INTERVAL)), atol=1e-15)
    np.testing.assert_allclose(whole, single, atol=1e-15)


def test_a_measured_series_keeps_its_impulse_at_any_rate():
    for rate in (300.0, 2000.0, 51_200.0):
        samples = tuple(np.random.default_rng(0).normal(size=400).tolist())
        means = interval_means(samples, rate, INTERVAL)
        assert means.sum() * INTERVAL == pytest.approx(np.trapezoid(samples, dx=1.0 / rate), rel=1e-9)
    ramp = interval_means(tuple(np.linspace(0.0, 1.0, 11).tolist()), 100.0, INTERVAL)  # 0 to 1 in 0.1 s
    np.testing.assert_allclose(ramp, (np.arange(200) + 0.5) / 200.0, atol=1e-12)


def test_a_scenario_file_names_a_series_that_lies_beside_it(tmp_path):
    (tmp_path / "gust.csv").write_text("force in N\n0.0\n1.0\n0.5\n0.0\n", encoding="utf-8")
    table = '[[loads]]\nshape = "line"\ncourse = "series"\nseries = "gust.csv"\nrate = 100.0\nmagnitude = 2.0\n'
    (tmp_path / "gusty.toml").write_text('preset = "quiet"\n' + table, encoding="utf-8")
    env = gym.make(beamenv.ENV_ID, preset="aluminium-cantilever", scenario=str(tmp_path / "gusty.toml"))
    found = acting(env, 80)[:, 0]
    assert found.sum() * INTERVAL == pytest.approx(2.0 * 0.01 * 1.5)
    assert np.array_equal(found[60:], np.zeros(20))
    assert load_scenario(tmp_path / "gusty.toml").loads[0].rate == 100.0


@pytest.mark.parametrize(
    ("load", "density"),
    [
        (Load(course="noise", cutoff=60.0), lambda f: 2.0 / (np.pi * 60.0) / (1.0 + (f / 60.0) ** 2)),
        (
            Load(course="noise", cutoff=80.0, order=2, damping=0.3),
            lambda f: 4.0 * 0.3 / (np.pi * 80.0) / ((1.0 - (f / 80.0) ** 2) ** 2 + (0.6 * f / 80.0) ** 2),
        ),
        (Load(course="noise", spectrum=((0.0, 1e-3), (200.0, 3e-3))), lambda f: np.where(f < 200.0, 1e-3 + 1e-5 * f, 0.0)),
    ],
)
def test_noise_has_the_spectrum_that_is_stated(load, density):
    power = 0.0
    for seed in range(8):
        noise = noise_of(load, INTERVAL, seed)
        values = np.array([noise.at(k) for k in range(2**14)])
        frequencies, own = welch(values, 1.0 / INTERVAL, nperseg=512)
        power = power + own / 8.0
    band = (frequencies > 8.0) & (frequencies < 180.0)  # far below the Nyquist frequency, where sampling folds little
    assert power[band] == pytest.approx(density(frequencies[band]), rel=0.3)
    assert power[band].mean() == pytest.approx(density(frequencies[band]).mean(), rel=0.05)


def test_the_same_seed_has_the_same_loads_alone_and_in_a_batch():
    loads = (
        {"course": "noise", "magnitude": 1.0, "cutoff": 30.0},
        {"magnitude": [1.0, 2.0], "onset": [0.0, 0.05], "shape": "base"},
    )
    single = acting(make(*loads, preset="nominal"), seed=4)
    assert np.array_equal(single, acting(make(*loads, preset="nominal"), seed=4))
    assert not np.array_equal(single, acting(make(*loads, preset="nominal"), seed=5))
    chosen = {"loads": list(loads)}
    envs = gym.make_vec(beamenv.ENV_ID, 2, preset="aluminium-cantilever", scenario=chosen)
    envs.reset(seed=[3, 4])
    together = []
    for _ in range(200):
        together.append(envs.unwrapped.coming_loads[1, 2:].copy())
        envs.step(np.zeros((2, 1), dtype=np.float32))
    assert np.array_equal(single, together)


def test_a_copied_environment_goes_on_alike():
    env = make({"course": "noise", "cutoff": 30.0}, {"shape": "line"}, preset="nominal")
    acting(env, 1100)
    for other in (copy.deepcopy(env), pickle.loads(pickle.dumps(env))):
        assert np.array_equal(env.unwrapped._blade.coming_loads, other.unwrapped._blade.coming_loads)
        assert np.array_equal(copy.deepcopy(env).step(np.ones(1))[0], other.step(np.ones(1))[0])


def test_controllers_see_the_disturbances_that_they_had():
    task = resolve_task("aluminium-cantilever", scenario={"loads": [{}]})
    assert task.design_plant.disturbance_input.shape[1] == 2
    assert task.plant.disturbance_input.shape[1] == 3
    varied = resolve_task("aluminium-cantilever", scenario={"loads": [{}], "plants": {"modulus_ratio": [0.9, 1.1], "bank": 3}})
    assert varied.bank.plant.disturbance_input.shape[1] == 3


@pytest.mark.parametrize(
    ("load", "sentence"),
    [
        ({"shape": "moment"}, r"scenario.loads\[0\].shape is 'moment', but must be one of point, line, base"),
        ({"position": 0.31}, r"scenario.loads\[0\].position is 0.31"),
        ({"shape": "line", "span": [0.2, 0.4]}, r"scenario.loads\[0\].span is"),
        ({"shape": "line", "span": [0.2, 0.2]}, r"scenario.loads\[0\].span is"),
        ({"direction": [0, 0, 0]}, r"scenario.loads\[0\].direction is"),
        ({"course": "series"}, "series is None"),
        ({"course": "series", "series": [0, 1]}, "rate is None"),
        ({"series": [0, 1], "rate": 10.0}, "series is 'given'"),
        ({"course": "series", "series": [0, float("nan")], "rate": 10.0}, "series"),
        ({"course": "series", "series": "nowhere.csv", "rate": 10.0}, "series is 'nowhere.csv', but must be a .csv file"),
        ({"course": "function"}, "function is None"),
        ({"course": "noise", "spectrum": [[10, 1], [5, 1]]}, "spectrum is"),
        ({"magnitude": [2.0, 1.0]}, "magnitude is"),
        ({"shape": "line", "profile": [1.0, 1e200]}, "profile"),
        ({"point": [1e200, 0.0]}, "point"),
        ({"course": "series", "series": [0, 1e200], "rate": 10.0}, "series"),
        ({"course": "noise", "spectrum": [[5, 1e200], [10, 1]]}, "spectrum is"),
        ({"course": "noise", "spectrum": [[5, 1], [10, 1]], "cutoff": 20.0}, "cutoff is 20.0, but must be left out where spectrum"),
        ({"course": "noise", "spectrum": [[5, 1], [10, 1]], "order": 2}, "order is 2, but must be left out where spectrum is"),
        ({"course": "noise", "damping": 0.1}, "damping is 0.1, but must be left out where order is 1"),
        ({"course": "noise", "onset": 0.1}, "onset is .*, but must be left out where course is 'noise'"),
        ({"cutoff": 20.0}, r"loads\[0\].cutoff is 20.0, but must be left out where course is 'step'"),
        ({"course": "harmonic", "duration": 0.1}, "duration is .*, but must be left out where course is 'harmonic'"),
        ({"course": "pulse", "frequency": 5.0}, "frequency is .*, but must be left out where course is 'pulse'"),
        ({"shape": "base", "position": 0.1}, "position is 0.1, but must be left out where shape is 'base'"),
        ({"shape": "point", "span": [0.1, 0.2]}, "span is .*, but must be left out where shape is 'point'"),
        ({"shape": "base", "point": [0.01, 0.0]}, "point is .*, but must be left out where shape is 'base'"),
    ],
)  # fmt: skip
def test_loads_that_cannot_be_are_refused_in_one_sentence(load, sentence):
    with pytest.raises(ValueError, match=sentence):
        make(load).reset()


def test_a_line_of_a_file_that_is_no_number_is_named(tmp_path):
    (tmp_path / "gap.csv").write_text("0.0\n1.0\n\n0.5\n", encoding="utf-8")
    load = {"course": "series", "series": str(tmp_path / "gap.csv"), "rate": 100.0}
    with pytest.raises(ValueError, match=r"series is '', but must be a number of at most 1e\+09 in each line; line 3 of"):
        make(load)


def test_a_function_is_named_where_a_specification_is_to_be_written():
    env = make({}, {"course": "function", "function": np.cos})
    with pytest.raises(ValueError, match=r"scenario.loads\[1\].function is a function, which no JSON can hold"):
        env.spec.to_json()
    assert gym.make(env.spec).unwrapped.task.scenario == env.unwrapped.task.scenario
    assert gym.envs.registration.EnvSpec.from_json(make({}).spec.to_json()).kwargs == make({}).spec.kwargs


def test_a_function_that_gives_no_number_is_named():
    env = make({"course": "function", "function": lambda t: None})
    env.reset()
    with pytest.raises(ValueError, match=r"scenario.loads: function\(0.00025\) is None, but must be a finite number"):
        env.step(np.zeros(1))


def test_a_function_that_takes_no_time_is_named():
    env = make({"course": "function", "function": lambda: 1.0})
    env.reset()
    with pytest.raises(ValueError, match=r"scenario.loads: function\(0.00025\) cannot be called: .* takes 0 positional arguments"):
        env.step(np.zeros(1))


def test_a_force_on_a_blade_of_the_thesis_model_acts_at_rest_and_in_a_spin_up():
    """At the tip, F L³/3EI by 8 over 3 the displacement under the line load F/L."""
    force = {"magnitude": 1.0}
    for scenario in ({}, {"plants": {"spin_up": [0.0, 1.0]}}):
        task = resolve_task(speed=0.0, blade={"model": "thesis"}, scenario={**scenario, "loads": [force]}, duration=0.01)
        release, shown = task.bank.release[0], task.bank.tip[0]
        assert (release @ shown)[2, 1] == pytest.approx(8.0 / 3.0 / 2.023 * (release @ shown)[1, 1], rel=0.05)


@pytest.mark.parametrize("scenario", [{}, {"loads": [{"position": 0.1}]}])
def test_places_without_a_size_are_refused(scenario):
    with pytest.raises(ValueError, match="blade.loads is .*, but must be left out, or the places of the scenario's loads"):
        resolve_task("aluminium-cantilever", blade={"loads": [{"position": 0.2}]}, scenario=scenario)
    again = resolve_task("aluminium-cantilever", scenario={"loads": [{"position": 0.1}]})
    assert resolve_task(blade=again.config, scenario={"loads": [{"position": 0.1}]}).config == again.config
