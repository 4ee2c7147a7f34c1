"""A filter that knows of clipped readings: LQG itself until they clip, and unbiased where LQG is misled."""

import numpy as np
import pytest

from baselines import PersistentLoad, lqg
from baselines.laws.clipped_lqg import clipped_lqg
from beamenv.plant.plant import sample


@pytest.mark.parametrize("load", [None, PersistentLoad()])
def test_it_is_lqg_as_long_as_no_reading_clips(small_plant, load):
    plant, random = small_plant(), np.random.default_rng(5)
    law, plain = clipped_lqg(plant, load), lqg(plant, persistent_load=load)
    memory = plain_memory = None
    for begins in np.arange(200) % 70 == 0:
        observation, start = 0.3 * random.normal(size=(4, 2)), np.array([False, begins, False, True])
        action, memory = law.predict(observation, memory, start)
        expected, plain_memory = plain.predict(observation, plain_memory, start)
        assert np.abs(memory @ law.output.T / law.full_scale).max() < 1.0
        np.testing.assert_allclose(action, expected, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(memory, plain_memory, rtol=1e-9, atol=1e-12)


def final_errors(plant, amplitude, steps=2400):
    """Error of each filter's prediction over the size of the state, after vibration of ``amplitude`` full scales in mode 1."""
    held = sample(plant)
    laws = {law.name: law for law in (lqg(plant), clipped_lqg(plant))}
    errors = {}
    for name, law in laws.items():
        x, memory = np.zeros(6), None
        x[0] = amplitude * plant.sensor_full_scale[0] / np.abs(plant.C[:, 3]).max()
        worst = 0.0
        for k in range(steps):
            reading = np.clip(held.C @ x / plant.sensor_full_scale, -1.0, 1.0)
            action, memory = law.predict(reading, memory)
            x = held.A @ x + held.B @ (action * law.instruments.voltage_scale)
            if k >= steps - 70:  # two periods of the first mode
                worst = max(worst, np.linalg.norm(memory - x) / np.linalg.norm(x))
        errors[name] = worst
    return errors


def test_readings_far_beyond_full_scale_mislead_lqg_but_not_the_filter_that_knows(small_plant):
    plant = small_plant(A=_undamped(small_plant()), voltage_limits=np.array([[-1e-3, -1e-3], [1e-3, 1e-3]]))
    errors = final_errors(plant, amplitude=5.0)
    assert errors["LQG"] > 0.5
    assert errors["LQG, clipping known"] < 1e-3


def _undamped(plant):
    """A blade that goes on vibrating, so that readings stay clipped."""
    A = plant.A.copy()
    A[3:, 3:] -= np.diag(np.diag(A)[3:])
    return A
