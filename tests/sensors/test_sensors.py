"""Sensors of one's own in environments: accelerometers alone, together with patches, on plants that vary, in pictures."""

import json
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from baselines.laws.reference_lqg import reference_lqg
from beamenv.blade import Blade, blade_config, from_dict, to_dict
from beamenv.simulation.blades import Blades
from beamenv.task import resolve_task

ALL = [
    {"kind": "accelerometer", "position": 0.25, "noise": 0.01},
    {"kind": "strain-gauge", "position": 0.07, "wall": "strip", "angle_deg": 45.0},
    {"kind": "charge"},
    {"kind": "current"},
    {"kind": "velocity", "direction": [0.0, 1.0, 0.0]},
    {"kind": "displacement", "range": 0.004},
]
MIXED = {"sensors": ALL}
ACCELEROMETER = {"patches": {"sensors": []}, "sensors": [{"kind": "accelerometer"}]}


def make(**arguments):
    return gym.make(beamenv.ENV_ID, preset="aluminium-cantilever", dtype="float64", **arguments)


def test_each_sensor_has_a_reading_with_its_range_and_noise():
    plant = make(blade=MIXED).unwrapped.task.plant
    assert [each.unit for each in plant.sensors] == ["m/s²", "", "C", "A", "m/s", "m"]
    assert plant.sensor_full_scale[5] == 0.004
    noise = np.sqrt(np.diag(plant.sensor_noise) / plant.control_interval) / plant.sensor_full_scale
    assert noise == pytest.approx([0.01, *[0.02] * 5])
    env = make(blade=MIXED, physical_units=True)
    assert env.observation_space.high == pytest.approx(plant.sensor_full_scale)


def test_ranges_are_twice_the_largest_reading_after_a_sudden_reference_load():
    task = make(blade=MIXED).unwrapped.task
    quiet = {"step": 1.0, "pulse": 0.0, "deflection": 0.0, "harmonic": 0.0, "white_load": False, "sensor_noise": False}
    sudden = {**quiet, "magnitude": 30.0, "onset": 0.0, "direction_deg": [90.0, 90.0]}
    blades = Blades(task.plant, beamenv.scenario(sudden), 1)
    generator = np.random.default_rng(0)
    blades.begin(generator)
    largest = np.max([np.abs(blades.step(np.zeros((1, 1)), generator).observation[0]) for _ in range(400)], axis=0)
    assert largest[[1, 2, 3, 4]] == pytest.approx(0.5, rel=0.1)  # the filters round the current's peaks
    assert 0.2 < largest[0] < 0.6


def test_an_accelerometer_at_the_clamp_needs_a_range():
    at_the_clamp = {"sensors": [{"kind": "accelerometer", "position": 0.0}]}
    with pytest.raises(ValueError, match=r"blade.sensors\[0\].range is None, but must be given where .* moves no reading"):
        make(blade=at_the_clamp)
    make(blade={"sensors": [{"kind": "accelerometer", "position": 0.0, "range": 10.0}]})


def test_a_point_beyond_all_blades_is_refused():
    with pytest.raises(ValueError, match=r"blade.sensors\[0\].point"):
        make(blade={"sensors": [{"kind": "accelerometer", "point": [1e200, 0.0]}]})


def test_an_accelerometer_alone_is_enough_to_halve_the_cost():
    task, count = resolve_task("aluminium-cantilever", blade=ACCELEROMETER), 16
    assert np.any(task.design_plant.D)
    law, costs = reference_lqg(task.design.full_plant), []
    for controlled in (False, True):
        blades, generators = Blades(task.bank, task.scenario, count), [np.random.default_rng(k) for k in range(count)]
        motion, memory, cost = blades.begin(generators), None, 0.0
        for _ in range(task.steps):
            action = np.zeros((count, 1))
            if controlled:
                action, memory = law.predict(motion.observation, memory)
            motion = blades.step(action, generators)
            cost += motion.cost_increment.mean()
        costs.append(cost)
    assert costs[1] < 0.5 * costs[0]


def test_single_and_batched_environments_read_the_same():
    env, envs = make(blade=MIXED), gym.make_vec(beamenv.ENV_ID, 2, preset="aluminium-cantilever", blade=MIXED, dtype="float64")
    seen, together = env.reset(seed=4)[0], envs.reset(seed=[3, 4])[0]
    assert np.array_equal(seen, together[1])
    for action in np.random.default_rng(0).uniform(-1.0, 1.0, (50, 1)):
        seen, together = env.step(action)[0], envs.step(np.stack([action, action]))[0]
    np.testing.assert_allclose(seen, together[1], rtol=1e-9)
    assert np.isfinite(seen).all() and np.any(seen)


def test_plants_that_vary_are_read_in_one_range():
    chosen = {"plants": {"modulus_ratio": [0.8, 1.2], "bank": 3, "design_modes": 3}, "drive": {"delay": [0, 2]}}
    task = make(blade=MIXED, scenario=chosen).unwrapped.task
    assert len(task.bank) == 3
    assert np.array_equal(task.design_plant.sensor_full_scale, task.plant.sensor_full_scale)


def test_sensors_are_kept_in_files():
    config = blade_config("aluminium-cantilever", MIXED)
    assert from_dict(json.loads(json.dumps(to_dict(config)))) == config
    assert blade_config("aluminium-cantilever", ACCELEROMETER).patches.groups("sensors") == ()


def test_sensors_are_in_the_picture():
    for blade in (MIXED, ACCELEROMETER):
        env = make(blade=blade, render_mode="rgb_array")
        env.reset(seed=0)
        picture = env.render()
        env.step(np.ones(1))
        assert np.any(env.render() != picture)


def test_full_scale_of_a_rotating_blade_counts_what_turning_brings():
    """Along the span the axis of an accelerometer tilts in the centrifugal field: that, not q̈ alone, is seen."""
    sensors = {"sensors": [{"kind": "accelerometer"}]}
    turning, still = (Blade(blade_config("sound-blade", sensors, speed)).plant for speed in (100.0, 0.0))
    assert np.abs(turning.C - still.C).max() > 0.05 * np.abs(still.C).max()


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"blade": {"sensors": [{"kind": "gyroscope"}]}}, r"blade.sensors\[0\].kind is 'gyroscope', but must be one of current,"),
        ({"blade": {"sensors": [{"position": 0.1}]}}, r"blade.sensors\[0\].kind is None, but must be one of"),
        ({"blade": {"sensors": [{"kind": "strain-gauge"}]}}, r"position"),
        ({"blade": {"sensors": [{"kind": "strain-gauge", "position": 0.4, "wall": "strip"}]}}, r"blade.sensors\[0\] is 'at 0.4 m"),
        ({"blade": {"sensors": [{"kind": "strain-gauge", "position": 0.1}]}}, r"blade.sensors\[0\] is 'at 0.1 m on top'"),
        ({"blade": {"sensors": [{"kind": "velocity", "position": 0.31}]}}, r"blade.sensors\[0\].position is 0.31"),
        ({"blade": {"sensors": [{"kind": "velocity", "direction": [0, 0, 0]}]}}, "direction is"),
        ({"blade": {"sensors": [{"kind": "charge", "group": 1}]}}, r"blade.sensors\[0\].group is 1, but must be below 1"),
        ({"blade": {"patches": {"sensors": []}}}, "blade.sensors is"),
        (
            {"blade": {"sensors": [{"kind": "charge"}], "sensor_full_scale": 1e-6}},
            "blade.sensor_full_scale is 1e-06, but must be None",
        ),
        ({"blade": {**ACCELEROMETER, "electronics": {"filter_cutoff": None}}}, "blade.electronics.filter_cutoff is None"),
        ({"blade": {**MIXED, "model": "thesis"}}, "blade.sensors is .* model = 'thesis'"),
    ],
)
def test_sensors_that_cannot_be_are_refused_in_one_sentence(arguments, sentence):
    with pytest.raises(ValueError, match=sentence):
        make(**arguments).unwrapped.task.plant  # noqa: B018


def test_ganged_patches_have_one_charge():
    config = blade_config("airfoil-blade", {"sensors": [{"kind": "charge"}]})
    groups = tuple(replace(group, ganged=True) for group in config.patches.sensors)
    ganged = Blade(replace(config, patches=replace(config.patches, sensors=groups))).plant
    np.testing.assert_allclose(Blade(config).plant.C.sum(axis=0), ganged.C[0], rtol=1e-9)
