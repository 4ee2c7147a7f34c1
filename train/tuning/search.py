"""Asynchronous successive halving (Li et al. 2020) by Ray Tune: trials that are behind at a rung are stopped there.

Ray does the work; what is known lies in records, not in Ray's own folders, whose files run code when they are read and do not hold
what its scheduler knows. An interrupted search begins anew and is told at once what was found before.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

from ray import tune
from ray.tune import Callback, CheckpointConfig, FailureConfig, RunConfig, TuneConfig
from ray.tune.schedulers import ASHAScheduler, TrialScheduler

from beamenv.configuration import clause
from train.learning.job import Job
from train.learning.recipe import Recipe
from train.learning.several import files
from train.learning.validation import HIGHEST
from train.shared.cluster import connected
from train.tuning.records import FAILED, FINISHED, STOPPED, Record, checkpoints
from train.tuning.trial import REDUCTION, Look, looks
from train.workers.parcel import packed, unpacked

QUIET = {
    "TUNE_DISABLE_AUTO_CALLBACK_LOGGERS": "1",
    "TUNE_DISABLE_SIGINT_HANDLER": "1",
    "TUNE_PRINT_ALL_TRIAL_ERRORS": "0",
    "RAY_AIR_NEW_OUTPUT": "0",
}
"""Tune's environment: it prints nothing, records say what loggers would, and Ctrl-C is the command's."""

DEATHS = 3
"""Of its workers that a trial outlives."""

NOTHING = {"done": True, "updates": 0, "cost": HIGHEST}
"""In place of a look."""

Found = Callable[[Record], None]


@dataclass(frozen=True, slots=True)
class Search:
    """What every worker is told."""

    jobs: Sequence[Job]
    """By trial."""
    records: Sequence[Record]
    """By trial."""
    rungs: Sequence[int]
    folder: Path


class Arm(tune.Trainable):
    """A trial in a worker: each step leads to its next rung."""

    def setup(self, config: dict[str, Any], parcel: bytes) -> None:  # type: ignore[override] # ``with_parameters`` gives it
        """A trial from its beginning, or from what is known of it."""
        search, trial = unpacked(parcel), config["trial"]
        record, self._last = search.records[trial], search.rungs[-1]
        self._looks: Iterator[Look] = iter(record.looks)
        if record.ended not in (STOPPED, FAILED):
            self._looks = looks(search.jobs[trial], search.rungs, checkpoints(search.folder, trial), record.looks)

    def step(self) -> dict[str, Any]:
        """The next look, or the end."""
        try:
            look = next(self._looks, None)
        except Exception as error:  # noqa: BLE001 - settings may fail in many ways, and the other trials go on
            return {**NOTHING, "failed": clause(f"{type(error).__name__}: {error}")}
        return NOTHING if look is None else {**asdict(look), "done": look.updates == self._last}

    def reset_config(self, new_config: dict[str, Any]) -> bool:
        """Another trial in the same worker, which has loaded all that it needs."""
        self.cleanup()
        self.setup(new_config)  # type: ignore[call-arg]
        return True

    def cleanup(self) -> None:
        """Let go of the training."""
        if isinstance(self._looks, Generator):
            self._looks.close()


class Halving(ASHAScheduler):
    """Successive halving that lets the recipe as it is have all its updates: the others are compared with it."""

    def on_trial_result(self, tune_controller: Any, trial: Any, result: dict[str, Any]) -> str:
        """Whether a trial goes on."""
        decision: str = super().on_trial_result(tune_controller, trial, result)
        return TrialScheduler.CONTINUE if trial.config["trial"] == 0 else decision


class Notes(Callback):
    """Keeps what is found, as it is found."""

    def __init__(self, records: Sequence[Record], last: int, found: Found) -> None:
        self.records, self._last, self._found = list(records), last, found

    def __getstate__(self) -> dict[str, Any]:
        """Nothing: Ray keeps a copy of the whole search, and nobody reads it."""
        return {}

    def on_trial_result(self, iteration: int, trials: Any, trial: Any, result: dict[str, Any], **info: Any) -> None:
        """A look, or why there is none."""
        record = self.records[trial.config["trial"]]
        if "failed" in result:
            self._note(replace(record, ended=FAILED, sentence=result["failed"]))
        elif result["updates"]:
            self._note(record.looked(Look(**{each.name: result[each.name] for each in fields(Look)})))

    def on_trial_complete(self, iteration: int, trials: Any, trial: Any, **info: Any) -> None:
        """It has come to its end, or was stopped."""
        record = self.records[trial.config["trial"]]
        self._note(replace(record, ended=record.ended or (FINISHED if record.updates == self._last else STOPPED)))

    def on_trial_error(self, iteration: int, trials: Any, trial: Any, **info: Any) -> None:
        """Its worker died once too often."""
        record = self.records[trial.config["trial"]]
        self._note(replace(record, ended=FAILED, sentence=f"its worker died {DEATHS + 1} times"))

    def _note(self, record: Record) -> None:
        if record != self.records[record.trial]:
            self.records[record.trial] = record
            self._found(record)


def search(plan: Search, found: Found, cluster: str, side_by_side: int | None) -> list[Record]:
    """Run the trials that have not ended, so many side by side, all cores of a cluster if None; what is then known of each.

    ``found`` is called in this process with every record that says more than before. Raises ValueError if there is no such cluster.
    """
    notes = Notes(plan.records, plan.rungs[-1], found)
    os.environ |= QUIET
    with connected(cluster, side_by_side), tempfile.TemporaryDirectory(prefix="beamenv-tune-") as place:
        tune.Tuner(
            tune.with_resources(
                tune.with_parameters(Arm, parcel=packed(plan, files(plan.jobs[0]))), resources(plan.jobs[0].recipe)
            ),
            param_space={"trial": tune.grid_search(list(range(len(plan.jobs))))},
            tune_config=TuneConfig(
                metric="cost",
                mode="min",
                scheduler=Halving(
                    time_attr="updates", max_t=plan.rungs[-1], grace_period=plan.rungs[0], reduction_factor=REDUCTION
                ),
                max_concurrent_trials=side_by_side,
                reuse_actors=True,
            ),
            run_config=RunConfig(
                storage_path=place,
                verbose=0,
                callbacks=[notes],
                failure_config=FailureConfig(max_failures=DEATHS),
                checkpoint_config=CheckpointConfig(checkpoint_frequency=0, checkpoint_at_end=False),
            ),
        ).fit()
    return notes.records


def resources(recipe: Recipe) -> dict[str, float]:
    """A core for each trial, and a GPU where the recipe trains on one."""
    device = getattr(recipe.settings, "device", "cpu")
    return {"cpu": 1} if device == "cpu" else {"cpu": 1, "gpu": 1}
