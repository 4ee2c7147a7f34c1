"""A plant's fingerprint: the same for what a controller cannot tell apart, another one for any other plant."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.plant.fingerprint import fingerprint


@pytest.fixture(scope="module")
def plant():
    return build_plant(blade_config())


def test_the_sign_of_a_mode_shape_is_no_property_of_the_plant(plant):
    sign = np.ones(len(plant.A))
    sign[[3, 3 + len(sign) // 2]] = -1.0
    turned = replace(
        plant,
        A=sign[:, None] * plant.A * sign,
        B=sign[:, None] * plant.B,
        C=plant.C * sign,
        disturbance_input=sign[:, None] * plant.disturbance_input,
        tip_displacement=plant.tip_displacement * sign,
    )
    assert fingerprint(turned) == fingerprint(plant)


def test_last_digits_do_not_tell(plant):
    generator = np.random.default_rng(0)
    blurred = {name: getattr(plant, name) * (1.0 + 1e-13 * generator.standard_normal(getattr(plant, name).shape)) for name in "ABC"}
    assert fingerprint(replace(plant, **blurred)) == fingerprint(plant)


@pytest.mark.parametrize("name", ["A", "B", "C", "disturbance_input", "tip_displacement", "input_weight", "voltage_limits"])
def test_a_thousandth_more_is_another_plant(plant, name):
    assert fingerprint(replace(plant, **{name: 1.001 * getattr(plant, name)})) != fingerprint(plant)


@pytest.mark.parametrize("change", [{"damping_ratio": 0.02}, {"modes": 5}, {"voltage_limits": (-500.0, 1500.0)}, {"speed": 201.0}])
def test_another_blade_is_another_plant(plant, change):
    assert fingerprint(build_plant(blade_config(overrides=change))) != fingerprint(plant)
