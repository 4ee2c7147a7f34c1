"""Scenarios as TOML files, as dictionaries and as environment ids."""

import builtins
import sys
import time
import types
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.utils.env_checker import check_env

import beamenv
from beamenv import BENCHMARK_SCENARIOS, OPEN_SCENARIOS, UNSEEN_SCENARIOS, RotatingBeamEnv
from beamenv.configuration import files
from beamenv.scenarios.named import GROUPS, LOADS, NAMES, expanded, titles
from beamenv.scenarios.scenario import SCENARIOS, Scenario, load_scenario, scenario

GUST = """
preset = "rotor"
pulse = 1.0
deflection = 0.0

[plants]
speed_ratio = [0.9, 1.1]
bank = 3

[rotor]
turbulence = 8.0
"""


def test_the_benchmark_has_twelve_scenarios():
    assert BENCHMARK_SCENARIOS == (
        "delay", "failure", "hysteresis", "nominal", "off-model", "off-speed", "overload", "rotor", "solid", "solid-20",
        "spillover", "spin-up",
    )  # fmt: skip


def test_the_nominal_scenario_is_that_of_every_default_and_has_its_former_name_too():
    former = scenario("default"), scenario({"preset": "default"})
    assert {scenario(None), scenario({}), scenario("nominal"), *former} == {Scenario()}
    assert "default" not in SCENARIOS
    assert expanded(["default", "nominal", "delay"]) == ("nominal", "delay")


def test_every_scenario_has_a_line_that_says_what_it_is():
    assert list(titles()) == list(dict.fromkeys(["nominal", *LOADS, *NAMES]))
    assert titles().keys() == SCENARIOS.keys()
    assert all(title.endswith(".") and "#" not in title for title in titles().values())
    assert titles()["delay"] == "Voltages come 1 to 3 control intervals late, and 5 % of the readings are lost."


def test_what_is_kept_for_judging_is_not_what_is_learnt_on():
    """The solids alone are of two groups."""
    groups = BENCHMARK_SCENARIOS, OPEN_SCENARIOS, UNSEEN_SCENARIOS
    assert sorted({name for group in groups for name in group}) == list(NAMES)
    assert not set(OPEN_SCENARIOS) & {*BENCHMARK_SCENARIOS, *UNSEEN_SCENARIOS}
    assert set(BENCHMARK_SCENARIOS) & set(UNSEEN_SCENARIOS) == {"solid", "solid-20"}


def test_groups_hold_every_scenario_once_and_are_called_like_none():
    assert set(GROUPS) == {"benchmark", "open", "unseen", "all"} and not set(GROUPS) & set(SCENARIOS)
    assert sorted(GROUPS["all"]) == list(NAMES)
    assert expanded(["unseen", "delay", "solid", "open.toml"]) == (*UNSEEN_SCENARIOS, "delay", "open.toml")
    assert expanded(["open", "benchmark", "open"]) == (*OPEN_SCENARIOS, *BENCHMARK_SCENARIOS)


def _few(name):
    """Fewer plants than a scenario has, for they take long to build."""
    return {"scenario": {"preset": name, "plants": {"bank": 3}}} if SCENARIOS[name].plants.varies else {}


@pytest.mark.parametrize("name", NAMES)
def test_every_scenario_has_an_id(name):
    assert gymnasium.spec(f"beamenv/RotatingBeam-{name}-v0").kwargs == {"scenario": name}


@pytest.mark.parametrize("name", NAMES)
def test_check_env_passes_without_a_warning_and_the_spec_round_trips(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make(f"beamenv/RotatingBeam-{name}-v0", **_few(name))
        check_env(env.unwrapped)
    again = gymnasium.make(EnvSpec.from_json(env.spec.to_json()))
    assert again.unwrapped.task == env.unwrapped.task
    assert again.unwrapped.task.scenario == scenario(_few(name).get("scenario", name))
    assert np.array_equal(again.reset(seed=1)[0], env.reset(seed=1)[0])
    assert gymnasium.make_vec(f"beamenv/RotatingBeam-{name}-v0", num_envs=2, **_few(name)).unwrapped.task == env.unwrapped.task


@pytest.mark.parametrize("name", SCENARIOS)
def test_every_scenario_comes_back_from_its_dictionary(name):
    assert scenario(SCENARIOS[name].to_dict()) == SCENARIOS[name]
    assert hash(scenario(SCENARIOS[name].to_dict())) == hash(SCENARIOS[name])


def test_a_file_departs_from_the_scenario_it_names_table_by_table(tmp_path):
    path = tmp_path / "gust.toml"
    path.write_text(GUST, encoding="utf-8")
    chosen = load_scenario(path)
    assert chosen.rotor.turbulence == 8.0
    assert chosen.rotor.harmonics == SCENARIOS["rotor"].rotor.harmonics  # what the file does not name stays
    assert chosen.plants.speed_ratio == (0.9, 1.1)
    assert (chosen.pulse, chosen.deflection) == (1.0, 0.0)
    env = gymnasium.make(beamenv.ENV_ID, scenario=str(path))
    assert env.unwrapped.task.scenario == chosen
    env.reset(seed=0)
    assert 180.0 <= env.unwrapped.rotor_speed <= 220.0


def test_python_3_10_reads_toml_with_tomli(monkeypatch):
    """Its ``tomllib`` does not exist there: ``tomli`` has the same functions."""
    real = builtins.__import__

    def without_tomllib(name, *arguments, **keywords):
        if name == "tomllib":
            raise ModuleNotFoundError(name)
        return real(name, *arguments, **keywords)

    tomli = types.ModuleType("tomli")
    tomli.loads, tomli.TOMLDecodeError = files.tomllib.loads, files.tomllib.TOMLDecodeError
    monkeypatch.setitem(sys.modules, "tomli", tomli)
    monkeypatch.setattr(sys, "version_info", (3, 10, 0, "final", 0))
    monkeypatch.setattr(builtins, "__import__", without_tomllib)
    fresh = types.ModuleType("files_of_3_10")
    exec(compile(Path(files.__file__).read_text(encoding="utf-8"), files.__file__, "exec"), fresh.__dict__)
    assert fresh.tomllib is tomli
    assert fresh.parsed_table(GUST, "gust.toml")["plants"] == {"speed_ratio": [0.9, 1.1], "bank": 3}


WRONG = [
    ({"plants": {"spin_up": [100.0, 50000.0]}}, r"plants.spin_up is .* but must be below the critical speed, 26851.9"),
    ({"failures": {"dead_actuators": 5}}, "failures.dead_actuators is 5, but must be at most the 4 that the blade has"),
    ({"failures": {"faulty_sensors": 5}}, "failures.faulty_sensors is 5, but must be at most the 4 that the blade has"),
    ({"gust": 1.0}, "scenario has no field 'gust': its fields are step, pulse"),
    ({"plants": {"wind": 1.0}}, "scenario.plants has no field 'wind': its fields are speed_ratio"),
    ({"plants": 3.0}, "scenario.plants is 3.0, but must be a table of fields"),
    ({"plants": {"speed_ratio": [1.2, 0.8]}}, r"scenario.plants.speed_ratio is \[1.2, 0.8\], but must be a number or a range"),
    ({"plants": {"speed_ratio": 0.0}}, "scenario.plants.speed_ratio is 0.0, but must be .* from 0.01 to 10"),
    ({"plants": {"modulus_ratio": [0.9, float("nan")]}}, "scenario.plants.modulus_ratio"),
    ({"plants": {"mass_ratio": "heavy"}}, "scenario.plants.mass_ratio is 'heavy'"),
    ({"plants": {"damping_ratio": [0.0, 0.1]}}, "scenario.plants.damping_ratio"),
    (
        {"plants": {"truth": "liquid"}},
        "scenario.plants.truth is 'liquid', but must be None or one of solid-blade, or the path of a .npz",
    ),
    ({"plants": {"truth": 3}}, "scenario.plants.truth is 3, but must be None or one of solid-blade, or the path of a .npz file"),
    ({"plants": {"truth": "nowhere.npz"}}, "file 'nowhere.npz' cannot be read: No such file or directory"),
    (
        {"preset": "solid", "plants": {"speed_ratio": [0.9, 1.1]}},
        "scenario.plants.truth is 'solid-blade', but must be None where other plants are drawn or the rotor spins up",
    ),
    ({"preset": "solid", "plants": {"spin_up": [100.0, 300.0]}}, "scenario.plants.truth is 'solid-blade', but must be None where"),
    (
        {"preset": "solid", "plants": {"modes": 21}},
        "scenario.plants.modes is 21, but must be None or at most the 20 that the plant 's",
    ),
    ({"plants": {"modes": 0}}, "scenario.plants.modes is 0, but must be .*a whole number not below 1"),
    ({"plants": {"design_modes": 2.5}}, "scenario.plants.design_modes is 2.5, but must be None or a whole number"),
    ({"plants": {"bank": 0}}, "scenario.plants.bank is 0, but must be a whole number from 1 to 4096"),
    ({"plants": {"seed": -1}}, "scenario.plants.seed is -1, but must be a whole number not below 0"),
    ({"plants": {"spin_up": [300.0, -100.0]}}, "scenario.plants.spin_up"),
    ({"plants": {"spin_up": [0.0, 0.0]}}, "scenario.plants.spin_up is .0.0, 0.0., but must be two speeds of which one is above 0"),
    (
        {"plants": {"spin_up": [1.0, 2.0], "speed_ratio": [0.9, 1.1]}},
        "scenario.plants.spin_up is .1.0, 2.0., but must be None where other plants are drawn",
    ),
    ({"drive": {"hysteresis": 0.6}}, "scenario.drive.hysteresis is 0.6, but must be a number from 0 to 0.5"),
    ({"drive": {"delay": [3, 1]}}, r"scenario.drive.delay is \[3, 1\], but must be a whole number or a range .low, high."),
    ({"drive": {"delay": 1.5}}, "scenario.drive.delay is 1.5, but must be a whole number or .* from 0 to 100"),
    ({"drive": {"delay": [1, 2, 3]}}, r"scenario.drive.delay is \[1, 2, 3\], but must be a whole number or a range"),
    (
        {"drive": {"voltage_limits": [100.0, 200.0]}},
        r"scenario.drive.voltage_limits is .*, but must be .* a range .low, high. that encloses 0",
    ),
    ({"acquisition": {"dropout": 1.0}}, "scenario.acquisition.dropout is 1.0, but must be a number from 0 to 0.99"),
    ({"failures": {"dead_actuators": -1}}, "scenario.failures.dead_actuators is -1, but must be a whole number"),
    ({"failures": {"biased_share": 1.1}}, "scenario.failures.biased_share is 1.1, but must be a number from 0 to 1"),
    ({"failures": {"bias": [0.1, 2.0]}}, "scenario.failures.bias"),
    ({"failures": {"onset": [0.3, 0.1]}}, r"scenario.failures.onset is \[0.3, 0.1\], but must be a number or a range"),
    ({"failures": {"onset": -0.1}}, r"scenario.failures.onset is -0.1, but must be .* not below 0 \(s\)"),
    ({"failures": {"remaining": 1.5}}, "scenario.failures.remaining is 1.5, but must be .* from 0 to 1"),
    ({"failures": {"either": 1}}, "scenario.failures.either is 1, but must be True or False"),
    ({"rotor": {"harmonics": 6.0}}, "scenario.rotor.harmonics is 6.0, but must be a list of amplitudes"),
    ({"rotor": {"harmonics": [-1.0]}}, r"scenario.rotor.harmonics is \[-1.0\], but must be .*, each a number from 0 to 1e"),
    ({"rotor": {"turbulence": float("inf")}}, "scenario.rotor.turbulence is inf, but must be a number from 0 to 1e"),
    ({"rotor": {"turbulence_time": 0.0}}, "scenario.rotor.turbulence_time is 0.0, but must be a number from 1e-06"),
]


@pytest.mark.parametrize(("given", "sentence"), WRONG)
def test_what_a_scenario_cannot_hold_is_named_in_one_sentence(given, sentence):
    with pytest.raises(ValueError, match=sentence) as caught:
        RotatingBeamEnv(scenario=given)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("[plants]\nwind = 1.0\n", "file '.*broken.toml': scenario.plants has no field 'wind'"),
        ("step = \n", "file '.*broken.toml' cannot be read: .*line 1, column 8"),
        ('preset = "storm"\n', "scenario.preset is 'storm', but must be one of nominal"),
        (b"\xff\xfe", "file '.*broken.toml' cannot be read: .*position 0"),
        (None, "file '.*broken.toml' cannot be read: .*No such file"),
    ],
)
def test_a_file_that_is_none_is_named_in_one_sentence(tmp_path, content, sentence):
    path = tmp_path / "broken.toml"
    if content is not None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ValueError, match=sentence) as caught:
        scenario(str(path))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("a.toml", "a." * 50000 + "b = 1", "a key on line 1 has more than the 100 parts that are allowed"),
        ("a.toml", "\n[" + '"a" . ' * 50000 + "b]", "a key on line 2 has more than the 100 parts"),
        ("a.toml", "plants = {" + "a." * 50000 + "b = 1}", "a key on line 1 has more than the 100 parts"),
        ("a.toml", "#" * 1_000_001, "is too large, but must have at most 1000000 bytes"),
        ("a.json", " " * 1_000_001, "is too large, but must have at most 1000000 bytes"),
        ("a.json", '{"step": 1.0, "step": 0.0}', "key 'step' is there twice, but must be there once"),
        ("a.json", '{"plants": {"bank": 1, "bank": 2}}', "key 'bank' is there twice"),
        ("a.toml", "a" * 999_999, "cannot be read: "),
        ("a" * 250 + ".toml", "step = \n", "file '.{159}… cannot be read: "),
    ],
)
def test_a_file_that_no_scenario_needs_is_refused_at_once(tmp_path, name, content, sentence):
    path = tmp_path / name
    path.write_text(content, encoding="utf-8")
    began = time.perf_counter()
    with pytest.raises(ValueError, match=sentence) as caught:
        scenario(str(path))
    assert time.perf_counter() - began < 5.0
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 500


@pytest.mark.parametrize("name", ["A.TOML", "b.toml", "C.Json"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_endings_in_capitals_and_a_byte_order_mark_are_read(tmp_path, name, mark):
    path = tmp_path / name
    path.write_text(mark + ('{"step": 0.375, "pulse": 0.125}' if "C" in name else "step = 0.375\npulse = 0.125"), encoding="utf-8")
    assert (scenario(str(path)).step, load_scenario(path).pulse) == (0.375, 0.125)
