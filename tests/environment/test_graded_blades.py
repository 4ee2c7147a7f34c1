"""Blades with graded walls from a file to an episode: written, read, told apart, varied, and under several of them at once."""

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from beamenv.blade import build_plant, from_dict, to_dict
from beamenv.blade.changed import changed_blade
from beamenv.blade.files import load_config
from beamenv.configuration import read
from beamenv.plant.fingerprint import fingerprint

FILE = """
[beam.material]
inner = "ti-6al-4v"
outer = "zirconia"
exponent = 2
"""


@pytest.fixture
def config(tmp_path):
    (tmp_path / "graded.toml").write_text(FILE)
    return load_config(tmp_path / "graded.toml")


def test_a_blade_is_read_as_it_is_written_and_its_fingerprint_tells_the_exponent(config):
    again = from_dict(to_dict(config))
    assert again == config and hash(again) == hash(config)
    other = read(config, {"beam": {"material": {"exponent": 3.0}}})
    assert other.beam.material.inner == "ti-6al-4v"
    assert fingerprint(build_plant(again)) == fingerprint(build_plant(config)) != fingerprint(build_plant(other))


def test_an_environment_is_made_again_from_its_specification(config):
    env = gym.make(beamenv.ENV_ID, blade=config, duration=0.01)
    first, _ = env.reset(seed=4)
    again = gym.make(gym.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    assert np.array_equal(first, again.reset(seed=4)[0])


def test_a_stiffer_and_heavier_blade_scales_both_materials(config):
    changed = changed_blade(config, 1.0, 1.0, 1.1, 0.9, 0.01)
    was, now = (each.beam.material.constituents for each in (config, changed))
    assert [each.E1 for each in now] == pytest.approx([1.1 * each.E1 for each in was])
    assert [each.density for each in now] == pytest.approx([0.9 * each.density for each in was])
    frequencies = [beamenv.build_plant(each).natural_frequencies[0] for each in (config, changed)]
    assert frequencies[1] > frequencies[0]


@pytest.mark.slow
def test_plants_of_a_bank_differ_in_the_moduli_of_both_materials(config):
    env = gym.make(beamenv.ENV_ID, blade=config, scenario={"plants": {"modulus_ratio": [0.8, 1.2]}}, duration=0.005)
    found = set()
    for seed in range(3):
        env.reset(seed=seed)
        found.add(env.step(np.zeros(env.action_space.shape))[0].tobytes())
    assert len(found) == 3


def test_a_partial_table_departs_from_what_stood_there():
    config = beamenv.blade_config("thesis", {"beam": {"material": {"inner": "sus304", "outer": "alumina", "exponent": 1.0}}})
    metal = read(config, {"beam": {"material": "aluminium"}})
    assert metal.beam.material == "aluminium"
    with pytest.raises(ValueError, match=r"^blade.beam.material.outer is missing"):
        read(metal, {"beam": {"material": {"inner": "sus304", "exponent": 1.0}}})
    with pytest.raises(ValueError, match=r"^blade.beam.material has no field 'E1': its fields are inner, outer, exponent"):
        read(metal, {"beam": {"material": {"inner": "sus304", "outer": "alumina", "exponent": 1.0, "E1": 7e10}}})
    soft = {"E1": 1e4, "E2": 1e4, "G12": 1e4 / 2.6, "G13": 1e4 / 2.6, "G23": 1e4 / 2.6, "nu12": 0.3, "density": 900.0}
    with pytest.raises(
        ValueError, match=r"^blade.beam.material.inner.E1 is 10000.0 \(did you give MPa\?\), but must be at least 1e"
    ):
        read(config, {"beam": {"material": {"inner": soft}}})
