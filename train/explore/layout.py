"""What stands on the page: controls, and the places of the figures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, get_args

from dash import dcc, html

from beamenv.blade.presets import THESIS
from beamenv.configuration import Number, Numbers
from beamenv.patches.layout import OUTERMOST
from train.explore.blade import CAMPBELL_MODES, HIGHEST_SPEED, MOTIONS, STEP_LOAD, Direction, Settings
from train.figures.palette import PALETTE

START = Settings()
DIRECTIONS = get_args(Direction)
ROUND_OFF = 1e-6
"""How far a slider's last step may lie beyond its end, in its unit."""


@dataclass(frozen=True, slots=True)
class Range:
    """What a slider goes through; with several values, one handle each."""

    label: str
    unit: str
    low: float
    high: float
    step: float
    value: float | list[float]

    def control(self, name: str) -> html.Div:
        """The slider under its label and value."""
        limits: dict[str, Any] = {"min": self.low, "max": self.high, "step": self.step, "value": self.value, "marks": None}
        limits |= {"updatemode": "drag", "allow_direct_input": False}  # an emptied input would stop the handle
        several = isinstance(self.value, list)
        slider = dcc.RangeSlider(id=name, **limits, pushable=APART) if several else dcc.Slider(id=name, **limits)
        return _control(self.label, html.Output(id=f"{name}-value"), slider)

    @property
    def kind(self) -> Number | Numbers:
        """What its value may be."""
        each = Number(ge=self.low - ROUND_OFF, le=self.high + ROUND_OFF, unit=self.unit)
        return Numbers(each, len(self.value), len(self.value)) if isinstance(self.value, list) else each

    def text(self, value: float | list[float] | None) -> str:
        """A value as the page writes it, with its unit."""
        if isinstance(value, list):
            return ", ".join(f"{edge:.1f}" for edge in value) + f" {self.unit}"
        return "" if value is None else f"{value:g} {self.unit}".rstrip()


def _control(label: str, *children: Any) -> html.Div:
    return html.Div([html.Span(label), *children], role="group", className="control", **{"aria-label": label})


def _millimetres(edges: tuple[float, ...]) -> list[float]:
    return [round(1e3 * edge, 6) for edge in edges]


_LAST = round(1e3 * (OUTERMOST * THESIS.beam.length - THESIS.patches.length), 6)
_STEP = round(_LAST / 153, 6)
"""mm: a 51st of the spacing of the thesis' four patches, so that these lie on the grid."""
APART = math.ceil(1e3 * THESIS.patches.length / _STEP)
"""Steps that keep patches from overlapping: Dash 4 counts the distance between handles in steps, whatever it says."""

RANGES: Mapping[str, Range] = MappingProxyType(
    {
        "ply_angle_deg": Range("ply angle from the contour", "°", 0.0, 90.0, 1.0, START.ply_angle_deg),
        "speed": Range("rotor speed", "rad/s", 0.0, HIGHEST_SPEED, 5.0, START.speed),
        "pretwist_deg": Range("pretwist", "°", 0.0, 90.0, 1.0, START.pretwist_deg),
        "taper": Range("taper, root chord over tip chord", "", 1.0, 3.0, 0.05, START.taper),
        "actuators": Range("actuators on top, from the root at", "mm", 0.0, _LAST, _STEP, _millimetres(START.actuators)),
        "sensors": Range("sensors below, from the root at", "mm", 0.0, _LAST, _STEP, _millimetres(START.sensors)),
    }
)
CONTROLS = (*RANGES, "load")
"""Ids: the fields of ``Settings``."""

_QUIET: Any = {"displayModeBar": False, "responsive": True}


def layout() -> html.Div:
    """The whole page."""
    return html.Div(
        [
            html.Header([html.H1("Rotating blade"), html.P(_introduction())]),
            html.Main([html.Div(_controls(), id="controls"), html.Div([_message(), _results()], id="shown")]),
            dcc.Store(id="wanted"),
            dcc.Store(id="busy"),
        ]
    )


def _introduction() -> str:
    beam, patches = THESIS.beam, THESIS.patches
    return (
        f"The thesis' box beam, {beam.length:g} m long, {1e3 * beam.width:g} × {1e3 * beam.depth:g} mm at the root, "
        f"with {patches.material} patches of {1e3 * patches.length:g} mm, whose mass and stiffness count. "
        f"Damping without control is {100.0 * THESIS.damping_ratio:g} % of critical in every mode, but for gyroscopic coupling."
    )


def _controls() -> list[Any]:
    choice = dcc.RadioItems(id="load", options=list(DIRECTIONS), value=START.load, inline=True)
    return [*(entry.control(name) for name, entry in RANGES.items()), _control(f"step load of {STEP_LOAD:g} N/m in", choice)]


def _message() -> html.P:
    return html.P(id="message", role="alert")


def _results() -> html.Div:
    small = html.Div([_small(mode) for mode in range(CAMPBELL_MODES)], className="shapes")
    crossings = "Dots: natural frequencies at the rotor speed. Dotted: its multiples."
    sudden = f"Uniform line load that sets in at once on the blade at rest. The drive is limited to {_volts()}."
    left = [
        _section("Campbell diagram", crossings, _graph("campbell", 430)),
        _section("Step response of the tip", sudden, _graph("response", 660)),
    ]
    right = [
        _section("Mode shapes", _legend(), small),
        _section("Damping", html.Span(id="filter"), _table()),
    ]
    return html.Div([html.Div(left), html.Div(right)], id="results")


def _volts() -> str:
    low, high = THESIS.voltage_limits
    return f"{low:g} … {high:g} V".replace("-", "−")


def _section(heading: str, note: Any, content: Any) -> html.Section:
    return html.Section([html.H2(heading), html.P(note), content])


def _graph(name: str, height: int) -> dcc.Graph:
    return dcc.Graph(id=name, config=_QUIET, style={"height": f"{height}px"})


def _legend() -> list[Any]:
    keys = [
        html.Span([html.I(style={"borderColor": colour}), motion], className="key")
        for motion, colour in zip(MOTIONS, PALETTE, strict=False)
    ]
    return [*keys, html.Br(), html.Span("Each over the mode's largest. Dotted: a quarter of a period later.")]


def _small(mode: int) -> html.Div:
    return html.Div([html.H3(id=f"shape-{mode}-heading"), _graph(f"shape-{mode}", 190)])


def _table() -> html.Div:
    names = ("mode", "ω, rad/s", "ζ alone, %", "ζ with LQG, %")
    head = html.Thead(html.Tr([html.Th(name, scope="col") for name in names]))
    return html.Div(html.Table([head, html.Tbody(id="damping")]), className="scroll", tabIndex=0)
