"""The episode that the benchmark's page shows, under every controller that is measured there."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from baselines import Controller
from beamenv.knowledge import TRUTH
from beamenv.task import Task, resolve_task
from train.benchmark.listed import ListedController
from train.benchmark.table import BenchmarkTable, Row
from train.controllers.shipped import shipped_agents
from train.controllers.sources import Source
from train.page import RecordedEpisode, record_episode
from train.page.recording import RecordingProgress
from train.shared.held_out import HELD_OUT


@dataclass(frozen=True, slots=True, eq=False)
class ShownEpisode:
    """An episode of one scenario, and what to say of it."""

    episode: RecordedEpisode
    scenario: str
    best: Row
    """The least J there of all that see no more than a real blade shows."""
    note: str


def shown_episode(
    table: BenchmarkTable, listed: Sequence[ListedController], progress: RecordingProgress | None = None
) -> ShownEpisode | None:
    """The first held-out episode of the scenario in which a shipped agent gains most on LQG, under everyone who is measured there,
    agents in their first run. It opens beside the best that sees no more than a real blade shows.

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
    sources = {each.name: each.runs(name, task.scenario) for each in listed}
    made = {row: law for row in rows if (law := _made(sources.get(row.controller, {}), task)) is not None}
    recorded = _recorded(arguments, made, progress)
    if recorded is None:
        return None
    episode, best, shown = recorded
    which = ", where an agent gains most on LQG" if gains else ""
    without = [row.controller for row in rows if row not in shown]
    left = f" Not shown, because they could not be run once more: {', '.join(without)}." if without else ""
    note = f"Scenario {name}{which}: held-out episode of seed {HELD_OUT}. J₀: J without control, in this episode.{left}"
    return ShownEpisode(episode, name, best, note)


def _recorded(
    arguments: Mapping[str, Any], made: Mapping[Row, Controller], progress: RecordingProgress | None
) -> tuple[RecordedEpisode, Row, Collection[Row]] | None:
    """The episode, the best of those who see no more than a real blade shows, and whose it is: all, or, where the code of a caller
    raises whatever it may, all but callers' own.
    """
    rivals = [row for row in made if row.controller != "none" and row.tier < TRUTH]
    if not rivals:
        return None
    try:
        laws = {row.controller: law for row, law in made.items()}
        return record_episode(arguments, HELD_OUT, laws, rivals[0].controller, progress), rivals[0], made
    except Exception:  # of an object that is not ours
        ours = {row: law for row, law in made.items() if row.kind != "own"}
        if len(ours) == len(made):
            raise
        return _recorded(arguments, ours, progress)


def _made(runs: Mapping[str, Source], task: Task) -> Controller | None:
    """The controller of the first of its runs; None of one that cannot be had any more."""
    source = next(iter(runs.values()), None)
    try:
        return None if source is None else source.build(task)
    except Exception:  # a file that is gone, or whatever the code of a caller raises
        return None
