"""Loads and sensors of one's own on a blade that moves as a plant file says: those that the file has."""

import json
from dataclasses import replace

import numpy as np
import pytest

from baselines.design.modelling_errors import modelling_errors
from beamenv import RotatingBeamEnv, blade_config, load_plant, modal_plant_of, save_plant
from beamenv.blade.build import Blade
from beamenv.blade.load_shapes import LoadShape
from beamenv.task import resolve_task

SENSORS = [
    {"kind": "accelerometer", "position": 1.5, "point": [0.05, 0.01], "direction": [0.3, 1.0, 0.2], "range": 400.0},
    {"kind": "charge"},
    {"kind": "current"},
    {"kind": "velocity"},
    {"kind": "displacement", "direction": [1.0, 0.0, 0.0]},
    {"kind": "strain-gauge", "position": 0.5, "wall": "top", "angle_deg": 20.0},
]
LOADS = [{"position": 1.0, "direction": [1.0, 1.0, 0.0]}, {"shape": "base"}, {"shape": "line", "span": [0.5, 1.5]}]
CONFIG = replace(blade_config(overrides={"sensors": SENSORS}), loads=tuple(LoadShape(**each) for each in LOADS))


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("plants") / "own.npz"
    save_plant(modal_plant_of(CONFIG), path)
    return str(path)


def test_loads_and_sensors_come_back_from_a_file(path):
    plant = load_plant(path)
    assert plant == modal_plant_of(CONFIG)
    assert [each["kind"] for each in json.loads(plant.sensor_list)] == ["accelerometer", "velocity", "displacement", "strain-gauge"]
    assert plant.first(5).further_loads.shape == (5, 3) and plant.first(5).sensor_rate.shape == (4, 5)


def answer(plant, s):
    """Readings per voltage and load (p, m + k) at a complex frequency, 1/s, in full scales."""
    inputs = np.hstack([plant.B, plant.disturbance_input])
    return plant.C @ np.linalg.solve(s * np.eye(len(plant.A)) - plant.A, inputs) / plant.sensor_full_scale[:, None]


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 0)])
def test_a_plant_saved_from_a_blade_moves_and_shows_as_the_blade(path, order):
    loads, sensors = [LOADS[k] for k in order], SENSORS[:: 1 if len(order) == 3 else -1]
    alone, given = (
        resolve_task(blade={"sensors": sensors}, scenario={"loads": loads, "plants": plants}).plant
        for plants in ({}, {"truth": path})
    )
    assert given.sensors == alone.sensors and given.disturbances == alone.disturbances
    for name in ("C", "D", "disturbance_input", "strain", "sensor_noise", "sensor_full_scale"):
        own, there = getattr(given, name), getattr(alone, name)
        np.testing.assert_allclose(own, there, rtol=0.0, atol=1e-12 * np.abs(there).max())
    for s in (30.0j, 300.0j):
        own, there = (answer(plant, s) for plant in (given, alone))
        np.testing.assert_allclose(own, there, rtol=0.0, atol=1e-9 * np.abs(there).max())


def test_a_file_that_tells_no_static_readings_has_the_beam_s_of_gauges_and_its_own_modes_of_points(path, tmp_path):
    plain = replace(load_plant(path), sensor_static=None, sensor_static_rate=None)
    save_plant(plain, tmp_path / "plain.npz")
    sensors = [SENSORS[5], SENSORS[4]]
    known, plain_one = (
        resolve_task(blade={"sensors": sensors}, scenario={"plants": {"truth": file}}).plant
        for file in (path, str(tmp_path / "plain.npz"))
    )
    gauge, point = (np.abs(each) for each in answer(known, 1.0j)[:, :4] - answer(plain_one, 1.0j)[:, :4])
    assert gauge.max() < 1e-12 and 0.0 < point.max() < 0.02 * np.abs(answer(known, 1.0j)[1, :4]).max()


def test_a_blade_without_sensor_patches_is_kept_in_a_file(tmp_path):
    changes = {"patches": {"sensors": []}, "sensors": [{"kind": "accelerometer"}]}
    save_plant(modal_plant_of(blade_config("aluminium-cantilever", changes)), tmp_path / "strip.npz")
    scenario = {"plants": {"truth": str(tmp_path / "strip.npz")}}
    env = RotatingBeamEnv("aluminium-cantilever", blade=changes, scenario=scenario)
    env.reset(seed=0)
    assert np.isfinite(env.step(np.ones(1))[0]).all()


def test_an_episode_with_a_file_feels_loads_of_one_s_own(path):
    scenario = {"preset": "quiet", "plants": {"truth": path}, "loads": [{**LOADS[0], "magnitude": 5.0}]}
    env = RotatingBeamEnv(blade={"sensors": SENSORS}, scenario=scenario)
    still = RotatingBeamEnv(blade={"sensors": SENSORS}, scenario={**scenario, "loads": []})
    for each in (env, still):
        each.reset(seed=0)
    for _ in range(20):
        felt, nothing = env.step(np.zeros(4))[0], still.step(np.zeros(4))[0]
    assert np.any(felt) and not np.any(nothing)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (
            {"scenario": {"loads": [{}]}},
            r"scenario.loads\[0\] is .*, but must be one of its loads, \[{'shape': 'point', 'pos",
        ),
        (
            {"blade": {"sensors": [{"kind": "charge"}, {"kind": "velocity", "position": 1.0}]}},
            r"blade.sensors\[1\] is .*, but must be one of its sensors besides its patches, \[{'position': 1.5",
        ),
    ],
)
def test_what_a_file_has_not_is_said_in_one_sentence(path, arguments, sentence):
    for truth, said in (
        (path, sentence),
        ("solid-blade", "but must be left out, for it has no (loads|sensors besides)"),
    ):
        scenario = {**arguments.get("scenario", {}), "plants": {"truth": truth}}
        with pytest.raises(ValueError, match=said):
            resolve_task(**{**arguments, "scenario": scenario})


def test_the_solid_has_charges_too():
    plant = resolve_task(blade={"sensors": [{"kind": "charge"}]}, scenario="solid").plant
    assert [each.unit for each in plant.sensors] == ["C"] * 4


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"load_places": ""}, "plant.load_places has 0 tables, but must have 3, as many as plant.further_loads has."),
        ({"load_places": "{}"}, "plant.load_places is '{}', but must be empty or the text of a JSON list of objects."),
        ({"sensor_rate": None}, "plant.sensor_list has 4 tables, but must have 0, as many as plant.sensor_rate has."),
        ({"sensor_position": np.zeros((4, 3))}, "plant.sensor_position has shape"),
        ({"further_loads": None}, "plant.load_places has 3 tables, but must have 0"),
    ],
)
def test_signals_that_cannot_be_are_refused_in_one_sentence(changes, sentence):
    with pytest.raises(ValueError) as refusal:
        replace(modal_plant_of(CONFIG), **changes)
    assert sentence in str(refusal.value)


def test_a_table_that_is_no_load_is_told_with_its_file(tmp_path):
    plant = replace(modal_plant_of(CONFIG), load_places=json.dumps([{"shape": "moment"}, {}, {}]))
    save_plant(plant, tmp_path / "wrong.npz")
    with pytest.raises(ValueError, match=r"wrong.npz.*plant.loads\[0\].shape is 'moment'"):
        resolve_task(scenario={"plants": {"truth": str(tmp_path / "wrong.npz")}})


def test_mistaken_blades_have_their_sensors_and_loads():
    plants = modelling_errors(Blade(CONFIG), 2)
    for plant in plants:
        assert (len(plant.C), plant.disturbance_input.shape[1]) == (12, 5)
        assert np.isfinite(plant.A).all()
