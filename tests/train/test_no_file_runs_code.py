"""Files of other people: none runs code, whichever door it comes through, unless the caller says that its maker is trusted."""

import base64
import io
import json
import os
import pickle
import shutil
import zipfile
from contextlib import suppress

import gymnasium
import numpy as np
import pytest
from typer.testing import CliRunner

import beamenv
from baselines.placement.optimal import optimal_layout
from beamenv.blade.files import load_config
from beamenv.blade.presets import blade_config
from beamenv.plant.files import load_plant
from train.benchmark import benchmark
from train.cli.app import app
from train.controllers.policy_files import load_policy
from train.learning.recipe import load_recipe

torch = pytest.importorskip("torch", reason="torch is not installed")
zoo = pytest.importorskip("train.learning.checkpoint")

SHORT = {"duration": 0.02}


class Bomb:
    """Unpickled, it leaves a folder behind."""

    def __init__(self, trace):
        self.trace = trace

    def __reduce__(self):
        return os.mkdir, (str(self.trace),)


@pytest.fixture
def trace(tmp_path):
    return tmp_path / "trace"


@pytest.fixture
def bombs(trace):
    """Contents that run code where a reader trusts them, by the name of the reader's mistake."""
    pickled = pickle.dumps(Bomb(trace))
    arrays, tensors, archive = io.BytesIO(), io.BytesIO(), io.BytesIO()
    np.savez(arrays, **dict.fromkeys(("A", "B", "weight0", "bias0", "name"), np.array([Bomb(trace)], dtype=object)))
    single = io.BytesIO()
    np.save(single, np.array([Bomb(trace)], dtype=object))
    torch.save({"training": Bomb(trace), "policy": Bomb(trace)}, tensors)
    with zipfile.ZipFile(archive, "w") as file:
        file.writestr("data", json.dumps({"policy_class": {":type:": "x", ":serialized:": base64.b64encode(pickled).decode()}}))
        file.writestr("data.pkl", pickled)
    python = f"__import__('os').mkdir({str(trace)!r})"
    yaml = f"!!python/object/apply:os.mkdir [{str(trace)!r}]\n"
    return {
        "pickle": pickled,
        "npz": arrays.getvalue(),
        "npy": single.getvalue(),
        "torch": tensors.getvalue(),
        "zip": archive.getvalue(),
        "python": python.encode(),
        "yaml": yaml.encode(),
    }


KINDS = ("pickle", "npz", "npy", "torch", "zip", "python", "yaml")


def as_agent(content, folder):
    """An agent's folder whose weights, and then whose description, are the content."""
    folder.mkdir()
    (folder / "weights.npz").write_bytes(content)
    about = {"kind": "history", "name": "x", "settings": {}, "lowest": [-1.0] * 4, "highest": [1.0] * 4}
    (folder / "agent.json").write_text(json.dumps(about))
    return folder


def agent(content, folder):
    load_policy(as_agent(content, folder / "agent"))


def agent_description(content, folder):
    home = as_agent(content, folder / "agent")
    (home / "agent.json").write_bytes(content)
    load_policy(home)


def checkpoint(content, folder):
    (folder / zoo.NAME).write_bytes(content)
    zoo.read_checkpoint(folder)


def file_of(name, read):
    def door(content, folder):
        (folder / name).write_bytes(content)
        read(folder / name)

    return door


def command(*words):
    """Words of the command line, with FILE for the file; its refusal is a ``ValueError`` here."""

    def door(path):
        result = CliRunner().invoke(app, [str(path) if word == "FILE" else word for word in words])
        assert result.exit_code in (1, 2) and "Traceback" not in result.output
        raise ValueError(result.stderr)

    return door


def model(path):
    benchmark(models=[path], scenarios=["nominal"], controllers=[], seeds=2, environment=SHORT)


DOORS = {
    "blade.json": file_of("blade.json", load_config),
    "blade.toml": file_of("blade.toml", load_config),
    "blade of an environment": file_of("b.json", lambda path: gymnasium.make(beamenv.ENV_ID, blade=load_config(path))),
    "scenario.toml": file_of("s.toml", lambda path: gymnasium.make(beamenv.ENV_ID, scenario=str(path))),
    "scenario.json": file_of("s.json", lambda path: gymnasium.make(beamenv.ENV_ID, scenario=path)),
    "plant.npz": file_of("p.npz", load_plant),
    "plant of a scenario": file_of(
        "p.npz", lambda path: gymnasium.make(beamenv.ENV_ID, scenario={"plants": {"solid": str(path)}}).reset(seed=0)
    ),
    "recipe.toml": file_of("r.toml", load_recipe),
    "agent": agent,
    "agent.json": agent_description,
    "checkpoint": checkpoint,
    "model": file_of("m.zip", model),
    "evaluate FILE": file_of("m.zip", command("evaluate", "FILE", "--episodes", "2")),
    "evaluate --blade": file_of("b.json", command("evaluate", "none", "--episodes", "2", "--blade", "FILE")),
    "frequencies --blade": file_of("b.toml", command("frequencies", "--blade", "FILE")),
    "evaluate --scenario": file_of("s.toml", command("evaluate", "none", "--episodes", "2", "--scenario", "FILE")),
    "train --recipe": file_of("r.toml", command("train", "mine", "--recipe", "FILE")),
    "train --from": file_of("m.zip", command("train", "gradient", "--from", "FILE")),
    "benchmark --model": file_of("m.zip", command("benchmark", "--model", "FILE", "--episodes", "2", "--controller", "none")),
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("door", DOORS)
def test_a_file_runs_no_code(door, kind, bombs, trace, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError):
        DOORS[door](bombs[kind], tmp_path)
    assert not trace.exists()


def test_these_files_run_code_where_they_are_trusted(bombs, trace, tmp_path):
    """Else nothing above would be shown."""
    readers = {
        "pickle": pickle.loads,
        "npz": lambda content: np.load(io.BytesIO(content), allow_pickle=True)["A"],
        "npy": lambda content: np.load(io.BytesIO(content), allow_pickle=True),
        "torch": lambda content: torch.load(io.BytesIO(content), weights_only=False),
        "python": eval,
        "yaml": __import__("yaml").unsafe_load,
    }
    for kind, read in readers.items():
        with suppress(Exception):  # after the bomb went off
            read(bombs[kind])
        assert trace.exists(), kind
        trace.rmdir()


@pytest.mark.parametrize("kind", KINDS)
def test_a_kept_layout_runs_no_code_and_is_worked_out_again(kind, bombs, trace, tmp_path, monkeypatch):
    from baselines.placement import optimal

    monkeypatch.setenv("BEAMENV_CACHE", str(tmp_path))
    monkeypatch.setattr(optimal, "computed_layout", lambda config: {"actuators": (0.0,), "sensors": (0.1,)})
    optimal.kept_layout.cache_clear()
    config = blade_config()
    optimal._kept_in(config).write_bytes(bombs[kind])
    assert optimal_layout(config) == {"actuators": (0.0,), "sensors": (0.1,)}
    assert not trace.exists()
    optimal.kept_layout.cache_clear()


@pytest.mark.parametrize("kind", ["pickle", "python"])
def test_a_kept_cell_runs_no_code_and_is_measured_again(kind, bombs, trace, tmp_path):
    small = {"scenarios": ["nominal"], "controllers": [], "seeds": 2, "environment": SHORT, "folder": tmp_path / "kept"}
    first = benchmark(**small).row("nominal", "lqg").estimates["relative_cost"].value
    cells = [path for path in (tmp_path / "kept").rglob("*.json") if "cell" in str(path.parent)]
    assert cells
    for path in cells:
        path.write_bytes(bombs[kind])
    try:
        again = benchmark(**small).row("nominal", "lqg").estimates["relative_cost"].value
    except ValueError:
        again = first  # told, not taken
    assert again == first
    assert not trace.exists()
    shutil.rmtree(tmp_path / "kept")
