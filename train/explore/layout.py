"""What stands on the page: controls, and the places of the figures."""

from __future__ import annotations

from base64 import b64encode
from typing import Any

from dash import dcc, html

from beamenv.blade.config import BladeConfig
from beamenv.blade.presets import THESIS
from train.explore.blade import CAMPBELL_MODES, MOTIONS
from train.explore.controls import BLADE, GROUPS, PAIR, THESIS_PAGE, Options, Page, Range
from train.explore.figures import MOTION_LINES
from train.explore.picture import key
from train.explore.slider import slider
from train.figures.palette import PALETTE

_QUIET: Any = {"displayModeBar": False, "responsive": True}
DASHES = {"solid": "", "dashed": "7 3", "dashdot": "7 3 2 3", "dotted": "2 3"}


def layout(page: Page = THESIS_PAGE) -> html.Div:
    """The whole page."""
    return html.Div(
        [
            html.Header([html.H1("Rotating blade"), html.P(_introduction(page.base))]),
            html.Main([_controls(page), html.Div([_message(), _results(page)], id="shown")]),
            dcc.Store(id="about", data=about(page)),
            *(dcc.Store(id=name) for name in ("link", "state", "wanted", "settled", "busy", "analysing", "file", "named")),
        ]
    )


def about(page: Page) -> list[dict[str, Any]]:
    """What the browser knows of the controls."""
    return [
        {
            "name": name,
            "label": entry.label,
            "start": entry.value,
            "entries": entry.entries(name),
            **({"options": entry.options} if isinstance(entry, Options) else _bounds(entry)),
        }
        for name, entry in page.controls.items()
    ]


def _bounds(entry: Range) -> dict[str, Any]:
    return {"unit": entry.unit, "low": entry.low, "high": entry.high, "logarithmic": entry.logarithmic}


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


def _controls(page: Page) -> html.Div:
    groups = []
    for name in GROUPS:
        inside = [control(each, entry) for each, entry in page.controls.items() if entry.group == name]
        if inside:
            groups.append(html.Details([html.Summary(name), *inside], open=True, className="first" if name == BLADE else ""))
    buttons = [
        html.Button(text, id=name, n_clicks=0, type="button")
        for name, text in (("reset", "Reset"), ("copy", "Copy link"), ("save", "Save as blade.toml"))
    ]
    done = html.P(id="done", role="status")
    return html.Div([html.Div(buttons, className="buttons"), done, *groups], id="controls")


def control(name: str, entry: Range | Options) -> html.Div:
    """A slider under its name and the fields that take its values as numbers; or what can be chosen from."""
    if isinstance(entry, Options):
        options = [{"label": each, "value": each} for each in entry.options]
        parts: list[Any] = [html.Span(entry.label), dcc.RadioItems(id=name, options=options, value=entry.value, inline=True)]
    else:
        fields = [dcc.Input(id=each, type="number", debounce=True, step="any") for each in entry.entries(name)]
        beside = html.Output(id=f"{name}-value") if entry.unit == "rad/s" else None
        parts = [
            html.Span(entry.label),
            html.Div([*fields, html.Span(entry.unit)], className="numbers"),
            beside,
            slider(name, entry),
        ]
    return html.Div([each for each in parts if each is not None], role="group", className="control", **{"aria-label": entry.label})


def _message() -> html.P:
    return html.P(id="message", role="alert")


def _results(page: Page) -> html.Div:
    base = page.base
    small = html.Div([_small(mode) for mode in range(CAMPBELL_MODES)], className="shapes")
    crossings = "Dots: natural frequencies at the rotor speed. Dotted: its multiples."
    sudden = f"Uniform line load that sets in at once on the blade at rest. The drive is limited to {_volts(base)}."
    pair = [control(name, page.choices[name]) for name in PAIR]
    bode = (
        "From a voltage to a reading of the sampled plant, in full scales of the sensor per limit of the drive; with LQG: from "
        "what is added to its voltage, once it has gone round the loop."
    )
    singular = (
        "Of all voltages and readings together, in full scales per limit of the drive, without control; and the largest from loads "
        "in lag and flap to the tip."
    )
    left = [
        _section("Campbell diagram", crossings, _graph("campbell", 430)),
        _section("Step response of the tip", sudden, _graph("response", 660)),
        _section("Poles", "Of the sampled loops, as log(z)/Δt. Right of the line is unstable.", _graph("poles", 400)),
        _section("Singular values", singular, _graph("singular", 480)),
    ]
    right = [
        _section("Mode shapes", _legend(), small),
        _section("Damping", html.Span(id="filter"), _table(DAMPING, "damping")),
        _section("Margins of LQG", html.Span(id="cost"), html.Div([html.P(id="lost", role="alert"), _table(MARGINS, "margins")])),
        _section("Bode diagram", bode, html.Div([html.Div(pair, className="pair"), _graph("bode", 480)])),
    ]
    return html.Div([_picture(base), html.Div(left), html.Div(right)], id="results")


DAMPING = ("mode", "ω, rad/s", "f, Hz", "ζ alone, %", "ζ with LQG, %")
MARGINS = ("margin, the loops broken at", "voltages", "readings")


def _picture(base: BladeConfig) -> html.Section:
    keys: list[Any] = [
        html.Span([html.I(style={"background": each}, className="patch"), name], className="key")
        for name, each in key(base).items()
    ]
    note = "Numbered from the root: actuators full, sensors pale, below the blade where they cannot be seen; dashed: behind a wall."
    return html.Section([html.H2("Blade"), html.Img(id="picture", alt=""), html.P([*keys, html.Span(note)])], className="wide")


def _volts(base: BladeConfig) -> str:
    low, high = base.voltage_limits
    return f"{low:g} … {high:g} V".replace("-", "−")


def _section(heading: str, note: Any, content: Any) -> html.Section:
    return html.Section([html.H2(heading), html.P(note), content])


def _graph(name: str, height: int) -> dcc.Graph:
    return dcc.Graph(id=name, config=_QUIET, style={"height": f"{height}px"})


def _legend() -> list[Any]:
    keys = [
        html.Span([_line(colour, line), motion], className="key")
        for motion, colour, line in zip(MOTIONS, PALETTE, MOTION_LINES, strict=False)
    ]
    return [*keys, html.Br(), html.Span("Each over the mode's largest. Thin: a quarter of a period later.")]


def _line(colour: str, line: str) -> html.Img:
    """A piece of a curve, as its legend shows it."""
    stroke = f'stroke="{colour}" stroke-width="2" stroke-dasharray="{DASHES[line]}"'
    drawn = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 30 8"><path d="M0 4H30" {stroke}/></svg>'
    return html.Img(src="data:image/svg+xml;base64," + b64encode(drawn.encode()).decode(), alt="", className="line")


def _small(mode: int) -> html.Div:
    return html.Div([html.H3(id=f"shape-{mode}-heading"), _graph(f"shape-{mode}", 190)])


def _table(names: tuple[str, ...], body: str) -> html.Div:
    head = html.Thead(html.Tr([html.Th(name, scope="col") for name in names]))
    return html.Div(html.Table([head, html.Tbody(id=body)]), className="scroll", tabIndex=0)
