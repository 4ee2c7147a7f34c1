"""What plants differ in, in words."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade import blade_config
from beamenv.blade.build import build_plant
from beamenv.plant.differences import differences
from beamenv.plant.fingerprint import fingerprint


@pytest.fixture(name="plant", scope="module")
def _plant():
    return build_plant(blade_config())


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"patches": {"actuators": 3}}, "3 voltages in place of 4"),
        ({"patches": {"actuators": 3, "sensors": 2}}, "3 voltages in place of 4, 2 sensors in place of 4"),
        ({"modes": 9}, "9 modes in place of 11"),
        ({"control_interval": 4e-4}, "a control interval of 0.0004 s in place of 0.0005"),
        ({"voltage_limits": (-500.0, 1500.0)}, "and down to -500 V in place of -1500"),
        ({"damping_ratio": 0.02}, "another full scale of its sensors, other noise of its sensors"),
        ({"sensor_noise_fraction": 0.03}, "other noise of its sensors"),
        ({"effort_weight": 0.1}, "another price of voltages"),
        ({"beam": {"length": 2.1}}, "a first natural frequency of "),
    ],
)
def test_what_was_changed_is_named(plant, changes, words):
    changed = build_plant(blade_config(overrides=changes))
    assert fingerprint(changed) != fingerprint(plant)
    assert words in differences(changed, plant)


def test_what_no_field_tells_is_in_the_answers(plant):
    assert differences(replace(plant, A=plant.A - 0.1 * np.eye(len(plant.A))), plant) == "other answers to voltages and loads"
