"""Matrices that users hand in."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from baselines.design.controller import Array
from beamenv.configuration import shown

_ROUNDING = 1e-9
"""Of the largest entry: what an asymmetry or a negative eigenvalue may come to by rounding."""

_HEAVIEST = 1e100
"""Of a weight: squares of what is solved for leave the numbers beyond."""


def real_matrix(name: str, value: Any, shape: tuple[int, ...]) -> Array:
    """A copy as float64; ``ValueError`` for what is not of finite real numbers in this shape: complex ones, text, masks, flags."""
    try:
        given = np.asarray(value)
    except (TypeError, ValueError, RuntimeError, OverflowError):
        given = np.array(None)  # ragged, or of a kind that NumPy cannot read
    if given.dtype.kind not in "iuf" or np.ma.is_masked(value) or _holds_flags(value):
        raise ValueError(f"{name} = {shown(value)} must be a matrix of real numbers.")
    numbers = np.array(given, dtype=np.float64)
    if numbers.shape != shape or not np.isfinite(numbers).all():
        raise ValueError(f"{name} has shape {numbers.shape}, but must hold finite numbers in shape {shape}.")
    return numbers


def definite_matrix(name: str, value: Any, size: int, definite: Literal["semidefinite", "definite"]) -> Array:
    """As ``real_matrix``, (size, size), symmetric and positive definite or semidefinite; ``ValueError`` otherwise."""
    weight = real_matrix(name, value, (size, size))
    if (largest := np.abs(weight).max()) > _HEAVIEST:
        raise ValueError(f"{name} has the entry {largest:.3g}, but must hold numbers from -{_HEAVIEST:g} to {_HEAVIEST:g}.")
    rounding = _ROUNDING * largest
    if np.abs(weight - weight.T).max() > rounding:
        raise ValueError(f"{name} differs from its transpose by {np.abs(weight - weight.T).max():.3g}, but must be symmetric.")
    lowest = float(np.linalg.eigvalsh(weight).min())
    if lowest < -rounding if definite == "semidefinite" else lowest <= 0.0:
        raise ValueError(f"{name} has the eigenvalue {lowest:.3g}, but must be positive {definite}.")
    return weight


def keep_matrices(holder: object, shapes: Mapping[str, tuple[int, ...]]) -> None:
    """Make the named fields of a frozen dataclass arrays of its own that nobody writes to; ``ValueError`` as ``real_matrix``."""
    for name, shape in shapes.items():
        matrix = real_matrix(name, getattr(holder, name), shape)
        matrix.setflags(write=False)
        object.__setattr__(holder, name, matrix)


def rows(matrix: Any) -> int:
    """So many rows a first matrix has, which decides the shapes of all: of what is none, one."""
    return len(matrix) if hasattr(matrix, "__len__") and getattr(matrix, "shape", None) != () else 1


def one_or_each(name: str, value: Any, count: int, of: str) -> Array:
    """A number, or one for each of ``count``, as an array (count,); ``ValueError`` for anything else."""
    try:
        return np.broadcast_to(real_matrix(name, value, np.shape(value) if np.shape(value) == (count,) else ()), count)
    except ValueError:
        raise ValueError(f"{name} = {shown(value)} must be a finite number, or {count} of them, one for each {of}.") from None


def _holds_flags(value: Any) -> bool:
    """Whether bytes, or true and false among the members of a list, which NumPy makes numbers of."""
    if isinstance(value, (list, tuple)):
        return any(map(_holds_flags, value))
    return isinstance(value, (bool, np.bool_, bytes, bytearray, memoryview))
