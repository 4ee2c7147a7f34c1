"""One cell of the table: a controller, or one training run of it, on all seeds of one scenario."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import lru_cache
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

import beamenv
from baselines import EpisodeMetrics, Episodes, no_control, roll_out
from baselines.design.controller import name_of
from baselines.evaluation.metrics import finite, measure, settling_band
from beamenv.scenarios.scenario import Scenario
from train.controllers.sources import Source
from train.shared.digests import CONTROLLERS, digest, source_digest
from train.shared.files import write_json
from train.shared.held_out import held_out
from train.shared.versions import installed_version

Array = NDArray[np.float64]

DEPENDS_ON = (
    *CONTROLLERS,
    "train.benchmark.cells",
    "train.controllers.models",
    "train.controllers.sources",
    "train.shared.held_out",
)
"""Modules that decide the numbers of a cell, besides the controller's own file."""

SERIES = tuple(each.name for each in fields(EpisodeMetrics))


@dataclass(frozen=True, slots=True)
class Setting:
    """The episodes that every controller is put through."""

    name: str
    """Of the scenario."""
    scenario: Scenario
    seeds: int
    arguments: str = "{}"
    """Of the environment besides, as JSON."""


@dataclass(frozen=True, slots=True, eq=False)
class Job:
    """A cell that is to be measured."""

    setting: Setting
    controller: str
    run: str
    """Name of the training run, empty without training."""
    source: Source

    @property
    def path(self) -> Path:
        """Where the cell lies in the folder of a benchmark."""
        return Path("cells", self.setting.name, f"{self.controller}{self.run and '-'}{self.run}.json")

    def digest(self) -> str:
        """Changes with whatever the cell depends on; empty if that cannot be known."""
        own = self.source.fingerprint()
        return own and digest(own.encode(), repr(self.setting).encode(), sources_digest().encode())


@dataclass(frozen=True, slots=True, eq=False)
class Cell:
    """What came of a job: the metrics seed by seed, or the one sentence that says why there are none."""

    scenario: str
    controller: str
    run: str
    title: str = ""
    sentence: str = ""
    """Why it failed; or, beside metrics, what went wrong on the way."""
    uncontrolled: Array | None = None
    """(N,), J s: J without control."""
    metrics: Mapping[str, Array] | None = None
    """(N,) each, as in ``EpisodeMetrics``."""


@dataclass(frozen=True, slots=True, eq=False)
class Opened:
    """The blades of a setting, and what they do without control."""

    envs: Any
    reference: Episodes
    band: Array


@lru_cache(maxsize=1)
def opened(setting: Setting) -> Opened:
    """Made once for all controllers that follow one another in a process."""
    envs: Any = gym.make_vec(beamenv.ENV_ID, num_envs=setting.seeds, scenario=setting.scenario, **json.loads(setting.arguments))
    reference = roll_out(no_control(envs.unwrapped.design_plant), envs, held_out(setting.seeds))
    return Opened(envs, reference, settling_band(reference))


def measured(job: Job) -> Cell:
    """The cell; whatever fails fails in it alone."""
    try:
        return _measured(job)
    except Exception as error:  # noqa: BLE001 - one cell must not stop the table
        return Cell(job.setting.name, job.controller, job.run, sentence=_sentence(error))


def _measured(job: Job) -> Cell:
    blades = opened(job.setting)
    controller = job.source.build(blades.envs.unwrapped.task)
    uncontrolled = np.nansum(blades.reference.cost, axis=0)
    if not uncontrolled.all():
        raise ValueError("J without control is zero in an episode of this scenario: no other can be relative to it.")
    episodes = roll_out(controller, blades.envs, held_out(job.setting.seeds))
    metrics = measure(episodes, blades.band)
    gave_up = getattr(controller, "solver_failures", 0)
    return Cell(
        job.setting.name,
        job.controller,
        job.run,
        title=name_of(controller),
        sentence=f"the solver gave up at {gave_up} instants; the law's substitute was applied there." if gave_up else "",
        uncontrolled=uncontrolled,
        metrics={name: getattr(metrics, name) for name in SERIES},
    )


def _sentence(error: Exception) -> str:
    """Of bad input its own; of anything else also the kind, for it may say little alone."""
    text = " ".join(str(error).split())
    return text if isinstance(error, ValueError) and text else f"{type(error).__name__}: {text}".rstrip(": ")


@lru_cache(maxsize=1)
def sources_digest() -> str:
    """Of the code that decides what a controller does and how it is judged, and of NumPy and SciPy."""
    return digest(source_digest(DEPENDS_ON).encode(), *(installed_version(name).encode() for name in ("numpy", "scipy")))


def write_cell(folder: Path, job: Job, cell: Cell) -> None:
    """To its file, with the digest of what it depends on."""
    series = {"uncontrolled": cell.uncontrolled, **(cell.metrics or {})} if cell.metrics else {}
    lists = {name: [finite(value) for value in values] for name, values in series.items() if values is not None}
    about = {name: getattr(cell, name) for name in ("scenario", "controller", "run", "title", "sentence")}
    write_json(folder / job.path, {"digest": job.digest(), **about, "series": lists})


def read_cell(folder: Path, job: Job) -> Cell | None:
    """The cell of an earlier run, if nothing it depends on has changed since and it did not fail."""
    path, wanted = folder / job.path, job.digest()
    if not wanted or not path.is_file():
        return None
    content = json.loads(path.read_text())
    if content.pop("digest") != wanted or not content["series"]:
        return None
    series = {name: np.array([np.inf if v is None else v for v in values]) for name, values in content.pop("series").items()}
    return Cell(**content, uncontrolled=series.pop("uncontrolled"), metrics=series)
