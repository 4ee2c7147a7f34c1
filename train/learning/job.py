"""One training job: run in a folder, resumed from its checkpoint there, and saved with all that it depends on."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from beamenv.plant.fingerprint import fingerprint
from beamenv.scenarios.named import BENCHMARK, OPEN, UNSEEN
from beamenv.scenarios.of_models import fits_models
from beamenv.scenarios.scenario import SCENARIOS, Scenario
from beamenv.task import Task, resolve_task
from train.controllers.policies import Policy
from train.controllers.policy_files import load_policy, save_policy
from train.controllers.runs import best_run
from train.controllers.shipped import GENERALIST as GENERALIST
from train.controllers.tiers import LEARNT, TIER
from train.learning.agents import AGENTS
from train.learning.checkpoint import FORMAT, NAME, damaged, read_checkpoint, write_checkpoint
from train.learning.recipe import Recipe
from train.learning.scalars import Scalars
from train.learning.session import Budget, follow
from train.learning.training import Progress, Report, Training
from train.learning.validation import Validation
from train.shared.curve import LOOKED, VALIDATION, write_curve
from train.shared.curve import NAME as CURVE
from train.shared.held_models import told_models
from train.shared.interruption import Interrupted, ending_as_interrupted
from train.shared.lock import alone_in
from train.shared.threads import one_torch_thread
from train.shared.versions import versions

NAMES = tuple(name for name in (*BENCHMARK, *OPEN) if name not in UNSEEN)
"""All scenarios but those that are kept for judging."""

CURVE_POINTS = 200
"""Rows of a learning curve, about."""

LOOKS = 12
"""At the policy on validation seeds, for the learning curve of an agent that never looks itself."""

PART = 0.1
"""Of the time spent on training: what looks may take where they are to be sparing."""

STATE = ("identity", "training", "seconds", "curve")
"""What a checkpoint holds of a training."""


@dataclass(frozen=True, slots=True)
class Job:
    """What is trained, on what, and for how long."""

    name: str
    """Of the recipe."""
    recipe: Recipe
    scenario: Any
    """A name, a TOML file, a table as JSON can hold it, or ``GENERALIST``: all of ``NAMES``, in one training."""
    seed: int
    budget: Budget
    environment: Mapping[str, Any]
    """Keyword arguments of the environment but the scenario, as JSON can hold them."""
    teacher: Path | None = None
    """Folder of a trained policy to start from; of several runs in it, the one that ended its training at the least cost."""
    content: Scenario | None = None
    """What the scenario's file says, for where it is not."""
    looks: int = 0
    """How many times a training that never looks at its policy on validation seeds is looked at, for its learning curve alone."""
    sparing: bool = False
    """Whether there are fewer looks where these would take more than ``PART`` of the training's time; the first and last stay."""

    def tasks(self) -> dict[str, Task]:
        """The task of each scenario; of a model of one's own a generalist has those that can be of it."""
        scenarios: tuple[Any, ...] = (self.scenario,)
        if self.content is not None:
            return {str(self.scenario): resolve_task(**{**self.environment, "scenario": self.content})}
        if self.scenario == GENERALIST:
            of_model = self.environment.get("plant") is not None
            scenarios = tuple(each for each in NAMES if not of_model or fits_models(SCENARIOS[each]))
        return {str(each): resolve_task(**{**self.environment, "scenario": each}) for each in scenarios}

    def identity(self) -> dict[str, Any]:
        """What two runs must share for one to resume the other."""
        weights = None if self.teacher is None else sha256(_weights(self.teacher).read_bytes()).hexdigest()
        return {
            "agent": self.name,
            "recipe": self.recipe.to_dict(),
            "scenario": self.scenario,
            "environment": told_models(self.environment),
            "seed": self.seed,
            "budget": [str(self.budget.updates), str(self.budget.seconds)],
            "teacher": weights,
        }

    def told(self, tasks: Mapping[str, Task] | None = None) -> str:
        """The identity with the scenarios as they are, as a checkpoint holds it; ``ValueError`` for what no task can be made of."""
        tasks = self.tasks() if tasks is None else tasks
        return json.dumps({**self.identity(), "scenarios": {name: task.scenario.to_dict() for name, task in tasks.items()}})

    def check_resumed(self, folder: Path, before: Mapping[str, Any], tasks: Mapping[str, Task] | None = None) -> None:
        """``ValueError`` if the checkpoint in a folder is another training's."""
        if before["identity"] != (asked := self.told(tasks)):
            held = _held(before["identity"], json.loads(asked))
            raise ValueError(f"folder = {str(folder)!r} holds another training{held}: resume with the same arguments.")


DIFFERING = {
    "agent": "recipe's name",
    "recipe": "recipe's content",
    "environment": "blade, speed or model",
    "seed": "seed",
    "budget": "updates or minutes",
    "teacher": "agent to start from",
}
"""What two trainings may differ in, by the keys of their identities, but for scenarios."""


def _held(identity: str, asked: Mapping[str, Any]) -> str:
    """Which training a checkpoint is of, and what of it differs; empty where its identity is damaged."""
    try:
        held = json.loads(identity)
        told = f", of {held['agent']} in {held['scenario']} with seed {held['seed']}"
    except (ValueError, TypeError, KeyError):
        return ""
    other = [words for key, words in DIFFERING.items() if held.get(key) != asked[key]]
    if held["scenario"] != asked["scenario"]:
        other.append("scenario")
    elif held.get("scenarios") != asked["scenarios"] and held.get("environment") == asked["environment"]:
        other.append("scenario's content")
    return f"{told} ({', '.join(other)} differ{'s' if len(other) == 1 else ''})" if other else told


def _weights(teacher: Path) -> Path:
    weights = best_run(teacher) / "weights.npz"
    if not weights.is_file():
        raise ValueError(f"teacher = {str(teacher)!r} must be the folder of a trained agent, but has no weights.npz.")
    return weights


def run(
    job: Job, folder: Path, report: Report, resume: bool = False, overwrite: bool = False, keeps_unfinished: bool = True
) -> list[Path]:
    """Train, with checkpoints, learning curve and TensorBoard's files in ``folder``; the folders of the policies.

    ``report`` is called after every update. Ctrl-C keeps a checkpoint, and saves what has been learnt as an agent that says it is
    not ``finished``; a signal to end does the same and raises ``Interrupted``. Unless ``keeps_unfinished``, both leave no agent and
    raise ``Interrupted``.

    Raises ValueError if the folder holds a training or an agent and it is neither to be resumed nor to be overwritten, if what is
    to be resumed is another one, and if another process is at work in the folder.
    """
    with alone_in(folder), ending_as_interrupted():
        return _run(job, folder, report, begun(folder, resume, overwrite), keeps_unfinished)


def begun(folder: Path, resume: bool, overwrite: bool) -> Mapping[str, Any] | None:
    """The checkpoint to resume from, None to begin; ``ValueError`` if the folder holds what is neither to be."""
    if resume and overwrite:
        raise ValueError("resume and overwrite must not both be given.")
    if resume:
        return read_checkpoint(folder, STATE)
    if not overwrite and (held := held_in(folder)):
        what = "training" if NAME in held else "trained agent"
        raise ValueError(f"folder = {str(folder)!r} holds a {what} already: resume or overwrite it, or name another folder.")
    return None


def held_in(folder: Path) -> list[str]:
    """Files of a training or of trained agents in a folder, by their paths there."""
    runs = [f"{each.name}/" for each in folder.glob("*/") if each.name.isdecimal()]
    held = [f"{place}{name}" for place in ("", *runs) for name in ("agent.json", "weights.npz", CURVE)]
    return [name for name in (NAME, *held) if (folder / name).is_file()]


def _run(job: Job, folder: Path, report: Report, before: Mapping[str, Any] | None, keeps_unfinished: bool) -> list[Path]:
    """What ``run`` does in a folder of its own, from a checkpoint on if there is one."""
    identity, tasks = job.identity(), job.tasks()
    if before is not None:
        job.check_resumed(folder, before, tasks)
    ending = None
    with one_torch_thread():
        start = AGENTS[job.recipe.agent].training
        training = start(list(tasks.values()), job.recipe.settings, job.seed, teacher_for(job.teacher, tasks))
        looks = 0 if getattr(job.recipe.settings, "validation", 0) else job.looks
        validation = Validation(list(tasks.values())) if looks else None
        journal = Journal(folder, job.budget, training, job.told(tasks), report, validation, looks, job.sparing)
        try:
            elapsed = journal.begin() if before is None else journal.resume(before)
            policies = follow(training, job.budget, journal.note, journal.keep, elapsed, aside=lambda: journal.looking)
        except Interrupted as error:
            ending, policies = error, training.policies()
        finally:
            journal.scalars.close()
            training.close()
    finished = journal.finished
    if not finished and not keeps_unfinished:
        raise ending or Interrupted()
    about = {**identity, "finished": finished, "updates": training.updates, "steps": training.steps}
    places = save_all(policies, folder, journal, about, {name: fingerprint(task.design_plant) for name, task in tasks.items()})
    if ending is not None:
        raise ending
    return places


def teacher_for(folder: Path | None, tasks: Mapping[str, Task]) -> Policy | None:
    """The policy in a folder, if one is named, or its best run; ``ValueError`` if it does not know the plants of all tasks."""
    if folder is None:
        return None
    folder = best_run(folder)
    policies = [load_policy(folder, task.design_plant) for task in tasks.values()]
    return policies[0] if len(policies) == 1 else load_policy(folder)


class Journal:
    """The learning curve, the checkpoints and TensorBoard's files of a training."""

    def __init__(
        self,
        folder: Path,
        budget: Budget,
        training: Training,
        identity: str,
        report: Report,
        validation: Validation | None = None,
        looks: int = 0,
        sparing: bool = False,
    ) -> None:
        self.curve: list[Progress] = []
        self.seconds, self.looking = 0.0, 0.0
        self._validation, self._looks, self._sparing = validation, looks, sparing
        self.scalars = Scalars(folder / "tensorboard")
        self._folder, self._budget, self._training, self._identity, self._report = folder, budget, training, identity, report

    def begin(self) -> float:
        """A first checkpoint, in the place of whatever training or agents the folder held: from now on it can be resumed."""
        for name in held_in(self._folder):
            (self._folder / name).unlink()
        self.keep(0.0)
        return 0.0

    def resume(self, before: Mapping[str, Any]) -> float:
        """Resume from a checkpoint; the seconds spent until then. ``ValueError`` if it does not fit the training."""
        try:
            self._training.load_state_dict(before["training"])
            self.curve = [
                Progress(elapsed, steps, cost, updates, tuple(costs), validated, tuple(*looked))
                for elapsed, steps, cost, updates, costs, validated, *looked in before["curve"]
            ]
            self.seconds = float(before["seconds"])
        except Exception as error:  # noqa: BLE001 - torch, NumPy and SB3 each complain of a state in ways of their own
            raise damaged(self._folder, f"holds a state that does not fit this training ({type(error).__name__})") from None
        return self.seconds

    @property
    def finished(self) -> bool:
        """Whether the budget is spent."""
        return self._budget.share(self._training.updates, self.seconds) >= 1.0

    def note(self, progress: Progress) -> None:
        """A point of the curve where it is time, and report."""
        self.seconds = progress.elapsed
        share = self._budget.share(progress.updates, progress.elapsed)
        if self._validation is not None and self._looks_now(share):
            progress = replace(progress, looked=self._look(self._validation))
        if share * CURVE_POINTS >= len(self.curve) + 1 or progress.looked or np.isfinite(progress.validated):
            self.curve.append(progress)
            self.scalars.write(progress, self._training.losses)
        self._report(progress)

    def _looks_now(self, share: float) -> bool:
        """Whether one more look is due and not too dear."""
        due = share * self._looks >= sum(bool(each.looked) for each in self.curve) + 1
        return due and (not self._sparing or share >= 1.0 or self.looking <= PART * self.seconds)

    def _look(self, validation: Validation) -> tuple[float, ...]:
        """Cost of each policy; the time that it takes is not the training's."""
        begin = time.monotonic()
        costs = tuple(validation.cost(policy) for policy in self._training.policies())
        self.looking += time.monotonic() - begin
        return costs

    def keep(self, elapsed: float) -> None:
        """Write a checkpoint."""
        curve = [
            [each.elapsed, each.steps, each.cost, each.updates, list(each.costs), each.validated, list(each.looked)]
            for each in self.curve
        ]
        training = self._training.state_dict()
        if self.finished:
            training.pop("memory", None)  # of experience, which is large: nothing will be learnt from it any more
        state = {"training": training, "seconds": elapsed, "curve": curve, "identity": self._identity}
        write_checkpoint(self._folder, {"format": FORMAT, **state})

    def write_curve(self, folder: Path, run: int) -> None:
        """``learning.csv`` of one of the runs."""
        seen = [each.looked[run] if each.looked else each.validated for each in self.curve]
        rows = [(each.elapsed, each.steps, each.updates, each.costs[run], one) for each, one in zip(self.curve, seen, strict=True)]
        write_curve(folder, rows, LOOKED if any(each.looked for each in self.curve) else VALIDATION)


def save_all(
    policies: list[Policy], folder: Path, journal: Journal, about: Mapping[str, Any], plants: Mapping[str, str]
) -> list[Path]:
    """Each policy with its curve and what it depends on: in ``folder``, or, of several runs, in folders there."""
    places = [folder] if len(policies) == 1 else [folder / str(run) for run in range(len(policies))]
    for run, (policy, place) in enumerate(zip(policies, places, strict=True)):
        journal.write_curve(place, run)
        own = {TIER: LEARNT, "run": run, "seconds": round(journal.seconds, 1), "versions": versions(), "plants": dict(plants)}
        save_policy(policy, place, {**about, **own})
    return places
