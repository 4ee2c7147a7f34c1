"""Layouts by name, by positions, or drawn: what a ``PlacementWrapper`` takes for each side of the blade."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from importlib import import_module
from importlib.resources import files
from typing import Any

import numpy as np

from beamenv.blade.bounds import Bounds
from beamenv.blade.config import BladeConfig
from beamenv.configuration import Number, checked, checked_table, unknown_name
from beamenv.patches.group import Positions
from beamenv.patches.layout import SIDES as SIDES
from beamenv.patches.layout import Side as Side

THESIS_TABLES: Mapping[str, Side] = {"thesis-table-6.3": "actuators", "thesis-table-6.4": "sensors"}

OPTIMAL = "beamenv.baselines.placement.optimal:optimal_positions"
"""What works out "optimal", named as Gymnasium names entry points: optimisers know plants, and plants know no optimiser."""

NAMES = ("uniform", *THESIS_TABLES, "optimal")


@dataclass(frozen=True, slots=True)
class Drawn:
    """Positions to be drawn anew, every feasible layout within the bounds equally likely."""

    bounds: Bounds

    def draw(self, generator: np.random.Generator) -> Positions:
        """One layout."""
        return tuple(self.bounds.random(generator, 1)[0].tolist())


def resolve(config: BladeConfig, side: Side, given: Any) -> Positions | Drawn:
    """Positions (m) of one side of a blade, or how they are to be drawn.

    ``given`` is one of ``NAMES``, a number of patches (equally spaced), positions in metres, a mapping {"low", "high", "count"}
    for a range to draw root-side edges from (0 … 0.7 L less a patch, and the blade's own number, where left out), or None for
    the blade's own. Raises ``ValueError`` for anything else and for what does not fit.
    """
    own = positions_of(config, side)
    if given is None:
        return own
    if isinstance(given, str):
        return named(config, side, given)
    if isinstance(given, Mapping):
        return _range(config, side, given, len(own))
    return positions_of(with_positions(config, {side: given}), side)


def positions_of(config: BladeConfig, side: Side) -> Positions:
    """Root-side edges, m, of the patches of one side of a blade."""
    return config.patches.positions(side, config.beam.length)


def with_positions(config: BladeConfig, positions: Mapping[Side, int | Positions]) -> BladeConfig:
    """A blade with its patches, or those of one side, at other positions (m), or equally spaced where a number is given."""
    patches = config.patches
    for side, given in positions.items():
        patches = patches.placed(side, given)
    return replace(config, patches=patches)


def named(config: BladeConfig, side: Side, name: str) -> Positions:
    """A layout of ``NAMES`` with as many patches as the blade has on that side; ``ValueError`` for an invalid name."""
    config.patches.only(side)  # several groups, or none, are refused by their own name
    count = len(positions_of(config, side))
    if name == "uniform":
        return tuple(Bounds.of(config.patches, config.beam.length, count, None, side).uniform().tolist())
    if name == "optimal":
        module, attribute = OPTIMAL.split(":")
        optimal: Callable[[BladeConfig, Side], Positions] = getattr(import_module(module), attribute)
        return optimal(config, side)
    if THESIS_TABLES.get(name) == side:
        return thesis_positions(config, side, name, count)
    known = [each for each in NAMES if THESIS_TABLES.get(each, side) == side]
    raise unknown_name(side, name, known, ", a number of patches, positions (m), or a range")


def thesis_positions(config: BladeConfig, side: Side, name: str, count: int) -> Positions:
    """The thesis' positions (GA, then SQP) for 0 or 200 rad/s, whichever is nearer, moved apart where its patches overlap.

    The thesis keeps patches 85 mm long only 57 mm (their width) apart.
    """
    text = files("beamenv.blade").joinpath("numbers", f"{name.removeprefix('thesis-')}.csv").read_text(encoding="utf-8")
    speed = 0 if config.speed < 100.0 else 200
    rows = [row for row in csv.DictReader(text.splitlines()) if int(row["count"]) == count and int(row["speed"]) == speed]
    if not rows:
        raise ValueError(f"{side} = {name!r} has one to four patches, not {count}.")
    bounds = Bounds.of(config.patches, config.beam.length, count, None, side)
    return tuple(bounds.repaired([float(row["sqp_position"]) for row in rows]).tolist())


def _range(config: BladeConfig, side: Side, given: Mapping[str, Any], own: int) -> Drawn:
    given = checked_table(side, given, ("low", "high", "count"))
    for name in given.keys() & {"low", "high"}:
        checked(f"{side}.{name}", given[name], Number(unit="m"))
    count = given.get("count", own)
    whole = Bounds.of(config.patches, config.beam.length, 1, None, side)
    limits = (given.get("low", whole.low), given.get("high", whole.high))
    return Drawn(Bounds.of(config.patches, config.beam.length, count, limits, side))
