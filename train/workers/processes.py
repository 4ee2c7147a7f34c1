"""Workers that are processes of this machine, by joblib's pool."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from train.shared.interruption import end_with_parent
from train.shared.threads import ONE_THREAD
from train.workers.pool import Lost


@contextmanager
def processes(count: int) -> Iterator[Processes]:
    """Fresh interpreters that end with this block or with this process, whichever is first."""
    pool = Processes(count)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "A worker stopped", UserWarning)  # one that outgrew its memory, and was replaced
            yield pool
    finally:
        pool.end()


class Processes:
    """A pool of joblib's, on one thread each."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._pool = self._fresh()

    def _fresh(self) -> Any:
        from joblib.externals.loky import ProcessPoolExecutor  # takes a moment, and one process alone does without

        return ProcessPoolExecutor(self._count, initializer=end_with_parent, initargs=(os.getpid(),), env=ONE_THREAD)

    def room(self) -> int:
        """Two a process: with more, an interrupted pool writes a traceback."""
        return 2 * self._count

    def submit(self, work: Callable[[Any], Any], piece: Any, files: Iterable[Path]) -> Future[Any]:
        """Begin a piece; its files are there already."""
        try:
            future: Future[Any] = self._pool.submit(work, piece)
        except BrokenProcessPool as error:
            future = Future()
            future.set_exception(error)
        return future

    def result(self, future: Future[Any]) -> Any:
        """What came of it; ``Lost`` if a process died."""
        try:
            return future.result()
        except BrokenProcessPool:
            raise Lost from None

    def renewed(self) -> bool:
        """True: a pool breaks as a whole."""
        self.end()
        self._pool = self._fresh()
        return True

    def end(self) -> None:
        """End the processes."""
        self._pool.shutdown(wait=True, kill_workers=True)
