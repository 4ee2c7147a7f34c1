"""Handing out pieces: the one definition of it, whoever the workers are."""

from __future__ import annotations

import logging
from collections import Counter, deque
from collections.abc import Callable, Collection, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, wait
from pathlib import Path
from typing import Any, Protocol, TypeVar

Piece = TypeVar("Piece")
Result = TypeVar("Result")

TRIES = 3
"""How many workers may die at a piece before it is given up: whatever kills one may kill them all."""

DIED = "a worker process died: what was finished is kept, and the same command resumes."


AGAIN = "beamenv: a worker process died: what it was at is done again."
"""What is logged then; of a program that sets up no logging it is a line on standard error."""


class Lost(Exception):  # noqa: N818 - no error yet: the piece is handed out again
    """The worker died before its piece was done."""


class Pool(Protocol):
    """Workers on one thread each, that are sent a function and a piece."""

    def room(self) -> int:
        """How many pieces it may have at a time."""
        ...

    def submit(self, work: Callable[[Any], Any], piece: Any, files: Iterable[Path]) -> Future[Any]:
        """Begin a piece; the files it names go with it where workers are on other machines."""
        ...

    def result(self, future: Future[Any]) -> Any:
        """What came of it, raised if that is an exception; ``Lost`` if its worker died."""
        ...

    def renewed(self) -> bool:
        """After a loss: whether the death of one worker has ended all of them, and others now stand in their place."""
        ...


def no_files(piece: Any) -> Iterable[Path]:
    """Of pieces that name none."""
    return ()


def hand_out(
    pool: Pool,
    work: Callable[[Piece], Result],
    pieces: Iterable[Piece],
    finished: Callable[[Piece, Result], Piece | None],
    files: Callable[[Piece], Iterable[Path]] = no_files,
) -> None:
    """Have ``work`` done on each piece, and call ``finished`` here as each is; a piece that this returns comes next.

    What a piece comes to must depend on the piece alone: then it is the same whichever worker does it, and when. A piece whose
    worker dies is handed out again. Raises what ``work`` raises, and ``ChildProcessError`` for the piece at which ``TRIES`` died.
    """
    queue, running = _Queue(pieces), dict[Future[Any], Piece]()
    while True:
        while len(running) < pool.room() and (waiting := queue.next()):
            running[pool.submit(work, waiting[0], files(waiting[0]))] = waiting[0]
        if not running:
            return
        future = next(iter(wait(running, return_when=FIRST_COMPLETED).done))
        piece = running.pop(future)
        try:
            result = pool.result(future)
        except Lost:
            lost = [piece, *running.values()] if pool.renewed() else [piece]
            running = {} if len(lost) > 1 else running
            queue.again(lost)
        else:
            queue.first(() if (further := finished(piece, result)) is None else (further,))


class _Queue:
    """Pieces that wait; those that were lost, or follow from another, come before the others."""

    def __init__(self, pieces: Iterable[Any]) -> None:
        self._rest: Iterator[Any] = iter(pieces)
        self._before: deque[Any] = deque()
        self._lost: Counter[int] = Counter()

    def next(self) -> tuple[Any, ...]:
        """The next piece alone, or nothing."""
        return (self._before.popleft(),) if self._before else tuple(_first(self._rest))

    def first(self, pieces: Iterable[Any]) -> None:
        """Put pieces before all others."""
        self._before.extendleft(pieces)

    def again(self, pieces: Collection[Any]) -> None:
        """… and count the losses."""
        self._lost.update(map(id, pieces))
        if any(self._lost[id(piece)] == TRIES for piece in pieces):
            raise ChildProcessError(DIED)
        logging.getLogger(__name__).warning(AGAIN)
        self.first(pieces)


def _first(rest: Iterator[Any]) -> Iterator[Any]:
    for piece in rest:
        yield piece
        return
