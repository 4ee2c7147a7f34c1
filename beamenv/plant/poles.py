"""Poles: what those of a sampled system mean in continuous time, and how well damped they are."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def poles_of_sampled(transition: Array, interval: float) -> NDArray[np.complex128]:
    """Continuous equivalents log(z)/Δt (n,) of a sampled system's poles, rad/s, in ascending order of magnitude."""
    with np.errstate(divide="ignore"):  # z = 0 is infinitely fast
        found = np.log(np.linalg.eigvals(transition).astype(complex)) / interval
    return np.asarray(found[np.argsort(np.abs(found))])


def damping_ratios(poles: NDArray[np.complex128]) -> Array:
    """ζ = −Re s/|s| (r,) of a real system's 2r poles, by ascending |s|: of one of each pair, and of every second real pole."""
    real = poles[poles.imag == 0.0]
    one_each = np.concatenate([poles[poles.imag > 0.0], real[np.argsort(np.abs(real))][::2]])
    one_each = one_each[np.argsort(np.abs(one_each))]
    return np.asarray(-one_each.real / np.abs(one_each))
