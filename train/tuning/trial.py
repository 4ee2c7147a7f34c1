"""One trial of a tuning: a training that is looked at on validation seeds at some of its updates, its rungs."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from beamenv.task import Task
from train.controllers.policies import Policy
from train.learning.agents import AGENTS
from train.learning.checkpoint import FORMAT, read_checkpoint, write_checkpoint
from train.learning.job import Job, teacher_for
from train.learning.session import CHECKPOINT_INTERVAL, Budget
from train.learning.training import Training
from train.learning.validation import EPISODES, Validation
from train.shared.held_out import VALIDATION
from train.shared.threads import one_torch_thread

STATE = ("identity", "looks", "seconds", "training")
"""What a checkpoint holds of a trial."""

REDUCTION = 4
"""Of four trials that come to a rung about one goes on."""


@dataclass(frozen=True, slots=True)
class Look:
    """How good the policies of a trial are at a rung; of several runs side by side the mean."""

    updates: int
    cost: float
    """J relative to no control on the validation episodes that choose."""
    apart: float
    """The same on as many others, which choose nothing: what is chosen is flattered by the ones it was chosen on."""
    seconds: float
    """Of training so far."""


def rungs(updates: int) -> tuple[int, ...]:
    """About a sixteenth of the updates, a quarter, and all of them."""
    first = max(1, updates // REDUCTION**2)
    return tuple(sorted({min(rung, updates) for rung in (first, REDUCTION * first, updates)}))


def looks(job: Job, at: Sequence[int], folder: Path, known: Sequence[Look] = ()) -> Iterator[Look]:
    """Train and look, one rung after another; those ``known`` come first, and are not trained again unless more is to follow.

    After each a checkpoint is in ``folder``, from which the next call resumes, bit for bit. Where there is none, say on another
    machine, the training begins anew, to the same result. Raises ValueError as a training does.
    """
    yield from known
    if len(known) == len(at):
        return
    tasks = job.tasks()
    identity = json.dumps({**job.identity(), "rungs": list(at)})
    validations = [Validation(list(tasks.values()), first) for first in (VALIDATION, VALIDATION + EPISODES)]
    with one_torch_thread(), closing(_training(job, tasks)) as training:
        clock = _Clock(training, folder, identity)
        yield from clock.found[len(known) :]
        for rung in at[len(clock.found) :]:
            clock.train(rung, job.budget)
            policies = training.policies()
            cost, apart = (_mean(validation, policies) for validation in validations)
            clock.found.append(Look(rung, cost, apart, clock.seconds))
            clock.keep()
            if len(clock.found) > len(known):
                yield clock.found[-1]


def _training(job: Job, tasks: Mapping[str, Task]) -> Training:
    start = AGENTS[job.recipe.agent].training
    return start(list(tasks.values()), job.recipe.settings, job.seed, teacher_for(job.teacher, tasks))


def _mean(validation: Validation, policies: Sequence[Policy]) -> float:
    return float(np.mean([validation.cost(policy) for policy in policies]))


class _Clock:
    """A training under way, with the looks at it so far: those of its checkpoint to begin with, if there is one."""

    def __init__(self, training: Training, folder: Path, identity: str) -> None:
        self._training, self._folder, self._identity = training, folder, identity
        before = _checkpoint(folder)
        self.found: list[Look] = []
        self.seconds = 0.0
        if before.get("identity") == identity:
            training.load_state_dict(before["training"])
            self.found, self.seconds = [Look(**each) for each in before["looks"]], float(before["seconds"])

    def train(self, rung: int, budget: Budget) -> None:
        """Train to a rung, with a checkpoint now and then."""
        begin = kept = time.monotonic()
        before = self.seconds
        while self._training.updates < rung:
            self._training.update(1.0 - budget.share(self._training.updates, 0.0))
            self.seconds = before + time.monotonic() - begin
            if time.monotonic() - kept >= CHECKPOINT_INTERVAL:
                self.keep()
                kept = time.monotonic()

    def keep(self) -> None:
        """Write a checkpoint."""
        looks = [asdict(each) for each in self.found]
        state = {"training": self._training.state_dict(), "looks": looks, "seconds": self.seconds, "identity": self._identity}
        write_checkpoint(self._folder, {"format": FORMAT, **state})


def _checkpoint(folder: Path) -> Mapping[str, Any]:
    """What a checkpoint holds; nothing where there is none, or it is damaged: the trial then begins anew."""
    try:
        return read_checkpoint(folder, STATE)
    except ValueError:
        return {}
