"""``beamenv place --size``: patches sized with their places."""

from __future__ import annotations

from typing import Any

from rich.console import Console

from train.cli.bars import one_cost_bar
from train.cli.options import note, print_json
from train.cli.place_written import Written
from train.cli.tables import Column, show_table
from train.placement.sized import SizedFront, size_patches


def place_sizes(config: Any, counts: dict[str, int | None], budget: dict[str, Any], seed: int, to: Written) -> None:
    """Search for the front, tell it, and write what is asked for; an interruption ends it with what was found."""
    from baselines.placement import Budget, Sizes, sized_blade

    to.check()
    with one_cost_bar("sizes") as report:
        sized = size_patches(
            config, Sizes(actuators=counts["actuators"], sensors=counts["sensors"]), Budget(**budget), seed, report
        )
    if to.as_json:
        print_json(sized.to_dict())
    else:
        show_front(sized)
    if to.output is not None:
        to.save(sized_blade(sized.problem, sized.front.points[sized.chosen]))
    if to.drawn is not None:
        from train.placement.front_picture import draw_front

        draw_front(sized, to.drawn)
        Console(stderr=to.as_json).print(f"picture in {to.drawn}", soft_wrap=True, markup=False)
    if not sized.front.complete:
        raise KeyboardInterrupt


def show_front(sized: SizedFront) -> None:
    """A line for each point, and for the blade's own patches."""
    columns = [Column("g", words=True), Column("J"), Column("on its\nplant"), Column("W")]
    columns += [Column("actuators, mm", words=True), Column("sensors, mm", words=True), Column("", words=True)]
    rows = []
    for number, (each, cost) in enumerate(zip(sized.front.points, sized.on_plants, strict=True)):
        power = "" if each.power is None else f"{each.power:.3g}"
        mark = "chosen" if number == sized.chosen else ""
        sides = [f"{len(side.patches)}: {sheet(side)}" if side.patches else "" for side in (each.actuators, each.sensors)]
        rows.append([f"{1e3 * each.mass:.4g}", f"{each.cost:.4g}", f"{cost:.4g}", power, *sides, mark])
    show_table(columns, rows, "Patches sized and placed: stationary cost of LQG over mass")
    chosen = sized.front.points[sized.chosen]
    note(f"chosen, root-side edges: actuators {edges(chosen.actuators)}; sensors {edges(chosen.sensors)} m")
    for layout in sized.layouts:
        note(f"own size, {layout.name}: {1e3 * layout.mass:.4g} g, {layout.cost:.4g} J")
    if sized.left_out:
        note(f"{sized.left_out} designs of thick sheets whose edges nearly meet are left out: no blade can be computed with them")
    note(f"{sized.front.evaluations} designs; power is that of ½CV²f at {sized.problem.frequency:.4g} Hz")


def sheet(side: Any) -> str:
    """Lengths × width × thickness of a side's patches, mm."""
    lengths = "/".join(f"{1e3 * each.length:.0f}" for each in side.patches)
    return f"{lengths} × {1e3 * side.width:.0f} × {1e3 * side.thickness:.2g}"


def edges(side: Any) -> str:
    """Where a side's patches begin, m."""
    return " ".join(f"{each.start:.4f}" for each in side.patches)
