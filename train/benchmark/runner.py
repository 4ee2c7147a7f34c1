"""Measuring many cells, one after another or by several workers; each is handed over as soon as it is whole."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from functools import partial
from pathlib import Path

from train.benchmark.bench import Bench
from train.benchmark.cells import Cell, Job, measured, together
from train.controllers.sources import Source
from train.shared.held_models import files_of
from train.workers.workers import Workers


def run(jobs: Sequence[Job], workers: Workers, finished: Callable[[Job, Cell], None]) -> None:
    """Measure every job and call ``finished`` for each, in this process or by workers, each of them on one thread.

    Neighbours are measured together where they can be. An interruption loses only the cells that are being measured. Raises
    ValueError for objects that cannot be sent to another process, ChildProcessError if processes die again and again.
    """

    def hand_over(group: Sequence[Job], cells: Sequence[Cell]) -> None:
        for job, cell in zip(group, cells, strict=True):
            finished(job, cell)

    workers = workers.at_most(len(jobs))
    if not workers.alone:
        check_portable(jobs)
    with closing(Bench()) as bench:
        work = partial(measured, bench=bench) if workers.alone else _measured_here
        workers.do(work, together(jobs), hand_over, _files)


BENCH = Bench()
"""Of this process if it is a worker, which is sent one job after another and has nobody else to keep the blades in between."""


def _measured_here(jobs: Sequence[Job]) -> list[Cell]:
    return measured(jobs, BENCH)


def _files(jobs: Sequence[Job]) -> list[Path]:
    """What the jobs read."""
    return [*files_of(jobs[0].setting.played), *(path for job in jobs for path in job.source.files())]


def check_portable(jobs: Sequence[Job]) -> None:
    """``ValueError`` names a controller that cannot be sent to another process, say one that holds an open file."""
    for job in {job.controller: job for job in jobs}.values():
        if not is_portable(job.source):
            raise ValueError(f"controller {job.controller!r} cannot be sent to another process: take jobs=1, and no cluster.")


def is_portable(source: Source) -> bool:
    """Whether another process can have it too."""
    import cloudpickle  # comes with the extra for training, which one process does without

    try:
        cloudpickle.dumps(source)
    except Exception:  # noqa: BLE001 - pickling raises whatever the object does
        return False
    return True
