"""Plants of blades of finite elements: against those of polynomials, as the mesh grows finer, and as a truth for control."""

from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from baselines import no_control, reference_lqg, stationary_cost
from baselines.placement.model.contributions import contributions
from beamenv.blade import BeamConfig, BladeConfig
from beamenv.blade.build import Blade
from beamenv.blade.files import from_dict, load_config, to_dict
from beamenv.blade.load_shapes import LoadShape
from beamenv.plant.files import save_plant

ELEMENTS = {"discretisation": "finite-elements"}
MODES = 11


def blade(speed=200.0, **way):
    return Blade(BladeConfig(beam=BeamConfig(**way), speed=speed))


def tip_per_volt(blade):
    """(2, m), m/V."""
    return blade.full.tip @ np.linalg.solve(blade.beam.at(blade.config.speed).stiffness, blade.full.forces)


def largest(found, reference):
    return np.abs(found - reference).max() / np.abs(reference).max()


def turned(plant, reference):
    """B and C of a plant's modes with the signs of another's."""
    force, charge = (each[MODES:] for each in (plant.B, plant.C.T))
    other, sensed = (each[MODES:] for each in (reference.B, reference.C.T))
    sign = np.sign(
        (force * other).sum(axis=1) / np.abs(other).max() ** 2 + (charge * sensed).sum(axis=1) / np.abs(sensed).max() ** 2
    )
    return sign[:, None] * force, sign[:, None] * charge, other, sensed


@pytest.fixture(scope="module")
def fine():
    return blade(**ELEMENTS, elements=24)


@pytest.mark.parametrize(
    ("way", "frequencies", "forces"), [(ELEMENTS, 1e-5, 1e-4), ({}, 2e-4, 0.025), ({"terms": 30}, 1e-4, 0.0125)]
)
def test_default_plant_is_that_of_a_finer_mesh(fine, way, frequencies, forces):
    """Default elements: frequencies within 3e-6, B and C within 4e-5 of their largest; polynomials, which the edges of patches
    bend: 1.5e-4 and 2.1 % with sixteen, 7e-5 and 1 % with thirty. R, of local strains, is the same by rounding.
    """
    plant, reference = blade(**way).plant, fine.plant
    assert np.abs(plant.natural_frequencies / reference.natural_frequencies - 1.0).max() < frequencies
    force, charge, other, sensed = turned(plant, reference)
    assert largest(force, other) < forces
    assert largest(charge, sensed) < forces
    assert plant.input_weight == pytest.approx(reference.input_weight, rel=1e-12, abs=1e-18)


def test_tip_per_volt_settles_as_the_mesh_at_patches_grows_finer():
    """At rest: within 2e-6 with twelve elements, where sixteen polynomials are 2.2 % too high and thirty 1 %."""
    few, usual, fine = (tip_per_volt(blade(0.0, **ELEMENTS, elements=count)) for count in (4, 12, 24))
    assert largest(few, fine) < 1e-4
    assert largest(usual, fine) < 2e-6
    sixteen, thirty = (tip_per_volt(blade(0.0, terms=terms)) / fine - 1.0 for terms in (16, 30))
    assert sixteen.max() == pytest.approx(0.024, abs=0.002)
    assert thirty.max() == pytest.approx(0.012, abs=0.002)


def test_law_designed_on_polynomials_is_as_good_on_finite_elements(fine):
    """J of the reference LQG, over that without control: 0.3177 on the plant it knows, 0.3195 on the true one of elements; the law
    that knows the elements gains 0.1 %.
    """
    known = blade().with_fixed_range()
    truth = Blade(replace(known.config, beam=BeamConfig(**ELEMENTS)))
    laws = [reference_lqg(each.truth) for each in (known, truth)]
    without = stationary_cost(truth.truth, no_control(truth.plant))
    costs = [stationary_cost(truth.truth, law) for law in laws]
    assert costs[0] / costs[1] == pytest.approx(1.0, abs=3e-3)
    assert costs[0] / without == pytest.approx(0.32, abs=0.01)


@pytest.mark.parametrize("model", ["blade", "thesis"])
def test_an_environment_of_finite_elements_runs(model):
    env = gym.make(beamenv.ENV_ID, blade={"model": model, "beam": {**ELEMENTS, "elements": 4, "element_order": 3}}, duration=0.05)
    observation, _ = env.reset(seed=0)
    truncated = False
    while not truncated:
        observation, reward, _, truncated, _ = env.step(np.zeros(env.action_space.shape, dtype=np.float32))
        assert np.isfinite(reward)
    assert np.isfinite(observation).all()


def test_blade_files_keep_the_mesh(tmp_path):
    beam = BeamConfig(**ELEMENTS, mesh=(0.0, 0.1, 0.4, 1.0), element_order=3)
    assert from_dict(to_dict(BladeConfig(beam=beam))).beam == beam
    written = tmp_path / "blade.toml"
    written.write_text('[beam]\ndiscretisation = "finite-elements"\nmesh = [0, 0.1, 0.4, 1]\nelement_order = 3\n', encoding="utf-8")
    assert load_config(written).beam == beam


def test_patches_are_placed_by_polynomials_whatever_the_blade_is_made_of():
    one, other = (contributions(blade(**way).config) for way in (ELEMENTS, {}))
    assert np.array_equal(one.bare_frequencies, other.bare_frequencies)
    assert np.array_equal(one.actuator_force, other.actuator_force)


@pytest.mark.parametrize(
    "held",
    [
        {"temperature_table": ((0.0, 290.0), (0.4, 350.0), (1.0, 300.0))},
        {"temperature": 300.0, "tip_springs": (0.0, 0.0, 1e9, 0.0, 0.0, 0.0)},
    ],
    ids=["heated along the span", "heated and held"],
)
def test_heat_and_springs_act_on_elements_as_on_polynomials(held):
    """Five frequencies of an aluminium blade at 100 rad/s within 2e-6."""
    metal = replace(BeamConfig(material="aluminium").build(), **held)
    one, other = (replace(metal, **way).natural_frequencies(100.0, 5) for way in ({**ELEMENTS, "element_order": 5}, {"terms": 24}))
    assert np.abs(one / other - 1.0).max() < 2e-6


def test_what_moves_may_be_of_elements_and_what_is_known_of_polynomials(tmp_path):
    """By a plant file, as the solid blade is: the law for polynomials is within 1 % of the one that is told the truth."""
    elements = BladeConfig(beam=BeamConfig(**ELEMENTS), modes=21)
    save_plant(beamenv.modal_plant_of(elements), tmp_path / "elements.npz")
    task = gym.make(beamenv.ENV_ID, scenario={"plants": {"truth": str(tmp_path / "elements.npz")}}).unwrapped.task
    known, told = reference_lqg(task.design.full_plant), reference_lqg(task.plant)
    costs = [stationary_cost(task.plant, law) for law in (known, told)]
    assert costs[1] < 0.35 * stationary_cost(task.plant, no_control(task.plant))
    assert costs[0] / costs[1] == pytest.approx(1.0, abs=0.01)


def test_sensors_and_loads_of_elements_read_as_those_of_polynomials():
    """Strain gauges, one of them within the clamp's layer, and an accelerometer: by mode within 0.6 % of the largest. A force and a
    line load over part of the span, and the clamp's motion, move the tip alike within 7e-4."""
    gauges = [{"kind": "strain-gauge", "position": place, "wall": "top"} for place in (0.02, 0.7)]
    sensors = [*gauges, {"kind": "accelerometer", "position": 1.9, "direction": [0.0, 1.0, 0.0]}]
    loads = LoadShape(), LoadShape(shape="line", span=(0.3, 1.1), profile=(0.2, 1.0)), LoadShape(shape="base")
    read, moved = [], []
    for way in (ELEMENTS, {}):
        blade = Blade(replace(beamenv.blade_config("thesis", {"sensors": sensors, "beam": way}), loads=loads))
        read.append(np.abs(blade.plant.C))
        moved.append(blade.full.tip @ np.linalg.solve(blade.beam.at(200.0).stiffness, blade.further_loads))
    assert np.all(np.abs(read[0] - read[1]).max(axis=1) < 6e-3 * read[0].max(axis=1))
    assert np.abs(moved[1] / moved[0] - 1.0).max() < 1e-3
