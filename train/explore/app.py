"""The page and its callbacks."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from threading import Lock
from typing import Any

from dash import ClientsideFunction, Dash, Input, Output, State, html, no_update
from dash.exceptions import DashException
from werkzeug.exceptions import HTTPException, NotFound
from werkzeug.wrappers import Response

from train.explore import along, figures, loop_figures
from train.explore.blade import CAMPBELL_MODES, blade_of, view
from train.explore.controls import THESIS_PAGE, Page
from train.explore.hertz import hertz
from train.explore.layout import layout
from train.explore.loop import loop
from train.explore.picture import picture, said
from train.explore.requests import ANSWERED, OnlyThePage, told
from train.explore.saved import saved
from train.explore.section_picture import Cut, first_patch, plies_picture, section_picture, section_said
from train.explore.stoppable import Stopped, stop, stoppable
from train.explore.tables import along_rows, cost_note, damping_rows, filter_note, heading, margin_rows, peaks, title
from train.figures.themes import THEMES
from train.shared.threads import one_thread

SHAPES = tuple(f"shape-{mode}" for mode in range(CAMPBELL_MODES))
"""Ids of the small figures."""

ONE_AT_A_TIME = Lock()
STOPPED = "Stopped: what is shown is of the values before. Move a control, or reset, to compute again."

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
        title=f"{page.name} – beamenv explore",
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
        ("stopping", "ending", {"stopped": Output("stopped", "data")}, stop_all),
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
    kept = [State("blade", "data"), State("about", "data"), State("state", "data")]
    for name, outputs, inputs in (
        (
            "settle",
            [*(Output(*value) for value in values), Output("state", "data"), Output("notice", "children")],
            [*triggers, *kept],
        ),
        ("newest", Output("wanted", "data"), [Input("state", "data")]),
        ("rested", Output("settled", "data"), [Input("busy", "data"), State("wanted", "data")]),
        ("analysed", Output("named", "data"), [Input("analysing", "data")]),
        ("ended", Output("stopping", "data"), [Input("stop", "n_clicks"), State("state", "data")]),
        ("copied", Output("done", "children"), [Input("copy", "n_clicks"), State("blade", "data")]),
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
        "title": Output("title", "children"),
        "hertz": [Output("speed-value", "children")] if "speed" in page.ranges else [],
        "message": Output("message", "children"),
        "results": Output("results", "hidden"),
        "file": Output("file", "data"),
        "save": Output("save", "children"),
        "picture": Output("picture", "src"),
        "said": Output("picture", "alt"),
        "section": Output("section", "src"),
        "plies": Output("plies", "src"),
        "walls": Output("walls", "children"),
        "planform": Output("planform", "figure"),
        "along": Output("along", "children"),
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
        "sensitivity": Output("sensitivity", "figure"),
        "peaks": Output("peaks", "children"),
        "margins": Output("margins", "children"),
        "cost": Output("cost", "children"),
    }


def redraw(page: Page = THESIS_PAGE, **values: Any) -> dict[str, Any]:
    """Figures for the controls' values; for what makes no blade, one sentence in their place.

    On one BLAS thread, for matrices are so small that a second one makes it five times slower; one redraw at a time, for that
    limit is the whole process'.
    """
    with ONE_AT_A_TIME, one_thread():
        try:
            return stoppable(lambda: drawn(values, page))
        except Stopped:
            return {**_kept(page), "message": STOPPED}


def drawn(values: Mapping[str, Any], page: Page = THESIS_PAGE) -> dict[str, Any]:
    """What ``redraw`` gives, on as many threads as there are."""
    kept = _kept(page)
    try:
        wanted = page.settings(values)
        seen, blade = view(wanted, page.base), blade_of(wanted, page.base)
        at = first_patch(page.base) if wanted.station is None else wanted.station
        cut = Cut.at(blade.config, blade.beam, at)
    except ValueError as error:
        return {**kept, "message": str(error), "results": True, "file": None}
    name, text = saved(blade.config)
    return {
        "title": title(seen, page.name),
        "hertz": [hertz(seen.speed)] * len(kept["hertz"]),
        "message": "",
        "results": False,
        "file": {"name": name, "text": text},
        "save": f"Save as {name}",
        "picture": picture(blade.config, blade.beam),
        "said": said(blade.config),
        "section": section_picture(cut),
        "plies": plies_picture(cut),
        "walls": [html.Li(line) for line in section_said(cut)],
        "planform": along.planform(blade.beam, at),
        "along": along_rows(blade.beam),
        "campbell": figures.campbell_diagram(seen),
        "response": figures.step_response(seen),
        "damping": damping_rows(seen),
        "filter": filter_note(seen),
        "shapes": [figures.mode_shape(seen, mode) for mode in range(CAMPBELL_MODES)],
        "headings": [heading(seen, mode) for mode in range(CAMPBELL_MODES)],
    }


def _kept(page: Page) -> dict[str, Any]:
    return {name: [no_update] * len(each) if isinstance(each, list) else no_update for name, each in quick_outputs(page).items()}


def stop_all(page: Page = THESIS_PAGE, **values: Any) -> dict[str, Any]:  # noqa: ARG001 - as the page asks for all else
    """End what is being computed."""
    stop()
    return {"stopped": None}


def analyse(page: Page = THESIS_PAGE, **values: Any) -> dict[str, Any]:
    """What is said of the loop for the controls' values; where there is none, one sentence beside what was said last."""
    with ONE_AT_A_TIME, one_thread():
        try:
            return stoppable(lambda: analysed(values, page))
        except Stopped:
            return {**dict.fromkeys(thorough_outputs(), no_update), "lost": STOPPED}


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
        "sensitivity": loop_figures.sensitivity(closed),
        "peaks": peaks(closed),
        "margins": margin_rows(closed),
        "cost": cost_note(closed),
    }
