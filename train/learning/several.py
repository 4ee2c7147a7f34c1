"""Several trainings, each in a folder of its own: in this process one after another, or stretch by stretch by workers."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from beamenv.configuration import clause
from beamenv.configuration.writing import write_whole
from beamenv.scenarios.scenario import Scenario
from train.controllers.policy_files import read_about
from train.controllers.runs import AGENT, best_run, runs_in
from train.learning.checkpoint import NAME
from train.learning.job import Job, begun, held_in, run
from train.learning.training import Progress
from train.shared.held_models import files_of, held_models, scenario_of_file
from train.shared.interruption import Interrupted, ending_as_interrupted
from train.shared.lock import alone_in
from train.workers.pool import Piece, Result
from train.workers.workers import Workers

STRETCH = 120.0
"""s of training between two checkpoints that come back from a worker, which is what its death may cost."""

Told = Callable[[Path, Progress], None]


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
    """A training from a checkpoint on, or from its beginning, for so many seconds or until it is done."""

    job: Job
    home: Path
    """Of the training, where it is handed out from."""
    checkpoint: bytes | None
    seconds: float


@dataclass(frozen=True, slots=True, eq=False)
class Stretched:
    """What the folder of a training holds after a stretch."""

    files: Mapping[str, bytes]
    finished: bool
    progress: Progress | None


@dataclass(frozen=True, slots=True)
class Trained:
    """What came of trainings, by their folders."""

    places: dict[Path, list[Path]] = field(default_factory=dict)
    """Folders of the policies."""
    failed: dict[Path, str] = field(default_factory=dict)
    """Why there are none, in a clause."""


def train_all(
    jobs: Mapping[Path, Job],
    workers: Workers,
    told: Told,
    resume: bool = False,
    overwrite: bool = False,
    stretch: float = STRETCH,
) -> Trained:
    """Train every job in its folder.

    ``told`` is called with a folder and how far its training is. Workers need none of the files here: what a training leaves comes
    back as it stands after each ``stretch`` seconds, so that their number and their deaths leave no trace in the policies. In this
    process an interruption ends with the training that it meets: what that has learnt is saved, as ``job.run`` does.

    With ``resume`` a training with a checkpoint is resumed, one that is finished is left as it is, and the others begin. Raises
    ValueError, before anything is written, as ``job.run`` does for any of them. What one of several raises later costs that one
    alone; what the only one raises is raised.
    """
    workers, whole = workers.at_most(len(jobs)), {job.told() for job in jobs.values()}
    if len(whole) < len(jobs):
        raise ValueError("two of the trainings are the same: name each once.")
    resumed = [home for home in jobs if resume and (len(jobs) == 1 or (home / NAME).is_file())]
    if workers.alone:
        return _here(jobs, told, resumed, overwrite)
    with ExitStack() as locks, ending_as_interrupted():
        for home in jobs:
            locks.enter_context(alone_in(home))
        waiting = [Stretch(held(job), home, before(job, home, home in resumed, overwrite), stretch) for home, job in jobs.items()]
        waiting = [each for each in waiting if each.checkpoint is None or not is_finished(each.home)]
        failed: dict[Path, str] = {}

        def finished(piece: Stretch, result: Stretched | str) -> Stretch | None:
            if isinstance(result, str):
                failed[piece.home] = result
                return None
            written(piece.home, result.files, begins=piece.checkpoint is None)
            if result.progress is not None:
                told(piece.home, result.progress)
            return None if result.finished else replace(piece, checkpoint=result.files[NAME])

        work = trained_on if len(jobs) == 1 else partial(attempted, trained_on)
        workers.do(work, waiting, finished, lambda piece: files(piece.job))
    return Trained({home: list(runs_in(home).values()) for home in jobs if home not in failed}, failed)


def _here(jobs: Mapping[Path, Job], told: Told, resumed: Collection[Path], overwrite: bool) -> Trained:
    """The trainings in this process, until one is interrupted."""
    begun = {home: before(job, home, home in resumed, overwrite) is not None for home, job in jobs.items()}
    trained = Trained()

    def train(home: Path) -> list[Path]:
        if not begun[home] or not is_finished(home):
            run(jobs[home], home, partial(told, home), home in resumed, overwrite)
        return list(runs_in(home).values())

    for home in jobs:
        made = train(home) if len(jobs) == 1 else attempted(train, home)
        if isinstance(made, str):
            trained.failed[home] = made
            continue
        trained.places[home] = made
        if not is_finished(home):
            break
    return trained


def attempted(work: Callable[[Piece], Result], piece: Piece) -> Result | str:
    """What came of it, or in a clause why nothing did: whatever a training raises, the others go on."""
    try:
        return work(piece)
    except Exception as error:  # noqa: BLE001
        return clause(str(error) if isinstance(error, ValueError) else f"{type(error).__name__}: {error}")


def before(job: Job, home: Path, resume: bool, overwrite: bool) -> bytes | None:
    """The checkpoint from which a training is resumed, None to begin; ``ValueError`` if it is another one's."""
    checkpoint = begun(home, resume, overwrite)
    if checkpoint is None:
        return None
    job.check_resumed(home, checkpoint)
    return (home / NAME).read_bytes()


def is_finished(home: Path) -> bool:
    """Whether all that a training makes is there."""
    return all((place / AGENT).is_file() and read_about(place).get("finished", True) for place in runs_in(home).values())


def held(job: Job) -> Job:
    """The same training where none of the files here may be: with what they say, and the best run of its teacher."""
    teacher = None if job.teacher is None else best_run(job.teacher)
    return replace(job, content=scenario_of_file(job.scenario), teacher=teacher, environment=held_models(job.environment))


def files(job: Job) -> list[Path]:
    """Files that go with a held job."""
    of_teacher = () if job.teacher is None else tuple(job.teacher / name for name in (AGENT, "weights.npz"))
    return [*of_teacher, *(files_of(job.content) if isinstance(job.content, Scenario) else ())]


def trained_on(stretch: Stretch) -> Stretched:
    """What a worker does: the same as ``job.run``, in a folder for the moment."""
    end, last = time.monotonic() + stretch.seconds, list[Progress]()

    def note(progress: Progress) -> None:
        last[:] = [progress]
        if time.monotonic() >= end:
            raise KeyboardInterrupt

    with TemporaryDirectory(prefix="beamenv-", ignore_cleanup_errors=True) as place:
        folder = Path(place)
        if stretch.checkpoint is not None:
            (folder / NAME).write_bytes(stretch.checkpoint)
        try:
            run(stretch.job, folder, note, resume=stretch.checkpoint is not None, keeps_unfinished=False)
            finished = True
        except Interrupted:
            finished = False
        made = {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    own = {name: content for name, content in made.items() if not Path(name).name.startswith(".")}
    return Stretched(own, finished, last[0] if last else None)


def written(home: Path, made: Mapping[str, bytes], begins: bool) -> None:
    """Write what a stretch made; where a training begins in the place of what the folder held. The policies come last."""
    for name in held_in(home) if begins else (each for each in made if each.endswith(AGENT)):
        (home / name).unlink(missing_ok=True)
    for name in sorted(made, key=lambda name: (name.endswith(AGENT), name)):
        (home / name).parent.mkdir(parents=True, exist_ok=True)
        write_whole(home / name, made[name])
