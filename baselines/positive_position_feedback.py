"""Positive position feedback: each pair of patches drives the blade through filters tuned to its first modes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import block_diag, expm
from scipy.optimize import minimize

from baselines.controller import Array, LinearController
from baselines.lqg import observer
from baselines.stationary import stationary_cost
from baselines.velocity_feedback import pairing
from beamenv.plant import Plant

FILTER_DAMPING = 0.3
"""ζ_f of every filter: wide enough for a mode that is some per cent off."""

LEAK = 0.05
"""Corner of the charge integrator over the first natural frequency: 3° of phase there, and offsets are forgotten."""

_GAINS = 10.0 ** np.linspace(-3.0, 0.0, 16)
"""Common gains tried first."""


def positive_position_feedback(
    plant: Plant, gain: ArrayLike | None = None, modes: int = 3, filter_damping: float = FILTER_DAMPING, leak: float = LEAK
) -> LinearController:
    """u_j = Σ_k g_k q_k / c_j with, for each of the first ``modes`` natural frequencies ω_k and each pair j of patches, a filter

        q̈_k + 2 ζ_f ω_k q̇_k + ω_k² q_k = ω_k² q,        q̇ = y_j − (leak ω_1) q,

    of the sensor's charge q, for positive position feedback wants the strain and the sensor tells its rate; c_j is the charge that
    a volt on the same pair brings about at rest, so that one mode, fed back alone, is stable as long as g < 1 (Fanson and
    Caughey, AIAA Journal 28, 1990). Ganged drive takes the sensors' mean.

    ``gain`` (modes,) are the g_k. By default those of least stationary cost under the plant's white loads and sensor noise, among
    stable loops: the best common one of a few, then each for itself from there (Nelder and Mead's simplex). Integrated exactly
    from sample to sample, with the newest reading held over the interval that it ends. Raises ValueError when sensors and
    actuators cannot be paired, or for gains, modes, damping or leak that are not allowed.
    """
    _check(plant, modes, filter_damping, leak)
    pairs = pairing(plant, "positive position feedback")
    chain = _filters(plant.natural_frequencies[:modes], filter_damping, leak * plant.natural_frequencies[0])
    transition, charging = _held(chain, plant.control_interval)
    if gain is None:
        gains = _least_cost_gains(plant, lambda trial: _law(plant, pairs, transition, charging, trial), modes)
    else:
        gains = np.asarray(gain, dtype=np.float64)
        if gains.shape not in ((), (modes,)) or not np.isfinite(gains).all():
            raise ValueError(f"gain = {gain!r} must be a finite number, or {modes} of them, one for each mode")
    return _law(plant, pairs, transition, charging, np.broadcast_to(gains, modes))
