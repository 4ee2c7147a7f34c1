"""The command ``beamenv place``: where the patches belong, with the proof."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
from rich.table import Table

from train.cli.bars import fleeting
from train.cli.options import BladeOption, JsonOption, PresetOption, SpeedOption, one_sentence, print_json, print_table, say
from train.cli.place_sizes import Written, place_sizes, place_together
from train.placement.placed import LAWS, UNITS, PlacedSide, place_sides
from train.shared.files import check_picture

METHOD = "multistart"
"""Of placing one side, unless told otherwise."""


def place(
    actuators: Annotated[int | None, typer.Option(help="How many actuators to place.")] = None,
    sensors: Annotated[int | None, typer.Option(help="How many sensors to place.")] = None,
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
    passive: Annotated[bool, typer.Option(help="With the patches' mass and stiffness.")] = True,
    method: Annotated[
        str, typer.Option(help="multistart, ga+sqp (the thesis'), ga, sqp, cma-es, or grid for one or two.")
    ] = METHOD,
    seed: Annotated[int, typer.Option(min=0, max=2**63 - 1, help="Of the search.")] = 0,
    leave_unreached: Annotated[
        bool,
        typer.Option("--leave-unreached", help="Leave modes that no patch moves to their own damping."),
    ] = False,
    together: Annotated[bool, typer.Option("--together", help="Place both sides at once, by the closed loop's cost.")] = False,
    size: Annotated[
        bool,
        typer.Option("--size", help="Size patches too, and as many at most: the trade-off between the loop's cost and mass."),
    ] = False,
    mass: Annotated[float | None, typer.Option(help="With --size: kg of piezo sheet at most.")] = None,
    channels: Annotated[int | None, typer.Option(help="With --size: voltages at most.")] = None,
    power: Annotated[float | None, typer.Option(help="With --size: W at most, ½CV²f of all actuators.")] = None,
    frequency: Annotated[float | None, typer.Option(help="With --size: f in Hz; the first mode's if left out.")] = None,
    save: Annotated[
        Path | None,
        typer.Option(help="With --size: JSON file of the best blade within the mass, or no heavier than its own patches."),
    ] = None,
    picture: Annotated[
        Path | None, typer.Option(help="PNG of the blade, its patches and the cost along the span; with --size of the trade-off.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Where the patches belong: least tr(P) of the regulator for actuators, least tr(S) of the filter for sensors.

    Both sides are placed, with as many patches as the blade has, unless the options name one.
    """
    drawn = picture or (None if as_json or together else Path("results/sizes.png" if size else "results/placement.png"))
    with one_sentence():
        from beamenv.blade.files import load_config
        from beamenv.blade.layouts import SIDES, positions_of
        from beamenv.blade.presets import blade_config

        budget = {"mass": mass, "channels": channels, "power": power, "frequency": frequency}
        check_alone(together, size, picture, {**budget, "save": save})
        if size and leave_unreached:
            raise ValueError("--size leaves modes that no patch reaches alone: leave --leave-unreached out.")
        check_searched("size" if size else "together" if together else "", method)
        if drawn is not None:
            check_picture(drawn)
        config = blade_config(preset, load_config(blade) if blade else None, speed)
        config = config if passive else replace(config, patches=config.patches.without_mass())
        wanted = {"actuators": actuators, "sensors": sensors}
        if size:
            place_sizes(config, wanted, budget, seed, Written(save, drawn, as_json))
            return
        if together:
            place_together(config, wanted, seed, leave_unreached, as_json)
            return
        counts = {side: count for side, count in zip(SIDES, (actuators, sensors), strict=True) if count is not None}
        counts = counts or {side: count for side in SIDES if (count := len(positions_of(config, side)))}
        with bars(counts) as report:
            sides = place_sides(config, counts, method, seed, report, leave_unreached)
        if as_json:
            print_json([side.to_dict() for side in sides])
        else:
            show(sides)
        if drawn is not None:  # last: whatever becomes of it, the positions have been told
            from train.placement.picture import draw_placement

            draw_placement(sides, drawn)
            Console(stderr=as_json).print(f"picture in {drawn}", soft_wrap=True, markup=False)


def check_alone(together: bool, size: bool, picture: Path | None, of_sizes: dict[str, Any]) -> None:
    """``ValueError`` for options that do not go together."""
    if together and (size or picture):
        raise ValueError(f"--together places patches as they are and draws nothing: leave --{'size' if size else 'picture'} out.")
    given = [name for name, value in of_sizes.items() if value is not None]
    if given and not size:
        raise ValueError(f"--{given[0]} limits patches that are sized: add --size.")


def check_searched(way: str, method: str) -> None:
    """``ValueError`` for a method of one side's search beside ``way``, "size" or "together", which has a search of its own."""
    if way and method != METHOD:
        raise ValueError(f"--{way} searches in a way of its own: leave --method out.")


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
        positions = Table(title=f"{placement.side}, {side.problem.config.speed:g} rad/s: root-side edges, m")
        for column in ("layout", *map(str, range(1, len(placement.positions) + 1)), f"{name}, {unit}", "of uniform"):
            positions.add_column(column, justify="left" if column == "layout" else "right")
        for label, layout, cost in (
            ("uniform", side.problem.bounds.uniform(), side.uniform_cost),
            (placement.method, placement.positions, placement.cost),
        ):
            positions.add_row(label, *(f"{z:.4f}" for z in layout), f"{cost:.5g}", f"{100.0 * cost / side.uniform_cost:.2f} %")
        print_table(positions)
        say(f"{placement.evaluations} layouts in {placement.seconds:.1f} s")
        print_table(damping_table(side))
        if side.note:
            say(side.note)


def damping_table(side: PlacedSide) -> Table:
    """Damping ratios, mode by mode."""
    law = LAWS[side.placement.side]
    table = Table(title=f"damping ratios of the {law}, %")
    for column in ("mode", "left alone", "uniform", side.placement.method):
        table.add_column(column, justify="right")
    longest = max(len(side.left_alone), len(side.uniform), len(side.placed))
    for mode in range(longest):
        cells = [f"{100.0 * each[mode]:.2f}" if mode < len(each) else "" for each in (side.left_alone, side.uniform, side.placed)]
        table.add_row(str(mode + 1), *cells)
    return table
