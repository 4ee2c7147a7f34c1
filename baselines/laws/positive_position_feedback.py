"""Positive position feedback: each pair of patches drives the blade through filters tuned to its first modes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import block_diag

from baselines.analysis.stationary import stationary_cost
from baselines.design.controller import Array
from baselines.design.instruments import checked_plant
from baselines.design.linear import LinearController
from baselines.design.loop import sampled
from baselines.design.matrix import one_or_each
from baselines.design.verification import verified
from baselines.laws.gain_search import least_cost_gains
from baselines.laws.lqg import observer
from baselines.laws.velocity_feedback import pairing
from beamenv.configuration import Count, Number, checked
from beamenv.plant.hold import hold
from beamenv.plant.plant import Plant

NAME = "positive position feedback"

POSITIVE, LARGEST = Number(gt=0.0), Number(le=1e6)

FILTER_DAMPING = 0.3
"""ζ_f of every filter: wide enough for a mode that is some per cent off."""

LEAK = 0.05
"""Corner of the charge integrator over the first natural frequency: 3° of phase there, and offsets are forgotten."""

_GAINS = np.logspace(-3.0, 0.0, 16)
"""Common gains tried first."""


def positive_position_feedback(
    plant: Plant,
    gain: ArrayLike | None = None,
    modes: int | None = None,
    filter_damping: float = FILTER_DAMPING,
    leak: float = LEAK,
    *,
    verify: bool = True,
) -> LinearController:
    """Voltages u_j = Σ_k g_k q_k / c_j, with a filter for each of the first ``modes`` natural frequencies on each pair of patches:
    by default three, or as many as the plant has.

        q̈_k + 2 ζ_f ω_k q̇_k + ω_k² q_k = ω_k² q,        q̇ = y_j − (leak ω_1) q,

    filters the sensor's charge q, because the sensor shows the rate of strain and positive position feedback needs strain. c_j is
    the charge that one volt on the same pair causes at rest, so that a single mode with a single filter is stable if and only if
    g < 1 (Fanson and Caughey, AIAA Journal 28, 1990). With ganged drive the one voltage answers the mean of the sensors.

    ``gain`` gives the g_k: an array (modes,), or one number for all. By default they are the gains with the least stationary cost
    under the plant's white loads and sensor noise, among stable loops: first the best common gain of a few, then each by itself
    (Nelder and Mead's simplex). The filters are integrated exactly from sample to sample, with the newest reading held over the
    interval that ends with it. The loop is ``verified`` on ``plant`` unless ``verify=False``. Raises ValueError if sensors and
    actuators cannot be paired, for modes, damping, leak or gains that are not allowed, and if the loop is unstable with the given
    gains or with every gain that was tried.
    """
    known = len(checked_plant(plant).natural_frequencies)
    count = min(3, known) if modes is None else checked("modes", modes, Count(1, known))
    filter_damping, leak = (
        checked(name, checked(name, value, POSITIVE), LARGEST)
        for name, value in (("filter_damping", filter_damping), ("leak", leak))
    )
    frequencies = plant.natural_frequencies[:count]
    pairs = pairing(plant, NAME)
    filters = _held_filters(frequencies, filter_damping, leak * frequencies[0], plant.control_interval)

    def law(gains: ArrayLike) -> LinearController:
        return _law(plant, pairs, filters, np.broadcast_to(np.asarray(gains, dtype=np.float64), count))

    if gain is None:
        held = sampled(plant)
        gains = least_cost_gains(lambda each: stationary_cost(held, law(each)), _GAINS, count, NAME, xatol=np.inf, maxiter=400)
    else:
        gains = one_or_each("gain", gain, count, "mode")
    return verified(law(gains), plant, instead="smaller gains", verify=verify)


def _held_filters(frequencies: Array, damping: float, corner: float, interval: float) -> tuple[Array, Array]:
    """Transition (s, s) and input (s,) of one pair's states [charge; q_k, q̇_k/ω_k of each filter] under a held current."""
    size = 1 + 2 * len(frequencies)
    dynamics = np.zeros((size, size))
    dynamics[0, 0] = -corner
    for k, omega in enumerate(frequencies):
        at = 1 + 2 * k
        dynamics[at, at + 1] = dynamics[at + 1, 0] = omega
        dynamics[at + 1, at : at + 2] = -omega, -2.0 * damping * omega
    with np.errstate(all="ignore"):  # of numbers too large nothing finite is left, which verification tells
        transition, held_input = hold(dynamics, np.eye(size, 1), interval)
    return transition, held_input[:, 0]


def _law(plant: Plant, pairs: Array, filters: tuple[Array, Array], gains: Array) -> LinearController:
    """The filters' states at t_k, F ξ + G y, make the voltage."""
    transition, held_input = filters
    charge_per_volt = np.diag(pairs @ -plant.C @ np.linalg.solve(plant.A @ plant.A, plant.B))
    outputs = np.zeros(len(transition))
    outputs[1::2] = gains
    F = block_diag(*[transition] * len(pairs))
    G: Array = block_diag(*[held_input[:, None]] * len(pairs)) @ pairs
    M = block_diag(*(outputs / each for each in charge_per_volt))
    return observer(plant, NAME, F, G, np.zeros((len(F), len(pairs))), M @ F, M @ G)
