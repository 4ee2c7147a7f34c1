"""The page and its callbacks."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from threading import Lock
from typing import Any

from dash import ClientsideFunction, Dash, Input, Output, State, no_update
from dash.exceptions import DashException
from werkzeug.exceptions import HTTPException, NotFound
from werkzeug.wrappers import Response

from train.explore import figures, loop_figures
from train.explore.blade import CAMPBELL_MODES, blade_of, view
from train.explore.controls import THESIS_PAGE, Page
from train.explore.hertz import hertz
from train.explore.layout import layout
from train.explore.loop import loop
from train.explore.picture import picture, said
from train.explore.requests import ANSWERED, OnlyThePage, told
from train.explore.saved import saved
from train.explore.tables import cost_note, damping_rows, filter_note, heading, margin_rows
from train.figures.themes import THEMES
from train.shared.threads import one_thread

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
    _in_the_browser(app, page)
    answers = {}
    for asked, busy, outputs, answer in (
        ("wanted", "busy", quick_outputs(page), redraw),
        ("settled", "analysing", thorough_outputs(), analyse),
    ):
        before = set(app.callback_map)
        app.callback(outputs, Input(asked, "data"), running=[(Output(busy, "data"), True, False)], prevent_initial_call=True)(
            lambda values, answer=answer: answer(page, **dict(zip(page.controls, values, strict=True)))
        )
        (output,) = set(app.callback_map) - before
        answers[output] = asked
    app.server.wsgi_app = OnlyThePage(app.server.wsgi_app, answers, page)
    return app


def _in_the_browser(app: Dash, page: Page) -> None:
    """What the page does by itself: one list of values for all its controls, its pace, and the buttons."""
    fields = [field for name, entry in page.controls.items() for field in entry.entries(name)]
    values = [(name, "value") for name in (*page.controls, *fields)]
    triggers = [Input("link", "data"), Input("reset", "n_clicks"), *(Input(*value) for value in values)]
    kept = [State("about", "data"), State("state", "data")]
    for name, outputs, inputs in (
        ("settle", [*(Output(*value) for value in values), Output("state", "data")], [*triggers, *kept]),
        ("newest", Output("wanted", "data"), [Input("state", "data")]),
        ("rested", Output("settled", "data"), [Input("busy", "data"), State("wanted", "data")]),
        ("analysed", Output("named", "data"), [Input("analysing", "data")]),
        ("copied", Output("done", "children"), [Input("copy", "n_clicks")]),
        ("saved", Output("done", "children", allow_duplicate=True), [Input("save", "n_clicks"), State("file", "data")]),
    ):
        app.clientside_callback(ClientsideFunction("explore", name), outputs, *inputs, prevent_initial_call=name == "saved")


def refusal(error: HTTPException) -> Response:
    """What Flask and Dash refuse, in one sentence."""
    return told(f"{error.name.lower()}: {ANSWERED}.", error.code)


def theme() -> str:
    """Colours of both schemes as variables of the style sheet."""
    names = ("paper", "panel", "ink", "faint", "grid")
    light, dark = THEMES["light"], THEMES["dark"]
    return ":root{" + "".join(f"--{name}:light-dark({getattr(light, name)},{getattr(dark, name)});" for name in names) + "}"


def quick_outputs(page: Page = THESIS_PAGE) -> dict[str, Any]:
    """What is given while a control moves, by the names that ``redraw`` uses."""
    return {
        "hertz": [Output("speed-value", "children")] if "speed" in page.ranges else [],
        "message": Output("message", "children"),
        "results": Output("results", "hidden"),
        "file": Output("file", "data"),
        "save": Output("save", "children"),
        "picture": Output("picture", "src"),
        "said": Output("picture", "alt"),
        "campbell": Output("campbell", "figure"),
        "response": Output("response", "figure"),
        "damping": Output("damping", "children"),
        "filter": Output("filter", "children"),
        "shapes": [Output(name, "figure") for name in SHAPES],
        "headings": [Output(f"{name}-heading", "children") for name in SHAPES],
    }


def thorough_outputs() -> dict[str, Any]:
    """What is given once the controls rest, by the names that ``analyse`` uses."""
    return {
        "lost": Output("lost", "children"),
        "poles": Output("poles", "figure"),
        "bode": Output("bode", "figure"),
        "singular": Output("singular", "figure"),
        "margins": Output("margins", "children"),
        "cost": Output("cost", "children"),
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
    kept = {name: [no_update] * len(each) if isinstance(each, list) else no_update for name, each in quick_outputs(page).items()}
    try:
        wanted = page.settings(values)
        seen, blade = view(wanted, page.base), blade_of(wanted, page.base)
    except ValueError as error:
        return {**kept, "message": str(error), "results": True, "file": None}
    name, text = saved(blade.config)
    return {
        "hertz": [hertz(seen.speed)] * len(kept["hertz"]),
        "message": "",
        "results": False,
        "file": {"name": name, "text": text},
        "save": f"Save as {name}",
        "picture": picture(blade.config, blade.beam),
        "said": said(blade.config),
        "campbell": figures.campbell_diagram(seen),
        "response": figures.step_response(seen),
        "damping": damping_rows(seen),
        "filter": filter_note(seen),
        "shapes": [figures.mode_shape(seen, mode) for mode in range(CAMPBELL_MODES)],
        "headings": [heading(seen, mode) for mode in range(CAMPBELL_MODES)],
    }


def analyse(page: Page = THESIS_PAGE, **values: Any) -> dict[str, Any]:
    """What is said of the loop for the controls' values; where there is none, one sentence beside what was said last."""
    with ONE_AT_A_TIME, one_thread():
        return analysed(values, page)


def analysed(values: Mapping[str, Any], page: Page = THESIS_PAGE) -> dict[str, Any]:
    """What ``analyse`` gives, on as many threads as there are."""
    try:
        closed = loop(page.settings(values), page.base)
    except ValueError as error:
        return {**dict.fromkeys(thorough_outputs(), no_update), "lost": str(error)}
    return {
        "lost": "",
        "poles": loop_figures.poles(closed),
        "bode": loop_figures.bode(closed),
        "singular": loop_figures.singular_values(closed),
        "margins": margin_rows(closed),
        "cost": cost_note(closed),
    }
