"""The page itself: one HTML file that needs no network."""

from __future__ import annotations

from collections.abc import Mapping
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
from train.page.blade import blade_figures, frame_times, motions
from train.page.plots import spectra, time_series
from train.page.recording import RecordedEpisode
from train.page.signals import drawn_signals, words
from train.page.table import Table
from train.shared.versions import versions


@dataclass(frozen=True, slots=True, eq=False)
class PageContent:
    """What a page shows; a part that is None is left out."""

    title: str
    note: str = ""
    """What the reader must know first."""
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

    @property
    def json(self) -> str:
        """For a script element: plotly escapes what could end one."""
        return str(self.figure.to_json())


@dataclass(frozen=True, slots=True, eq=False)
class Animation:
    """The blade under two controllers."""

    plots: tuple[Plot, Plot]
    times: list[float]
    """ms, of the frames."""
    note: str


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
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("beamenv.train.page", ""),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("page.html").render(
        content=content,
        animation=animation(content),
        plots=plots(content),
        themes=THEMES,
        templates=templates(),
        versions={**versions(), "plotly.js": get_plotlyjs_version()},
        plotly_js=get_plotlyjs(),
    )


@lru_cache(maxsize=1)
def templates() -> dict[str, Any]:
    """Each theme as plotly takes it."""
    return {name: theme.template() for name, theme in THEMES.items()}


def animation(content: PageContent) -> Animation | None:
    """The blade's pair of figures, when there is an episode."""
    if content.episode is None or not content.episode.has_shape:
        return None
    pair = blade_figures(content.episode)
    left, right = (Plot(f"blade-{side}", "", "", figure, 440) for side, figure in zip(("left", "right"), pair, strict=True))
    note = (
        f"Deflections are drawn {motions(content.episode)[1]:,.0f} times larger than life; thin lines: the blade at rest. "
        "Actuators are coloured by their voltage. Drag to turn both blades, scroll to zoom."
    )
    return Animation((left, right), [round(1e3 * float(time), 3) for time in frame_times(content.episode)], note)


def plots(content: PageContent) -> list[Plot]:
    """Every figure but the blade, in the order of the page."""
    found = []
    if content.heat_map is not None:
        found.append(_heat_map(content.heat_map))
    if content.episode is not None:
        found += _of_episode(content.episode, content.episode_note)
    if content.poles:
        note = (
            "Continuous equivalents log(z)/Δt of the sampled loops' poles, upper half plane. "
            "The real axis is logarithmic beyond 10 rad/s."
        )
        found.append(Plot("poles", "Closed-loop poles", note, _plotted(pole_panel(content.poles)), 480))
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
            )
        )
    return found


def _of_episode(episode: RecordedEpisode, which: str) -> list[Plot]:
    """Its course and its spectra."""
    signals, what = len(drawn_signals(episode)), words(episode)
    instant = "The upright line is the instant of the blade above." if episode.has_shape else which
    note = f"Panels share their time axis: zoom into one and all follow. {instant}".rstrip()
    height = 130 + 160 * (signals + len(episode.controlled))
    course = Plot("time-series", f"{what.capitalize()} and voltages", note, time_series(episode), height)
    of = "the tip" if episode.has_shape else f"the {what}"
    note = f"Spectra of {of} before and after: Hann window over the whole record, mean removed; dotted: natural frequencies."
    return [course, Plot("spectra", "Spectra", note, spectra(episode), 120 + 220 * signals)]


def _plotted(panel: Panel, **layout: Any) -> go.Figure:
    return go.Figure(screen.figure([panel])).update_layout(**layout)


def _heat_map(content: HeatMap) -> Plot:
    note = "; ".join([f"{QUANTITY}: {WAY}, dark is bad", *content.key.split("    ")]).rstrip("; ") + "."
    height, width = 180 + 44 * len(content.scenarios), 260 + 62 * len(content.controllers)
    return Plot("heat-map", "Scenarios", note, go.Figure(heat_map(content)), height, width)
