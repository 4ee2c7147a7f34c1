"""The one drawing of all figures: panels of curves, distinguished by lightness, marker and line, with the legend outside."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import replace
from importlib.resources import as_file, files
from typing import Any

import numpy as np

from train.figures.figure import PLAIN, Curve, Look, Marker, Panel
from train.figures.paper import THEMES, draw_panel, handles, themed
from train.reproduce.judging.study import Grid, Outcome
from train.reproduce.thesis.points import is_printed

SIGNS = (
    *("circle", "square", "triangle-up", "diamond", "triangle-down"),
    *("cross", "x", "triangle-left", "triangle-right", "pentagon"),
)
PALE = replace(PLAIN, width=2.6, opacity=0.5)
NOTHING = np.empty(0)
Looks = dict[str, Look]
MATERIALS = {"MFC": (0.0, "circle"), "PZT": (0.3, "square")}
"""Lightness and sign of patches of a material, the same in all figures."""
LIGHTEST = 0.59
"""Contrast of 3 on white, as lines must have."""
DIMMEST = 0.32
"""Likewise on dark paper, where the darkest of white paper is the lightest."""
PAGE_WIDTH, SINGLE_WIDTH, PANEL_HEIGHT, LOW_PANEL_HEIGHT, LEGEND_ROW = 8.6, 6.2, 2.7, 1.9, 0.22
"""Inches."""


def draw(outcome: Outcome, title: str, theme: str = "light") -> bytes:
    """The outcome's panels as one PNG, for light or for dark pages."""
    from matplotlib import rc_context, style
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with (
        as_file(files("beamenv.train.reproduce").joinpath("look.mplstyle")) as look,
        style.context(str(look)),
        rc_context(themed(theme)),
    ):
        columns = len(outcome.panels) if len(outcome.panels) <= 3 else 2
        rows = -(-len(outcome.panels) // columns)
        width = PAGE_WIDTH if columns > 1 else SINGLE_WIDTH
        looks = appearances(outcome, theme)
        entries = handles([Panel("", "", "", legend_entries(outcome, looks))])
        per_row = max(1, int(width // 2.1))
        height = (PANEL_HEIGHT if rows < 4 else LOW_PANEL_HEIGHT) * rows + 0.3 + LEGEND_ROW * (-(-len(entries) // per_row))
        canvas = FigureCanvasAgg(figure := Figure((width, height)))
        axes = figure.subplots(rows, columns, squeeze=False)
        for axis, panel in zip(axes.flat, outcome.panels, strict=False):
            if isinstance(panel, Grid):
                draw_grid(axis, panel, theme)
            else:
                dotted = any(curve.line == "dotted" for curve in panel.curves)
                draw_panel(axis, dressed(panel, looks, in_pairs=dotted and "dotted" in outcome.lines))
        for axis in axes.flat[len(outcome.panels) :]:
            axis.set_visible(False)
        figure.suptitle(title, fontsize=10, x=0.01, ha="left")
        if entries:
            figure.legend(handles=entries, loc="outside lower center", ncols=per_row)
        canvas.draw()  # once, where savefig lays everything out twice
    return compact(canvas.buffer_rgba(), rare=bool(printed_entries(outcome.panels)))


def compact(pixels: Any, rare: bool) -> bytes:
    """A picture (height, width, 4) in few colours, more where rare ones count: a third of the bytes, no difference to the eye.

    Compressed as usual: the most that can be had is 9 % less, and takes eight times as long.
    """
    from PIL import Image

    picture = io.BytesIO()
    plain = Image.fromarray(np.asarray(pixels)).convert("RGB")
    few = plain.quantize(256, Image.Quantize.MAXCOVERAGE) if rare else plain.quantize(64)
    few.save(picture, format="png")
    return picture.getvalue()


def curves_of(panels: Sequence[Panel | Grid]) -> list[Curve]:
    """All curves but the thesis' own numbers."""
    return [curve for panel in panels if isinstance(panel, Panel) for curve in panel.curves if not is_printed(curve)]


def labels_of(panels: Sequence[Panel | Grid]) -> list[str]:
    """The labels of these curves, in the order of their first appearance."""
    return list(dict.fromkeys(curve.label for curve in curves_of(panels) if curve.label))


def appearances(outcome: Outcome, theme: str = "light") -> Looks:
    """Colour and sign of each label: a sign of its own, and a lightness from dark to light within the panels that share labels.

    On dark paper from light to dark: what stands out on white does so on black.
    """
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    labels = labels_of(outcome.panels)
    if not labels or len(labels) + len(printed_entries(outcome.panels)) < 2:
        return {}
    own = {curve.label: curve.look.marker for curve in reversed(curves_of(outcome.panels)) if curve.look.marker}
    looks: Looks = {}
    for together in shared_labels(outcome.panels):
        for label, lightness in zip(together, lightnesses(together), strict=True):
            marker = replace(own.get(label, Marker()), sign=sign_of(label, labels))
            shade = lightness if theme == "light" else 1.0 - (1.0 - DIMMEST) * lightness / LIGHTEST
            looks[label] = Look(to_hex(colormaps["viridis"](shade)), marker=marker)
    return looks


def lightnesses(labels: Sequence[str]) -> list[float]:
    """From dark to light; materials have their own, and others beside them lighter ones."""
    others = [label for label in labels if label not in MATERIALS]
    if len(others) == len(labels):
        return [LIGHTEST * place / max(1, len(labels) - 1) for place in range(len(labels))]
    darkest = max(lightness for lightness, _ in MATERIALS.values())
    step = (LIGHTEST - darkest) / max(1, len(others))
    return [MATERIALS[label][0] if label in MATERIALS else darkest + step * (others.index(label) + 1) for label in labels]


def sign_of(label: str, labels: Sequence[str]) -> str:
    """By its place among all labels; where there are materials, those that are none have the signs after theirs."""
    if label in MATERIALS:
        return MATERIALS[label][1]
    others = [each for each in labels if each not in MATERIALS]
    first = len(MATERIALS) if len(others) < len(labels) else 0
    return SIGNS[(first + others.index(label)) % len(SIGNS)]


def shared_labels(panels: Sequence[Panel | Grid]) -> list[list[str]]:
    """Labels that are to be told apart: those of a panel, together with those of panels that share some with it."""
    groups: list[list[str]] = []
    for panel in panels:
        own = labels_of([panel])
        joined = [group for group in groups if set(group) & set(own)]
        groups = [group for group in groups if group not in joined]
        groups.append(list(dict.fromkeys([label for group in joined for label in group] + own)))
    return groups


def legend_entries(outcome: Outcome, looks: Looks) -> list[Curve]:
    """One for each meaning of a line and for each label, the thesis' own numbers last."""
    labels, curves = labels_of(outcome.panels), curves_of(outcome.panels)
    used = {label: {curve.line for curve in curves if curve.label == label} for label in labels}
    solid = PALE if "dotted" in outcome.lines else PLAIN
    known: dict[str, Look] = {"points": replace(PLAIN, marker=Marker()), "solid": solid}
    signed = signed_labels(outcome.panels)
    entries = [Curve(NOTHING, NOTHING, text, line, known.get(line, PLAIN)) for line, text in outcome.lines.items()]
    scatters = all(lines == {"points"} for lines in used.values())
    for label in labels:
        line = "points" if used[label] == {"points"} else "solid" if len(used[label]) > 1 else next(iter(used[label]))
        look = looks.get(label, replace(PLAIN, marker=Marker()))
        if label not in signed:
            look = replace(look, marker=None)
        if scatters and label != labels[0] and look.marker:
            look = replace(look, marker=replace(look.marker, fill="none"))
        entries.append(Curve(NOTHING, NOTHING, label, line, look))
    return entries + printed_entries(outcome.panels)


def printed_entries(panels: Sequence[Panel | Grid]) -> list[Curve]:
    """One for each label of the thesis' own numbers."""
    found = [curve for panel in panels if isinstance(panel, Panel) for curve in panel.curves if is_printed(curve)]
    return [replace(curve, x=NOTHING, y=NOTHING) for curve in {curve.label: curve for curve in reversed(found)}.values()][::-1]


def signed_labels(panels: Sequence[Panel | Grid]) -> set[str]:
    """Labels that signs are drawn for: of points, and of lines where no points are."""
    signed: set[str] = set()
    for panel in panels:
        curves = curves_of([panel])
        points = {curve.label for curve in curves if curve.line == "points"}
        signed |= points or {curve.label for curve in curves if curve.line != "bars"}
    return signed


def dressed(panel: Panel, looks: Looks, in_pairs: bool) -> Panel:
    """The panel with the looks of its curves. Where dotted curves run on solid ones, these are broad and pale so that both show."""
    own = curves_of([panel])
    points = any(curve.line == "points" for curve in own)
    scattered = all(curve.line == "points" for curve in own)
    curves = []
    for curve in panel.curves:
        if is_printed(curve):
            look = curve.look
        elif curve.line == "points":
            look = point_look(curve, looks, hollow=scattered and curve is not own[0])
        else:
            look = line_look(curve, looks, in_pairs, marked=not points)
        curves.append(replace(curve, look=look))
    return replace(panel, curves=curves)


def point_look(curve: Curve, looks: Looks, hollow: bool) -> Look:
    """``hollow`` points do not hide others."""
    look = looks.get(curve.label, PLAIN)
    marker = look.marker or Marker()
    return replace(look, marker=replace(marker, fill="none", size=6) if hollow else marker)


def line_look(curve: Curve, looks: Looks, in_pairs: bool, marked: bool) -> Look:
    """Its signs are sparse and begin at a place of its own, so that they do not pile up. A curve that is faint itself has none.

    Where points of the same label mean something (not ``marked``) the line goes without signs.
    """
    look = looks.get(curve.label, PLAIN)
    if curve.look.opacity < 1.0 or curve.line == "bars":
        return replace(look, width=curve.look.width, opacity=curve.look.opacity, marker=None)
    if look.marker is not None:
        place, points = list(looks).index(curve.label), len(curve.x)
        spacing = max(1, points // 7)
        every = (0, 1) if points <= 12 else (place * spacing // len(looks) % spacing, spacing)
        marker = replace(look.marker, every=every, fill="full" if curve.line == "solid" else "white")
        look = replace(look, marker=marker if marked else None)
    if in_pairs:
        return replace(look, width=PALE.width, opacity=PALE.opacity) if curve.line == "solid" else replace(look, above=True)
    return look


def draw_grid(axis: Any, grid: Grid, theme: str) -> None:
    """A table of text cells."""
    paper, cell = THEMES[theme]["paper"], THEMES[theme]["cell"]
    axis.set_axis_off()
    axis.set_title(grid.title)
    cells = [[grid.cells.get((row, column), "") for column in grid.names] for row in grid.names]
    shade = [[cell if text else paper for text in line] for line in cells]
    heads = {"rowColours": [paper] * len(grid.names), "colColours": [paper] * len(grid.names)}
    table = axis.table(cells, shade, rowLabels=grid.names, colLabels=grid.names, loc="center", cellLoc="center", **heads)
    for each in table.get_celld().values():
        each.set_edgecolor(THEMES[theme]["ink"])
    table.scale(1.0, 1.25)
    table.auto_set_font_size(False)
    table.set_fontsize(8)


def curve_rows(outcome: Outcome) -> tuple[list[str], list[list[object]]]:
    """Header and rows of a figure's numbers: every point of every curve."""
    rows: list[list[object]] = []
    for panel in outcome.panels:
        if isinstance(panel, Panel):
            for curve in panel.curves:
                meaning = "" if is_printed(curve) else outcome.lines.get(curve.line, "")
                points = zip(np.asarray(curve.x).tolist(), np.asarray(curve.y).tolist(), strict=True)
                rows += [
                    [panel.title, curve.label, meaning, f"{x:.8g}", f"{y:.8g}", panel.x_label, panel.y_label] for x, y in points
                ]
    return ["panel", "curve", "line", "x", "y", "x quantity", "y quantity"], rows
