"""Section 6.5: Tables 6.1 to 6.4, where the patches belong by GA, by SQP, and by one after the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines.placement.cost.riccati import solve_riccati
from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import SIDES, Side
from train.reproduce.judging.study import Outcome, Part, Parts, Statement, Study
from train.reproduce.judging.verdicts import Changes, Holds, Substantial, WhateverIsOpen
from train.reproduce.studies import chapter6_printed
from train.reproduce.studies.chapter5_individual import OPEN_WEIGHTS
from train.reproduce.studies.chapter6_columns import (
    NUMBERS,
    TRACE,
    all_header,
    all_panels,
    all_rows,
    four_header,
    four_panels,
    four_rows,
)
from train.reproduce.studies.chapter6_layouts import placed_blade
from train.reproduce.studies.chapter6_printed import NEAR
from train.reproduce.studies.placement_study import (
    COUNTS,
    SPEEDS,
    TableRow,
    descents,
    gathering_at_the_root,
    placed,
    problem_of,
    shift_with_speed,
    starts_that_fail,
    table_row,
    together_against_alone,
    variants,
)
from train.reproduce.studies.printed_layouts import UNPRINTED, cost_of, printed_positions
from train.reproduce.thesis import Model, printed_table

Array = NDArray[np.float64]

STARTS = 10
MOVED = 0.01
"""Share of the span by which a patch must move for its place to depend on something."""


def four_parts(side: Side, model: Model) -> Parts:
    """Rows of two and of four patches, and where SQP ends from random starts, by number and speed."""
    config, cases = placed_blade(model), [(count, speed) for count in (2, 4) for speed in SPEEDS]
    rows = {("row", *case): Part(table_row, (side, *case, config)) for case in cases}
    return rows | {("descents", *case): Part(descents, (side, *case, config, STARTS)) for case in cases}


def four_patches(side: Side, model: Model, found: Mapping[Any, Any]) -> Outcome:
    """Table 6.1 or 6.2: four patches by GA and by SQP."""
    config = placed_blade(model)
    rows = [found["row", 4, speed] for speed in SPEEDS]
    two, four = (
        [starts_that_fail(found["descents", n, speed], found["row", n, speed].both.cost) for speed in SPEEDS] for n in (2, 4)
    )
    evidence = {
        "ga-below-sqp": [[row.sqp.cost, row.ga.cost] for row in rows],
        "start": np.array(four) > 0.0,
        "start-two": np.array(two) > 0.0,
        "speed": speed_orders(side, rows, config),
        "printed": [[printed_cost(side, config, speed, kind) for kind in ("sqp", "ga")] for speed in SPEEDS],
    }
    *most, last = (f"{100.0 * share:.0f} %" for share in (*two, *four))
    notes = [
        f"SQP misses the best layout from {', '.join(most)} and {last} of {STARTS} random starts (two patches at rest and at "
        f"200 rad/s, then four). {TRACE[side]} of equally spaced patches, by GA, by SQP and by GA then SQP: {costs_of(rows, side)}."
    ]
    return Outcome(evidence, four_panels(side, rows), header=four_header(side), rows=four_rows(side, rows), notes=notes)


def speed_orders(side: Side, rows: Sequence[TableRow], config: BladeConfig) -> list[bool]:
    """Whether the trace goes with speed as the thesis prints it, by the input weight and by the scale of the state."""
    printed = [float(row["ga_cost"]) for row in printed_table(NUMBERS[side, "four"]) if row["patch"] == "1"]
    weighed = [replace(config, effort_weight=weight) for weight in OPEN_WEIGHTS] if side == "actuators" else [config]
    ours = np.array([[traces(side, each, row) for row in rows] for each in weighed])
    return [bool((pair[1] > pair[0]) == (printed[1] > printed[0])) for pair in ours.swapaxes(1, 2).reshape(-1, 2)]


def traces(side: Side, config: BladeConfig, row: TableRow) -> tuple[float, float]:
    """The trace of a placed layout with the state [ωη; η̇], and with [η; η̇]."""
    problem = problem_of(config, side, row.count, row.speed)
    reduced = problem.reduced(np.array([row.ga.positions]))
    frequencies = reduced.natural_frequencies[0]
    scale = np.concatenate([frequencies, np.ones_like(frequencies)]) ** (2 if side == "actuators" else -2)
    diagonal = np.diag(solve_riccati(*problem.equation(reduced))[0])
    return float(diagonal.sum()), float(scale @ diagonal)


def printed_cost(side: Side, config: BladeConfig, speed: float, method: str) -> float:
    """What the thesis' own layout of four costs on our blade, its patches moved apart where they overlap."""
    return cost_of(config, side, printed_positions(side, "four", 4, speed, method), speed)


def costs_of(rows: Sequence[TableRow], side: Side) -> str:
    """The four costs of each row in words."""
    unit = "s" if side == "actuators" else "J"
    return "; ".join(
        f"{row.uniform_cost:.4g}, {row.ga.cost:.4g}, {row.sqp.cost:.4g} and {row.both.cost:.4g} {unit} at {row.speed:g} rad/s"
        for row in rows
    )


def all_parts(side: Side, model: Model) -> Parts:
    """Rows of every number at every speed, of actuators for sensors too; for actuators where two belong on other blades."""
    config = placed_blade(model)
    sides: tuple[Side, ...] = ("actuators",) if side == "actuators" else SIDES
    rows = {
        (each, count, speed): Part(table_row, (each, count, speed, config))
        for each in sides
        for count in COUNTS
        for speed in SPEEDS
    }
    if side == "sensors":
        return rows
    others = variants(config).items()
    return rows | {(each, name): Part(placed, (each, count, blade)) for each in SIDES for name, (blade, count) in others}


def one_to_four_patches(side: Side, model: Model, found: Mapping[Any, Any]) -> Outcome:
    """Table 6.3 or 6.4: one to four patches by GA, and by SQP from there."""
    config = placed_blade(model)
    rows = rows_of(side, found)
    saved = 1.0 - 1.0 / (1.0 + np.array(together_against_alone(rows)))
    evidence: dict[str, object] = {
        "then": saved[:, 0] > 0.0,
        "superior": -saved,
        "shift": np.array(list(shift_with_speed(rows).values())) + 0.5 * config.patches.length,
    }
    notes = [
        f"GA then SQP lies up to {100.0 * saved[:, 0].max():.2f} % below GA alone, and below SQP alone from equally spaced patches "
        f"by {100.0 * np.median(saved[:, 1]):.2f} % in the median and up to {100.0 * saved[:, 1].max():.2f} %.",
        gain_over_uniform(side, rows),
    ]
    if side == "actuators":
        evidence["depends"] = depends_on(config, found)
    else:
        others = rows_of("actuators", found)
        edges = np.concatenate([row.both.positions for row in rows])
        evidence["near"] = edges < NEAR * model.box.length
        evidence["nearer"] = [sensor < actuator for _, _, sensor, actuator in gathering_at_the_root(rows, others)]
        notes.append(f"The outermost sensor begins {edges.max():.3g} m from the root, the outermost one of the thesis 0.259 m.")
    return Outcome(evidence, all_panels(side, rows), header=all_header(side), rows=all_rows(side, rows), notes=notes)


def gain_over_uniform(side: Side, rows: Sequence[TableRow]) -> str:
    """How much placing lowers the trace, at rest and rotating."""
    saved = {speed: [1.0 - row.both.cost / row.uniform_cost for row in rows if row.speed == speed] for speed in SPEEDS}
    spans = [f"{100.0 * min(each):.2g} to {100.0 * max(each):.2g} % at {speed:g} rad/s" for speed, each in saved.items()]
    return f"Against equally spaced {side} the best ones lower {TRACE[side]} by {' and '.join(spans)}."


def rows_of(side: Side, found: Mapping[Any, Any]) -> list[TableRow]:
    """One side's rows: each number at rest and at 200 rad/s."""
    return [found[side, count, speed] for count in COUNTS for speed in SPEEDS]


def depends_on(config: BladeConfig, found: Mapping[Any, Any]) -> list[bool]:
    """Whether an actuator or a sensor moves by more than 1 % of the span with speed, pretwist, presetting and number."""
    shifts = []
    for side in SIDES:
        before, *others = (np.array(found[side, name].positions) for name in variants(config))
        shifts.append([float(np.abs(after[: len(before)] - before).max()) for after in others])
    return [bool(shift > MOVED * config.beam.length) for shift in np.max(shifts, axis=0)]


WHERE = "θ = 30°, untwisted; GA with 30 individuals and 50 generations; patches of 85 mm within 0 … 0.7 L that do not overlap"
ALONE = f"{WHERE}; SQP from equally spaced patches (the thesis names no start)"
WHY_SQP = (
    "With the exact gradient of the trace SQP from equally spaced patches ends at the best layout known of four actuators and of "
    "any number of sensors, though not always of one to three actuators, and GA alone stays 0 to 2 % above it; the thesis' SQP "
    "ended 1.6 to 26 times above its GA."
)
WHY_START = "With four patches all random starts end at one layout; with two actuators the start decides."
WHY_SCALE = (
    "The thesis prints neither the scale of its state nor its weights: in energy and in modal coordinates, ρ from 0.05 to 5."
)
WHY_LAYOUT = (
    "The thesis keeps patches apart by their width, 57 mm, not by their length, 85 mm; where its patches overlap they are moved "
    "apart."
)
WHY_SENSORS = (
    "At rest sensors at the root are best, but their place hardly matters; at 200 rad/s it does, and all but one lie further out."
)


def four_statements(side: Side) -> tuple[Statement, ...]:
    """What the text says of Table 6.1 or 6.2."""
    way = "larger" if side == "actuators" else "smaller"
    return (
        Statement("ga-below-sqp", f"GA yields a smaller {TRACE[side]} than SQP", Changes(-1), WHY_SQP),
        Statement(
            "start", f"Different initial guesses give SQP different solutions (any of {STARTS} random ones)", Holds(), WHY_START
        ),
        Statement("start-two", "The same with two patches", Holds(), aside=True),
        Statement("speed", f"{TRACE[side]} is {way} at 200 rad/s than at rest, as printed", WhateverIsOpen(), WHY_SCALE),
        Statement(
            "printed",
            f"The thesis' GA layout has the smaller {TRACE[side]} than its SQP layout on our blade too",
            Changes(-1),
            WHY_LAYOUT,
            aside=True,
        ),
    )


def both_statements(side: Side) -> tuple[Statement, ...]:
    """What the text says of Table 6.3 as well as of Table 6.4."""
    why_shift = WHY_SENSORS if side == "sensors" else ""
    why_equal = "One sensor at rest belongs at the root, where GA puts it already." if side == "sensors" else ""
    return (
        Statement("then", "GA then SQP is better than GA alone", Holds(), why_equal),
        Statement("superior", "GA then SQP is far superior to GA and to SQP", Substantial(-1), WHY_SQP),
        Statement("shift", f"With speed the {side} shift towards the root (mean of their centres)", Changes(-1), why_shift),
    )


def four_study(name: str, side: Side) -> Study:
    """Table 6.1 or 6.2."""
    compute, parts = partial(four_patches, side), partial(four_parts, side)
    title, printed = f"Four {side} by GA and by SQP", partial(chapter6_printed.four, side)
    return Study(name, title, ALONE, four_statements(side), compute, parts, printed=printed, unprinted=UNPRINTED)


STUDIES = (
    four_study("table-6.1", "actuators"),
    four_study("table-6.2", "sensors"),
    Study(
        "table-6.3",
        "Optimal locations of actuators",
        f"{ALONE}; {len(COUNTS)} numbers of actuators at two speeds",
        (
            *both_statements("actuators"),
            Statement(
                "depends",
                "Optimal locations depend on speed, pretwist (30°), presetting (30°) and number: one of two actuators or of two "
                f"sensors moves by more than {100 * MOVED:g} % of the span",
                Holds(),
            ),
        ),
        partial(one_to_four_patches, "actuators"),
        partial(all_parts, "actuators"),
        printed=partial(chapter6_printed.one_to_four, "actuators"),
        unprinted=UNPRINTED,
    ),
    Study(
        "table-6.4",
        "Optimal locations of sensors",
        f"{ALONE}; {len(COUNTS)} numbers of sensors at two speeds, the four actuators equally spaced",
        (
            *both_statements("sensors"),
            Statement("near", f"Sensors gather near the root: each begins within {100 * NEAR:g} % of the span", Holds()),
            Statement(
                "nearer", "Sensors lie nearer the root than as many actuators", Holds(), "At 200 rad/s one and two sensors do not."
            ),
        ),
        partial(one_to_four_patches, "sensors"),
        partial(all_parts, "sensors"),
        printed=partial(chapter6_printed.one_to_four, "sensors"),
        unprinted=UNPRINTED,
    ),
)
