"""Blades just below their critical speed, whose first mode is almost without stiffness."""

import time

import numpy as np
import pytest

from beamenv.blade.build import Blade
from beamenv.blade.presets import blade_config
from beamenv.plant.reduction import MOST_SAMPLES

THESIS = Blade(blade_config(overrides={"model": "thesis"}))


def plant_at(share):
    return Blade(blade_config(overrides={"model": "thesis", "speed": THESIS.beam.critical_speed * (1.0 - share)})).plant


def test_the_range_of_sensors_is_found_in_bounded_time_however_slow_the_blade_is():
    """0.07 rad/s at 1e-9 below the critical speed: five periods are 900,000 intervals, of which 20,000 are looked at."""
    begun = time.process_time()
    plant = plant_at(1e-9)
    assert time.process_time() - begun < 3.0
    assert 5.0 * 2.0 * np.pi / plant.natural_frequencies[0] / plant.control_interval > 40 * MOST_SAMPLES
    assert np.isfinite(plant.sensor_full_scale).all()


def test_a_blade_whose_stiffness_is_rounding_is_refused():
    with pytest.raises(ValueError, match="^speed is .*, but must be (at least 0 and below|one at which)"):
        plant_at(1e-14)
