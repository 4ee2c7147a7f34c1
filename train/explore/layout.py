"""What stands on the page: controls, and the places of the figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from dash import dcc, html

from beamenv.configuration import THESIS
from beamenv.patches.layout import OUTERMOST
from train.explore.blade import CAMPBELL_MODES, HIGHEST_SPEED, MOTIONS, STEP_LOAD, Settings
from train.page.themes import PALETTE

START = Settings()


@dataclass(frozen=True, slots=True)
class Range:
    """What a slider goes through; with several values, one handle each."""

    label: str
    """With the unit."""
    low: float
    high: float
    step: float
    value: float | list[float]

    def slider(self, name: str) -> html.Div:
        """The slider under its label."""
        limits = {"min": self.low, "max": self.high, "step": self.step, "value": self.value, "marks": None, "updatemode": "drag"}
        if isinstance(self.value, list):
            shown = {"placement": "bottom", "always_visible": True}
            slider = dcc.RangeSlider(id=name, **limits, pushable=1e3 * THESIS.patches.length, allow_direct_input=False, tooltip=shown)
        else:
            slider = dcc.Slider(id=name, **limits)
        return html.Div([html.Label(self.label, htmlFor=name), slider], className="control")


def _millimetres(edges: tuple[float, ...]) -> list[float]:
    return [round(1e3 * edge, 6) for edge in edges]


_LAST = round(1e3 * (OUTERMOST * THESIS.beam.length - THESIS.patches.length), 6)

RANGES: Mapping[str, Range] = MappingProxyType(
    {
        "ply_angle_deg": Range("ply angle, ° from the span", 0.0, 90.0, 1.0, START.ply_angle_deg),
        "speed": Range("rotor speed, rad/s", 0.0, HIGHEST_SPEED, 5.0, START.speed),
        "pretwist_deg": Range("pretwist, °", 0.0, 90.0, 1.0, START.pretwist_deg),
        "taper": Range("taper, root over tip chord", 1.0, 3.0, 0.05, START.taper),
        "actuators": Range("actuators on the top wall: root-side edges, mm", 0.0, _LAST, 0.1, _millimetres(START.actuators)),
        "sensors": Range("sensors on the bottom wall: root-side edges, mm", 0.0, _LAST, 0.1, _millimetres(START.sensors)),
    }
)
CONTROLS = (*RANGES, "load")
"""Ids: the fields of ``Settings``."""

_QUIET = {"displayModeBar": False, "responsive": True}


def layout() -> html.Div:
    """The whole page."""
    return html.Div(
        [
            html.Header([html.H1("Rotating blade"), html.P(_introduction())]),
            html.Main([html.Div(_controls(), id="controls"), html.Div([_message(), _results()], id="shown")]),
        ]
    )


def _introduction() -> str:
    beam, patches = THESIS.beam, THESIS.patches
    return (
        f"The thesis' box beam, {beam.length:g} m long, {1e3 * beam.width:g} × {1e3 * beam.depth:g} mm at the root, "
        f"with {patches.material} patches of {1e3 * patches.length:g} mm, whose mass and stiffness count. "
        f"Damping without control is {100.0 * THESIS.damping_ratio:g} % of critical in every mode."
    )


def _controls() -> list[Any]:
    choice = dcc.RadioItems(id="load", options=["lag", "flap"], value=START.load, inline=True)
    load = html.Div([html.Label(f"step load of {STEP_LOAD:g} N/m in", htmlFor="load"), choice], className="control")
    return [*(entry.slider(name) for name, entry in RANGES.items()), load]


def _message() -> html.P:
    return html.P(id="message", role="alert")


def _results() -> html.Div:
    return html.Div(
        [
            _section("Campbell diagram", "Dots: natural frequencies at the rotor speed. Dotted: its multiples.", _graph("campbell", 420)),
            _section("Mode shapes", _legend(), html.Div([_small(mode) for mode in range(CAMPBELL_MODES)], className="shapes")),
            _section("Step response", "Sudden uniform line load on the blade at rest, drive limited to ±1500 V.", _graph("response", 620)),
            _section("Damping ratios, %", "LQG's poles are those of its regulator and those of its filter.", _table()),
        ],
        id="results",
    )


def _section(heading: str, note: Any, content: Any) -> html.Section:
    return html.Section([html.H2(heading), html.P(note), content])


def _graph(name: str, height: int) -> dcc.Graph:
    return dcc.Graph(id=name, config=_QUIET, style={"height": f"{height}px"})


def _legend() -> list[Any]:
    keys = [html.Span(motion, className="key", style={"--colour": colour}) for motion, colour in zip(MOTIONS, PALETTE, strict=False)]
    return [*keys, html.Span("Dotted: a quarter of a period later.")]


def _small(mode: int) -> html.Div:
    return html.Div([html.H3(id=f"shape-{mode}-heading"), _graph(f"shape-{mode}", 190)])


def _table() -> html.Div:
    names = ("mode", "frequency, rad/s", "without control", "LQG", "its filter")
    head = html.Thead(html.Tr([html.Th(name, scope="col") for name in names]))
    return html.Div(html.Table([head, html.Tbody(id="damping")]), className="scroll", tabIndex=0)
