"""What ``beamenv benchmark --quick`` runs: the rows and scenarios that tell the story, on few episodes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from beamenv.task import Task
    from train.benchmark.table import BenchmarkTable

QUICK_SCENARIOS = ("nominal", "delay", "failure", "mid-failure", "delay-failure")
"""LQG's own, two in which it goes unstable, an open one, and one unseen; none whose many plants take long to build."""

QUICK_LAWS = (
    *("none", "positive-position-feedback", "lqg-thesis", "lqg", "lqg-load", "informed-lqg", "multiple-model"),
    *("scheduled-lqg", "clairvoyant"),
)
"""Of every tier."""

QUICK_SEEDS = 16

QUICK_RUNS = 2
"""Of each generalist: with all of them, these would take more than half the time."""


def told() -> str:
    """What it is, for whoever asks."""
    return (
        f"{len(QUICK_LAWS)} controllers and {QUICK_RUNS} runs of each shipped generalist in {len(QUICK_SCENARIOS)} scenarios on "
        f"{QUICK_SEEDS} episodes"
    )


def quick_controllers(plant: Path | None = None) -> list[str]:
    """The laws, and the generalists that ship for the default blade; of a model of one's own those that can be had of it."""
    from beamenv.plant.fingerprint import fingerprint
    from beamenv.task import resolve_task
    from train.controllers.policy_files import read_about
    from train.controllers.shipped import shipped

    task = resolve_task(plant=plant)
    own = fingerprint(task.design_plant)
    general = [each for each in shipped() if each.scenario == "generalist"]
    fit = [each.agent for each in general if own in read_about(each.folder).get("plants", {}).values()]
    return [*(name for name in QUICK_LAWS if _can_be_had(name, task)), *dict.fromkeys(f"{name}-generalist" for name in fit)]


def _can_be_had(name: str, task: Task) -> bool:
    from train.controllers.named import named

    try:
        named(name).check_for(task)
    except ValueError:
        return False
    return True


def wide(table: BenchmarkTable) -> str:
    """How wide the intervals of so few episodes are."""
    import numpy as np

    found = [row.estimates["relative_cost"] for row in table.rows if row.measured and row.controller != "none"]
    widths = [0.5 * (each.high - each.low) / each.value for each in found if np.isfinite([each.low, each.value, each.high]).all()]
    half = f"±{100.0 * float(np.median(widths)):.0f} % of J / J₀ in the median" if widths else "without bounds"
    return (
        f"{table.rows[0].seeds} episodes a cell: intervals are wide, {half}. To compare closely, or to cite, run beamenv benchmark "
        "without --quick."
    )
