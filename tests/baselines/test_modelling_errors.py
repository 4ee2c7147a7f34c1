"""Blades as they may turn out: what is mistaken in them, by how much, and what is not."""

import numpy as np
import pytest

from baselines.design import modelling_errors as errors
from beamenv import blade_config
from beamenv.blade.build import Blade

CONFIG = blade_config("thesis")


@pytest.fixture(name="blade", scope="module")
def _blade():
    return Blade(CONFIG)


def test_without_errors_a_mistaken_blade_is_the_blade_itself(blade, monkeypatch):
    monkeypatch.setattr(errors, "FREQUENCY", (0.0, 0.0))
    monkeypatch.setattr(errors, "SHAPE", (0.0, 0.0))
    (same,) = errors.modelling_errors(blade, 1)
    for name in ("A", "B", "C", "disturbance_input", "state_weight", "input_weight", "sensor_noise", "sensor_full_scale"):
        one, other = getattr(same, name), getattr(blade.truth, name)
        assert one == pytest.approx(other, rel=1e-9, abs=1e-9 * np.abs(other).max()), name


def test_the_first_frequency_is_known_best_and_none_is_off_by_more_than_an_eighth(blade):
    plants, omega = errors.modelling_errors(blade, 40), blade.truth.natural_frequencies
    first = np.array([each.natural_frequencies[0] for each in plants]) / omega[0] - 1.0
    assert 0.01 < np.abs(first).max() <= 0.02 + 1e-12
    every = np.array([each.natural_frequencies for each in plants])
    assert every.min(axis=0) == pytest.approx(every.min(axis=0).clip(0.88 * omega - 1e-9, None))
    assert every.max(axis=0) == pytest.approx(every.max(axis=0).clip(None, 1.12 * omega + 1e-9))
    assert np.abs(every[:, -1] / omega[-1] - 1.0).max() > 0.05


def test_where_a_model_ends_the_blade_goes_on_up_to_the_nyquist_frequency():
    few = Blade(blade_config("thesis", {"modes": 5, "truth_modes": 5}))
    for plant in errors.modelling_errors(few, 3):
        further = plant.natural_frequencies[5:]
        assert 20 < len(further) <= errors.MOST - 5
        assert few.truth.natural_frequencies[-1] < further.max() < np.pi / CONFIG.control_interval


def test_equal_seeds_draw_equal_errors(blade):
    one, same, other = (errors.modelling_errors(blade, 1, seed)[0].B for seed in (0, 0, 1))
    assert np.array_equal(one, same)
    assert not np.array_equal(one, other)
