"""Measuring many cells, one after another or in several processes; each is handed over as soon as it is whole."""

from __future__ import annotations

import pickle
import signal
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context

from train.benchmark.cells import Cell, Job, measured
from train.benchmark.entrants.sources import Source
from train.shared.threads import one_thread_each


def run(jobs: Sequence[Job], processes: int, finished: Callable[[Job, Cell], None]) -> None:
    """Measure every job and call ``finished`` for each, in this process or in several, each of them on one thread.

    An interruption loses only the cells that are being measured. Raises ValueError for objects that cannot be sent to another
    process, ChildProcessError if a process dies.
    """
    if processes == 1 or len(jobs) < 2:
        for job in jobs:
            finished(job, measured(job))
        return
    _check_that_they_travel(jobs)
    with one_thread_each(), _pool(min(processes, len(jobs))) as pool:
        futures = {pool.submit(measured, job): job for job in jobs}
        try:
            for future in as_completed(futures):
                finished(futures[future], future.result())
        except BrokenProcessPool:
            raise ChildProcessError("a process died: what was finished is kept, and the same command goes on.") from None
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _pool(processes: int) -> ProcessPoolExecutor:
    """Fresh interpreters, which Ctrl-C ends without a word: what it means is said by the process that started them."""
    return ProcessPoolExecutor(processes, get_context("spawn"), signal.signal, (signal.SIGINT, signal.SIG_DFL))


def _check_that_they_travel(jobs: Sequence[Job]) -> None:
    for job in {job.controller: job for job in jobs}.values():
        if not _travels(job.source):
            raise ValueError(f"controller {job.controller!r} cannot be sent to another process: take jobs=1.")


def _travels(source: Source) -> bool:
    try:
        pickle.dumps(source)
    except Exception:  # noqa: BLE001 - pickle raises whatever the object does
        return False
    return True
