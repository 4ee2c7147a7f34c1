"""What a numerical argument may be."""

from __future__ import annotations

import math
from numbers import Integral, Real
from typing import Any


def is_number(value: Any) -> bool:
    """Whether a value is a finite real number; a bool, a string, an array and None are not."""
    return not isinstance(value, bool) and isinstance(value, Real) and math.isfinite(value)


def is_count(value: Any, lowest: int, highest: int) -> bool:
    """Whether a value is an integer from ``lowest`` to ``highest``."""
    return not isinstance(value, bool) and isinstance(value, Integral) and lowest <= int(value) <= highest


def check_positive(**values: Any) -> None:
    """``ValueError`` for a value that is not a positive finite number."""
    for name, value in values.items():
        if not (is_number(value) and value > 0.0):
            raise ValueError(f"{name} = {value!r} must be a positive, finite number.")
