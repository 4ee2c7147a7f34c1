"""Poles of sampled systems and their damping."""

import numpy as np
import pytest

from beamenv.plant.poles import damping_ratios, poles_of_sampled


def test_each_pair_of_poles_has_one_damping_ratio():
    poles = np.array([-1.0 + 10.0j, -1.0 - 10.0j, -2.0, -3.0])
    np.testing.assert_allclose(np.sort(damping_ratios(poles)), [1.0 / np.sqrt(101.0), 1.0])


def test_poles_that_alternate_from_sample_to_sample_are_counted_in_pairs_too():
    """A negative pole of a sampled system has the logarithm −… + iπ/Δt alone, and no conjugate beside it."""
    found = poles_of_sampled(np.diag([-0.5, -0.4, 0.9, 0.8]), 0.1)
    assert np.count_nonzero(found.imag > 0.0) == 2
    ratios = damping_ratios(found)
    assert len(ratios) == 2
    assert ratios.max() == pytest.approx(1.0)
