"""What stands on the page: controls, and the places of the figures."""

from __future__ import annotations

from base64 import b64encode
from typing import Any

from dash import dcc, html

from beamenv.blade.config import BladeConfig
from beamenv.blade.presets import THESIS
from train.explore.blade import CAMPBELL_MODES, MOTIONS
from train.explore.controls import BLADE, GROUPS, PAIR, THESIS_PAGE, Control, Options, Page, Words
from train.explore.figures import MOTION_LINES
from train.explore.picture import key, which
from train.explore.settings import INSTEAD
from train.explore.slider import slider
from train.explore.units import unit_of
from train.figures.palette import PALETTE

_QUIET: Any = {"displayModeBar": False, "responsive": True}
EXAMPLES = {"twist_table": "0 30, 0.5 12, 1 0", "chord_table": "0 1, 0.6 0.9, 1 0.5"}
SAID = {
    "planform": "Chord and angle along the span; the table below has them too.",
    "campbell": "Natural frequencies over the rotor speed; those at the speed chosen are in the table of damping.",
    "response": "Tip displacement in lag and flap over time, without control and under LQG, and the voltages.",
    "poles": "Poles of the loop in the complex plane, without control and under LQG; the table of damping has their dampings.",
    "bode": "Magnitude and phase over frequency from the voltage to the reading chosen, without control and under LQG.",
    "singular": "Singular values over frequency, from voltages to readings and from loads to the tip.",
    "sensitivity": "Largest singular value of S over frequency; the sentence above has its peaks.",
}
"""Of figures, for those who do not see them."""
DASHES = {"solid": "", "dashed": "7 3", "dashdot": "7 3 2 3", "dotted": "2 3"}


def layout(page: Page = THESIS_PAGE) -> html.Div:
    """The whole page."""
    kept = ("link", "state", "wanted", "settled", "busy", "analysing", "file", "named", "stopping", "stopped", "ending")
    return html.Div(
        [
            html.Header([html.H1(page.name, id="title"), html.P(_introduction(page.base)), _notice()]),
            html.Main([_controls(page), html.Div([_working(), _message(), _results(page)], id="shown")]),
            dcc.Store(id="about", data=about(page)),
            dcc.Store(id="blade", data=page.key),
            *(dcc.Store(id=name) for name in kept),
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
            **_further(entry),
        }
        for name, entry in page.controls.items()
    ]


def _further(entry: Control) -> dict[str, Any]:
    if isinstance(entry, Options):
        return {"options": entry.options}
    if isinstance(entry, Words):
        return {"words": True, "instead": INSTEAD[entry.name][0]}
    return {"unit": entry.unit, "low": entry.low, "high": entry.high, "logarithmic": entry.logarithmic}


def _introduction(base: BladeConfig) -> str:
    beam, groups = base.beam, base.patches.groups("actuators")
    shape = "box" if beam.section is None else beam.section.shape
    length = unit_of(0.1 * beam.length, "m")
    what = f"A beam of {length.per * beam.length:g} {length.name} with a section of the shape {shape!r}"
    if beam == THESIS.beam:
        what = f"The thesis' box beam, {beam.length:g} m long, {1e3 * beam.width:g} × {1e3 * beam.depth:g} mm at the root"
    counted = ", whose mass and stiffness count" if groups and all(group.passive for group in groups) else ""
    but = ", but for gyroscopic coupling" if base.gyroscopic and base.speed > 0.0 else ""
    return (
        f"{what}, {_patches(base)}{counted}. Damping without control is {100.0 * base.damping_ratio:g} % of critical in every "
        f"mode{but}. Move a slider or write a number: all is computed again, and LQG is designed anew."
    )


def _patches(base: BladeConfig) -> str:
    groups = base.patches.groups("actuators")
    if not groups:
        return "without actuators"
    names = ", ".join(dict.fromkeys(group.material if isinstance(group.material, str) else "your own" for group in groups))
    size = unit_of([group.length for group in groups], "m")
    sizes = ", ".join(dict.fromkeys(f"{size.per * group.length:.4g}" for group in groups))
    return f"with {names} patches of {sizes} {size.name}"


def _controls(page: Page) -> html.Div:
    groups = []
    for name in GROUPS:
        inside = [control(each, entry) for each, entry in page.controls.items() if entry.group == name]
        if inside:
            groups.append(html.Details([html.Summary(name), *inside], open=True, className="first" if name == BLADE else ""))
    buttons = [_button(*each) for each in (("reset", "Reset"), ("copy", "Copy link"), ("save", "Save as blade.toml"))]
    done = html.P(id="done", role="status")
    more = html.Div("more controls below ↓", id="more", hidden=True, **{"aria-hidden": "true"})
    return html.Div([html.Div(buttons, className="buttons"), done, *groups, more], id="controls")


def _button(name: str, text: str) -> html.Button:
    return html.Button(text, id=name, n_clicks=0, type="button")


def control(name: str, entry: Control) -> html.Div:
    """A slider under its name and the fields that take its values as numbers; or what can be chosen from; or a table as text."""
    if isinstance(entry, Options):
        options = [{"label": each, "value": each} for each in entry.options]
        parts: list[Any] = [html.Span(entry.label), dcc.RadioItems(id=name, options=options, value=entry.value, inline=True)]
    elif isinstance(entry, Words):
        parts = [
            html.Label(entry.label, htmlFor=name),
            dcc.Input(id=name, type="text", value=entry.value, debounce=True, placeholder=f"none; say {EXAMPLES[entry.name]}"),
        ]
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


def _notice() -> html.P:
    """What of a link was not taken."""
    return html.P(id="notice", role="alert")


def _working() -> html.Div:
    """What is said while it takes long."""
    return html.Div([html.Span("computing", id="elapsed", role="status"), _button("stop", "Stop")], id="working", hidden=True)


def _message() -> html.P:
    return html.P(id="message", role="alert")


def _results(page: Page) -> html.Div:
    base = page.base
    small = html.Div([_small(mode) for mode in range(CAMPBELL_MODES)], className="shapes")
    crossings = "Dots: natural frequencies at the rotor speed. Dotted: its multiples."
    sudden = (
        "A uniform line load that sets in at once; nothing vibrates before. Displacement of the tip from its steady state, and the "
        f"voltages of LQG, which the drive limits to {_volts(base)}."
    )
    pair = [control(name, page.choices[name]) for name in PAIR]
    bode = (
        "From a voltage to a reading of the sampled plant, in full scales of the sensor per limit of the drive; with LQG: from "
        "what is added to its voltage, once it has gone round the loop."
    )
    singular = (
        "Above: of all voltages and readings together, in full scales per limit of the drive, without control. Below: the largest "
        "from line loads in lag and flap to the tip."
    )
    sensitive = [
        "By how much the loop enlarges a signal that is added where it is broken, S = (I + L)⁻¹; below 1 it lessens it. ",
        html.Span(id="peaks"),
    ]
    margins = html.Div([html.P(id="lost", role="alert"), _table(MARGINS, "margins")])
    left = [
        _section("Section", "To scale, inner and outer faces as they are; patches in the colours above.", _cut(page)),
        _section("Campbell diagram", crossings, _graph("campbell", 430)),
        _section("Step response of the tip", sudden, _graph("response", 660)),
        _section("Poles", "Of the sampled loops, as log(z)/Δt. Right of the line is unstable.", _graph("poles", 400)),
        _section("Singular values", singular, _graph("singular", 480)),
    ]
    right = [
        _section("Chord and twist", ALONG_NOTE, html.Div([_graph("planform", 260), _table(ALONG, "along")])),
        _section("Mode shapes", _legend(), small),
        _section("Damping", html.Span(id="filter"), _table(DAMPING, "damping")),
        _section("Margins of LQG", html.Span(id="cost"), margins),
        _section("Sensitivity", sensitive, _graph("sensitivity", 360)),
        _section("Bode diagram", bode, html.Div([html.Div(pair, className="pair"), _graph("bode", 480)])),
    ]
    return html.Div([_picture(base), html.Div(left), html.Div(right)], id="results")


def _cut(page: Page) -> html.Div:
    """The section at a station, and how its walls are made."""
    listed = html.Details([html.Summary("in words"), html.Ul(id="walls")])
    return html.Div(
        [
            control("station", page.ranges["station"]),
            html.Img(id="section", alt="The section at the station, to scale; its walls are listed in words below."),
            html.P("Walls from the inner face, left, to the outer; ply angles from the contour."),
            html.Img(id="plies", alt="The plies of each wall and the patches there, to scale; they are listed in words below."),
            listed,
        ]
    )


ALONG_NOTE = "Width of the section's mid-line and angle from the plane of rotation. The dashed line is where the section is drawn."
ALONG = ("of the span", "z", "chord", "angle")
DAMPING = ("mode", "ω, rad/s", "f, Hz", "ζ alone, %", "ζ with LQG, %")
MARGINS = ("margin, the loops broken at", "voltages", "readings")


def _picture(base: BladeConfig) -> html.Section:
    keys: list[Any] = [
        html.Span([html.I(style={"background": each}, className="patch"), f"{name}: {which(base, name)}"], className="key")
        for name, each in key(base).items()
    ]
    note = "Numbered from the root: actuators full, sensors pale, below the blade where they cannot be seen; dashed: behind a wall."
    return html.Section([html.H2("Blade"), html.Img(id="picture", alt=""), html.P([*keys, html.Span(note)])], className="wide")


def _volts(base: BladeConfig) -> str:
    low, high = base.voltage_limits
    return f"{low:g} … {high:g} V".replace("-", "−")


def _section(heading: str, note: Any, content: Any) -> html.Section:
    return html.Section([html.H2(heading), html.P(note), content])


def _graph(name: str, height: int) -> html.Div:
    graph = dcc.Graph(id=name, config=_QUIET, style={"height": f"{height}px"})
    return html.Div(graph, role="img", **{"aria-label": SAID.get(name, "Mode shape along the span")})


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
