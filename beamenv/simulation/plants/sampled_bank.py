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
    readings are normalised, loads in N/m. Where sensors feel voltages, what readings show of those before are further states of
    each plant, one for each sensor, behind its own.
    """

    A: Array
    """(K, n, n)."""
    B: Array
    """(K, n, m)."""
    E: Array
    """(K, n, k)."""
    C: Array
    """(K, p, n)."""
    cost: Array
    """(K, n + m + k, n + m + k), J s, symmetric."""


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
    driven = n + bank.plant.B.shape[1]
    plants = SampledBank(moved[..., :n], moved[..., n:driven], moved[..., driven:], bank.readout.swapaxes(-1, -2), cost)
    return _with_feedthrough(plants, bank.feedthrough) if bank.feedthrough.any() else plants


def _with_feedthrough(plants: SampledBank, felt: Array) -> SampledBank:
    """With states D u (K, p) of the interval before, D = ``felt`` (K, p, m)."""
    (K, p, _), n, size = felt.shape, plants.A.shape[1], plants.cost.shape[1]
    own = np.concatenate([np.arange(n), np.arange(n + p, p + size)])
    cost = np.zeros((K, p + size, p + size))
    cost[:, own[:, None], own] = plants.cost
    A = np.zeros((K, n + p, n + p))
    A[:, :n, :n] = plants.A
    E = np.concatenate([plants.E, np.zeros((K, p, plants.E.shape[2]))], axis=1)
    C = np.concatenate([plants.C, np.tile(np.eye(p), (K, 1, 1))], axis=2)
    return SampledBank(A, np.concatenate([plants.B, felt], axis=1), E, C, cost)
