"""The figures of the loop: its poles, a Bode diagram and singular values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from train.explore.figures import Figure, shown, with_room_for_its_legend
from train.explore.hertz import beside, carrier
from train.explore.loop import Array, Complex, Loop
from train.explore.units import angular, unit_of
from train.figures.figure import Curve, Look, Marker, Panel
from train.figures.palette import LINES, NEUTRAL, PALETTE, colour
from train.figures.panels import pole_panel

HALF_A_TURN = 180.0
HERTZ_ROOM = 46
"""Pixels that the axis in Hz takes."""
STEEP = 20.0
"""From a peak of S as high on it is drawn in its logarithm."""
MOST_TICKS = 4
"""Of a logarithmic axis, about."""
BY_CONTROLLER = ((Look(NEUTRAL, 1.2), "solid"), (Look(PALETTE[0], 2.2), "dashed"))
"""Look and line without control and under LQG: told apart by their dashes and width too."""


def poles(loop: Loop) -> Figure:
    """Poles of the sampled loops, as their continuous equivalents."""
    return shown([pole_panel(loop.poles)], even=False)


def bode(loop: Loop) -> Figure:
    """Magnitude and phase from one voltage to one reading."""
    frequencies, magnitudes, phases = _scaled(loop), [], []
    for (name, response), (look, line) in zip(loop.bode.items(), BY_CONTROLLER, strict=True):
        magnitudes.append(Curve(frequencies, np.abs(response), name, line, look))
        phases.append(Curve(frequencies, _phase(response), name, line, look, listed=False))
    panels = [
        Panel("", "", "magnitude", magnitudes, logarithmic=True),
        Panel("", "", "phase, °", phases, y_limits=(-HALF_A_TURN, HALF_A_TURN)),
    ]
    figure = over_frequency(panels, loop)
    figure["layout"]["yaxis2"] |= {"tickvals": [-180, -90, 0, 90, 180]}
    return figure


def _phase(response: Complex) -> Array:
    """Degrees from −180 to 180, with a gap where it passes from one to the other: many zeros are too sharp to tell how often."""
    phase = np.degrees(np.angle(response))
    phase[np.flatnonzero(np.abs(np.diff(phase)) > HALF_A_TURN)] = np.nan
    return phase


def singular_values(loop: Loop) -> Figure:
    """From voltages to readings, and from line loads to the tip."""
    frequencies = _scaled(loop)
    own = [
        Curve(frequencies, gains, "voltages to readings", "solid", BY_CONTROLLER[0][0], listed=False)
        for gains in loop.plant_gains.T
    ]
    first = float(next(iter(loop.load_gains.values()))[0])
    unit = unit_of(first, "m")
    tips = [
        Curve(frequencies, unit.per * gains, name, line, look)
        for (name, gains), (look, line) in zip(loop.load_gains.items(), BY_CONTROLLER, strict=True)
    ]
    panels = [
        Panel("", "", "readings", own, logarithmic=True),
        Panel("", "", f"tip, {unit.name} per N/m", tips, logarithmic=True),
    ]
    return over_frequency(panels, loop)


def sensitivity(loop: Loop) -> Figure:
    """The largest singular value of S where the loops are broken, with its peaks, beside 1."""
    frequencies, curves = _scaled(loop), []
    for k, (where, gains) in enumerate(loop.sensitivity.items()):
        look, at = Look(colour(k), 2.0), int(np.argmax(gains))
        curves.append(Curve(frequencies, gains, f"at the {where}", LINES[k], look))
        peak = replace(look, marker=Marker(("circle", "square")[k], 10))
        curves.append(Curve(frequencies[at : at + 1], gains[at : at + 1], f"at the {where}", "points", peak, listed=False))
    one = Curve(frequencies[[0, -1]], np.ones(2), "neither more nor less", "dotted", Look(NEUTRAL, 1.2))
    highest = max(float(gains.max()) for gains in loop.sensitivity.values())
    steep = highest > STEEP
    limits = (None, None) if steep else (0.0, 1.1 * highest)
    return over_frequency([Panel("", "", "largest singular value", [*curves, one], steep, y_limits=limits)], loop)


def _scaled(loop: Loop) -> Array:
    return angular(float(loop.frequencies[-1]))[0].per * loop.frequencies


def over_frequency(panels: Sequence[Panel], loop: Loop) -> Figure:
    """Panels over one logarithmic axis of frequency, with Hz above them."""
    low, high = float(loop.frequencies[0]), float(loop.frequencies[-1])
    unit, cycles = angular(high)
    named = [*panels[:-1], replace(panels[-1], x_label=f"frequency, {unit.name}")]
    figure = shown(named, gap=0.12, even=False)
    layout: dict[str, Any] = figure["layout"]
    decades = {"type": "log", "dtick": 1, "minor": {"showgrid": True}, "exponentformat": "none"}
    layout["xaxis"] |= {**decades, "range": [float(np.log10(unit.per * each)) for each in (low, high)]}
    layout["xaxis2"] = {**beside("x", low, high, logarithmic=True, unit=unit, cycles=cycles), "anchor": "y"}
    for name, panel in zip(("yaxis", "yaxis2"), panels, strict=False):
        layout[name] |= {"dtick": _decades_a_tick(panel)} if panel.logarithmic else {}
    first = panels[0].curves[0].y
    figure["data"].append(carrier("x", unit.per * low, float(first[0])))
    return with_room_for_its_legend(figure, HERTZ_ROOM)


def _decades_a_tick(panel: Panel) -> int:
    values = np.concatenate([curve.y[curve.y > 0.0] for curve in panel.curves])
    return max(1, round(float(np.ptp(np.log10(values))) / MOST_TICKS)) if len(values) else 1
