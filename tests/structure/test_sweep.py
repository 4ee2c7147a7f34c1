import os
import subprocess
import sys

import numpy as np
import pytest

from beamenv.blade.config import BeamConfig
from beamenv.structure.sweep import frequency_sweep
from train.shared.threads import ONE_THREAD

BOX = BeamConfig(ply_angles_deg=(0.0,) * 6, pretwist_deg=0.0)
BLADE = BeamConfig().build()


@pytest.mark.parametrize("gyroscopic", [True, False])
@pytest.mark.parametrize("motions", [None, ("lag", "extension")])
def test_sweep_gives_each_speeds_own_frequencies(gyroscopic, motions):
    speeds = [0.0, 130.0, 400.0]
    swept = frequency_sweep(BLADE, speeds, 5, motions, gyroscopic)
    alone = [BLADE.natural_frequencies(speed, 5, motions, gyroscopic) for speed in speeds]
    np.testing.assert_allclose(swept, alone, rtol=1e-8)


@pytest.mark.parametrize("gyroscopic", [True, False])
def test_between_steady_states_frequencies_follow_them_to_1e_7(gyroscopic):
    """A sweep of many speeds works out few steady states: at speeds between them, against each speed's own."""
    speeds = np.linspace(0.0, 300.0, 41)
    swept = frequency_sweep(BLADE, speeds, 8, gyroscopic=gyroscopic)
    picked = [1, 7, 20, 33, 40]
    alone = [BLADE.natural_frequencies(speeds[k], 8, gyroscopic=gyroscopic) for k in picked]
    np.testing.assert_allclose(swept[picked], alone, rtol=1e-7)


def test_sweep_goes_on_past_the_critical_speed():
    box = BOX.build(model="thesis")
    speeds = [0.5 * box.critical_speed, 1.05 * box.critical_speed]
    swept = frequency_sweep(box, speeds, 3, ("lag", "extension"))
    assert swept[1, 0] == pytest.approx(0.0, abs=1e-3)
    np.testing.assert_allclose(swept[1], box.natural_frequencies(speeds[1], 3, ("lag", "extension")), rtol=1e-7, atol=1e-3)


def test_many_blades_stack_along_the_first_axis():
    blades = [BeamConfig(taper=taper).build() for taper in (1.0, 2.0)]
    swept = frequency_sweep(blades, [100.0, 200.0], 4)
    assert swept.shape == (2, 2, 4)
    np.testing.assert_allclose(swept[1, 0], blades[1].natural_frequencies(100.0, 4), rtol=1e-8)


TWO_HUNDRED_SPEEDS = """
import time, numpy
from beamenv.blade.config import BeamConfig
from beamenv.structure.sweep import frequency_sweep
from train.shared.threads import ONE_THREAD
blade = BeamConfig(terms=10).build()
blade.matrices  # assembled once, not counted
start = time.process_time()
frequency_sweep(blade, numpy.linspace(0.0, 400.0, 200), 6)
print(time.process_time() - start)
"""


def test_two_hundred_speeds_of_ten_terms_take_less_than_two_seconds():
    """Of one processor and one BLAS thread: more would wait for each other and count that as work."""
    one = {**os.environ, **ONE_THREAD}
    run = subprocess.run([sys.executable, "-c", TWO_HUNDRED_SPEEDS], env=one, check=True, capture_output=True, text=True)
    assert float(run.stdout) < 2.0


@pytest.mark.parametrize("speeds", [[-1.0], [np.nan], [[100.0]]])
def test_speeds_must_be_a_row_of_numbers_from_zero(speeds):
    with pytest.raises(ValueError, match="speeds"):
        frequency_sweep(BLADE, speeds)


def test_count_must_not_exceed_the_trial_functions():
    with pytest.raises(ValueError, match="count is 97"):
        frequency_sweep(BLADE, [0.0], 97)
