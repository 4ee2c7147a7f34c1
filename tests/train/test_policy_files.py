"""Trained policies in folders: refused where they do not belong, read without executing anything."""

import json
import pickle

import numpy as np
import pytest

from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.plant.fingerprint import fingerprint
from train.controllers.policies import HistoryPolicy
from train.controllers.policy_files import load_policy, save_policy

ONE = np.ones(4, np.float32)
POLICY = HistoryPolicy(
    "idle", {"weight0": np.zeros((4, 24), np.float32), "bias0": np.zeros(4, np.float32)}, {"input_gain": 1.0, "held": 1}, -ONE, ONE
)


def plant(**changes):
    return build_plant(blade_config(overrides=changes))


@pytest.fixture
def folder(tmp_path):
    save_policy(POLICY, tmp_path, {"plants": {"nominal": fingerprint(plant())}})
    return tmp_path


def test_it_loads_for_the_plant_it_was_trained_on(folder):
    assert load_policy(folder, plant()).name == "idle"


def test_it_is_refused_for_another_plant(folder):
    other = plant(damping_ratio=0.02)
    with pytest.raises(ValueError, match=f"fingerprint {fingerprint(other)[:12]}.* was trained on: nominal") as refused:
        load_policy(folder, other)
    assert "\n" not in str(refused.value)


def test_a_policy_that_does_not_tell_its_plant_is_refused_for_any(tmp_path):
    save_policy(POLICY, tmp_path)
    assert load_policy(tmp_path).name == "idle"
    with pytest.raises(ValueError, match="does not say what plant"):
        load_policy(tmp_path, plant())


def test_the_limits_are_those_of_the_plant_it_works_on(tmp_path):
    narrow = plant(voltage_limits=(-500.0, 1500.0))
    save_policy(POLICY, tmp_path, {"plants": {"nominal": fingerprint(plant()), "hysteresis": fingerprint(narrow)}})
    assert load_policy(tmp_path, narrow).lowest == pytest.approx(-1.0 / 3.0)
    assert load_policy(tmp_path, plant()).lowest == pytest.approx(-1.0)


class Bomb:
    """Unpickled, it leaves a file behind."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return open, (str(self.path), "w")


def test_loading_executes_no_code(folder, tmp_path):
    trace = tmp_path / "trace"
    np.savez(folder / "weights.npz", weight0=np.array([Bomb(trace)], dtype=object), bias0=np.zeros(4))
    with pytest.raises(ValueError, match="allow_pickle"):
        load_policy(folder)
    (folder / "weights.npz").write_bytes(pickle.dumps(Bomb(trace)))
    with pytest.raises(ValueError, match="cannot be read"):
        load_policy(folder)
    assert not trace.exists()
    pickle.loads(pickle.dumps(Bomb(trace))).close()
    assert trace.exists()


def test_a_folder_without_an_agent_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"agent\.json is not there"):
        load_policy(tmp_path)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"kind": "oracle"}, "'oracle'.*must be one of history, recurrent, residual, lstm"),
        ({"kind": "lstm"}, "must hold the weights of a 'lstm' policy: 'weight_ih"),
        ({"lowest": "low"}, "cannot be read"),
    ],
)
def test_what_does_not_fit_is_told_in_a_sentence(folder, change, sentence):
    about = json.loads((folder / "agent.json").read_text())
    (folder / "agent.json").write_text(json.dumps(about | change))
    with pytest.raises(ValueError, match=sentence):
        load_policy(folder)


@pytest.mark.parametrize("key", ["kind", "name", "settings", "lowest", "highest"])
def test_a_missing_key_is_named(folder, key):
    about = json.loads((folder / "agent.json").read_text())
    del about[key]
    (folder / "agent.json").write_text(json.dumps(about))
    with pytest.raises(ValueError, match=f"'{key}' is not there"):
        load_policy(folder)


@pytest.mark.parametrize("content", ["{", "[]", "\xff"])
def test_a_damaged_description_is_told_in_a_sentence(folder, content):
    (folder / "agent.json").write_bytes(content.encode("latin-1"))
    with pytest.raises(ValueError, match=r"agent\.json"):
        load_policy(folder)


def test_half_a_file_of_weights_is_told_in_a_sentence(folder):
    whole = (folder / "weights.npz").read_bytes()
    for length in (0, 1, len(whole) // 2, len(whole) - 1):
        (folder / "weights.npz").write_bytes(whole[:length])
        with pytest.raises(ValueError, match="cannot be read"):
            load_policy(folder)
