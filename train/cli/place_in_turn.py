"""``beamenv place``: actuators and sensors placed in turn, each by its own trace, with the proof."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn

from train.cli.bars import fleeting
from train.cli.options import note, print_json
from train.cli.place_written import Written
from train.cli.tables import Column, show_table
from train.placement.placed import LAWS, UNITS, PlacedSide, place_sides

METHOD = "multistart"
"""Of the search, unless told otherwise."""


@dataclass(frozen=True, slots=True)
class Search:
    """How each side is searched for."""

    method: str
    seed: int
    leave_unreached: bool
    """Whether modes that no patch moves keep their own damping."""


def place_in_turn(config: Any, counts: dict[str, int | None], search: Search, to: Written) -> None:
    """Place the sides that are counted, or both with as many patches as the blade has, tell how, and draw them."""
    from beamenv.blade.layouts import SIDES, positions_of, with_positions

    to.check()
    wanted = {side: count for side in SIDES if (count := counts[side]) is not None}
    wanted = wanted or {side: count for side in SIDES if (count := len(positions_of(config, side)))}
    with bars(wanted) as report:
        sides = place_sides(config, wanted, search.method, search.seed, report, search.leave_unreached)
    if to.as_json:
        print_json([side.to_dict() for side in sides])
    else:
        show(sides)
    to.save(with_positions(config, {side.placement.side: side.placement.positions for side in sides}))
    if to.drawn is not None:  # last: whatever becomes of it, the positions have been told
        from train.placement.picture import draw_placement

        draw_placement(sides, to.drawn)
        Console(stderr=to.as_json).print(f"picture in {to.drawn}", soft_wrap=True, markup=False)


@contextmanager
def bars(sides: Any) -> Iterator[Callable[[str, float, float], None]]:
    """A bar for each side."""
    columns = TextColumn("{task.description:>9}"), BarColumn(), TextColumn("{task.fields[cost]}"), TimeElapsedColumn()
    with fleeting(*columns) as progress:
        tasks = {side: progress.add_task(side, total=1.0, cost="") for side in sides}

        def report(side: str, done: float, cost: float) -> None:
            name, unit = UNITS[side]
            progress.update(tasks[side], completed=done, cost=f"{name} {cost:.4g} {unit}")

        yield report


def show(sides: list[PlacedSide]) -> None:
    """Positions, traces and damping ratios on the screen."""
    for side in sides:
        placement, (name, unit) = side.placement, UNITS[side.placement.side]
        each_way = (
            ("uniform", side.problem.bounds.uniform(), side.uniform_cost),
            (placement.method, placement.positions, placement.cost),
        )
        columns = [Column("layout", words=True), *(Column(str(k)) for k in range(1, len(placement.positions) + 1))]
        rows = [
            [label, *(f"{z:.4f}" for z in layout), f"{cost:.5g}", f"{100.0 * cost / side.uniform_cost:.2f} %"]
            for label, layout, cost in each_way
        ]
        title = f"{placement.side.capitalize()}, {side.problem.config.speed:g} rad/s: root-side edges, m"
        show_table([*columns, Column(f"{name}, {unit}"), Column("of uniform")], rows, title)
        note(f"{placement.evaluations} layouts in {placement.seconds:.1f} s")
        show_damping(side)
        if side.note:
            note(side.note)


def show_damping(side: PlacedSide) -> None:
    """Damping ratios, mode by mode."""
    found = side.left_alone, side.uniform, side.placed
    columns = [Column("mode", words=True), Column("family", words=True)]
    columns += [Column(each) for each in ("left alone", "uniform", side.placement.method)]
    rows = []
    for mode in range(max(map(len, found))):
        ratios = [f"{100.0 * each[mode]:.2f}" if mode < len(each) else "" for each in found]
        rows.append([str(mode + 1), side.families[mode], *ratios])
    show_table(columns, rows, f"Damping ratios of the {LAWS[side.placement.side]}, %")
