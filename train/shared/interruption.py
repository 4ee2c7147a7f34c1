"""Interruptions: Ctrl-C, and the signals by which systems ask a process to end; and processes that end with their parent."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from types import FrameType, TracebackType
from typing import Any

ENDING = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
"""What asks a process to end besides Ctrl-C: a scheduler, a shutdown, a terminal that is closed."""


WHEN_ASKED: ContextVar[Callable[[], object]] = ContextVar("WHEN_ASKED", default=lambda: None)
"""Called when an interruption comes that waits for the end of a piece of work, in the handler of its signal."""


class Interrupted(KeyboardInterrupt):
    """A signal has asked to end, and what was under way has been left in order."""

    def __init__(self, number: int = signal.SIGINT) -> None:
        super().__init__(number)
        self.status = 128 + number
        """What a shell expects as exit status."""


def status_of(interruption: KeyboardInterrupt) -> int:
    """Exit status after an interruption: 130 after Ctrl-C, 143 after SIGTERM."""
    return interruption.status if isinstance(interruption, Interrupted) else 128 + signal.SIGINT


@contextmanager
def ending_as_interrupted() -> Iterator[None]:
    """Within it the signals that ask to end raise ``Interrupted`` where Ctrl-C raises ``KeyboardInterrupt``: nothing ends half-way.

    Signals that somebody has set otherwise, say ``nohup``, stay as they are; in other threads than the main one it does nothing.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handled = [number for number in ENDING if signal.getsignal(number) is signal.SIG_DFL]
    for number in handled:
        signal.signal(number, _raise)
    try:
        yield
    finally:
        for number in handled:
            signal.signal(number, signal.SIG_DFL)


def _raise(number: int, frame: FrameType | None) -> None:
    raise Interrupted(number)


class Deferred:
    """Interruptions that wait for the end of a piece of work: a checkpoint must not hold half an update. A second does not wait."""

    def __init__(self) -> None:
        self.asked = 0
        """Number of the signal that asked to end, 0 before."""
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Deferred:
        if threading.current_thread() is threading.main_thread():
            handled = [number for number in ENDING if signal.getsignal(number) is not signal.SIG_IGN]
            self._before = {number: signal.signal(number, self._ask) for number in (signal.SIGINT, *handled)}
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            raise Interrupted(number)
        self.asked = number
        WHEN_ASKED.get()()


def end_with_parent(parent: int) -> None:
    """Leave interruptions to the parent process, and end when it does, however it does."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(0.5)
        os._exit(1)

    if os.name == "posix":  # elsewhere the identity of a parent outlives it
        threading.Thread(target=watch, daemon=True).start()
