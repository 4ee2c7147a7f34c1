"""Hz beside rad/s."""

from __future__ import annotations

from typing import Any

import numpy as np

TURN = 2.0 * np.pi
TICKS = 5
"""Of a linear axis, about."""
ROUND = (1.0, 2.0, 2.5, 5.0, 10.0)


def hertz(speed: float) -> str:
    """Of a rotor speed in rad/s: in Hz and in revolutions per minute."""
    return f"{speed / TURN:.1f} Hz, {60.0 * speed / TURN:.0f} rpm"


def beside(axis: str, low: float, high: float, logarithmic: bool = False) -> dict[str, Any]:
    """An axis of plotly in Hz on the other side of one in rad/s, "x" or "y", that shows ``low`` to ``high`` and zooms with it."""
    ticks = _decades(low / TURN, high / TURN) if logarithmic else _even(high / TURN)
    side, title = ("top", "Hz") if axis == "x" else ("right", "Hz")
    return {
        "overlaying": axis,
        "matches": axis,
        "side": side,
        "showgrid": False,
        "zeroline": False,
        "ticks": "outside",
        "title": {"text": title, "standoff": 4},
        "tickvals": [TURN * tick for tick in ticks],
        "ticktext": [f"{tick:g}" for tick in ticks],
        **({"type": "log"} if logarithmic else {}),
    }


def carrier(axis: str, x: float, y: float) -> dict[str, Any]:
    """A trace that is not seen, without which plotly draws no second axis."""
    return {
        "type": "scatter",
        "x": [x],
        "y": [y],
        f"{axis}axis": f"{axis}2",
        "mode": "markers",
        "marker": {"opacity": 0},
        "hoverinfo": "skip",
        "showlegend": False,
    }


def _even(high: float) -> list[float]:
    power = 10.0 ** np.floor(np.log10(high / TICKS))
    step = next(power * digit for digit in ROUND if power * digit >= high / TICKS)
    return [float(step * k) for k in range(int(high / step) + 1)]


def _decades(low: float, high: float) -> list[float]:
    return [10.0**k for k in range(int(np.ceil(np.log10(low))), int(np.floor(np.log10(high))) + 1)]
