"""``beamenv place --together``: both sides placed at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from train.cli.bars import one_cost_bar
from train.cli.options import note, print_json
from train.cli.tables import Column, show_table


def place_together(config: Any, counts: dict[str, int | None], seed: int, leave_unreached: bool, as_json: bool) -> None:
    """Place both sides by the closed loop's cost, and tell what that gains over one after the other."""
    from baselines.placement import JointProblem, place_jointly

    problem = JointProblem.of(config, **counts)
    with one_cost_bar("both sides") as report:
        found = place_jointly(problem, seed, report, leave_unreached)
    if as_json:
        print_json({**asdict(found), "unit": "J", "gain": found.gain})
        return
    each_way = (
        ("one after the other", found.in_turn["actuators"], found.in_turn["sensors"], found.in_turn_cost),
        ("together", found.actuators, found.sensors, found.cost),
    )
    words = [Column(each, words=True) for each in ("placed", "actuators", "sensors")]
    rows = [[name, _edges(above), _edges(below), f"{cost:.4g}"] for name, above, below, cost in each_way]
    show_table([*words, Column("cost of\nthe loop, J")], rows, f"Both sides, {problem.config.speed:g} rad/s: root-side edges, m")
    note(f"together they cost {100.0 * found.gain:.2f} % less")


def _edges(side: Sequence[float]) -> str:
    return " ".join(f"{z:.4f}" for z in side)
