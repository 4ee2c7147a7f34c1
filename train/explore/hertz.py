"""Hz beside rad/s."""

from __future__ import annotations

from typing import Any

import numpy as np

from train.explore.units import Unit, number

TURN = 2.0 * np.pi
TICKS = 5
"""Of a linear axis, about."""
PLAIN = Unit("rad/s", 1.0)
ROUND = (1.0, 2.0, 2.5, 5.0, 10.0)


def hertz(speed: float) -> str:
    """Of a rotor speed in rad/s: in Hz and in revolutions per minute."""
    turns = 60.0 * speed / TURN
    return (
        f"{number(speed / TURN, 3)} Hz, {turns:.0f} rpm"
        if turns >= 100.0
        else f"{number(speed / TURN, 3)} Hz, {number(turns, 3)} rpm"
    )


def beside(axis: str, low: float, high: float, logarithmic: bool = False, unit: Unit = PLAIN, cycles: str = "Hz") -> dict[str, Any]:
    """An axis of plotly in Hz on the other side of one in rad/s, "x" or "y", that shows ``low`` to ``high`` and zooms with it.

    Both ends are in rad/s; the axis may be in another ``unit``, and its own in as many ``cycles``.
    """
    low, high = unit.per * low, unit.per * high
    ticks = _decades(low / TURN, high / TURN) if logarithmic else _even(high / TURN)
    side, title = ("top", cycles) if axis == "x" else ("right", cycles)
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
