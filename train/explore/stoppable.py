"""Work that can be stopped: each piece has a thread of its own, which is told to end."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")


class Stopped(Exception):  # noqa: N818 - asked for, and not an error
    """The work was stopped before it was done."""


class _Worker(threading.Thread):
    def __init__(self, work: Callable[[], Any]) -> None:
        super().__init__(daemon=True)
        self.work = work
        self.result: Any = None
        self.error: Exception | None = None

    def run(self) -> None:
        try:
            try:
                self.result = self.work()
            except Exception as error:  # noqa: BLE001 - raised again where the work was asked for
                self.error = error
        except Stopped as late:
            self.error = late

    def stop(self) -> None:
        """Raise ``Stopped`` within it, at its next line of Python."""
        ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(self.ident or 0), ctypes.py_object(Stopped))


_at_work: set[_Worker] = set()


def stoppable(work: Callable[[], T]) -> T:
    """What the work gives; ``Stopped`` where ``stop`` was called before it was done."""
    worker = _Worker(work)
    _at_work.add(worker)
    try:
        worker.start()
        worker.join()
    finally:
        _at_work.discard(worker)
    if worker.error is not None:
        raise worker.error
    result: T = worker.result
    return result


def stop() -> None:
    """End all work that is being done."""
    for worker in tuple(_at_work):
        worker.stop()
