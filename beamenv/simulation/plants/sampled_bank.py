"""The plants of a bank over one control interval, as matrices: the very numbers that blades move by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.simulation.plants.bank import Bank

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class SampledBank:
    """K plants x⁺ = A x + B u + E d, y = C x, zᵀ cost z J s an interval with z = [x; u; d], as ``SampledPlant`` has one.

    States are in the axes in which they move (``Bank.axes``), of the following plant where plants follow one another; voltages and
    readings are normalised, loads in N/m.
    """

    A: Array
    """(K, n, n)."""
    B: Array
    """(K, n, m)."""
    E: Array
    """(K, n, 2)."""
    C: Array
    """(K, p, n)."""
    cost: Array
    """(K, n + m + 2, n + m + 2), J s, symmetric."""


def sampled_bank(bank: Bank) -> SampledBank:
    """All plants of a bank, of one group or of several, one after the other."""
    operators = bank.operators
    n, lagging, size = operators.states, operators.lagging, operators.fused.shape[-2]
    fused, weights = operators.fused.reshape(-1, *operators.fused.shape[-2:]), operators.weights.reshape(len(bank), -1)
    moved = np.zeros((len(fused), n, size))
    moved[:, : n - lagging] = fused[..., : n - lagging].swapaxes(-1, -2)
    kept = np.arange(n - lagging, n)
    moved[:, kept, kept] = operators.decay
    moved[:, kept, kept + lagging] = 1.0 - operators.decay
    half = np.zeros((len(fused), size, size))
    half[..., operators.crossing :] = fused[..., operators.costs : operators.costs + size - operators.crossing]
    diagonal = np.arange(weights.shape[1])
    half[:, diagonal, diagonal] += weights
    cost = 0.5 * (half + half.swapaxes(-1, -2))
    return SampledBank(moved[..., :n], moved[..., n : size - 2], moved[..., size - 2 :], bank.readout.swapaxes(-1, -2), cost)
