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


def swinging(poles: NDArray[np.complex128]) -> tuple[Array, Array]:
    """Natural frequencies (r,), rad/s, ascending, and damping ratios (r,) of the pairs among a system's poles."""
    pairs = poles[poles.imag > 0.0]
    pairs = pairs[np.argsort(np.abs(pairs))]
    return np.abs(pairs), -pairs.real / np.abs(pairs)


def damping_ratios(poles: NDArray[np.complex128]) -> Array:
    """ζ = −Re s/|s| (r,) of a real system's 2r poles, by ascending |s|: of one of each pair, and of every second one that has no
    conjugate, a real one or, of a sampled system, one that alternates from sample to sample.
    """
    above = poles[poles.imag > 0.0]
    apart = np.abs(above[:, None] - poles.conj()[None, :])
    paired = np.any(apart <= 1e-9 * np.abs(above)[:, None], axis=1)
    alone = np.concatenate([poles[poles.imag == 0.0], above[~paired]])
    one_each = np.concatenate([above[paired], alone[np.argsort(np.abs(alone))][::2]])
    one_each = one_each[np.argsort(np.abs(one_each))]
    return np.asarray(-one_each.real / np.abs(one_each))
