"""Doors of tables in files, TOML and JSON: their bytes damaged, their values wrong."""

import json
import sys
from functools import cache
from pathlib import Path

from hypothesis import strategies as st

from beamenv.blade.files import load_config
from beamenv.scenarios.scenario import load_scenario
from tests.fuzz.blade_doors import BLADE, BLADE_PARTS, SCENARIO, SCENARIO_PARTS
from tests.fuzz.damage import PLAIN, damaged, read_anew
from tests.fuzz.meaning import ANYTHING, NOTHING, Kind
from tests.fuzz.oracle import Door
from tests.fuzz.wrong import MAKERS, places
from train.learning.recipe import load_recipe

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

RAW = [
    "nan",
    "-inf",
    "true",
    "'no'",
    '""',
    "[]",
    "[1, 2]",
    "[[1], [2]]",
    "{}",
    "{ a = 1 }",
    "1979-05-27",
    "0x10",
    "1_0",
    "1e400",
    "-0.0",
    "10000000000000000000000",
    "'\\ud800'",
    "1.5",
    "-1",
    "3",
    "[nan]",
    "['1', '2']",
    "[true, false]",
    "07:32:00",
    "x",
    "",
]


def table_file(name, load, kind, parts, ending, text, told):
    """Of a table as a file."""
    path = f"mine{ending}"

    def call(content):
        Path(path).write_bytes(content)
        try:
            return load(path)
        finally:
            Path(path).unlink()

    def means(content):
        found = read_anew(ending, content)
        return NOTHING if found is NOTHING else kind.means(found)

    json_values = st.tuples(st.sampled_from(places(parts)), st.sampled_from(PLAIN)).map(
        lambda drawn: json.dumps(_nested(drawn[0], MAKERS[drawn[1]]()), allow_nan=True).encode()
    )
    toml_values = st.tuples(st.sampled_from(places(parts)), st.sampled_from(RAW)).map(
        lambda drawn: f"{'.'.join(drawn[0])} = {drawn[1]}\n".encode()
    )
    examples = st.one_of(damaged(text.encode()), json_values if ending == ".json" else toml_values)
    return Door(
        f"{name} {ending}",
        call,
        {"content": Kind("content", means, examples)},
        lambda: {"content": text.encode()},
        lambda made: {"content": made},
        (path, *told),
        junk=st.nothing(),
        plain=False,
    )


def _nested(path, value):
    for name in reversed(path):
        value = {name: value}
    return value


BLADE_TOML = """speed = 150.0
modes = 5
[beam]
length = 1.5
ply_angles_deg = [30.0, -30.0]
material = { density = 1600.0 }
[patches]
actuators = 2
sensors = [0.1, 0.5]
passive = false
"""
BLADE_JSON = json.dumps(tomllib.loads(BLADE_TOML), indent=1)
SCENARIO_TOML = """preset = "rotor"
magnitude = [10.0, 20.0]
white_load = false
[plants]
speed_ratio = [0.9, 1.1]
bank = 4
[drive]
delay = [1, 2]
[rotor]
harmonics = [6.0, 4.0]
"""
SCENARIO_JSON = json.dumps(tomllib.loads(SCENARIO_TOML), indent=1)


@cache
def recipe_text():
    from importlib.resources import files

    from train.learning import recipes

    return files(recipes).joinpath("ppo.toml").read_text()


DOORS = [
    table_file("blade", load_config, BLADE, BLADE_PARTS, ".toml", BLADE_TOML, ()),
    table_file("blade", load_config, BLADE, BLADE_PARTS, ".json", BLADE_JSON, ()),
    table_file("scenario", load_scenario, SCENARIO, SCENARIO_PARTS, ".toml", SCENARIO_TOML, ()),
    table_file("scenario", load_scenario, SCENARIO, SCENARIO_PARTS, ".json", SCENARIO_JSON, ()),
    table_file(
        "recipe",
        load_recipe,
        Kind("recipe", lambda value: value, st.nothing()),
        dict.fromkeys(("agent", "title", "updates", "settings"), ANYTHING),
        ".toml",
        recipe_text(),
        (),
    ),
]
