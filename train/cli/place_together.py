"""``beamenv place --together``: both sides placed at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from train.cli.bars import one_cost_bar
from train.cli.options import note, print_json
from train.cli.place_written import Written
from train.cli.tables import Column, show_table


def place_together(config: Any, counts: dict[str, int | None], seed: int, leave_unreached: bool, to: Written) -> None:
    """Place both sides by the closed loop's cost, and tell what that gains over one after the other."""
    from baselines.placement import JointProblem, place_jointly
    from beamenv.blade.layouts import with_positions

    to.check()
    problem = JointProblem.of(config, **counts)
    with one_cost_bar("both sides") as report:
        found = place_jointly(problem, seed, report, leave_unreached)
    if to.as_json:
        print_json({**asdict(found), "unit": "J", "gain": found.gain})
    else:
        _show(found, problem.config.speed)
    to.save(with_positions(config, {"actuators": found.actuators, "sensors": found.sensors}))


def _show(found: Any, speed: float) -> None:
    each_way = (
        ("one after the other", found.in_turn["actuators"], found.in_turn["sensors"], found.in_turn_cost),
        ("together", found.actuators, found.sensors, found.cost),
    )
    words = [Column(each, words=True) for each in ("placed", "actuators", "sensors")]
    rows = [[name, _edges(above), _edges(below), f"{cost:.4g}"] for name, above, below, cost in each_way]
    show_table([*words, Column("cost of\nthe loop, J")], rows, f"Both sides, {speed:g} rad/s: root-side edges, m")
    note(f"together they cost {100.0 * found.gain:.2f} % less")


def _edges(side: Sequence[float]) -> str:
    return " ".join(f"{z:.4f}" for z in side)
