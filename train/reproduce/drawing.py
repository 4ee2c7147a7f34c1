"""The one drawing of all figures: panels of curves, distinguished by lightness, marker and line, with the legend outside."""

from __future__ import annotations

import io
from collections.abc import Sequence
from importlib.resources import as_file, files
from typing import Any

import numpy as np

from train.reproduce.judging.study import Curve, Grid, Outcome, Panel

DASHES: dict[str, Any] = {"solid": "-", "dotted": (0, (1.2, 1.4)), "dashed": (0, (5, 2)), "points": ""}
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<", ">", "p")
PLAIN = {"color": "0.1"}
Looks = dict[str, dict[str, Any]]
PAGE_WIDTH, SINGLE_WIDTH, PANEL_HEIGHT, LOW_PANEL_HEIGHT, LEGEND_ROW = 8.6, 6.2, 2.7, 1.9, 0.22
"""Inches."""


def draw(outcome: Outcome, title: str) -> bytes:
    """The outcome's panels as one PNG."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    with as_file(files("train.reproduce").joinpath("look.mplstyle")) as look, pyplot.style.context(str(look)):
        columns = len(outcome.panels) if len(outcome.panels) <= 3 else 2
        rows = -(-len(outcome.panels) // columns)
        width = PAGE_WIDTH if columns > 1 else SINGLE_WIDTH
        handles = legend_handles(outcome)
        per_row = max(1, int(width // 2.1))
        height = (PANEL_HEIGHT if rows < 4 else LOW_PANEL_HEIGHT) * rows + 0.3 + LEGEND_ROW * (-(-len(handles) // per_row))
        figure, axes = pyplot.subplots(rows, columns, figsize=(width, height), squeeze=False)
        looks = appearances(outcome)
        for axis, panel in zip(axes.flat, outcome.panels, strict=False):
            draw_grid(axis, panel) if isinstance(panel, Grid) else draw_panel(axis, panel, looks, "dotted" in outcome.lines)
        for axis in axes.flat[len(outcome.panels) :]:
            axis.set_visible(False)
        figure.suptitle(title, fontsize=10, x=0.01, ha="left")
        if handles:
            figure.legend(handles=handles, loc="outside lower center", ncols=per_row)
        buffer = io.BytesIO()
        figure.savefig(buffer, format="png")
        pyplot.close(figure)
    return compact(buffer)


def compact(picture: io.BytesIO) -> bytes:
    """The same picture in 64 colours: a third of the bytes, and no difference to the eye."""
    from PIL import Image

    smaller = io.BytesIO()
    Image.open(picture).convert("RGB").quantize(64).save(smaller, format="png", optimize=True)
    return smaller.getvalue()


def labels_of(panels: Sequence[Panel | Grid]) -> list[str]:
    """The labels of all curves, in the order of their first appearance."""
    curves = [curve for panel in panels if isinstance(panel, Panel) for curve in panel.curves]
    return list(dict.fromkeys(curve.label for curve in curves if curve.label))


def appearances(outcome: Outcome) -> Looks:
    """Colour and marker of each label: a marker of its own, and a lightness that falls from dark to light within its panel."""
    from matplotlib import colormaps

    labels = labels_of(outcome.panels)
    if len(labels) < 2:
        return {}
    looks: dict[str, dict[str, Any]] = {}
    for panel in outcome.panels:
        together = labels_of([panel])
        for place, label in enumerate(together):
            lightness = 0.78 * place / max(1, len(together) - 1)
            looks.setdefault(
                label, {"color": colormaps["viridis"](lightness), "marker": MARKERS[labels.index(label) % len(MARKERS)]}
            )
    return looks


def legend_handles(outcome: Outcome) -> list[Any]:
    """One entry for each meaning of a line and for each label."""
    from matplotlib.lines import Line2D

    labels, looks = labels_of(outcome.panels), appearances(outcome)
    used = {
        label: {
            curve.line for panel in outcome.panels if isinstance(panel, Panel) for curve in panel.curves if curve.label == label
        }
        for label in labels
    }
    pale: dict[str, Any] = {"linewidth": 2.6, "alpha": 0.5} if "dotted" in outcome.lines else {}
    handles = [
        Line2D(
            [],
            [],
            color="0.1",
            linestyle=DASHES[line],
            marker="." if line == "points" else "",
            label=text,
            **(pale if line == "solid" else {}),
        )
        for line, text in outcome.lines.items()
    ]
    scatters = all(lines == {"points"} for lines in used.values())
    for label in labels:
        line = "" if used[label] == {"points"} else "-" if len(used[label]) > 1 else DASHES[next(iter(used[label]))]
        fill = {"markerfacecolor": "none"} if scatters and label != labels[0] else {}
        handles.append(Line2D([], [], linestyle=line, label=label, **{"marker": ".", **looks.get(label, PLAIN), **fill}))
    return handles


def draw_panel(axis: Any, panel: Panel, looks: Looks, in_pairs: bool) -> None:
    """One pair of axes. Where dotted curves run on solid ones, these are broad and pale so that both show."""
    points = any(curve.line == "points" for curve in panel.curves)
    scattered = all(curve.line == "points" for curve in panel.curves)
    for value in panel.marked:
        axis.axvline(value, color="0.6", linewidth=0.8, zorder=0)
    for curve in panel.curves:
        draw_curve(axis, curve, looks, in_pairs, marked=not points, hollow=scattered and curve is not panel.curves[0])
    axis.set(title=panel.title, xlabel=panel.x_label, ylabel=panel.y_label)
    if panel.logarithmic:
        axis.set_yscale("log")
    if panel.whole:
        axis.yaxis.get_major_locator().set_params(integer=True)


def draw_curve(axis: Any, curve: Curve, looks: Looks, in_pairs: bool, marked: bool, hollow: bool = False) -> None:
    """One curve; its markers are sparse and begin at a place of its own, so that they do not pile up.

    Where points of the same label mean something (not ``marked``) the line goes without markers. ``hollow`` points do not hide
    others.
    """
    style = {**looks.get(curve.label, PLAIN)}
    if not marked and curve.line != "points":
        style.pop("marker", None)
    if curve.line == "points":
        fill = {"markerfacecolor": "none", "markersize": 6} if hollow else {}
        axis.plot(curve.x, curve.y, linestyle="", **{"marker": ".", **style, **fill})
        return
    if style.get("marker"):
        place, points = list(looks).index(curve.label), len(curve.x)
        spacing = max(1, points // 7)
        style["markevery"] = 1 if points <= 12 else (place * spacing // len(looks) % spacing, spacing)
        if curve.line != "solid":
            style["markerfacecolor"] = "white"
    if in_pairs:
        style |= {"linewidth": 2.6, "alpha": 0.5} if curve.line == "solid" else {"zorder": 3}
    axis.plot(curve.x, curve.y, linestyle=DASHES[curve.line], **style)


def draw_grid(axis: Any, grid: Grid) -> None:
    """A table of text cells."""
    axis.set_axis_off()
    axis.set_title(grid.title)
    cells = [[grid.cells.get((row, column), "") for column in grid.names] for row in grid.names]
    shade = [["0.93" if cell else "white" for cell in line] for line in cells]
    table = axis.table(cells, cellColours=shade, rowLabels=grid.names, colLabels=grid.names, loc="center", cellLoc="center")
    table.scale(1.0, 1.25)
    table.auto_set_font_size(False)
    table.set_fontsize(8)


def curve_rows(outcome: Outcome) -> tuple[list[str], list[list[object]]]:
    """Header and rows of a figure's numbers: every point of every curve."""
    rows: list[list[object]] = []
    for panel in outcome.panels:
        if isinstance(panel, Panel):
            for curve in panel.curves:
                meaning = outcome.lines.get(curve.line, "") if curve.line in outcome.lines else ""
                points = zip(np.asarray(curve.x).tolist(), np.asarray(curve.y).tolist(), strict=True)
                rows += [
                    [panel.title, curve.label, meaning, f"{x:.8g}", f"{y:.8g}", panel.x_label, panel.y_label] for x, y in points
                ]
    return ["panel", "curve", "line", "x", "y", "x quantity", "y quantity"], rows
