"""Trained policies in folders: refused where they do not belong, read without executing anything."""

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.plant.fingerprint import fingerprint
from train.controllers.policies import HistoryPolicy
from train.controllers.policy_files import load_policy, save_policy
from train.controllers.shipped import shipped

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
    with pytest.raises(
        ValueError, match=f"was trained on, in nominal: it has the fingerprint {fingerprint(other)[:12]}…"
    ) as refused:
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
    with pytest.raises(ValueError, match="weights.npz' cannot be read: it holds Python objects"):
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
        ({"kind": "oracle"}, r"agent.json': kind is 'oracle', but must be one of history, recurrent, state-space, residual"),
        ({"kind": ["history"]}, r"agent.json': kind is \['history'\], but must be one of"),
        ({"kind": "lstm"}, r"weights.npz': weights 'weight_ih' are missing: a policy of kind 'lstm' needs them"),
        ({"lowest": "low"}, r"agent.json': lowest is 'low', but must be a list of one or more numbers"),
        ({"lowest": [-1.0]}, r"agent.json': highest is .* but must be a list of 1 numbers, each above that of lowest"),
        ({"lowest": [1.0] * 4}, "each above that of lowest"),
        ({"highest": [float("nan")] * 4}, r"agent.json': highest.*must be"),
        ({"name": 3}, r"agent.json': name is 3, but must be a string"),
        ({"format": 2}, r"agent.json': format is 2, but must be 1: another version of beamenv"),
        ({"settings": []}, r"agent.json': settings is \[\], but must be a mapping"),
        ({"settings": {"input_gain": 1.0}}, r"settings.held is None, but must be a whole number not below 1"),
        ({"settings": {"input_gain": 1.0, "held": 0}}, r"settings.held is 0, but must be a whole number not below 1"),
        ({"settings": {"input_gain": float("nan"), "held": 1}}, r"settings.input_gain is nan, but must be a finite number"),
        ({"settings": {"input_gain": True, "held": 1}}, r"settings.input_gain is True, but must be a finite number"),
        (
            {"settings": {"input_gain": 1.0, "held": 1, "activation": "gelu"}},
            r"settings.activation is 'gelu' [(]did you mean relu[?][)], but must be one of",
        ),
        ({"settings": {"input_gain": 1.0, "held": 1, "squashed": "no"}}, r"settings.squashed is 'no', but must be True or False"),
    ],
)
def test_what_does_not_fit_is_told_in_a_sentence(folder, change, sentence):
    about = json.loads((folder / "agent.json").read_text())
    (folder / "agent.json").write_text(json.dumps(about | change))
    with pytest.raises(ValueError, match=sentence) as refused:
        load_policy(folder)
    assert "\n" not in str(refused.value)


KINDS = {policy.kind: policy for policy in (load_policy(each.folder) for each in shipped())}
"""One of each kind, of those that ship."""


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_weights_of_another_shape_or_not_finite_are_refused_with_the_file_s_name(kind, tmp_path):
    save_policy(KINDS[kind], tmp_path)
    assert load_policy(tmp_path).kind == kind
    for name, whole in KINDS[kind].weights.items():
        hole = whole.copy()
        hole.flat[0] = np.nan
        for wrong in (whole[:-1], whole[..., None], hole, whole.astype(int), whole.astype("U3"), whole[:0]):
            save_policy(replace(KINDS[kind], weights={**KINDS[kind].weights, name: wrong}), tmp_path)
            with pytest.raises(ValueError, match=r"weights.npz': weights '\w+' (are of shape|must be finite|are missing)"):
                load_policy(tmp_path)
        others = {key: value for key, value in KINDS[kind].weights.items() if key != name}
        for weights in (others, {**KINDS[kind].weights, "more": whole}):
            save_policy(replace(KINDS[kind], weights=weights), tmp_path)
            with pytest.raises(ValueError, match=r"weights.npz': weights '\w+' are "):
                load_policy(tmp_path)


def test_an_agent_of_other_sensors_is_refused_even_if_it_claims_the_plant(tmp_path):
    wide = replace(POLICY, weights={"weight0": np.zeros((4, 21), np.float32), "bias0": np.zeros(4, np.float32)})
    save_policy(wide, tmp_path, {"plants": {"nominal": fingerprint(plant())}})
    assert load_policy(tmp_path).name == "idle"  # three instants of three sensors and four voltages
    with pytest.raises(ValueError, match=r"'weight0' are of shape \(4, 21\), but must be of \(4, 16\)"):
        load_policy(tmp_path, plant())


def test_an_agent_s_description_never_stands_beside_another_s_weights(folder, monkeypatch):
    monkeypatch.setattr("train.controllers.policy_files.write_json", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        save_policy(POLICY, folder)
    assert [path.name for path in folder.iterdir()] == ["weights.npz"]


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
