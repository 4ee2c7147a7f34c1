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


UNSTABLE, UNDAMPED = "is unstable", "has no damping"
DRIFTS = "drifts without end (a rigid body, an integrator)"
MUST_END = ", but every mode must die away by itself"
REMEDIES = {
    UNSTABLE: f"{MUST_END}.",
    UNDAMPED: f"{MUST_END}: say how well it is damped.",
    DRIFTS: f"{MUST_END}: leave it out, or hold it by a spring.",
}
"""What is said of each to end the sentence."""

MARGINAL = 1e-9
"""Damping ratio below which none can be told from none at all."""

AT_REST, NOTHING = 1e-7, 1e-14
"""Frequencies over that of the fastest pole: below the first, poles drift unless they die away without a swing, for two equal ones
at zero are rounded to a pair of some 10⁻⁸; below the second, no pole can be told from one at zero."""


def check_modes(A: Array, B: Array, C: Array, interval: float | None) -> None:
    """``ValueError`` that names the first mode which does not die away, which no voltage reaches or no sensor sees.

    Of ẋ = A x + B u, y = C x, or of x⁺ = A x + B u sampled every ``interval`` s.
    """
    poles = np.linalg.eigvals(A).astype(complex)
    rates = poles if interval is None else np.log(np.where(poles == 0.0, np.finfo(float).tiny, poles)) / interval
    balanced, (scale, _) = matrix_balance(A, permute=False, separate=True)
    reached = _reached(balanced, _unit(B / scale[:, None]), poles)
    seen = _reached(balanced.T, _unit((C * scale).T), poles)
    fastest = float(np.abs(rates[poles != 0.0] if interval is not None else rates).max(initial=0.0))
    slow = np.abs(rates) <= AT_REST * fastest
    drifting = (np.abs(rates) <= NOTHING * fastest) | (slow if np.any(rates[slow].real > -0.5 * np.abs(rates[slow])) else False)
    one_each = [k for k in np.argsort(np.abs(rates)) if poles[k].imag >= 0.0]
    for number, k in enumerate(one_each, start=1):
        if wrong := (([DRIFTS] if drifting[k] else _lasts(rates[k])) + _out_of_reach(reached[k], seen[k])):
            raise ValueError(f"A has {_named(number, rates[k])} that {' and that '.join(wrong)}{_remedy(wrong[0])}")


def _lasts(rate: complex) -> list[str]:
    """Why a mode that does not drift does not die away, if it does not."""
    if rate.real < -MARGINAL * abs(rate):
        return []
    return [UNSTABLE] if rate.real > MARGINAL * abs(rate) else [UNDAMPED]


def _out_of_reach(reached: bool, seen: bool) -> list[str]:
    return [what for there, what in ((reached, "no voltage reaches"), (seen, "no sensor sees")) if not there]


def _remedy(what: str) -> str:
    return REMEDIES.get(what, ": leave it out of the model.")


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
