"""ERA by python-control: models of every order from Markov parameters, and which of their poles stay where they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines.identification.innovation_model import InnovationModel, in_modes
from baselines.identification.observer import Observer
from beamenv.configuration.read_only import ReadOnly
from beamenv.plant.poles import poles_of_sampled

Array = NDArray[np.float64]

HANKEL_ROWS = 640
"""Of the block Hankel matrix, about: its singular values take the time."""
LONGEST = 160
"""Blocks of it, at most."""
FREQUENCY_STAYS, DAMPING_STAYS = 0.01, 0.05
"""A pole is stable whose frequency changes by less than this share from an order to the next, and whose damping ratio by less than
this share (Heylen, Lammens and Sas, Modal Analysis Theory and Testing, 1997: 1 % and 5 %)."""
OVERDAMPED = 0.2
"""Damping ratio beyond which a pole is no mode of a structure but electronics, or noise."""


@dataclass(frozen=True, slots=True, eq=False)
class Realisation(ReadOnly):
    """Balanced models of one record: that of order r are the first r states."""

    A: Array
    inputs: Array
    """[B K] (n, m + p)."""
    C: Array
    covariance: Array
    interval: float
    singular_values: Array
    """Of the block Hankel matrix, descending."""

    def model(self, order: int) -> InnovationModel:
        """The model of so many states."""
        m = self.inputs.shape[1] - len(self.C)
        B, K = self.inputs[:order, :m], self.inputs[:order, m:]
        return in_modes(self.A[:order, :order], B, self.C[:, :order], K, self.covariance, self.interval).steadied()

    def stabilisation(self, step: int = 2) -> Stabilisation:
        """Poles of every ``step``-th order."""
        orders = range(step, len(self.A) + 1, step)
        return Stabilisation.of({order: poles_of_sampled(self.A[:order, :order], self.interval) for order in orders})


@dataclass(frozen=True, slots=True, eq=False)
class Stabilisation(ReadOnly):
    """Poles over the order: those of structures stay where they are."""

    order: Array
    """(k,)."""
    frequency: Array
    """(k,), rad/s."""
    damping_ratio: Array
    """(k,)."""
    stable: NDArray[np.bool_]
    """(k,): within a share of a pole of the order before, in frequency and in damping."""

    @classmethod
    def of(cls, poles: dict[int, NDArray[np.complex128]]) -> Stabilisation:
        """Of the poles (rad/s) of ascending orders; those with a damping ratio of ``OVERDAMPED`` and more are left out."""
        rows, before = [], np.zeros((0, 2))
        for order, each in poles.items():
            finite = each[np.isfinite(each) & (each.imag > 0.0)]
            found = np.stack([np.abs(finite), -finite.real / np.abs(finite)], axis=1)
            found = found[(found[:, 1] < OVERDAMPED) & (found[:, 1] > 0.0)]
            rows += [(order, *one, float(_stays(one, before))) for one in found]
            before = found
        columns = np.array(rows).reshape(-1, 4)
        return cls(columns[:, 0], columns[:, 1], columns[:, 2], columns[:, 3] > 0.0)


def _stays(pole: Array, before: Array) -> bool:
    near = np.abs(before - pole) <= pole * np.array([FREQUENCY_STAYS, DAMPING_STAYS])
    return bool(near.all(axis=1).any())


def realise(seen: Observer, interval: float, largest_order: int) -> Realisation:
    """Models of up to ``largest_order`` states from an observer, sampled at ``interval`` (s)."""
    import control

    p = len(seen.covariance)
    blocks = min(LONGEST, max(HANKEL_ROWS // p, -(-largest_order // p) + 1))
    markov = seen.markov(2 * blocks + 1)
    padded = np.concatenate([np.zeros((1, *markov.shape[1:])), markov]).transpose(1, 2, 0)
    order = min(largest_order, blocks * p)
    system, values = control.eigensys_realization(padded, order, m=blocks, n=blocks, dt=True)
    A, inputs, C = (np.array(part, dtype=np.float64) for part in (system.A, system.B, system.C))
    return Realisation(A, inputs, C, seen.covariance, interval, np.asarray(values, dtype=np.float64))
