"""A measured structure, struck once: what is identified beside what its publisher found by other means."""

from pathlib import Path

import numpy as np
import pytest

from baselines import identify, read_measurement

RATE = 1280.0
PUBLISHED = 212.092530551
"""Hz, by the publisher's fit of a transfer function that an analyser averaged (see tests/data/struck_structure.txt)."""


@pytest.fixture(scope="module")
def struck():
    file = Path(__file__).parents[1] / "data" / "struck_structure.csv"
    return identify(read_measurement(file, interval=1.0 / RATE, before=True))


def the_mode(struck):
    hertz = struck.modes.frequency / (2.0 * np.pi)
    k = np.abs(hertz - PUBLISHED).argmin()
    return hertz[k], struck.modes.frequency_spread[k] / (2.0 * np.pi), struck.modes.damping_ratio[k]


def test_a_struck_structure_has_the_frequency_that_its_publisher_finds_in_averaged_spectra(struck):
    hertz, spread, _ = the_mode(struck)
    assert abs(hertz - PUBLISHED) < 4.0 * spread
    assert spread < 2e-4 * PUBLISHED  # the record is 3.2 s long, which alone would tell 0.3 Hz


def test_its_damping_is_the_decay_of_the_record(struck):
    """By the root mean square of eighths, of which the second to the fifth are this mode and little else."""
    hertz, _, damping = the_mode(struck)
    eighths = struck.measurement.readings[: 8 * (len(struck.measurement) // 8), 0].reshape(8, -1)
    rate = -np.polyfit(np.arange(1, 5) * eighths.shape[1] / RATE, np.log(eighths[1:5].std(axis=1)), 1)[0]
    assert damping == pytest.approx(rate / (2.0 * np.pi * hertz), rel=0.15)  # it decays a little faster where it is large


def test_rows_held_back_are_predicted(struck):
    assert struck.fit.rows == round(0.25 * len(struck.measurement))
    assert struck.fit.one_step[0] > 0.9
