"""A slider of Dash for a range of values."""

from __future__ import annotations

import math
from typing import Any

from dash import dcc

from train.explore.controls import Range


def slider(name: str, entry: Range) -> Any:
    """One with a handle, or a handle for each of several patches; of a logarithmic range its logarithm to base 10."""
    low, high, value = entry.low, entry.high, entry.value
    if entry.logarithmic and not isinstance(value, list):
        low, high, value = (round(math.log10(each), 9) for each in (low, high, value))
    limits: dict[str, Any] = {"min": low, "max": high, "step": entry.step, "value": value, "marks": None}
    limits |= {"updatemode": "drag", "allow_direct_input": False}  # an emptied field of its own would stop the handle
    return dcc.RangeSlider(id=name, **limits, pushable=entry.apart) if entry.several else dcc.Slider(id=name, **limits)
