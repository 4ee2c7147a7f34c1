"""Configurations as dictionaries and files."""

import json

import pytest

from beamenv.blade.build import build_plant
from beamenv.blade.files import from_dict, load_config, to_dict
from beamenv.blade.presets import PRESETS, blade_config


@pytest.mark.parametrize("preset", PRESETS)
def test_every_preset_survives_json_and_builds(preset):
    config = blade_config(preset)
    assert from_dict(json.loads(json.dumps(to_dict(config)))) == config
    assert build_plant(config).B.shape == (22, 4)


def test_a_nested_dictionary_changes_only_what_it_names():
    config = blade_config("thesis", {"beam": {"pretwist_deg": 0.0}, "patches": {"actuators": [0.0, 0.2]}}, speed=100.0)
    assert config.beam.pretwist_deg == 0.0
    assert config.beam.length == 2.023
    assert config.patches.actuators == (0.0, 0.2)
    assert config.speed == 100.0


def test_walls_may_have_plies_of_their_own():
    walls = {"top": [60] * 6, "bottom": [-60] * 6, "left": [60, -60] * 3, "right": [60, -60] * 3}
    config = blade_config("thesis", {"beam": {"ply_angles_deg": walls}})
    assert config.beam.layup().plies("bottom")[0].angle_deg == -60.0


def test_ganged_actuators_have_one_voltage():
    ganged = build_plant(blade_config("thesis", {"patches": {"ganged": True}}))
    single = build_plant(blade_config("thesis"))
    assert pytest.approx(single.B.sum(axis=1, keepdims=True)) == ganged.B


def test_json_and_toml_files_give_the_same_blade(tmp_path):
    (tmp_path / "blade.json").write_text(json.dumps({"speed": 100.0, "beam": {"taper": 2.0}}))
    (tmp_path / "blade.toml").write_text("speed = 100.0\n[beam]\ntaper = 2.0\n")
    assert load_config(tmp_path / "blade.json") == load_config(tmp_path / "blade.toml")
    with pytest.raises(ValueError, match=r"blade.yaml., but must be a file that ends in .toml or .json"):
        load_config(tmp_path / "blade.yaml")
