"""One cell of the table: a controller, or one training run of it, on all seeds of one scenario."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import lru_cache
from itertools import groupby, islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines import Controller, EpisodeMetrics, Episodes, roll_out
from baselines.design.controller import name_of
from baselines.evaluation.metrics import finite, measure
from beamenv.configuration import Refused, Text, checked, checked_table
from beamenv.configuration.files import of_file
from train.benchmark.bench import Bench, Blades, Setting
from train.benchmark.together import roll_out_together
from train.controllers.sources import Classical, Source, Trained
from train.controllers.tiers import LEARNT
from train.shared.digests import CONTROLLERS, digest, source_digest
from train.shared.files import read_json, write_json
from train.shared.versions import installed_version

Array = NDArray[np.float64]

DEPENDS_ON = (
    *CONTROLLERS,
    "train.benchmark.bench",
    "train.benchmark.cells",
    "train.benchmark.together",
    "train.controllers.models",
    "train.controllers.sources",
    "train.shared.held_out",
)
"""Modules that decide the numbers of a cell, besides the controller's own file."""

MOST, BLADES = 5, 1280
"""Cells that are measured together, an agent's runs or as many laws, and blades: more would not be faster, but take memory."""

TOGETHER = (Classical, Trained)
"""Sources of controllers that decide by what they are shown and remember alone."""

SERIES = tuple(each.name for each in fields(EpisodeMetrics))

ABOUT = ("scenario", "controller", "run", "title", "sentence")
"""Fields of a cell that are text."""

BESIDE = ("uncontrolled", "fails")
"""Fields of a cell with a number for each seed, besides its metrics."""


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
    """(N,), J s: J₀, J without control; a blade that fails is charged to its episode's end as in its last interval."""
    fails: Array | None = None
    """(N,): 1 where the blade fails without control."""
    metrics: Mapping[str, Array] | None = None
    """(N,) each, as in ``EpisodeMetrics``."""


def measured(jobs: Sequence[Job], bench: Bench) -> list[Cell]:
    """The cells of jobs that go ``together``, in one batch; where that fails each alone, and whatever fails fails in its own."""
    if isinstance(jobs[0].source, TOGETHER) and not _is_reference(jobs[0]) and _fits(jobs[0]):
        try:
            return _measured_together(jobs, bench)
        except Exception:  # noqa: BLE001, S110 - it will come again, in the cell whose it is
            pass
    return [_measured_alone(job, bench) for job in jobs]


def together(jobs: Iterable[Job]) -> Iterator[list[Job]]:
    """Jobs next to each other that one batch can measure: of one setting, of sources whose controllers are known to observe alike.

    What a caller brings along goes alone: it may count its calls.
    """
    for _, alike in groupby(jobs, key=_goes_with):
        waiting = iter(alike)
        while first := next(waiting, None):
            yield [first, *islice(waiting, min(MOST, BLADES // (2 * first.setting.seeds)) - 1)] if _fits(first) else [first]


def _goes_with(job: Job) -> tuple[object, ...]:
    if isinstance(job.source, Trained):
        return job.setting.name, LEARNT
    if isinstance(job.source, Classical) and job.source.controller.tier <= LEARNT and not _is_reference(job):
        return job.setting.name, job.source.controller.tier
    return job.setting.name, job.controller, job.run


def _fits(job: Job) -> bool:
    return 2 * job.setting.seeds <= BLADES


def _is_reference(job: Job) -> bool:
    """Whether it is no control, which is measured before all others."""
    return isinstance(job.source, Classical) and job.controller == "none"


def _measured_together(jobs: Sequence[Job], bench: Bench) -> list[Cell]:
    setting = jobs[0].setting
    blades, envs = bench.blades(setting), bench.envs(setting, 2 * len(jobs))
    _check_moved(blades)
    controllers = [job.source.build(blades.task) for job in jobs]
    all_of_them = roll_out_together(controllers, envs, setting.episodes)
    return [_cell(*each, blades) for each in zip(jobs, controllers, all_of_them, strict=True)]


def _measured_alone(job: Job, bench: Bench) -> Cell:
    try:
        blades = bench.blades(job.setting)
        controller = job.source.build(blades.task)
        _check_moved(blades)
        if _is_reference(job):
            return _cell(job, controller, blades.reference, blades)
        return _cell(job, controller, roll_out(controller, blades.envs, job.setting.episodes), blades)
    except Exception as error:  # noqa: BLE001 - one cell must not stop the table
        return Cell(job.setting.name, job.controller, job.run, sentence=_sentence(error))


def _check_moved(blades: Blades) -> None:
    if not blades.uncontrolled.all():
        raise ValueError("J without control is zero in an episode of this scenario: no other can be relative to it.")
    if not np.isfinite(blades.uncontrolled).all():
        raise ValueError("J without control is infinite in an episode of this scenario: no other can be relative to it.")


def _cell(job: Job, controller: Controller, episodes: Episodes, blades: Blades) -> Cell:
    metrics = measure(episodes, blades.band)
    gave_up = getattr(controller, "solver_failures", 0)
    return Cell(
        job.setting.name,
        job.controller,
        job.run,
        title=name_of(controller),
        sentence=f"the solver gave up at {gave_up} instants; the law's substitute was applied there." if gave_up else "",
        uncontrolled=blades.uncontrolled,
        fails=blades.reference.failed.astype(float),
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
    series = {**{name: getattr(cell, name) for name in BESIDE}, **(cell.metrics or {})} if cell.metrics else {}
    lists = {name: [finite(value) for value in values] for name, values in series.items()}
    write_json(folder / job.path, {"digest": job.digest(), **{name: getattr(cell, name) for name in ABOUT}, "series": lists})


def read_cell(folder: Path, job: Job) -> Cell | None:
    """The cell of an earlier run, if nothing it depends on has changed since and it did not fail.

    Raises ValueError that names the file if it is no cell, or a damaged one.
    """
    path, wanted = folder / job.path, job.digest()
    if not wanted or not path.exists():
        return None
    content = read_json(path)
    with of_file(path):
        about = checked_table("cell", content, ("digest", *ABOUT, "series"))
        texts = {name: checked(f"cell.{name}", about.get(name), Text()) for name in ("digest", *ABOUT)}
        if texts.pop("digest") != wanted:
            return None  # whatever series a cell had when it was written
        series = checked_table("cell.series", about.get("series"), (*BESIDE, *SERIES))
        if not series:
            return None
        found = {name: _numbers(f"cell.series.{name}", series.get(name), job.setting.seeds) for name in (*BESIDE, *SERIES)}
    return Cell(**texts, uncontrolled=found.pop("uncontrolled"), fails=found.pop("fails"), metrics=found)


def _numbers(name: str, values: Any, count: int) -> Array:
    """(N,) of a list, infinite where it has None."""
    listed = [np.inf if each is None else each for each in values] if isinstance(values, list) else []
    if len(listed) != count or not all(isinstance(each, float | int) and not isinstance(each, bool) for each in listed):
        raise Refused(name, values, f"a list of {count} numbers, null for what is infinite")
    return np.array(listed, dtype=np.float64)
