"""What chapter 6 states of its tables, judged by the layouts that it prints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from beamenv.blade.layouts import SIDES, Side
from train.reproduce.studies.chapter6_layouts import READING, placed_blade
from train.reproduce.studies.placement_study import COUNTS, SPEEDS
from train.reproduce.studies.printed_layouts import cost_of, printed_positions
from train.reproduce.thesis import Model
from train.reproduce.thesis.readings import read_by

Evidence = Mapping[str, Any]

CASES = [(count, speed) for count in COUNTS for speed in SPEEDS]
NEAR = 0.25
"""Share of the span that counts as near the root; the thesis' sensors lie within 13 % of it."""


def four(side: Side, model: Model) -> Evidence:
    """Tables 6.1 and 6.2: the printed layout by GA against the one by SQP."""
    config = placed_blade(read_by(model, READING))
    layouts = {(by, speed): printed_positions(side, "four", 4, speed, by) for by in ("sqp", "ga") for speed in SPEEDS}
    return {"ga-below-sqp": [[cost_of(config, side, layouts[by, speed], speed) for by in ("sqp", "ga")] for speed in SPEEDS]}


def one_to_four(side: Side, model: Model) -> Evidence:
    """Tables 6.3 and 6.4: the printed layouts by GA, and by SQP from there."""
    config = placed_blade(read_by(model, READING))
    layouts = {(by, *case): printed_positions(side, "all", *case, by) for case in CASES for by in ("ga", "sqp")}
    costs = {key: cost_of(config, side, layout, key[2]) for key, layout in layouts.items()}
    alone = {speed: cost_of(config, side, printed_positions(side, "four", 4, speed, "sqp"), speed) for speed in SPEEDS}
    against = [costs[("sqp", *case)] / costs[("ga", *case)] for case in CASES]
    half = 0.5 * config.patches.length
    evidence: dict[str, Any] = {
        "then": np.array(against) < 1.0,
        "superior": np.array([*against, *(costs["sqp", 4, speed] / alone[speed] for speed in SPEEDS)]) - 1.0,
        "shift": [[layouts["sqp", count, speed].mean() + half for speed in SPEEDS] for count in COUNTS],
    }
    return evidence if side == "actuators" else {**evidence, **near_the_root(model)}


def near_the_root(model: Model) -> Evidence:
    """Whether the printed sensors lie there, and nearer than as many of the printed actuators."""
    actuators, sensors = ([printed_positions(side, "all", *case, "sqp") for case in CASES] for side in SIDES)
    nearer = [one.mean() < other.mean() for one, other in zip(sensors, actuators, strict=True)]
    return {"near": np.concatenate(sensors) < NEAR * model.box.length, "nearer": nearer}
