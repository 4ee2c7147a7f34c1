"""The episode that the benchmark's page shows: LQG and the best agent that ships, side by side."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from beamenv.knowledge import TRUTH
from beamenv.scenarios.scenario import scenario
from beamenv.task import resolve_task
from train.benchmark.table import BenchmarkTable
from train.controllers.choice import chosen
from train.controllers.named import KINDS, named
from train.controllers.shipped import shipped_agents
from train.page import RecordedEpisode, record_episode
from train.shared.held_out import HELD_OUT


def shown_episode(table: BenchmarkTable) -> tuple[RecordedEpisode | None, str]:
    """The first held-out episode of the scenario in which a shipped agent gains most on LQG, and what to say of it.

    Scenarios whose plant is drawn or changes are passed over: their blades have other shapes than the configured one. None without
    a shipped agent. Of a model of one's own, LQG and the best other law in the first scenario.
    """
    ships, environment = shipped_agents(), table.configuration.get("environment", {})
    if environment.get("plant") is not None:
        return _of_model(table, environment)
    candidates = [row for row in table.rows if row.controller in ships and row.measured and _one_plant(row.scenario)]
    if not candidates:
        return None, ""
    best = min(candidates, key=lambda row: row.estimates["difference_to_lqg"].value)
    arguments = {**environment, "scenario": best.scenario}
    task = resolve_task(**arguments)
    try:
        agent = chosen(best.controller, task, best.scenario)
    except ValueError:  # the table's blade is another one than that which agents ship for
        return None, ""
    note = f"Scenario {best.scenario}, held-out episode of seed {HELD_OUT}: LQG, and the agent that gains most on it."
    return record_episode(arguments, HELD_OUT, (named("lqg").build_for(task), agent)), note


def _of_model(table: BenchmarkTable, environment: Mapping[str, Any]) -> tuple[RecordedEpisode | None, str]:
    """The first held-out episode of the first scenario under LQG and the best other law with sensors there; it has no shape."""
    name = table.scenarios[0]
    rivals = [row for row in table.within(name) if row.measured and row.kind in KINDS and row.controller not in ("none", "lqg")]
    rivals = [row for row in rivals if row.tier < TRUTH]
    arguments = {**environment, "scenario": table.configuration["scenarios"][name]}
    task = resolve_task(**{key: value for key, value in arguments.items() if key != "max_episode_steps"})
    lqg = named("lqg").build_for(task)
    best = min(rivals, key=lambda row: row.mean_cost, default=None)
    pair = (named("none" if best is None else best.controller).build_for(task), lqg)
    told = "LQG, and no control" if best is None else f"LQG, and {best.controller}, the law that costs least beside it"
    return record_episode(arguments, HELD_OUT, pair), f"Scenario {name}, held-out episode of seed {HELD_OUT}: {told}."


def _one_plant(name: str) -> bool:
    try:
        plants = scenario(name).plants
    except ValueError:
        return False
    return not plants.varies and plants.spin_up is None
