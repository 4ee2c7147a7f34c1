"""The one stepping kernel: NumPy arrays and torch tensors (gradients included), any leading batch axes."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.plant.plant import Plant, SampledPlant, sample, sample_all


@dataclass(frozen=True, slots=True, eq=False)
class Operators:
    """What one step needs, fused into one product; arrays of NumPy or of torch.

    One plant for all blades, for each block of them, or for each: ``fused`` then has their leading axes. With
    z = [state, voltages, loads] (row vectors, size s = n + m + 2) ``z @ fused`` is
    [next state (n) | its noise-free sensor output (p) | its tip displacement (2) | z @ cost (s)].
    """

    fused: Any
    """(s, n + p + 2 + s), or (..., s, n + p + 2 + s) with the blocks' or the blades' own axes."""
    states: int
    outputs: int

    @classmethod
    def from_plant(cls, plant: Plant) -> Operators:
        """Operators of a plant held over its control interval, as float64 NumPy arrays."""
        return cls(_fused(plant, sample(plant)), states=len(plant.A), outputs=len(plant.C))

    @classmethod
    def from_plants(cls, plants: Sequence[Plant]) -> Operators:
        """Those of several plants of one size and one control interval; ``fused`` has an axis for them."""
        fused = np.stack([_fused(plant, held) for plant, held in zip(plants, sample_all(plants), strict=True)])
        return cls(fused, states=len(plants[0].A), outputs=len(plants[0].C))

    def convert(self, to_array: Callable[[Any], Any]) -> Operators:
        """The same operators with a copy of each array passed through ``to_array``, say ``torch.as_tensor``."""
        return replace(self, fused=to_array(self.fused.copy() if isinstance(self.fused, np.ndarray) else self.fused))

    def pick(self, index: Any) -> Operators:
        """The operators of one plant of several, or of one for each blade."""
        return Operators(self.fused[index], self.states, self.outputs)


def _fused(plant: Plant, held: SampledPlant) -> NDArray[np.float64]:
    step = np.hstack([held.A, held.B, held.disturbance_input])
    fused = np.hstack([step.T, (plant.C @ step).T, (plant.tip_displacement @ step).T, held.cost])
    return np.ascontiguousarray(fused)


def advance(
    operators: Operators, joined: Any, out: Any = None, multiply: Callable[[Any, Any, Any], Any] | None = None
) -> tuple[Any, Any, Any, Any]:
    """One control interval, exactly.

    ``joined`` (..., n + m + 2) is [state, voltages (V), line loads (N/m)]. Returns the next state (..., n), the
    noise-free sensor output there (..., p) in A, the tip displacement there (..., 2) in m (lag, flap), and the
    increment of J over the interval (...,) in J s. With NumPy, ``out`` (..., n + m + 2 + n + p + 2) may be given to
    hold the product, and the first three arrays are then views of it. ``multiply`` stands in for ``row_product``.
    """
    n, p = operators.states, operators.outputs
    product = (multiply or row_product)(joined, operators.fused, out)
    increment = row_dot(product[..., n + p + 2 :], joined)
    return product[..., :n], product[..., n : n + p], product[..., n + p : n + p + 2], increment


def row_product(rows: Any, matrix: Any, out: Any = None) -> Any:
    """Rows (..., k) times one matrix (k, l), each block of rows (b, i, k) times its own (b, k, l), or each row times its own
    (..., k, l); with NumPy, ``out`` may hold the result.
    """
    if matrix.ndim > max(rows.ndim, 2):
        each = rows[..., None, :]
        return (each @ matrix if out is None else np.matmul(each, matrix, out[..., None, :]))[..., 0, :]
    if out is None:
        return rows @ matrix
    return np.dot(rows, matrix, out) if rows.ndim == 1 else np.matmul(rows, matrix, out)  # for one row, dot starts faster


def row_dot(left: Any, right: Any) -> Any:
    """Scalar products (...,) over the last axis of two NumPy arrays or torch tensors."""
    if not isinstance(left, np.ndarray):
        return (left * right).sum(-1)
    return left.dot(right) if left.ndim == 1 else np.einsum("...i,...i->...", left, right)


def namespace(values: Any) -> Any:
    """The module whose functions take the array: NumPy, or torch for its tensors."""
    return np if isinstance(values, (np.ndarray, np.generic)) else sys.modules["torch"]
