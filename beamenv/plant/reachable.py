"""Whether a model's modes die away, and whether voltages reach and sensors see each of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matrix_balance

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

OUT_OF_REACH = 1e-9
"""Of what vectors of their lengths could have: a product of an eigenvector below is none, but for rounding; of equal poles the
smallest singular value of [A − sI, B] over its largest."""

ALIKE = 1e-6
"""Distance of two poles over their magnitude, up to which they count as equal: eigenvectors then are any of their span."""


def check_modes(A: Array, B: Array, C: Array, interval: float | None) -> None:
    """``ValueError`` that names the first mode which does not die away, which no voltage reaches or no sensor sees.

    Of ẋ = A x + B u, y = C x, or of x⁺ = A x + B u sampled every ``interval`` s.
    """
    poles = np.linalg.eigvals(A).astype(complex)
    rates = poles if interval is None else np.log(np.where(poles == 0.0, np.finfo(float).tiny, poles)) / interval
    balanced, (scale, _) = matrix_balance(A, permute=False, separate=True)
    reached = _reached(balanced, _unit(B / scale[:, None]), poles)
    seen = _reached(balanced.T, _unit((C * scale).T), poles)
    one_each = [k for k in np.argsort(np.abs(rates)) if poles[k].imag >= 0.0]
    for number, k in enumerate(one_each, start=1):
        for wrong, what in (
            (not rates[k].real < 0.0, "that is unstable, but every mode must die away by itself."),
            (not reached[k], "that no voltage reaches: leave it out of the model."),
            (not seen[k], "that no sensor sees: leave it out of the model."),
        ):
            if wrong:
                raise ValueError(f"A has {_named(number, rates[k])} {what}")


def _reached(A: Array, inputs: Array, poles: Complex) -> list[bool]:
    """Whether the columns of ``inputs`` reach each mode of ẋ = A x, by its left eigenvector."""
    own, vectors = np.linalg.eig(A.T)
    found = []
    for pole in poles:
        near = np.abs(poles - pole) <= ALIKE * np.abs(pole)
        vector = vectors[:, np.argmin(np.abs(own - pole))]
        alone = np.count_nonzero(near) == 1
        found.append(bool(np.abs(vector @ inputs).max() > OUT_OF_REACH) if alone else _by_rank(A, inputs, pole))
    return found


def _by_rank(A: Array, inputs: Array, pole: complex) -> bool:
    """By the test of Popov, Belevitch and Hautus."""
    whole = np.hstack([A - pole * np.eye(len(A)), inputs * max(float(np.abs(A).max()), 1e-300)])
    values = np.linalg.svd(whole, compute_uv=False)
    return bool(values[-1] > OUT_OF_REACH * values[0])


def _named(number: int, rate: complex) -> str:
    omega = abs(rate)
    return f"mode {number} at {omega:.5g} rad/s ({omega / (2.0 * np.pi):.4g} Hz)"


def _unit(inputs: Array) -> Array:
    """Columns of length 1, so that units do not matter."""
    sizes = np.linalg.norm(inputs, axis=0)
    return inputs / np.where(sizes > 0.0, sizes, 1.0)
