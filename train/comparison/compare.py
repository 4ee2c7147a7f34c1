"""The main job: train the agents, run every controller through the same held-out episodes, write what came of it."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, field, replace
from pathlib import Path
from typing import Annotated, Any

import gymnasium as gym

import beamenv
from baselines import Controller, Evaluation, LinearController, evaluate
from baselines.design.objects import instance, optional_instance
from baselines.evaluation.fit import check_state_told
from beamenv.blade.files import to_dict
from beamenv.blade.model_blade import ModelBlade
from beamenv.configuration import Natural, Number, Table, checked, checked_table, configuration
from beamenv.task import Task
from train.comparison.figures import write_figures
from train.comparison.table import write_tables
from train.controllers.named import named
from train.controllers.policy_files import read_about
from train.controllers.sources import Trained
from train.controllers.tiers import LEARNT
from train.learning.agents import AGENTS
from train.learning.checkpoint import NAME as CHECKPOINT
from train.learning.job import LOOKS, Job, run
from train.learning.recipe import Recipe, named_recipe
from train.learning.recipes import NAMES
from train.learning.session import Budget
from train.learning.training import Progress
from train.shared.claim import NAME, check_nothing_replaced
from train.shared.curve import drawn_as, read_curve
from train.shared.files import as_path, read_json, write_json
from train.shared.held_models import held_models, told_models
from train.shared.held_out import HELD_OUT, SEEDS, held_out
from train.shared.interruption import ending_as_interrupted
from train.shared.lock import alone_in

CLASSICAL = ("none", "velocity", "positive-position-feedback", "lqg-thesis", "lqg", "lqg-load", "lqr", "lqr-load")
"""The controllers that the two agents are compared with here; ``beamenv benchmark`` takes them all."""

DRAWN = ("none", "velocity", "positive-position-feedback", "lqg")
"""Whose loops' poles are drawn."""

RESULTS = (
    "agents",
    "evaluations",
    "table.csv",
    "table.md",
    "episode.png",
    "poles.png",
    "learning.png",
    "report.html",
)
"""What a comparison writes beside its configuration."""


@configuration("comparison")
class Comparison:
    """What is compared, and for how long agents are trained."""

    environment: Annotated[Mapping[str, Any], Table()] = field(default_factory=dict)
    """Keyword arguments of the environment, as JSON can hold them."""
    budget: Annotated[Mapping[str, float], Table()] = field(default_factory=lambda: {"belief": 30.0, "ppo-belief": 60.0})
    """Seconds of training of each agent, a trainer with its own settings or a recipe; none are trained where it is empty."""
    seeds: Annotated[int, SEEDS] = 64
    """Held-out episodes."""
    training_seed: Natural = 0

    def __post_init__(self) -> None:
        for name, seconds in checked_table(
            "comparison.budget", self.budget, (*AGENTS, *(each for each in NAMES if each not in AGENTS))
        ).items():
            checked(f"budget.{name}", seconds, Number(gt=0.0, unit="s"))

    def recipe(self, agent: str) -> Recipe:
        """Of an agent's only run: its trainer's own settings, or those of the recipe."""
        trainer, settings = (agent, AGENTS[agent].settings()) if agent in AGENTS else _alone(named_recipe(agent))
        return Recipe(trainer, f"{agent} of a comparison", 1, settings)

    def job(self, agent: str) -> Job:
        """The training of an agent."""
        environment = dict(self.environment)
        scenario = environment.pop("scenario", "nominal")
        budget = Budget(seconds=self.budget[agent])
        return Job(agent, self.recipe(agent), scenario, self.training_seed, budget, environment, looks=LOOKS)


def _alone(recipe: Recipe) -> tuple[str, Any]:
    """A recipe's trainer and settings, of one run where it is of several side by side."""
    return recipe.agent, replace(recipe.settings, runs=1) if hasattr(recipe.settings, "runs") else recipe.settings


class Listener:
    """What is called while a comparison runs; by default it does nothing."""

    def training(self, name: str, budget: float, progress: Progress) -> None:
        """After every update of an agent."""

    def resumed(self, name: str, finished: bool) -> None:
        """Before an agent that an earlier run has trained, or has begun to train."""

    def evaluated(self, evaluation: Evaluation) -> None:
        """After each controller."""

    def recording(self, done: int, total: int, name: str) -> None:
        """Before the episode that the page shows is run under a controller."""

    def left_out(self, name: str, sentence: str) -> None:
        """Before anything else, of each law that cannot be had of what moves."""


def compare(comparison: Comparison, folder: Path, listener: Listener | None = None) -> list[Evaluation]:
    """Train, evaluate, write tables, models, configuration, figures and a page to ``folder``, and return the evaluations.

    Each piece is written as soon as it is there. A folder of the same comparison is resumed: agents that it holds
    are not trained again. ``ValueError`` if it holds another comparison or what this one would replace, and
    if another process is at work in it; whatever is refused before any result leaves it as it was. An interruption ends
    all of it at once, as ``Interrupted`` where an agent is being trained: its checkpoint is kept, and no half-trained agent.

    A model of one's own, the "plant" of the environment, is compared on as its file says it now; a file that says something else
    later is another comparison. A law that cannot be had of what moves is told in one sentence, and the others go on.
    """
    instance("comparison", comparison, Comparison, "a Comparison")
    optional_instance("listener", listener, Listener, "a Listener")
    folder = as_path("folder", folder)
    held = replace(comparison, environment=held_models(comparison.environment))
    with alone_in(folder), ending_as_interrupted():
        return _compare(held, folder, listener or Listener())


def _compare(comparison: Comparison, folder: Path, listener: Listener) -> list[Evaluation]:
    from train.comparison.page import write_comparison_page  # plotly takes a while, and others want this module's names alone

    envs: Any = gym.make_vec(beamenv.ENV_ID, num_envs=comparison.seeds, **{"dtype": "float64", **comparison.environment})
    try:
        plant = envs.unwrapped.plant
        content = described(comparison, envs.unwrapped.task)
        check_claim(folder, content)
        laws, left_out = classical(envs.unwrapped.task)
        for name, sentence in left_out.items():
            listener.left_out(name, sentence)
        alone = evaluate(
            laws["none"], envs, held_out(comparison.seeds)
        )  # what cannot be compared is refused before anything is written
        with claimed(folder, content):
            agents = {name: trained(comparison, name, folder, envs.unwrapped.task, listener) for name in comparison.budget}
            curves = {drawn_as(name, folder / "agents" / name): read_curve(folder / "agents" / name) for name in agents}
            evaluations = evaluate_all({**laws, **agents}, envs, comparison, folder, listener, alone)
    finally:
        envs.close()
    tiers = tiers_of(evaluations)
    write_tables(folder, evaluations, tiers, left_out)
    by_name = {evaluation.name: evaluation.relative_cost.value for evaluation in evaluations}
    levels: dict[str, float] = {name: by_name[name] for name in ("lqg", "lqg-load") if name in laws}
    drawn: list[LinearController] = [laws[name] for name in DRAWN if name in laws]
    write_figures(folder, plant, evaluations, drawn, curves, levels)
    episodes = comparison.environment
    write_comparison_page(
        folder,
        plant,
        evaluations,
        {**laws, **agents},
        curves,
        levels,
        content,
        episodes,
        tiers,
        left_out,
        listener.recording,
    )
    return evaluations


def classical(task: Task) -> tuple[dict[str, Any], dict[str, str]]:
    """The laws of ``CLASSICAL`` that can be had of a task, and why not the others."""
    found = {name: _law_or_sentence(name, task) for name in CLASSICAL}
    laws = {name: law for name, law in found.items() if not isinstance(law, str)}
    return laws, {name: law for name, law in found.items() if isinstance(law, str)}


def _law_or_sentence(name: str, task: Task) -> Any:
    try:
        law = named(name).build_for(task)
        check_state_told(law, task)
    except ValueError as error:
        return str(error)
    return law


def tiers_of(evaluations: Sequence[Evaluation]) -> dict[str, int]:
    """Tiers of information by the controllers' ids: the laws' own, and that of agents."""
    return {each.name: named(each.name).tier if each.name in CLASSICAL else LEARNT for each in evaluations}


def described(comparison: Comparison, task: Any) -> dict[str, Any]:
    """The configuration of a comparison, as JSON holds it."""
    seeds, told = [HELD_OUT, HELD_OUT + comparison.seeds - 1], told_models(comparison.environment)
    blades = {} if isinstance(task.blade, ModelBlade) else {"blade": to_dict(task.config), "design": to_dict(task.design_config)}
    content = {
        "comparison": {**asdict(comparison), "environment": told, "held_out_seeds": seeds},
        **blades,
        "scenario": task.scenario.to_dict(),
        "agents": {name: asdict(comparison.recipe(name).settings) for name in comparison.budget},
    }
    whole: dict[str, Any] = json.loads(json.dumps(content))
    return whole


def check_claim(folder: Path, content: Mapping[str, Any]) -> None:
    """``ValueError`` unless the folder holds this very comparison, or nothing that it would replace."""
    path = folder / NAME
    if not path.exists():
        check_nothing_replaced(folder, RESULTS, "comparison")
        return
    told = read_json(path)
    if not isinstance(told, dict) or "comparison" not in told:
        raise ValueError(f"file {str(path)!r} is no configuration of a comparison: name another folder, or empty this one.")
    if told != content:
        raise ValueError(f"folder = {str(folder)!r} holds another comparison: name another folder, or empty this one.")


@contextmanager
def claimed(folder: Path, content: Mapping[str, Any]) -> Iterator[None]:
    """The configuration is in the folder, and goes again where bad input is told before there is any result."""
    path = folder / NAME
    fresh = not path.exists()
    if fresh:
        write_json(path, content)
    try:
        yield
    except ValueError:
        if fresh and not any((folder / name).exists() for name in RESULTS):
            path.unlink()
        raise


def trained(comparison: Comparison, name: str, folder: Path, task: Task, listener: Listener) -> Controller:
    """The agent of an earlier run, or one trained now, from its checkpoint on if it was interrupted; called as it is here."""
    home = folder / "agents" / name
    finished = (home / "agent.json").exists() and read_about(home).get("finished", True)
    budget, resumes = comparison.budget[name], (home / CHECKPOINT).exists()
    if finished or resumes:
        listener.resumed(name, finished)
    if not finished:
        run(
            comparison.job(name),
            home,
            lambda progress: listener.training(name, budget, progress),
            resume=resumes,
            keeps_unfinished=False,
        )
    return replace(Trained(home).build(task), name=name)


def evaluate_all(
    controllers: Mapping[str, Controller], envs: Any, comparison: Comparison, folder: Path, listener: Listener, alone: Evaluation
) -> list[Evaluation]:
    """Every controller on the same held-out seeds, each written as it is finished; ``alone`` is that of no control, the first."""
    seeds = held_out(comparison.seeds)
    evaluations: list[Evaluation] = []
    for name, controller in controllers.items():
        evaluation = evaluate(controller, envs, seeds, reference=alone.reference) if evaluations else alone
        write_json(folder / "evaluations" / f"{name}.json", evaluation.to_dict())
        evaluations.append(evaluation)
        listener.evaluated(evaluation)
    return evaluations
