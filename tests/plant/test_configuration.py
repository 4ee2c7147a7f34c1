"""Configurations as dictionaries and files."""

import json

import pytest

from beamenv.blade.build import build_beam, build_plant, plant_of
from beamenv.blade.changed import changed_blade
from beamenv.blade.files import from_dict, load_config, to_dict
from beamenv.blade.presets import PRESETS, blade_config


@pytest.mark.parametrize("preset", PRESETS)
def test_every_preset_survives_json_and_builds(preset):
    config = blade_config(preset)
    assert from_dict(json.loads(json.dumps(to_dict(config)))) == config
    assert build_plant(config).B.shape == (2 * config.modes, config.patches.channels("actuators"))


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


THESIS_WORLD = {"model": "thesis", "beam": {"shear_flow": "consistent"}}


@pytest.mark.parametrize("changes", [{"model": "thesis"}, THESIS_WORLD, {"beam": {"steady_state": "linear"}}])
def test_a_model_survives_json_and_reaches_the_beam(changes):
    config = blade_config(overrides=changes)
    assert from_dict(json.loads(json.dumps(to_dict(config)))) == config
    beam = build_beam(changed_blade(config, 1.1, 1.0, 1.0, 1.0, 0.01))
    assert beam.model == config.model and beam.steady_state == config.beam.steady_state


def test_files_that_name_the_consistent_shear_flow_and_no_model_load(tmp_path):
    path = tmp_path / "blade.json"
    path.write_text(json.dumps({"beam": {"shear_flow": "consistent"}}))
    assert load_config(path).model == "blade"


def test_the_thesis_model_has_the_shear_flow_of_the_thesis_unless_told_otherwise():
    """Off-axis walls that cannot relax are stiffer: the first frequency at rest rises."""
    thesis, named, consistent = (
        build_beam(blade_config(overrides=changes, speed=0.0)).natural_frequencies(0.0, 1)[0]
        for changes in ({"model": "thesis"}, {"model": "thesis", "beam": {"shear_flow": "thesis"}}, THESIS_WORLD)
    )
    assert thesis == named > 1.02 * consistent


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"model": "beam"}, "blade.model is 'beam', but must be one of blade, thesis."),
        (
            {"beam": {"shear_flow": "thesis"}},
            "blade.beam.shear_flow is 'thesis', but must be None or consistent, or come with model = 'thesis'.",
        ),
        (
            {"model": "thesis", "beam": {"steady_state": "linear"}},
            "blade.beam.steady_state is 'linear', but must be None with model = 'thesis'.",
        ),
    ],
)
def test_what_a_model_has_not_is_refused(changes, message):
    with pytest.raises(ValueError) as refused:
        blade_config(overrides=changes)
    assert str(refused.value) == message


def test_a_plant_takes_no_beam_of_another_model():
    config = blade_config(overrides={"model": "thesis"})
    with pytest.raises(ValueError, match=r"^beam.model is 'blade', but must be the blade's, 'thesis'\.$"):
        plant_of(config, build_beam(blade_config()))
