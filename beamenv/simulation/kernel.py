"""The one stepping kernel: NumPy arrays and torch tensors (gradients included), any leading batch axes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import namespace
from beamenv.plant.plant import Plant, SampledPlant, sample, sample_all


@dataclass(frozen=True, slots=True, eq=False)
class Operators:
    """What one step needs, fused into one product; arrays of NumPy or of torch.

    One plant for all blades, for each block of them, or for each: the arrays then have their leading axes. With
    z = [state, voltages, disturbances] (row vectors, size s = n + m + k) ``z @ fused`` is
    [next state (n) | the sensors' output then (p), free of noise, the voltages still on | tip displacement (q) | z @ cost, columns
    from ``crossing`` on].
    What need not be multiplied is left out: outputs that are states, and the states of amplifiers, v⁺ = u + decay (v − u).

    The increment of J is zᵀ cost z. In axes of the state in which the cost of its first b numbers is diagonal
    (``plants.cost_axes``) these are the ``weights``, and the product needs few other columns of the cost.
    """

    fused: Any
    """(s, w), or (..., s, w) with the blocks' or the blades' own axes."""
    weights: Any
    """(b,), or (..., b), J s per J: cost of the squares of the first b states; b = 0 where all of it is in ``fused``."""
    states: int
    """n"""
    reads: slice
    """Columns of the product that are the outputs: among the next states where filters show them."""
    tips: int
    """Column in which the tip displacement begins."""
    displaced: int
    """q"""
    costs: int
    """Column in which those of the cost begin."""
    crossing: int
    """Numbers of z before this one have no cost but ``weights`` and that with later ones."""
    lagging: int = 0
    """How many of the states, the last, are the voltages that amplifiers give, and not in the product."""
    decay: float = 0.0
    """What is left after an interval of their distance from the voltages held."""

    @classmethod
    def from_plant(cls, plant: Plant) -> Operators:
        """Operators of a plant held over its control interval, in its own coordinates, as float64 NumPy arrays."""
        return cls._plain(plant, _fused(plant, sample(plant)), ())

    @classmethod
    def from_plants(cls, plants: Sequence[Plant]) -> Operators:
        """Those of several plants of one size and one control interval; the arrays have an axis for them."""
        fused = np.stack([_fused(plant, held) for plant, held in zip(plants, sample_all(plants), strict=True)])
        return cls._plain(plants[0], fused, (len(plants),))

    @classmethod
    def _plain(cls, plant: Plant, fused: Any, axes: tuple[int, ...]) -> Operators:
        n, p, q = len(plant.A), len(plant.C), len(plant.tip_displacement)
        tips, weights = n + p, np.zeros((*axes, 0))
        return cls(fused, weights, states=n, reads=slice(n, tips), tips=tips, displaced=q, costs=tips + q, crossing=0)

    def convert(self, to_array: Callable[[Any], Any]) -> Operators:
        """The same operators with a copy of each array passed through ``to_array``, say ``torch.as_tensor``."""
        fused, weights = (to_array(each.copy() if isinstance(each, np.ndarray) else each) for each in (self.fused, self.weights))
        return replace(self, fused=fused, weights=weights)

    def pick(self, index: Any) -> Operators:
        """The operators of one plant of several, or of one for each blade."""
        return replace(self, fused=self.fused[index], weights=self.weights[index])


def _fused(plant: Plant, held: SampledPlant) -> NDArray[np.float64]:
    step = np.hstack([held.A, held.B, held.disturbance_input])
    n, m = plant.B.shape
    read = plant.C @ step
    read[:, n : n + m] += plant.D  # the reading comes before the next voltage
    fused = np.hstack([step.T, read.T, (plant.tip_displacement @ step).T, held.cost])
    return np.ascontiguousarray(fused)


FEW = 8
"""Numbers so few that their sums are written out where they are compiled."""

Multiply = Callable[[Any, Any, Any], Any]
"""A stand-in for ``row_product``."""


class Views(NamedTuple):
    """Parts of what goes into a product and of what comes out of it."""

    crossing: Any
    """(…, s − ``crossing``) of what goes in: what has a cost with ``costs``."""
    lagging: tuple[Any, Any] | None
    """The amplifiers' voltages (…, m) and those held, where their states are not in the product."""
    product: Any
    """(…, first states that are)"""
    state: Any
    output: Any
    tip: Any
    costs: Any


def views_of(operators: Operators, joined: Any, product: Any) -> Views:
    """The parts of rows (…, s) that go in and of rows (…, w) that come out."""
    n, lag, tip, cost = operators.states, operators.lagging, operators.tips, operators.costs
    crossing = joined[..., operators.crossing :]
    return Views(
        crossing,
        (joined[..., n - lag : n], joined[..., n : n + lag]) if lag else None,
        product[..., : n - lag],
        product[..., :n],
        product[..., operators.reads],
        product[..., tip : tip + operators.displaced],
        product[..., cost : cost + crossing.shape[-1]],
    )


def advance(
    operators: Operators,
    joined: Any,
    out: Any = None,
    multiply: Multiply | None = None,
    squares: Any = None,
    views: Views | None = None,
) -> tuple[Any, Any, Any, Any]:
    """One control interval, exactly.

    ``joined`` (..., n + m + k) is [state, voltages (V), line loads (N/m)]. Returns the next state (..., n), the
    noise-free sensor output there (..., p) in A, the tip displacement there (..., q) in m (lag, flap), and the
    increment of J over the interval (...,) in J s. With NumPy, ``out`` (..., w) may be given to hold the product, and the first
    three arrays are then views of it. ``squares`` (..., b) are those of the first b states, and ``views`` the parts of ``joined``
    and ``out``, where they are known. ``multiply`` stands in for ``row_product``.
    """
    product = (multiply or row_product)(joined, operators.fused, out)
    parts = views_of(operators, joined, product) if views is None else views
    increment = row_dot(parts.costs, parts.crossing)
    diagonal = operators.weights.shape[-1]
    if diagonal:
        increment = increment + weighted(joined[..., :diagonal] ** 2 if squares is None else squares, operators.weights)
    state = parts.state if parts.lagging is None else _with_amplifiers(operators.decay, parts, out is not None)
    return state, parts.output, parts.tip, increment


def _with_amplifiers(decay: float, parts: Views, in_place: bool) -> Any:
    """The next state (..., n): that of blade and filters from the product, and the voltages that amplifiers then give."""
    assert parts.lagging is not None
    before, held = parts.lagging
    given = held + decay * (before - held) if decay else held
    if not in_place:
        return namespace(given).concatenate([parts.product, given], -1)
    parts.state[..., parts.product.shape[-1] :] = given  # in the place of what the cost no longer needs
    return parts.state


def weighted(squares: Any, weights: Any) -> Any:
    """Sums (...,) of squares (..., b) times weights (b,) or (..., b)."""
    if squares.ndim == 1 and isinstance(squares, np.ndarray):
        return squares.dot(weights)  # starts faster
    return squares @ weights if weights.ndim == 1 else row_dot(squares, weights)


def row_product(rows: Any, matrix: Any, out: Any = None) -> Any:
    """Rows (..., k) times one matrix (k, l), each block of rows (b, i, k) times its own (b, k, l), or each row times its own
    (..., k, l); with NumPy, ``out`` may hold the result.
    """
    if matrix.ndim > max(rows.ndim, 2):
        each = rows[..., None, :]
        return (each @ matrix if out is None else np.matmul(each, matrix, out[..., None, :]))[..., 0, :]
    if out is None:
        return rows @ matrix
    return rows.dot(matrix, out) if rows.ndim == 1 else np.matmul(rows, matrix, out)  # for one row, dot starts faster


def joined_product(rows: Any, matrix: Any, out: Any = None) -> Any:
    """As ``row_product``, for a compiler: sums of few numbers it joins with what is before and after, a product it does not."""
    if matrix.ndim > 2 or matrix.shape[0] > FEW:
        return row_product(rows, matrix, out)
    return (rows[..., None] * matrix).sum(-2)


def row_dot(left: Any, right: Any) -> Any:
    """Scalar products (...,) over the last axis of two NumPy arrays or torch tensors."""
    if not isinstance(left, np.ndarray):
        return (left * right).sum(-1)
    return left.dot(right) if left.ndim == 1 else np.einsum("...i,...i->...", left, right)
