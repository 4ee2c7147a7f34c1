"""Load cases over time, and the scenarios they are drawn from."""

import json
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beamenv import RotatingBeamEnv
from beamenv.arrays import SomeRows
from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.scenarios.drawing import draw_load_cases
from beamenv.scenarios.load_cases import CASES, NEVER, LoadCases, static_deflection
from beamenv.scenarios.scenario import SCENARIOS, Scenario, scenario, with_load

PLANT = build_plant(blade_config())


def drawn(chosen, count=1, seed=0):
    return draw_load_cases(scenario(chosen), PLANT, np.random.default_rng(seed), count)


def one(**load):
    return draw_load_cases(with_load(SCENARIOS["nominal"], load), PLANT, np.random.default_rng(0), 1)


def test_a_step_sets_in_and_stays():
    case = one(case="step", magnitude=30.0, direction_deg=90.0, onset=0.01)
    assert np.array_equal(case.at(19), [[0.0, 0.0]])
    np.testing.assert_allclose(case.at(20), [[0.0, 30.0]], atol=1e-14)
    np.testing.assert_allclose(case.at(10**9), [[0.0, 30.0]], atol=1e-14)


def test_a_pulse_ends_after_its_duration():
    case = one(case="pulse", magnitude=10.0, direction_deg=0.0, onset=0.005, duration=0.02)
    acts = [bool(case.at(k).any()) for k in range(60)]
    assert acts == [10 <= k < 50 for k in range(60)]


def test_a_pulse_lasts_at_least_one_interval():
    case = one(case="pulse", duration=0.0)
    assert case.end[0] - case.onset[0] == 1


def test_a_harmonic_load_is_a_sine_of_the_given_frequency():
    case = one(case="harmonic", magnitude=2.0, direction_deg=0.0, onset=0.0, frequency_ratio=1.0, phase_deg=0.0)
    time = PLANT.control_interval * np.arange(200)
    expected = 2.0 * np.sin(PLANT.natural_frequencies[0] * time)
    np.testing.assert_allclose([case.at(k)[0, 0] for k in range(200)], expected, atol=1e-12)


def test_a_released_deflection_is_static_under_its_load_and_nothing_acts_after():
    case = one(case="deflection", magnitude=30.0, direction_deg=90.0)
    np.testing.assert_allclose(case.deflection, [[0.0, 30.0]], atol=1e-14)
    assert not case.at(np.arange(100)[:, None]).any()
    state = static_deflection(PLANT, case.deflection[0])
    np.testing.assert_allclose(PLANT.A @ state + PLANT.disturbance_input @ case.deflection[0], 0.0, atol=1e-9)
    assert np.abs(state[11:]).max() < 1e-9 * np.abs(state).max()  # at rest


def test_no_load_case_is_no_load():
    case = one(case="none")
    assert not case.at(np.arange(100)[:, None]).any()
    assert not case.deflection.any()


def test_blades_at_different_instants_are_evaluated_together():
    cases = drawn("nominal", count=50)
    steps = np.arange(50) * 7
    together = cases.at(steps)
    alone = [cases.at(int(step))[row] for row, step in enumerate(steps)]
    np.testing.assert_array_equal(together, alone)
    tape = cases.at(steps + np.arange(9)[:, None])
    np.testing.assert_array_equal(tape[4], cases.at(steps + 4))


def test_load_cases_are_frozen():
    cases = drawn("nominal", count=3)
    with pytest.raises(ValueError, match="read-only"):
        cases.amplitude[0] = 1.0


def test_some_blades_get_other_load_cases():
    cases, others = drawn("nominal", count=6, seed=1), drawn("nominal", count=2, seed=2)
    exchanged = cases.replace(SomeRows(np.array([1, 4]), ()), others)
    steps = np.arange(300)[:, None]
    np.testing.assert_array_equal(exchanged.at(steps)[:, [1, 4]], others.at(steps))
    np.testing.assert_array_equal(exchanged.at(steps)[:, [0, 2, 3, 5]], cases.at(steps)[:, [0, 2, 3, 5]])
    for each in fields(LoadCases):
        if each.init:
            np.testing.assert_array_equal(getattr(cases.rows(np.array([4, 1])), each.name), getattr(cases, each.name)[[4, 1]])


def test_default_scenario_draws_the_four_cases_equally_often():
    counts = np.bincount(drawn("nominal", count=40_000).case, minlength=5) / 40_000
    np.testing.assert_allclose(counts, [0.25, 0.25, 0.25, 0.25, 0.0], atol=0.01)


@pytest.mark.parametrize("case", CASES[:-1])
def test_a_scenario_named_after_a_case_draws_it_alone(case):
    assert set(drawn(case, count=200).case.tolist()) == {CASES.index(case)}


def test_shares_that_add_up_to_one_leave_none_without_a_load():
    thirds = {"step": 0.1, "pulse": 0.2, "deflection": 0.3, "harmonic": 0.4}
    highest = np.nextafter(1.0, 0.0)

    class Highest(np.random.Generator):
        def random(self, size):
            return np.full(size, highest)

    cases = draw_load_cases(scenario(thirds), PLANT, Highest(np.random.PCG64()), 1)
    assert cases.case[0] == CASES.index("harmonic")


def test_white_and_quiet_have_no_load_case():
    for name in ("white", "quiet"):
        assert set(drawn(name, count=50).case.tolist()) == {CASES.index("none")}
    assert SCENARIOS["white"].white_load
    assert SCENARIOS["white"].sensor_noise
    assert not SCENARIOS["quiet"].white_load
    assert not SCENARIOS["quiet"].sensor_noise


ranges = st.tuples(st.floats(0.0, 100.0), st.floats(0.0, 100.0)).map(sorted).map(tuple)
scenarios = st.builds(
    Scenario,
    step=st.floats(0.0, 0.25),
    pulse=st.floats(0.0, 0.25),
    deflection=st.floats(0.0, 0.25),
    harmonic=st.floats(0.0, 0.25),
    magnitude=ranges,
    harmonic_magnitude=ranges,
    direction_deg=ranges,
    onset=ranges,
    duration=ranges,
    frequency_ratio=ranges,
    phase_deg=ranges,
    white_load=st.booleans(),
    sensor_noise=st.booleans(),
)


@given(scenarios)
def test_scenarios_round_trip_through_json(chosen):
    assert scenario(json.loads(json.dumps(chosen.to_dict()))) == chosen


@given(scenarios, st.integers(0, 2**32))
def test_loads_keep_within_the_ranges_of_their_scenario(chosen, seed):
    cases = draw_load_cases(chosen, PLANT, np.random.default_rng(seed), 20)
    size = np.linalg.norm(cases.amplitude + cases.deflection, axis=1)
    harmonic, none = cases.case == CASES.index("harmonic"), cases.case == CASES.index("none")
    low, high = np.where(harmonic, *np.array([chosen.harmonic_magnitude, chosen.magnitude])[:, :, None])
    assert np.all((size >= low - 1e-9) & (size <= high + 1e-9) | none & (size == 0.0))
    steps = np.arange(0, 3000, 100)[:, None]
    assert np.all(np.linalg.norm(cases.at(steps), axis=-1) <= size + 1e-9)
    onset = cases.onset * PLANT.control_interval
    assert np.all((onset >= chosen.onset[0] - 3e-4) & (onset <= chosen.onset[1] + 3e-4))
    lasting = (cases.end - cases.onset)[cases.end != NEVER] * PLANT.control_interval
    assert np.all(lasting <= max(chosen.duration[1], PLANT.control_interval) + 3e-4)


@given(st.lists(st.integers(0, 2**32), min_size=1, max_size=8))
def test_a_blade_with_its_own_generator_draws_the_same_in_any_company(seeds):
    together = draw_load_cases(SCENARIOS["nominal"], PLANT, [np.random.default_rng(seed) for seed in seeds], len(seeds))
    for row, seed in enumerate(seeds):
        alone = draw_load_cases(SCENARIOS["nominal"], PLANT, [np.random.default_rng(seed)], 1)
        steps = np.arange(200)[:, None]
        np.testing.assert_array_equal(together.rows(np.array([row])).at(steps), alone.at(steps))
        np.testing.assert_array_equal(together.deflection[row], alone.deflection[0])


def test_a_fixed_magnitude_leaves_the_other_draws_as_they_were():
    free = drawn("pulse", count=20, seed=3)
    fixed = draw_load_cases(with_load(SCENARIOS["pulse"], {"magnitude": 1.0}), PLANT, np.random.default_rng(3), 20)
    np.testing.assert_array_equal(free.onset, fixed.onset)
    np.testing.assert_array_equal(free.end, fixed.end)
    np.testing.assert_allclose(np.linalg.norm(fixed.amplitude, axis=1), 1.0)


@pytest.mark.parametrize(
    ("given_scenario", "sentence"),
    [
        ("storm", "scenario is 'storm', but must be one of nominal, step"),
        (3, "scenario is 3, but must be a name, .* a dictionary of fields or a Scenario"),
        ({"preset": "storm"}, "scenario.preset is 'storm'"),
        ({"gust": 1.0}, "scenario has no field 'gust'"),
        ({"step": 1.5}, "scenario.step is 1.5, but must be a number from 0 to 1"),
        ({"step": 0.9}, "shares is .*, but must be .* that do not add up to more than 1"),
        ({"magnitude": (3.0, 1.0)}, r"scenario.magnitude is \(3.0, 1.0\), but must be a number or a range"),
        ({"magnitude": -1.0}, "number or a range .* from 0 to 1e[+]06"),
        ({"magnitude": "much"}, "scenario.magnitude is 'much'"),
        ({"onset": [0.0, float("inf")]}, "scenario.onset is"),
        ({"direction_deg": [1.0, 2.0, 3.0]}, "scenario.direction_deg is"),
        ({"white_load": 1}, "scenario.white_load is 1, but must be True or False"),
    ],
)
def test_a_bad_scenario_gets_one_clear_sentence(given_scenario, sentence):
    with pytest.raises(ValueError, match=sentence):
        scenario(given_scenario)


@pytest.mark.parametrize("onset", [1e10, 1e20, 1e300])
def test_a_load_that_sets_in_later_than_any_episode_never_acts(onset):
    cases = one(case="step", onset=onset)
    assert not cases.at(0).any()
    assert not cases.at(10**9).any()
    lasting = one(case="pulse", onset=0.0, duration=onset)
    assert (np.linalg.norm(lasting.at(10**9), axis=1) > 1.0).all()


NYQUIST = np.pi / PLANT.control_interval / PLANT.natural_frequencies[0]


def test_a_harmonic_load_up_to_the_nyquist_frequency_acts_as_asked():
    env = RotatingBeamEnv()
    env.reset(seed=0, options={"load": {"case": "harmonic", "frequency_ratio": 0.999 * NYQUIST}})
    cases = one(case="harmonic", frequency_ratio=0.999 * NYQUIST)
    assert cases.rate == pytest.approx(0.999 * np.pi)


@pytest.mark.parametrize("ratio", [1.001 * NYQUIST, 100.0, 1e20, [0.5, 40.0]])
def test_a_harmonic_load_beyond_the_nyquist_frequency_is_refused(ratio):
    with pytest.raises(ValueError, match=r"^scenario.frequency_ratio is .*, but must be at most 33[.]6.*, the Nyquist frequency"):
        RotatingBeamEnv(scenario={"preset": "harmonic", "frequency_ratio": ratio})
    with pytest.raises(ValueError, match=r"^options.load.frequency_ratio is .*, but must be at most 33[.]6"):
        RotatingBeamEnv().reset(seed=0, options={"load": {"case": "harmonic", "frequency_ratio": ratio}})


def test_the_default_range_is_drawn_at_the_nyquist_frequency_where_it_lies_beyond():
    env = RotatingBeamEnv(scenario="harmonic", blade={"control_interval": 0.1})
    env.reset(seed=0)
    plant = build_plant(blade_config(overrides={"control_interval": 0.1}))
    assert draw_load_cases(SCENARIOS["harmonic"], plant, np.random.default_rng(0), 5).rate == pytest.approx(np.pi)


def test_a_harmonic_of_the_rotor_beyond_the_nyquist_frequency_is_refused():
    """At 200 rad/s the 31st is at 6200, the 32nd at 6400 rad/s; the clock shows up to 6283."""
    RotatingBeamEnv(scenario={"rotor": {"harmonics": [1.0] * 31}})
    with pytest.raises(
        ValueError, match="^scenario.rotor.harmonics is .*, but must be amplitudes of the first 31 at most, at 200 rad/s"
    ):
        RotatingBeamEnv(scenario={"rotor": {"harmonics": [1.0] * 32}})
    with pytest.raises(ValueError, match="amplitudes of the first 20 at most, at 300 rad/s"):
        RotatingBeamEnv(scenario={"preset": "spin-up", "rotor": {"harmonics": [1.0] * 31}})
