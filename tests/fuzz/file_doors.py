"""Doors of files: their bytes damaged, their values wrong."""

import io
import json
import shutil
import sys
import zipfile
from functools import cache
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from beamenv.blade.files import load_config
from beamenv.plant.files import load_plant, save_plant
from beamenv.scenarios.scenario import load_scenario
from tests.fuzz.blade_doors import BLADE, BLADE_PARTS, SCENARIO, SCENARIO_PARTS
from tests.fuzz.meaning import ANYTHING, NOTHING, Kind
from tests.fuzz.oracle import Door
from tests.fuzz.train_doors import history
from tests.fuzz.wrong import MAKERS, places
from train.controllers.policy_files import load_policy, save_policy
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
PLAIN = [
    "none",
    "true",
    "false",
    "nan",
    "inf",
    "-0",
    "huge",
    "minus",
    "half",
    "text no",
    "text false",
    "text number",
    "text empty",
    "surrogate",
    "text nul",
    "empty list",
    "empty dict",
    "list of none",
    "list of text",
    "list of bools",
    "list of lists",
    "list of five",
    "dict",
    "nested dict",
    "large",
    "text two lines",
]


@st.composite
def damaged(draw, content):
    """Bytes with some cut out, put in, changed or said twice."""
    content = bytes(content)
    for _ in range(draw(st.integers(1, 2))):
        at = draw(st.integers(0, len(content)))
        to = min(len(content), at + draw(st.integers(0, 12)))
        put = draw(
            st.one_of(
                st.just(b""),
                st.binary(max_size=4),
                st.sampled_from([b"\n", b'"', b"=", b"[", b"{", b"\xff", b"\0", b"nan", b"-", b"e999"]),
            )
        )
        kind = draw(st.sampled_from(["replace", "cut", "flip", "twice", "end"]))
        if kind == "replace":
            content = content[:at] + put + content[to:]
        elif kind == "cut":
            content = content[:at]
        elif kind == "twice":
            content = content[:to] + content[at:to] + content[to:]
        elif kind == "end":
            content += put
        elif content and at < len(content):
            content = content[:at] + bytes([content[at] ^ (1 << draw(st.integers(0, 7)))]) + content[at + 1 :]
    return content


def no_twice(pairs):
    """A JSON object that says nothing twice."""
    if len({name for name, _ in pairs}) < len(pairs):
        raise ValueError
    return dict(pairs)


def read_anew(ending, content):
    """The table in a file, or NOTHING."""
    try:
        text = content.decode("utf-8")
        found = json.loads(text, object_pairs_hook=no_twice) if ending == ".json" else tomllib.loads(text)
    except (ValueError, RecursionError):
        return NOTHING
    return {name: value for name, value in found.items() if name != "$schema"} if isinstance(found, dict) else NOTHING


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
def plant_bytes():
    save_plant(load_plant("solid-blade").first(2), "kept.npz")
    content = Path("kept.npz").read_bytes()
    Path("kept.npz").unlink()
    return content


def arrays_of(content):
    """Every array in an archive that is whole; NOTHING for any other."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            names = archive.namelist()
            found = {
                name.removesuffix(".npy"): np.lib.format.read_array(io.BytesIO(archive.read(name)), allow_pickle=False)
                for name in names
            }
    except Exception:
        return NOTHING
    return found if len(found) == len(names) else NOTHING


def archived(arrays):
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


ARRAYS = [
    "nan array",
    "object array",
    "empty array",
    "complex array",
    "text array",
    "0-d",
    "bool array",
    "matrix",
    "structured",
    "0-d text",
    "large array",
    "empty matrix",
]


@st.composite
def changed_archive(draw, content):
    """An archive with an array too many, too few, or a wrong one."""
    arrays = dict(arrays_of(content))
    name = draw(st.sampled_from([*arrays, "colour", "file"]))
    wrong = draw(st.sampled_from([None, *ARRAYS, "member"]))
    if wrong is None:
        arrays.pop(name, None)
    elif wrong == "member":
        spoiled = np.array(arrays[name], dtype=float) if name in arrays and arrays[name].dtype.kind == "f" else np.zeros(3)
        spoiled.flat[-1] = draw(st.sampled_from([np.nan, np.inf, -1.0, 1e308]))
        arrays[name] = spoiled
    else:
        arrays[name] = MAKERS[wrong]()
    return archived({name: value for name, value in arrays.items() if name != "file"})


def plant_file(content):
    Path("mine.npz").write_bytes(content)
    try:
        return load_plant("mine.npz")
    finally:
        Path("mine.npz").unlink()


def _numeric(content):
    found = arrays_of(content)
    if found is NOTHING or any(value.dtype.kind not in "fiuU" for value in found.values()):
        return NOTHING
    return {name: value if value.ndim else value.item() for name, value in found.items()}


def agent(about=None, weights=None):
    """A policy from a folder with these files."""
    folder = Path("agent")
    folder.mkdir()
    try:
        (folder / "agent.json").write_bytes(about)
        (folder / "weights.npz").write_bytes(weights)
        loaded = load_policy(folder)
        action = loaded.predict(np.array([[0.1, -0.2]]))[0]
        assert np.isfinite(action).all() and np.abs(action).max() <= 1.0, "an agent that acts outside its space"
        return loaded
    finally:
        shutil.rmtree(folder)


@cache
def agent_files():
    save_policy(history(), Path("agent"))
    files = {"about": Path("agent/agent.json").read_bytes(), "weights": Path("agent/weights.npz").read_bytes()}
    shutil.rmtree("agent")
    return files


def _about(content):
    found = read_anew(".json", content)
    keys = ("kind", "name", "settings", "lowest", "highest")
    return (
        NOTHING
        if found is NOTHING or any(key not in found for key in keys)
        else {"name": found["name"], "kind": found["kind"], "settings": found["settings"]}
    )


@st.composite
def changed_about(draw):
    about = json.loads(agent_files()["about"])
    path = draw(
        st.sampled_from(
            [
                ("kind",),
                ("name",),
                ("settings",),
                ("settings", "held"),
                ("settings", "input_gain"),
                ("settings", "activation"),
                ("lowest",),
                ("highest",),
                ("settings", "squashed"),
            ]
        )
    )
    value = MAKERS[draw(st.sampled_from(PLAIN))]()
    if len(path) == 2:
        about["settings"][path[1]] = value
    else:
        about[path[0]] = value
    return json.dumps(about).encode()


@cache
def recipe_text():
    from importlib.resources import files

    from train.learning import recipes

    return files(recipes).joinpath("ppo.toml").read_text()


def lazily(make):
    """A strategy made when it is first drawn from: examples lie in a folder of their own."""
    return st.deferred(make)


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
    Door(
        "plant file",
        plant_file,
        {
            "content": Kind(
                "content", _numeric, st.deferred(lambda: st.one_of(damaged(plant_bytes()), changed_archive(plant_bytes())))
            )
        },
        lambda: {"content": plant_bytes()},
        lambda made: {"content": made},
        ("mine.npz",),
        junk=st.nothing(),
        plain=False,
    ),
    Door(
        "agent",
        agent,
        {
            "about": Kind("about", _about, st.deferred(lambda: st.one_of(damaged(agent_files()["about"]), changed_about()))),
            "weights": Kind(
                "weights",
                arrays_of,
                st.deferred(lambda: st.one_of(damaged(agent_files()["weights"]), changed_archive(agent_files()["weights"]))),
            ),
        },
        agent_files,
        lambda made: {"about": made, "weights": made.weights},
        ("agent",),
        junk=st.nothing(),
        plain=False,
    ),
]
