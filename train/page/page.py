"""The page itself: one HTML file that needs no network."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import jinja2
import plotly.graph_objects as go
from numpy.typing import NDArray
from plotly.offline import get_plotlyjs, get_plotlyjs_version

from beamenv.configuration.writing import write_whole
from train.figures import screen
from train.figures.figure import Panel
from train.figures.heat_map import QUANTITY, WAY, HeatMap
from train.figures.panels import LearningCurves, learning_panel, pole_panel
from train.figures.screen_heat_map import heat_map
from train.figures.themes import THEMES
from train.page import instead
from train.page.lead import Lead
from train.page.plots import spectra, time_series
from train.page.recording import RecordedEpisode
from train.page.shown import shown
from train.page.signals import drawn_signals, words
from train.page.table import Table
from train.shared.versions import versions

PANEL, REST = 160, 130
"""Pixels of each panel of an episode's course, and of what is about them."""


@dataclass(frozen=True, slots=True, eq=False)
class PageContent:
    """What a page shows; a part that is None is left out."""

    title: str
    note: str = ""
    """What must be known besides, a sentence a line."""
    table: Table | None = None
    heat_map: HeatMap | None = None
    episode: RecordedEpisode | None = None
    """The blade in motion, the course of the episode and its spectra."""
    episode_note: str = ""
    """Which episode that is."""
    poles: Mapping[str, NDArray[Any]] | None = None
    """rad/s, of each loop; the first one is drawn in grey: without control."""
    learning: LearningCurves | None = None
    configuration: Mapping[str, Any] | None = None
    """As JSON can hold it."""
    further: Mapping[str, Table] = field(default_factory=dict)
    """More tables, by their headings."""
    lead: Lead | None = None
    """What the reader is told first."""


@dataclass(frozen=True, slots=True, eq=False)
class Plot:
    """A figure with its place on the page."""

    name: str
    """Its id."""
    heading: str
    note: str
    figure: go.Figure
    height: int
    """Pixels."""
    width: int = 0
    """Least width in pixels; narrower screens scroll it sideways."""
    instead: str = ""
    """What it shows in words, for those who cannot see it."""
    panel: int = 0
    """Pixels that each panel adds, where readers choose how many there are."""
    rest: int = 0
    """Pixels besides the panels."""

    @property
    def json(self) -> str:
        """For a script element: plotly escapes what could end one."""
        return str(self.figure.to_json())


def write_page(path: Path, content: PageContent) -> None:
    """Write the page, whole or not at all.

    A comparison gives table, episode, poles, learning curves and configuration. A benchmark over scenarios gives
    ``PageContent(title, table=Table(...), heat_map=HeatMap.of({scenario: evaluations}), learning=LearningCurves(curves, levels),
    configuration={...})``, and may add an episode of any scenario: ``record_episode(arguments, seed, pair)``. Versions are
    always shown.
    """
    write_whole(path, render(content))


def render(content: PageContent) -> str:
    """The page as HTML, plotly.js (4.8 MB) once inside."""
    drawn = plots(content)
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("beamenv.train.page", ""),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("page.html").render(
        content=content,
        shown=None if content.episode is None else shown(content.episode),
        plots=drawn,
        parts=parts(content, drawn),
        themes=THEMES,
        templates=templates(),
        versions={**versions(), "plotly.js": get_plotlyjs_version()},
        plotly_js=get_plotlyjs(),
    )


def parts(content: PageContent, drawn: Sequence[Plot]) -> list[tuple[str, str]]:
    """Id and heading of every section, in the order of the page."""
    maps = [plot for plot in drawn if plot.name == "heat-map"]
    found = [(f"part-{place}", heading) for place, heading in enumerate(content.further, start=1)]
    found += [("table", "Controllers")] if content.table else []
    found += [(f"about-{plot.name}", plot.heading) for plot in maps]
    found += [("episode", "One episode")] if content.episode else []
    found += [(f"about-{plot.name}", plot.heading) for plot in drawn if plot not in maps]
    return [*found, ("provenance", "Configuration and versions")]


@lru_cache(maxsize=1)
def templates() -> dict[str, Any]:
    """Each theme as plotly takes it."""
    return {name: theme.template() for name, theme in THEMES.items()}


def plots(content: PageContent) -> list[Plot]:
    """Every figure but the blade, in the order of the page."""
    found = []
    if content.heat_map is not None:
        found.append(_heat_map(content.heat_map))
    if content.episode is not None:
        found += _of_episode(content.episode)
    if content.poles:
        note = (
            "Continuous equivalents log(z)/Δt of the sampled loops' poles, upper half plane. "
            "The real axis is logarithmic beyond 10 rad/s."
        )
        found.append(
            Plot(
                "poles",
                "Closed-loop poles",
                note,
                _plotted(pole_panel(content.poles)),
                480,
                instead=instead.of_poles(content.poles),
            )
        )
    if content.learning is not None and any(len(curve) for curve in content.learning.curves.values()):
        note = (
            "Agents: the policy without exploration on validation episodes; where it says so, the running cost in training. "
            "Level lines: controllers that do not learn, on the held-out episodes."
        )
        found.append(
            Plot(
                "learning",
                "Learning curves",
                note,
                _plotted(learning_panel(content.learning), hovermode="x"),
                420,
                instead=instead.of_learning(content.learning),
            )
        )
    return found


def _of_episode(episode: RecordedEpisode) -> list[Plot]:
    """Its course and its spectra."""
    signals, what = len(drawn_signals(episode)), words(episode)
    instant = " The upright line is the instant of the blade above." if episode.has_shape else ""
    note = f"Panels share their time axis: zoom into one and all follow.{instant}"
    controlled = len({0, episode.opens}) - 1
    height = REST + PANEL * (signals + controlled)
    title = f"{what.capitalize()} and voltages"
    seen = instead.of_course(episode)
    course = Plot("time-series", title, note, time_series(episode), height, instead=seen, panel=PANEL, rest=REST)
    of = "the tip" if episode.has_shape else f"the {what}"
    note = f"Spectra of {of}: Hann window over the whole record, mean removed; dotted: natural frequencies."
    seen = instead.of_spectra(episode)
    return [course, Plot("spectra", "Spectra", note, spectra(episode), 120 + 220 * signals, instead=seen)]


def _plotted(panel: Panel, **layout: Any) -> go.Figure:
    return go.Figure(screen.figure([panel])).update_layout(**layout)


def _heat_map(content: HeatMap) -> Plot:
    note = "; ".join([f"{QUANTITY}: {WAY}, dark is bad", *content.key.split("    ")]).rstrip("; ") + "."
    height, width = max(320, 180 + 44 * len(content.scenarios)), 260 + 62 * len(content.controllers)
    return Plot("heat-map", "Scenarios", note, go.Figure(heat_map(content)), height, width, instead.HEAT_MAP)
