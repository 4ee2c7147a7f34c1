"""Doors of arrays in files, plants and agents: their bytes damaged, their arrays wrong."""

import io
import json
import shutil
import zipfile
from functools import cache
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from beamenv.plant.files import load_plant, save_plant
from beamenv.plant.modal_plant import ModalPlant
from tests.fuzz.damage import PLAIN, damaged, read_anew
from tests.fuzz.meaning import NOTHING, PATH, Kind, instance
from tests.fuzz.oracle import Door
from tests.fuzz.train_doors import history
from tests.fuzz.wrong import MAKERS
from train.controllers.policy_files import load_policy, save_policy


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


def saved(plant, path):
    save_plant(plant, path)
    again = load_plant(path)
    Path(path).unlink()
    return again


DOORS = [
    Door(
        "load_plant", load_plant, {"source": PATH}, lambda: {"source": "solid-blade"}, told=("plant", "file"), public="load_plant"
    ),
    Door(
        "save_plant",
        saved,
        {"plant": instance(ModalPlant), "path": PATH},
        lambda: {"plant": load_plant("solid-blade").first(2), "path": "kept.npz"},
        told=("file",),
        public="save_plant",
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
