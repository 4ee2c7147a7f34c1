"""Modes that nothing damps and that no voltage, no sensor or no load reaches: for them regulator or filter have no solution."""

from __future__ import annotations

import numpy as np

from baselines.design.controller import Array
from beamenv.plant.plant import SampledPlant

_UNDAMPED = 1e-11
"""Less than this share of its amplitude is lost in an interval: no damping at all, but for rounding."""

_OUT_OF_REACH = 1e-9
"""Of what the best mode is reached with: not at all, but for rounding."""


def undamped_out_of_reach(held: SampledPlant) -> str | None:
    """The first such mode in words, such as "mode 2 at 700 rad/s, undamped, which no voltage reaches"; None: there is none.

    Left and right eigenvectors wᵀ and v of x⁺ = A x + B u + E d, y = C x tell what reaches a mode: wᵀB, wᵀE and C v.
    """
    poles, right = np.linalg.eig(held.A)
    left = np.linalg.pinv(right)
    reached = {"no voltage reaches": _rows(left @ held.B), "no sensor sees": _rows((_in_units(held.C) @ right).T)}
    reached["no white load drives"] = _rows(left @ held.disturbance_input @ held.process_noise)
    frequencies = np.abs(np.log(poles.astype(complex))) / held.interval
    one_each = [k for k in np.argsort(frequencies) if poles[k].imag >= 0.0]
    for number, k in enumerate(one_each, start=1):
        hindrances = [words for words, sizes in reached.items() if sizes[k] <= _OUT_OF_REACH * sizes.max(initial=0.0)]
        if hindrances and np.abs(poles[k]) > 1.0 - _UNDAMPED:
            return f"mode {number} at {frequencies[k]:.6g} rad/s, undamped, which {' and '.join(hindrances)}"
    return None


def _rows(matrix: Array) -> Array:
    return np.asarray(np.linalg.norm(matrix, axis=1))


def _in_units(C: Array) -> Array:
    sizes = _rows(C)
    return C / np.where(sizes > 0.0, sizes, 1.0)[:, None]
