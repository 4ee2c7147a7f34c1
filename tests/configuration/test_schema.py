"""What an editor is told of blade and scenario files."""

import json
import math
import re
from dataclasses import fields, is_dataclass
from importlib.resources import files

import pytest
from typer.testing import CliRunner

from beamenv.blade import PRESETS, BeamConfig, BladeConfig, from_dict, to_dict
from beamenv.blade.files import blade_schema
from beamenv.configuration.files import parsed_table
from beamenv.scenarios import named
from beamenv.scenarios.scenario import SCENARIOS, Scenario, scenario, scenario_schema
from beamenv.structure import Lamina
from train.cli.app import app

KNOWN = {
    "$schema", "$defs", "$ref", "title", "description", "default", "type", "enum", "anyOf", "properties", "additionalProperties",
    "items", "prefixItems", "minItems", "maxItems", "minProperties", "minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum",
    "pattern", "allOf", "required", "const",
}  # fmt: skip
TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None), "number": (int, float), "integer": int}


def has_what_is_needed(value, schema, root):
    """Whether it keeps to all of "allOf", is the "const" or in the "enum", and has what is "required"."""
    if not all(holds(value, each, root) for each in schema.get("allOf", ())):
        return False
    if "const" in schema and value != schema["const"] or "enum" in schema and value not in schema["enum"]:
        return False
    return not isinstance(value, dict) or set(schema.get("required", ())) <= set(value)


def holds(value, schema, root):
    """Whether a value keeps to a schema of the keywords in ``KNOWN``."""
    assert set(schema) <= KNOWN, set(schema) - KNOWN
    if not has_what_is_needed(value, schema, root):
        return False
    if "$ref" in schema:
        return holds(value, root["$defs"][schema["$ref"].rpartition("/")[2]], root)
    if "anyOf" in schema and not any(holds(value, each, root) for each in schema["anyOf"]):
        return False
    kind = schema.get("type")
    if kind == "integer" and isinstance(value, float) and value.is_integer():
        value = int(value)  # to JSON schema 11.0 is an integer
    if kind and (not isinstance(value, TYPES[kind]) or (isinstance(value, bool) and kind != "boolean")):
        return False
    if isinstance(value, dict):
        if len(value) < schema.get("minProperties", 0):
            return False
        rest = schema.get("additionalProperties", True)
        parts = [(each, schema.get("properties", {}).get(name, rest)) for name, each in value.items()]
        return all(part if isinstance(part, bool) else holds(each, part, root) for each, part in parts)
    if isinstance(value, list):
        first = schema.get("prefixItems", [])
        parts = [*first, *[schema.get("items", {})] * (len(value) - len(first))]
        fits = schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value))
        return fits and all(holds(each, part, root) for each, part in zip(value, parts, strict=False))
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        low, high = schema.get("minimum", value), schema.get("maximum", value)
        above, below = schema.get("exclusiveMinimum", -math.inf), schema.get("exclusiveMaximum", math.inf)
        return low <= value <= high and above < value < below
    return not isinstance(value, str) or re.search(schema.get("pattern", ""), value) is not None


@pytest.mark.parametrize("name", named.NAMES)
def test_every_scenario_that_ships_keeps_to_the_schema(name):
    content = parsed_table(files(named).joinpath(f"{name}.toml").read_text(encoding="utf-8"), f"{name}.toml")
    assert holds(content, scenario_schema(), scenario_schema())
    assert holds(SCENARIOS[name].to_dict(), scenario_schema(), scenario_schema())


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_keeps_to_the_schema(name):
    assert holds(to_dict(PRESETS[name]), blade_schema(), blade_schema())


@pytest.mark.parametrize(
    ("content", "schema"),
    [
        ({"beam": {"length": -1.0}}, blade_schema),
        ({"beam": {"lenght": 1.0}}, blade_schema),
        ({"beam": {"material": "steel"}}, blade_schema),
        ({"beam": {"material": {"E1": 0.0}}}, blade_schema),
        ({"beam": {"material": {"G23": 99_999.0}}}, blade_schema),
        ({"beam": {"material": {"inner": "sus304", "outer": "alumina"}}}, blade_schema),
        ({"beam": {"material": {"inner": "sus304", "outer": "alumina", "exponent": -1.0}}}, blade_schema),
        ({"beam": {"material": {"curves": {"E3": [[200, 1.0], [300, 1.0]]}}}}, blade_schema),
        ({"beam": {"ply_angles_deg": []}}, blade_schema),
        ({"patches": {"passive": "no"}}, blade_schema),
        ({"modes": 1.5}, blade_schema),
        ({"model": "shell"}, blade_schema),
        ({"beam": {"steady_state": "stalled"}}, blade_schema),
        ({"preset": "storm"}, scenario_schema),
        ({"plants": {"truth": "beam"}}, scenario_schema),
        ({"plants": {"speed_ratio": [0.9, 1.0, 1.1]}}, scenario_schema),
        ({"rotor": {"harmonics": 3.0}}, scenario_schema),
    ],
)
def test_what_is_refused_is_marked(content, schema):
    assert not holds(content, schema(), schema())


@pytest.mark.parametrize(
    ("content", "schema"),
    [
        ({"$schema": "blade.json", "beam": {"material": {"E1": 1e11}, "ply_angles_deg": [30, 30]}}, blade_schema),
        ({"beam": {"ply_angles_deg": {"top": [0], "bottom": [0], "left": [0], "right": [0]}}}, blade_schema),
        ({"beam": {"material": {"inner": "sus304", "outer": "alumina", "exponent": 1, "scheme": "mori-tanaka"}}}, blade_schema),
        (
            {"beam": {"material": {"curves": {"E2": [[200, 1.1], [300, 1.0]], "G12": {"least_K": 200, "most_K": 400}}}}},
            blade_schema,
        ),
        ({"patches": {"actuators": [0.1, 0.5], "sensors": 3}}, blade_schema),
        ({"preset": "rotor", "plants": {"speed_ratio": 1.1}}, scenario_schema),
    ],
)
def test_partial_tables_and_every_form_of_a_value_keep_to_the_schema(content, schema):
    assert holds(content, schema(), schema())


@pytest.mark.parametrize("schema", [blade_schema, scenario_schema])
def test_fields_are_described_by_the_lines_under_them(schema):
    whole = schema()
    assert "description" in json.dumps(whole)
    tables = [whole, *(each for each in whole.get("$defs", {}).values() if "properties" in each)]
    assert not any("required" in table for table in tables)  # a file departs from a preset: it may leave out anything


def test_a_section_and_its_webs_need_what_has_no_default():
    box = {"shape": "box", "width": 0.2, "depth": 0.06, "thickness": 0.004}
    for section, fits in (
        (box, True),
        ({**box, "webs": [{"position": 0.3}]}, True),
        ({**box, "webs": [{"name": "spar"}]}, False),
        ({name: value for name, value in box.items() if name != "depth"}, False),
        ({**box, "shape": "strip"}, False),
        ({**box, "shape": "star"}, False),
    ):
        assert holds({"beam": {"section": section}}, blade_schema(), blade_schema()) == fits


def test_the_command_writes_what_the_functions_say(tmp_path):
    for kind, schema in (("blade", blade_schema), ("scenario", scenario_schema)):
        printed = CliRunner().invoke(app, ["schema", kind])
        assert json.loads(printed.stdout) == schema()
        assert CliRunner().invoke(app, ["schema", kind, "--output", str(tmp_path / kind)]).exit_code == 0
        assert json.loads((tmp_path / kind).read_text(encoding="utf-8")) == schema()
    assert CliRunner().invoke(app, ["schema", "blade", "--output", str(tmp_path / "new" / "here.json")]).exit_code == 0
    refused = CliRunner().invoke(app, ["schema", "blade", "--output", str(tmp_path / "blade" / "here.json")])  # within a file
    assert refused.exit_code == 2
    assert "Traceback" not in refused.stderr


VALUES = [
    None, True, "", "no", "MFC", "graphite-epoxy", "higher_order", 0, -0.0, 1, 3, 1.0, 11.0, 0.5, 1.5, -1, 1e6, [], [1], [0.9, 1.1],
    [-1, 1], [1, 2], [0, 0], [1, 2, 3], ["1", "2"], [True, False], [[0, 1]], [["all", [30, 30]]], {}, {"all": [30]}, {"a": 1},
    "solid-blade", "blade.npz", {"E1": 1e11}, {"E1": "x"}, {"turbulence": 1}, {"delay": [0, 1.5]}, {"length": 1.0},
]  # fmt: skip
"""What somebody may write for a field."""


def places(cls, path=()):
    """The path of every field of a configuration, within tables too."""
    for each in fields(cls):
        yield (*path, each.name)
        default = getattr(cls(), each.name)
        if is_dataclass(default):
            yield from places(type(default), (*path, each.name))
        if each.name == "material" and cls is BeamConfig:
            yield from ((*path, "material", name.name) for name in fields(Lamina))


@pytest.mark.parametrize(
    ("cls", "schema", "reader"), [(BladeConfig, blade_schema, from_dict), (Scenario, scenario_schema, scenario)]
)
def test_editor_and_reader_agree_on_every_value_of_every_field_alone(cls, schema, reader):
    """Both refuse it or neither, but for what ties numbers together, which a schema cannot say: then the sentence names both."""
    root = schema()
    tied = "that do not add up", "smaller in magnitude than sqrt", "None where other plants are drawn", "where no patches are"
    tied = *tied, "two speeds of which one is above 0", "left out where discretisation is", "where no temperature is"
    tied = *tied, "where data of the material hold", "at most the beam's length", "times the section's size"
    for path in places(cls):
        for value in VALUES:
            table = value
            for name in reversed(path):
                table = {name: table}
            try:
                reader(table)
            except ValueError as error:
                falls = isinstance(value, list) and len(value) == 2 and sorted(value) != value
                assert not holds(table, root, root) or falls or any(words in str(error) for words in tied), (path, value, error)
            else:
                assert holds(table, root, root), (path, value)
