"""The episode that the benchmark's page shows, under every controller that is measured there."""

from __future__ import annotations

from dataclasses import dataclass

from baselines import Controller
from beamenv.knowledge import TRUTH
from beamenv.task import Task, resolve_task
from train.benchmark.table import BenchmarkTable, Row
from train.controllers.choice import chosen
from train.controllers.named import KINDS
from train.controllers.shipped import shipped_agents
from train.page import RecordedEpisode, record_episode
from train.shared.held_out import HELD_OUT


@dataclass(frozen=True, slots=True, eq=False)
class ShownEpisode:
    """An episode of one scenario, and what to say of it."""

    episode: RecordedEpisode
    scenario: str
    best: Row
    """The least J there of all that see no more than a real blade shows."""
    note: str


def shown_episode(table: BenchmarkTable) -> ShownEpisode | None:
    """The first held-out episode of the scenario in which a shipped agent gains most on LQG, under everyone who is measured there
    and can be made again from its name. It opens beside the best that sees no more than a real blade shows.

    Without a shipped agent, and of a model of one's own, that of the first scenario; None where nobody can be made again.
    """
    environment = table.configuration.get("environment", {})
    ships = {} if environment.get("plant") is not None else shipped_agents()
    gains = [
        (row.estimates["difference_to_lqg"].value, row.scenario) for row in table.rows if row.controller in ships and row.measured
    ]
    name = min(gains)[1] if gains else table.scenarios[0]
    arguments = {**environment, "scenario": table.configuration["scenarios"][name]}
    task = resolve_task(**{key: value for key, value in arguments.items() if key != "max_episode_steps"})
    rows = sorted((row for row in table.within(name) if row.measured), key=lambda row: row.mean_cost)
    made = {row: law for row in rows if (law := _made(row, task)) is not None}
    rivals = [row for row in made if row.controller != "none" and row.tier < TRUTH]
    if not rivals:
        return None
    episode = record_episode(arguments, HELD_OUT, {row.controller: law for row, law in made.items()}, rivals[0].controller)
    which = ", where an agent gains most on LQG" if gains else ""
    without = [row.controller for row in rows if row not in made]
    left = f" Not shown, for they cannot be made again from their names: {', '.join(without)}." if without else ""
    note = f"Scenario {name}{which}: held-out episode of seed {HELD_OUT}. J₀: J without control, in this episode.{left}"
    return ShownEpisode(episode, name, rivals[0], note)


def _made(row: Row, task: Task) -> Controller | None:
    """The controller of a row; None of one that cannot be had from its name, such as a caller's own."""
    if row.kind not in KINDS and row.controller not in shipped_agents():
        return None
    try:
        return chosen(row.controller, task, row.scenario)
    except ValueError:  # the table's blade is another one than that which agents ship for
        return None
