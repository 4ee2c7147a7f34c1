"""Measuring many cells, one after another or in several processes; each is handed over as soon as it is whole."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing, contextmanager
from itertools import islice
from typing import Any

from train.benchmark.bench import Bench
from train.benchmark.cells import Cell, Job, measured, together
from train.controllers.sources import Source
from train.shared.interruption import end_with_parent
from train.shared.threads import ONE_THREAD


def run(jobs: Sequence[Job], processes: int, finished: Callable[[Job, Cell], None]) -> None:
    """Measure every job and call ``finished`` for each, in this process or in several, each of them on one thread.

    Neighbours are measured together where they can be. An interruption loses only the cells that are being measured. Raises
    ValueError for objects that cannot be sent to another process, ChildProcessError if a process dies.
    """
    if processes == 1 or len(jobs) < 2:
        with closing(Bench()) as bench:
            for group in together(jobs):
                _hand_over(group, measured(group, bench), finished)
        return
    check_portable(jobs)
    waiting = together(jobs)
    with workers(min(processes, len(jobs))) as pool:
        running: dict[Future[list[Cell]], list[Job]] = {}
        while True:
            for group in islice(waiting, 2 * processes - len(running)):  # with more, an interrupted pool writes a traceback
                running[pool.submit(_measured_here, group)] = group
            if not running:
                return
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                _hand_over(running.pop(future), future.result(), finished)


def _hand_over(jobs: Sequence[Job], cells: Sequence[Cell], finished: Callable[[Job, Cell], None]) -> None:
    for job, cell in zip(jobs, cells, strict=True):
        finished(job, cell)


BENCH = Bench()
"""Of this process if it is a worker, which is sent one job after another and has nobody else to keep the blades in between."""


def _measured_here(jobs: Sequence[Job]) -> list[Cell]:
    return measured(jobs, BENCH)


@contextmanager
def workers(processes: int) -> Iterator[Any]:
    """Fresh interpreters of joblib's, on one thread each, that end with this block or with this process, whichever is first."""
    from joblib.externals.loky import ProcessPoolExecutor  # takes a moment, and one process alone does without

    pool = ProcessPoolExecutor(processes, initializer=end_with_parent, initargs=(os.getpid(),), env=ONE_THREAD)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "A worker stopped", UserWarning)  # one that outgrew its memory, and was replaced
            yield pool
    except BrokenProcessPool:
        raise ChildProcessError("a worker process died: what was finished is kept, and the same command resumes.") from None
    finally:
        pool.shutdown(wait=True, kill_workers=True)


def check_portable(jobs: Sequence[Job]) -> None:
    """``ValueError`` names a controller that cannot be sent to another process, say one that holds an open file."""
    for job in {job.controller: job for job in jobs}.values():
        if not is_portable(job.source):
            raise ValueError(f"controller {job.controller!r} cannot be sent to another process: take jobs=1.")


def is_portable(source: Source) -> bool:
    """Whether another process can have it too."""
    import cloudpickle  # comes with the extra for training, which one process does without

    try:
        cloudpickle.dumps(source)
    except Exception:  # noqa: BLE001 - pickling raises whatever the object does
        return False
    return True
