"""``beamenv place --together``: both sides placed at once."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from rich.table import Table

from train.cli.bars import one_cost_bar
from train.cli.options import print_json, print_table, say


def place_together(config: Any, counts: dict[str, int | None], seed: int, leave_unreached: bool, as_json: bool) -> None:
    """Place both sides by the closed loop's cost, and tell what that gains over one after the other."""
    from baselines.placement import JointProblem, place_jointly

    problem = JointProblem.of(config, **counts)
    with one_cost_bar("both sides") as report:
        found = place_jointly(problem, seed, report, leave_unreached)
    if as_json:
        print_json({**asdict(found), "unit": "J", "gain": found.gain})
        return
    table = Table(title=f"both sides, {problem.config.speed:g} rad/s: root-side edges, m")
    for column in ("placed", "actuators", "sensors", "cost of the loop, J"):
        table.add_column(column, justify="left" if column == "placed" else "right")
    for label, above, below, cost in (
        ("one after the other", found.in_turn["actuators"], found.in_turn["sensors"], found.in_turn_cost),
        ("together", found.actuators, found.sensors, found.cost),
    ):
        table.add_row(label, *(" ".join(f"{z:.4f}" for z in side) for side in (above, below)), f"{cost:.4g}")
    print_table(table)
    say(f"together they cost {100.0 * found.gain:.2f} % less")
