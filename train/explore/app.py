"""The page and its one callback."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from threading import Lock
from typing import Any

from dash import ClientsideFunction, Dash, Input, Output, html, no_update
from dash.exceptions import DashException
from werkzeug.exceptions import HTTPException, NotFound
from werkzeug.wrappers import Response

from beamenv.configuration import Refused
from train.explore.blade import CAMPBELL_MODES, Settings, View, view
from train.explore.figures import campbell_diagram, mode_shape, step_response
from train.explore.layout import THESIS_PAGE, Page, layout
from train.explore.requests import ANSWERED, OnlyThePage, told
from train.figures.themes import THEMES
from train.shared.threads import one_thread

SIDES = ("actuators", "sensors")
SHAPES = tuple(f"shape-{mode}" for mode in range(CAMPBELL_MODES))
"""Ids of the small figures."""

ONE_AT_A_TIME = Lock()

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{%title%}</title>
<link rel="icon" href="data:,">
<style>THEME</style>
{%css%}
</head>
<body>
{%app_entry%}
<footer>{%config%}{%scripts%}{%renderer%}</footer>
</body>
</html>"""


def create_app(page: Page = THESIS_PAGE) -> Dash:
    """The page of a blade as a Flask application that asks for nothing beyond this computer."""
    app = Dash(
        __name__,
        assets_folder=str(files("beamenv.train.explore") / "assets"),
        serve_locally=True,
        title="beamenv explore",
        update_title="",
        compress=False,
    )
    app.index_string = PAGE.replace("THEME", theme())
    app.server.register_error_handler(HTTPException, refusal)
    app.server.register_error_handler(DashException, lambda _: refusal(NotFound()))
    app.server.view_functions["/<path:path>"] = lambda path: refusal(NotFound())  # Dash gives the page under every name
    app.layout = layout(page)
    app.clientside_callback(
        ClientsideFunction("explore", "newest"), Output("wanted", "data"), [Input(name, "value") for name in page.controls]
    )
    app.clientside_callback(ClientsideFunction("explore", "goOn"), Input("busy", "data"))
    app.callback(
        outputs(page), Input("wanted", "data"), running=[(Output("busy", "data"), True, False)], prevent_initial_call=True
    )(lambda wanted: redraw(**dict(zip(page.controls, wanted, strict=True)), page=page))
    (callback,) = (name for name in app.callback_map if name.startswith(".."))
    app.server.wsgi_app = OnlyThePage(app.server.wsgi_app, callback, page)
    return app


def refusal(error: HTTPException) -> Response:
    """What Flask and Dash refuse, in one sentence."""
    return told(f"{error.name.lower()}: {ANSWERED}.", error.code)


def theme() -> str:
    """Colours of both schemes as variables of the style sheet."""
    names = ("paper", "panel", "ink", "faint", "grid")
    light, dark = THEMES["light"], THEMES["dark"]
    return ":root{" + "".join(f"--{name}:light-dark({getattr(light, name)},{getattr(dark, name)});" for name in names) + "}"


def outputs(page: Page = THESIS_PAGE) -> dict[str, Any]:
    """What the callback gives, by the names that ``redraw`` uses."""
    return {
        "values": [Output(f"{name}-value", "children") for name in page.ranges],
        "message": Output("message", "children"),
        "results": Output("results", "hidden"),
        "campbell": Output("campbell", "figure"),
        "response": Output("response", "figure"),
        "damping": Output("damping", "children"),
        "filter": Output("filter", "children"),
        "shapes": [Output(name, "figure") for name in SHAPES],
        "headings": [Output(f"{name}-heading", "children") for name in SHAPES],
    }


def redraw(page: Page = THESIS_PAGE, **values: Any) -> dict[str, Any]:
    """Figures for the controls' values; for what makes no blade, one sentence in their place.

    On one BLAS thread, for matrices are so small that a second one makes it five times slower; one redraw at a time, for that
    limit is the whole process'.
    """
    with ONE_AT_A_TIME, one_thread():
        return drawn(values, page)


def drawn(values: Mapping[str, Any], page: Page = THESIS_PAGE) -> dict[str, Any]:
    """What ``redraw`` gives, on as many threads as there are."""
    texts = [entry.text(values[name]) for name, entry in page.ranges.items()]
    try:
        seen = view(settings(**values), page.base)
    except ValueError as error:
        kept = dict.fromkeys(("campbell", "response", "damping", "filter"), no_update)
        rows = {name: [no_update] * CAMPBELL_MODES for name in ("shapes", "headings")}
        return {"values": texts, "message": str(error), "results": True, **kept, **rows}
    return {
        "values": texts,
        "message": "",
        "results": False,
        "campbell": campbell_diagram(seen),
        "response": step_response(seen),
        "damping": damping_rows(seen),
        "filter": filter_note(seen),
        "shapes": [mode_shape(seen, mode) for mode in range(CAMPBELL_MODES)],
        "headings": [heading(seen, mode) for mode in range(CAMPBELL_MODES)],
    }


def settings(**values: Any) -> Settings:
    """The controls' values, with patches in mm, as settings."""
    for name, value in values.items():
        if value is None:
            raise Refused(name, value, "what its control can have")
    metres = {side: tuple(round(1e-3 * edge, 9) for edge in values[side]) for side in SIDES if side in values}
    return Settings(**values | metres)


def heading(seen: View, mode: int) -> str:
    """Of one mode's small figure."""
    return f"{mode + 1} {seen.families[mode]}, {seen.natural_frequencies[mode]:.1f} rad/s"


def damping_rows(seen: View) -> list[html.Tr]:
    """A row a mode: number, family, frequency, damping in per cent."""
    rows = zip(seen.families, seen.natural_frequencies, 100.0 * seen.damping.free, 100.0 * seen.damping.controlled, strict=True)
    return [
        html.Tr([html.Td(cell) for cell in (f"{mode} {family}", f"{frequency:.1f}", f"{free:.2f}", f"{controlled:.2f}")])
        for mode, (family, frequency, free, controlled) in enumerate(rows, start=1)
    ]


def filter_note(seen: View) -> str:
    """On the poles that the table does not hold."""
    return (
        "Natural frequencies ω, and damping ratios ζ of the blade alone and with LQG: of the regulator's poles. "
        f"The loop's other poles are its Kalman filter's, whose error decays at {seen.damping.filter_rate:.1f} 1/s or faster."
    )
