"""Tables 6.1 to 6.4 in their own layout, the thesis' columns beside ours, and their pictures."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from beamenv.blade.layouts import Side
from train.figures.figure import Curve, Panel
from train.reproduce.studies.placement_study import SPEEDS, TableRow
from train.reproduce.thesis import printed_table
from train.reproduce.thesis.points import printed as points

TRACE = {"actuators": "tr(P)", "sensors": "tr(S)"}
NUMBERS = {("actuators", "four"): "table-6.1", ("sensors", "four"): "table-6.2"}
NUMBERS |= {("actuators", "all"): "table-6.3", ("sensors", "all"): "table-6.4"}


def four_header(side: Side) -> list[str]:
    """Columns of Table 6.1 or 6.2, each of the thesis' beside ours."""
    trace = f"{TRACE[side]} ({'s' if side == 'actuators' else 'J'})"
    columns = [f"{method} {what}" for method in ("GA", "SQP") for what in ("location (m)", TRACE[side])]
    pairs = [(f"{column}, thesis", f"{column.replace(TRACE[side], trace)}, ours") for column in columns]
    return ["Ω (rad/s)", *(name for pair in pairs for name in pair)]


def four_rows(side: Side, rows: Sequence[TableRow]) -> list[list[str]]:
    """The lines of Table 6.1 or 6.2."""
    lines = []
    for printed in printed_table(NUMBERS[side, "four"]):
        row, patch = next(r for r in rows if r.speed == float(printed["speed"])), int(printed["patch"]) - 1
        cells = [printed["speed"] if patch == 0 else ""]
        for method, found in (("ga", row.ga), ("sqp", row.sqp)):
            cells += [printed[f"{method}_position"], f"{found.positions[patch]:.5f}"]
            cells += [printed[f"{method}_cost"], f"{found.cost:.4E}"] if patch == 0 else ["", ""]
        lines.append(cells)
    return lines


def four_panels(side: Side, rows: Sequence[TableRow]) -> list[Panel]:
    """Where each method puts each patch, at rest and rotating, the thesis' beside ours."""
    panels = []
    for row in rows:
        printed = [each for each in printed_table(NUMBERS[side, "four"]) if float(each["speed"]) == row.speed]
        ordinal = np.arange(1.0, row.count + 1.0)
        curves = []
        for name, line, sign, found in (("GA", "solid", "circle", row.ga), ("SQP", "dashed", "square", row.sqp)):
            stated = [float(each[f"{name.lower()}_position"]) for each in printed]
            curves += [
                Curve(np.array(found.positions), ordinal, f"{name}, ours", line),
                points(stated, ordinal, name, sign, line),
            ]
        panels.append(
            Panel(f"{row.speed:g} rad/s", "root-side edge from the root (m)", f"number of the {side[:-1]}", curves, whole=True)
        )
    return panels


def all_header(side: Side) -> list[str]:
    """Columns of Table 6.3 or 6.4, each of the thesis' beside ours."""
    trace = f"{TRACE[side]} ({'s' if side == 'actuators' else 'J'})"
    columns = [
        (f"{what} {method}", shown)
        for method in ("GA", "SQP from GA")
        for what, shown in (("location (m)", ""), (TRACE[side], trace))
    ]
    pairs = [(f"{name}, thesis", f"{name.replace(TRACE[side], shown) if shown else name}, ours") for name, shown in columns]
    return [f"{side}", "Ω (rad/s)", *(name for pair in pairs for name in pair)]


def all_rows(side: Side, rows: Sequence[TableRow]) -> list[list[str]]:
    """The lines of Table 6.3 or 6.4."""
    by_case, lines = {(row.count, row.speed): row for row in rows}, []
    for printed in printed_table(NUMBERS[side, "all"]):
        row, patch = by_case[int(printed["count"]), float(printed["speed"])], int(printed["patch"]) - 1
        cells = [printed["count"], printed["speed"]] if patch == 0 else ["", ""]
        for method, found in (("ga", row.ga), ("sqp", row.both)):
            cells += [printed[f"{method}_position"], f"{found.positions[patch]:.5f}"]
            cells += [printed[f"{method}_cost"], f"{found.cost:.4E}"] if patch == 0 else ["", ""]
        lines.append(cells)
    return lines


def all_panels(side: Side, rows: Sequence[TableRow]) -> list[Panel]:
    """Where GA then SQP puts one to four patches, the thesis' a little above ours."""
    panels = []
    for speed in SPEEDS:
        printed = [each for each in printed_table(NUMBERS[side, "all"]) if float(each["speed"]) == speed]
        stated = np.array([[float(each["sqp_position"]), float(each["count"]) + 0.1] for each in printed]).T
        ours = np.array([(at, row.count - 0.1) for row in rows if row.speed == speed for at in row.both.positions]).T
        curves = [Curve(ours[0], ours[1], "ours", "points"), points(*stated)]
        panels.append(Panel(f"{speed:g} rad/s", "root-side edge from the root (m)", f"number of {side}", curves, whole=True))
    return panels
