"""Twist and chord along the span: as text that can be edited, and as they are drawn and told."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.structure import RotatingBeam
from beamenv.structure.planform import Steps
from train.explore.blade import width
from train.explore.figures import Figure, shown
from train.explore.units import number, unit_of
from train.figures.figure import Curve, Look, Panel
from train.figures.palette import NEUTRAL, PALETTE

Array = NDArray[np.float64]

STATIONS = 61
SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Of the span: where they are told."""
PAIRS = "pairs of a share of the span and a value, such as '0 30, 0.5 12, 1 0', or nothing"


def as_text(table: Steps | None) -> str:
    """A table as it is edited: 0 30, 0.5 12, 1 0; nothing for none."""
    return ", ".join(f"{share:.12g} {value:.12g}" for share, value in table or ())


def as_table(name: str, text: str) -> Steps:
    """What a text says; ``ValueError``, in one sentence, for one that is no list of pairs."""
    pairs = [pair.replace(":", " ").split() for pair in text.replace(";", ",").split(",") if pair.strip()]
    try:
        numbers = tuple((float(share), float(value)) for share, value in pairs)
    except ValueError:
        raise Refused(name, text, PAIRS) from None
    return numbers


def stations(beam: RotatingBeam) -> Array:
    """(S,), m from the root."""
    return np.linspace(0.0, beam.length, STATIONS)


def chords(beam: RotatingBeam, z: Array) -> Array:
    """(S,), m: the width of the section's mid-line."""
    return width(beam) * beam.planform.scale(z)


def angles(beam: RotatingBeam, z: Array) -> Array:
    """(S,), degrees: of the chord from the plane of rotation."""
    return np.degrees(beam.planform.angle(z))


def planform(beam: RotatingBeam, at: float) -> Figure:
    """Chord and angle over the span, with a line where the section is drawn, ``at`` m from the root."""
    z = stations(beam)
    along, across = unit_of(beam.length, "m"), unit_of(chords(beam, z), "m")
    x, limits = along.per * z, (0.0, along.per * beam.length)
    panel = partial(Panel, marked=(along.per * at,), marked_line="dashed", x_limits=limits)
    turned = angles(beam, z)
    panels = [
        panel("", "", f"chord, {across.name}", [Curve(x, across.per * chords(beam, z), "chord", look=Look(PALETTE[0], 2.0))]),
        panel("", f"z, {along.name}", "angle, °", [Curve(x, turned, "angle", "dashed", Look(PALETTE[1], 2.0))]),
    ]
    figure = shown(panels, gap=0.2)
    layout = figure["layout"]
    layout["yaxis"] |= {"rangemode": "tozero"}
    if np.ptp(turned) < 1e-9:
        layout["yaxis2"] |= {"range": [float(turned[0]) - 10.0, float(turned[0]) + 10.0]}
    layout["shapes"] = [each | {"line": {**each["line"], "color": NEUTRAL}} for each in layout["shapes"][:1]]
    return {**figure, "layout": {**layout, "showlegend": False}}


def rows(beam: RotatingBeam) -> list[tuple[str, str, str, str]]:
    """At some shares of the span: the share in per cent, z, the chord and the angle, each with its unit but the first."""
    z = np.array(SHARES) * beam.length
    along, across = unit_of(beam.length, "m"), unit_of(chords(beam, z), "m")
    told = zip(SHARES, z, chords(beam, z), angles(beam, z), strict=True)
    return [(f"{100 * share:g} %", along(at), across(chord), f"{number(angle)}°") for share, at, chord, angle in told]
