"""Whether a model's modes die away, and whether voltages reach and sensors see each of them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matrix_balance

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

OUT_OF_REACH = 1e-9
"""Of the largest singular value of [A − sI, B]: a smallest one below is none, but for rounding."""


def check_modes(A: Array, B: Array, C: Array, interval: float | None) -> None:
    """``ValueError`` that names the first mode which does not die away, which no voltage reaches or no sensor sees.

    Of ẋ = A x + B u, y = C x, or of x⁺ = A x + B u sampled every ``interval`` s; by the test of Popov, Belevitch and Hautus.
    """
    poles = np.linalg.eigvals(A).astype(complex)
    rates = poles if interval is None else np.log(np.where(poles == 0.0, np.finfo(float).tiny, poles)) / interval
    balanced, (scale, order) = matrix_balance(A, permute=False, separate=True)
    drive, seen = _unit(B / scale[:, None]), _unit((C * scale).T)
    one_each = [k for k in np.argsort(np.abs(rates)) if poles[k].imag >= 0.0]
    for number, k in enumerate(one_each, start=1):
        for what in _hindrances(balanced, drive, seen, poles[k], rates[k]):
            raise ValueError(f"A has {_named(number, rates[k])}{what}")


def _hindrances(A: Array, drive: Array, seen: Array, pole: complex, rate: complex) -> Iterator[str]:
    if not rate.real < 0.0:
        yield " that is unstable, but every mode must die away by itself."
    if _out_of_reach(A, drive, pole):
        yield " that no voltage reaches: leave it out of the model."
    if _out_of_reach(A.T, seen, pole):
        yield " that no sensor sees: leave it out of the model."


def _out_of_reach(A: Array, inputs: Array, pole: complex) -> bool:
    values = np.linalg.svd(np.hstack([A - pole * np.eye(len(A)), inputs * max(np.abs(A).max(), 1e-300)]), compute_uv=False)
    return bool(values[-1] <= OUT_OF_REACH * values[0])


def _named(number: int, rate: complex) -> str:
    omega = abs(rate)
    return f"mode {number} at {omega:.5g} rad/s ({omega / (2.0 * np.pi):.4g} Hz)"


def _unit(inputs: Array) -> Array:
    """Columns of length 1, so that units do not matter."""
    sizes = np.linalg.norm(inputs, axis=0)
    return inputs / np.where(sizes > 0.0, sizes, 1.0)
