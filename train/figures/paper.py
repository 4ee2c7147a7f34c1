"""Figures as PNG, by matplotlib."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from beamenv.configuration.writing import write_whole
from beamenv.rendering.charts import spread
from train.figures.figure import Curve, Marker, Panel, listed
from train.figures.palette import BEHIND, INK
from train.shared.files import on_one_line

STYLE: Mapping[str, Any] = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 9,
    "legend.frameon": False,
    "lines.linewidth": 1.0,
    "lines.markersize": 5,
}
THEMES: Mapping[str, Mapping[str, str]] = {
    "light": {"paper": "#ffffff", "ink": INK, "behind": BEHIND, "wall": "#cccccc", "cell": "#ededed", "grid": "#e0e0e0"},
    "dark": {"paper": "#0d1117", "ink": "#e6eaef", "behind": "#5f6b78", "wall": "#6b7684", "cell": "#212b36", "grid": "#27303b"},
}
"""What is no datum, on the paper of a light and of a dark page."""
DOTS = 200
"""An inch, which the file tells: pages show a picture at half its pixels, sharp on fine screens too."""
DASHES: Mapping[str, Any] = {
    "solid": "-",
    "dotted": (0, (1.2, 1.4)),
    "dashed": (0, (5, 2)),
    "dashdot": (0, (6, 2, 1.2, 2)),
    "points": "",
    "bars": "-",
}
END, PIECE = 10.5, 18.0
"""Points: from one curve's name at its end to the next, at least, and how long the piece of line beside it is."""
BAR = 3.5
"""Points: how broad bars are."""
DECADES = 500.0
"""Ratio of the ends of a logarithmic axis up to which there is room for 2 and 5 between the powers of ten."""
PLAIN_TICKS = (1e-2, 1e4)
"""Limits within which the numbers of a logarithmic axis are written as they are, not as powers of ten."""
SIGNS = {
    "point": ".",
    "circle": "o",
    "square": "s",
    "triangle-up": "^",
    "triangle-down": "v",
    "triangle-left": "<",
    "triangle-right": ">",
    "diamond": "D",
    "cross": "P",
    "x": "X",
    "pentagon": "p",
    "cross-thin": "+",
    "x-thin": "x",
}
"""By plotly's names."""
STEPS = {"ends": "steps-pre", "begins": "steps-post"}


def styled(theme: str = "light") -> Any:
    """The context in which figures of a theme are made."""
    import matplotlib.pyplot as plt

    return plt.rc_context({**STYLE, **themed(theme)})


def themed(theme: str) -> dict[str, str]:
    """Matplotlib's settings for ink and paper of a theme."""
    inked = ("text.color", "axes.edgecolor", "axes.labelcolor", "axes.titlecolor", "xtick.color", "ytick.color")
    papered = ("figure.facecolor", "axes.facecolor", "savefig.facecolor")
    colours = THEMES[theme]
    return {**dict.fromkeys(inked, colours["ink"]), **dict.fromkeys(papered, colours["paper"]), "grid.color": colours["grid"]}


def on_paper(colour: str) -> str:
    """A colour as the theme that is drawn in has it: ink, and what lies behind ink, follow the paper."""
    from matplotlib import rcParams

    theme = next((each for each in THEMES.values() if each["paper"] == rcParams["axes.facecolor"]), THEMES["light"])
    return {INK: theme["ink"], BEHIND: theme["behind"]}.get(colour, colour)


def save(figure: Any, path: Path) -> None:
    """A PNG without margins, whole or not at all."""
    _save(figure, path, tight=True)


def save_themes(drawn: Callable[[str], Any], path: Path, tight: bool = False) -> None:
    """A figure, drawn in the theme that is named, as a PNG for light pages and one beside it for dark ones.

    Of the figure's own size, or ``tight``: without margins.
    """
    for theme in THEMES:
        _save(drawn(theme), path if theme == "light" else dark(path), tight)


def dark(path: Path) -> Path:
    """Where the picture for dark pages lies: beside the one for light pages, as ``…-dark.png``."""
    return path.with_stem(f"{path.stem}-dark")


def _save(figure: Any, path: Path, tight: bool) -> None:
    """At ``DOTS``, in 256 colours: a third of the bytes, and no difference to the eye."""
    import matplotlib.pyplot as plt
    from PIL import Image

    picture, compact = io.BytesIO(), io.BytesIO()
    figure.savefig(picture, format="png", dpi=DOTS, bbox_inches="tight" if tight else None)
    plt.close(figure)
    few = Image.open(picture).convert("RGB").quantize(256, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    few.save(compact, format="png", optimize=True, dpi=(DOTS, DOTS))
    write_whole(path, compact.getvalue())


def plain(text: str) -> str:
    """Text drawn as it stands: matplotlib sets what is between dollars as formulae, and lists no label that begins with _."""
    line = on_one_line(text).replace("$", r"\$")
    return f" {line}" if line.startswith("_") else line


def draw_panel(axis: Any, panel: Panel) -> None:
    """A panel on a pair of axes."""
    for x in panel.marked:
        axis.axvline(x, color="0.6", linewidth=0.8, linestyle=DASHES[panel.marked_line], zorder=0)
    for curve in panel.curves:
        draw_curve(axis, curve)
    for note in panel.notes:
        axis.text(note.x, note.y, plain(note.text), ha="right", va="top")
    axis.set(title=plain(panel.title), xlabel=plain(panel.x_label), ylabel=plain(panel.y_label))
    _scale(axis, panel)
    if panel.whole:
        axis.yaxis.get_major_locator().set_params(integer=True)
    if panel.y_names:
        axis.set_yticks(range(1, len(panel.y_names) + 1), [plain(name) for name in panel.y_names])


def _scale(axis: Any, panel: Panel) -> None:
    """Linear or logarithmic axes and their limits."""
    if panel.x_linear_within is not None:
        axis.set_xscale("symlog", linthresh=panel.x_linear_within)
        axis.xaxis.set_major_formatter(lambda value, _: f"{value:g}".replace("-", "−"))
    for logarithmic, set_scale in ((panel.x_logarithmic, axis.set_xscale), (panel.logarithmic, axis.set_yscale)):
        if logarithmic:
            set_scale("log")
    if panel.x_limits != (None, None):
        axis.set_xlim(*panel.x_limits)
    if panel.y_limits != (None, None):
        axis.set_ylim(*panel.y_limits)
    for logarithmic, ticks in ((panel.x_logarithmic, axis.xaxis), (panel.logarithmic, axis.yaxis)):
        low, high = sorted(ticks.get_view_interval())
        if logarithmic and PLAIN_TICKS[0] <= low and high <= PLAIN_TICKS[1]:
            _write_plainly(ticks)


def _write_plainly(ticks: Any) -> None:
    """1, 2, 5, 10, … along a logarithmic axis; without 2 and 5 where there would be too many."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = sorted(ticks.get_view_interval())
    ticks.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < DECADES * low else (1.0,)))
    ticks.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ticks.set_minor_formatter(NullFormatter())


def draw_curve(axis: Any, curve: Curve) -> None:
    """A curve on a pair of axes."""
    every = {} if curve.look.marker is None else {"markevery": curve.look.marker.every}
    steps = {"drawstyle": STEPS[curve.joined]} if curve.joined in STEPS else {}
    axis.plot(curve.x, curve.y, **appearance(curve), **every, **steps)


def appearance(curve: Curve) -> dict[str, Any]:
    """How matplotlib draws a curve's line and markers, in the axes and in the legend."""
    look = curve.look
    style: dict[str, Any] = {"color": on_paper(look.colour), "linestyle": DASHES[curve.line], "alpha": look.opacity}
    if look.width is not None:
        style["linewidth"] = look.width
    if curve.line == "bars":
        style |= {"linewidth": look.width or BAR, "solid_capstyle": "butt"}
    if look.above:
        style["zorder"] = 3
    return style if look.marker is None else {**style, **marking(look.marker)}


def marking(marker: Marker) -> dict[str, Any]:
    """How matplotlib draws a sign."""
    from matplotlib import rcParams

    size = {} if marker.size is None else {"markersize": marker.size}
    fills = {"none": {"markerfacecolor": "none"}, "white": {"markerfacecolor": rcParams["axes.facecolor"]}}
    return {"marker": SIGNS[marker.sign], **fills.get(marker.fill, {}), **size}


def name_ends(axis: Any, panel: Panel) -> None:
    """The names of curves right of the axes, each at the height at which its curve ends or near it, with a piece of its line.

    Of a figure whose layout is there, as ``draw_without_rendering`` finds it.
    """
    from matplotlib.lines import Line2D
    from matplotlib.offsetbox import AnnotationBbox, DrawingArea, HPacker, TextArea

    curves, box = listed([panel]), axis.get_window_extent()
    ends = [axis.transData.transform((curve.x[-1], curve.y[np.isfinite(curve.y)][-1]))[1] for curve in curves]
    heights = spread(np.array(ends), box.y0, box.y1, END / 72.0 * axis.figure.dpi) if curves else np.empty(0)
    for curve, height in zip(curves, ((heights - box.y0) / box.height).tolist(), strict=True):
        piece = DrawingArea(PIECE, 4.0)
        piece.add_artist(Line2D([0.0, PIECE], [2.0, 2.0], **appearance(curve)))
        name = TextArea(plain(curve.label), textprops={"fontsize": 8})
        beside = HPacker(children=[piece, name], align="center", pad=0.0, sep=4.0)
        held = AnnotationBbox(
            beside, (1.0, height), (5.0, 0.0), "axes fraction", "offset points", box_alignment=(0.0, 0.5), frameon=False, pad=0.0
        )
        axis.add_artist(held)


def handles(panels: Sequence[Panel]) -> list[Any]:
    """The entries of a legend of some panels, one for each label."""
    from matplotlib.lines import Line2D

    return [Line2D([], [], label=plain(curve.label), **appearance(curve)) for curve in listed(panels)]
