"""Arrays of real numbers as arguments, their shapes and that they are finite."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.sentence import Refused

Array = NDArray[np.float64]


def real_numbers(name: str, value: Any) -> Array:
    """The numbers as float64, itself where it is such an array.

    ``ValueError`` for text, bools, objects, complex numbers and rows of different lengths.
    """
    try:
        values = np.asarray(value)
    except (ValueError, TypeError, RuntimeError):  # the last from a tensor that wants a gradient
        values = np.asarray(None)
    if values.dtype.kind not in "fiu" or isinstance(value, (bytes, bytearray, memoryview)):
        raise Refused(name, value, "an array of real numbers")
    return np.asarray(values, dtype=np.float64)


def shaped_array(name: str, value: Any, shape: Sequence[int | None], what: str) -> Array:
    """As ``real_numbers``, and of a shape (None: one or more). ``what`` says in the sentence what its rows and columns are."""
    values = real_numbers(name, value)
    sizes = zip(values.shape, shape, strict=False)
    if values.ndim != len(shape) or not all(has > 0 and has == (want or has) for has, want in sizes):
        wanted = ", ".join("any" if want is None else str(want) for want in shape)
        raise ValueError(f"{name} has shape {values.shape}, but must have shape ({wanted}): {what}.")
    return values


def checked_array(name: str, value: Any, shape: Sequence[int | None], what: str) -> Array:
    """As ``shaped_array``, and every number finite."""
    values = shaped_array(name, value, shape, what)
    check_finite(name, values)
    return values


def check_finite(name: str, values: Array) -> None:
    """``ValueError`` that names the first number which is not finite."""
    finite = np.isfinite(values)
    if not finite.all():
        wrong = np.argwhere(~finite)[0].tolist()
        raise ValueError(f"{name}{wrong or ''} is {values[tuple(wrong)]}, but every number must be finite.")
