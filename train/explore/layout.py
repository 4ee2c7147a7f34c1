"""What stands on the page: controls, and the places of the figures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, get_args

from dash import dcc, html

from beamenv.blade.build import Blade
from beamenv.blade.config import ON_EVERY_WALL, BladeConfig
from beamenv.blade.layouts import SIDES, Side
from beamenv.blade.presets import THESIS
from beamenv.configuration import Number, Numbers
from train.explore.blade import CAMPBELL_MODES, HIGHEST_SPEED, MOTIONS, Direction
from train.figures.palette import PALETTE

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
    apart: int = 0
    """Steps that keep handles from one another."""

    def control(self, name: str) -> html.Div:
        """The slider under its label and value."""
        limits: dict[str, Any] = {"min": self.low, "max": self.high, "step": self.step, "value": self.value, "marks": None}
        limits |= {"updatemode": "drag", "allow_direct_input": False}  # an emptied input would stop the handle
        several = isinstance(self.value, list)
        slider = dcc.RangeSlider(id=name, **limits, pushable=self.apart) if several else dcc.Slider(id=name, **limits)
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


@dataclass(frozen=True, slots=True)
class Page:
    """The blade that a page begins with, and its sliders: of what it has, and has in one way that a slider can change."""

    base: BladeConfig
    ranges: Mapping[str, Range]

    @classmethod
    def of(cls, base: BladeConfig) -> Page:
        """That of a blade."""
        sliders = {"ply_angle_deg": _plies(base), "speed": _within("rotor speed", "rad/s", 0.0, HIGHEST_SPEED, 5.0, base.speed)}
        if base.beam.twist_table is None:
            sliders["pretwist_deg"] = _within("pretwist", "°", 0.0, 90.0, 1.0, base.beam.pretwist_deg)
        if base.beam.chord_table is None:
            sliders["taper"] = _within("taper, root chord over tip chord", "", 1.0, 3.0, 0.05, base.beam.taper)
        for side in SIDES:
            sliders[side] = _patches(base, side)
        return cls(base, MappingProxyType({name: entry for name, entry in sliders.items() if entry is not None}))

    @property
    def controls(self) -> tuple[str, ...]:
        """Ids: the fields of ``Settings``."""
        return (*self.ranges, "load")


def _within(label: str, unit: str, low: float, high: float, step: float, value: float) -> Range | None:
    return Range(label, unit, low, high, step, value) if low <= value <= high else None


def _plies(base: BladeConfig) -> Range | None:
    """Where all plies of all walls have one angle."""
    angles = {angle for _, each in base.beam.ply_angles_deg for angle in each}
    if len(angles) > 1 or set(dict(base.beam.ply_angles_deg)) != {ON_EVERY_WALL}:
        return None
    return _within("ply angle from the contour", "°", 0.0, 90.0, 1.0, angles.pop())


def _patches(base: BladeConfig, side: Side) -> Range | None:
    """Where they are one group."""
    groups, length = base.patches.groups(side), base.beam.length
    if len(groups) != 1:
        return None
    group = groups[0]
    last = round(1e3 * (group.outermost * length - group.length), 6)
    step = round(last / STEPS, 6)
    where = {"top": "on top", "bottom": "below"}.get(group.wall, f"on the {group.wall} wall")
    edges = _millimetres(base.patches.positions(side, length))
    apart = math.ceil(1e3 * group.length / step)
    return Range(f"{side} {where}, from the root at", "mm", 0.0, last, step, edges, apart) if step > 0.0 else None


STEPS = 153
"""Of a slider for patches: the thesis' four, 51 of them apart, lie on its grid. Dash 4 counts what handles are apart in steps,
whatever it says."""

THESIS_PAGE = Page.of(THESIS)
RANGES, CONTROLS = THESIS_PAGE.ranges, THESIS_PAGE.controls

_QUIET: Any = {"displayModeBar": False, "responsive": True}


def layout(page: Page = THESIS_PAGE) -> html.Div:
    """The whole page."""
    return html.Div(
        [
            html.Header([html.H1("Rotating blade"), html.P(_introduction(page.base))]),
            html.Main([html.Div(_controls(page), id="controls"), html.Div([_message(), _results(page.base)], id="shown")]),
            dcc.Store(id="wanted"),
            dcc.Store(id="busy"),
        ]
    )


def _introduction(base: BladeConfig) -> str:
    beam, groups = base.beam, base.patches.groups("actuators")
    shape = "box" if beam.section is None else beam.section.shape
    what = f"A beam with a section of the shape {shape}, {beam.length:g} m long"
    if beam == THESIS.beam:
        what = f"The thesis' box beam, {beam.length:g} m long, {1e3 * beam.width:g} × {1e3 * beam.depth:g} mm at the root"
    names = ", ".join(dict.fromkeys(group.material if isinstance(group.material, str) else "your own" for group in groups))
    sizes = ", ".join(dict.fromkeys(f"{1e3 * group.length:g}" for group in groups))
    counted = ", whose mass and stiffness count" if all(group.passive for group in groups) else ""
    return (
        f"{what}, with {names} patches of {sizes} mm{counted}. "
        f"Damping without control is {100.0 * base.damping_ratio:g} % of critical in every mode, but for gyroscopic coupling."
    )


def _controls(page: Page) -> list[Any]:
    choice = dcc.RadioItems(id="load", options=list(DIRECTIONS), value="flap", inline=True)
    load = float(Blade(page.base).reference_load)
    return [*(entry.control(name) for name, entry in page.ranges.items()), _control(f"step load of {load:.3g} N/m in", choice)]


def _message() -> html.P:
    return html.P(id="message", role="alert")


def _results(base: BladeConfig) -> html.Div:
    small = html.Div([_small(mode) for mode in range(CAMPBELL_MODES)], className="shapes")
    crossings = "Dots: natural frequencies at the rotor speed. Dotted: its multiples."
    sudden = f"Uniform line load that sets in at once on the blade at rest. The drive is limited to {_volts(base)}."
    left = [
        _section("Campbell diagram", crossings, _graph("campbell", 430)),
        _section("Step response of the tip", sudden, _graph("response", 660)),
    ]
    right = [
        _section("Mode shapes", _legend(), small),
        _section("Damping", html.Span(id="filter"), _table()),
    ]
    return html.Div([html.Div(left), html.Div(right)], id="results")


def _volts(base: BladeConfig) -> str:
    low, high = base.voltage_limits
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
