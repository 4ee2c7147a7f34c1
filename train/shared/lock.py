"""One process in a folder at a time: two that write there would mix what they write."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from beamenv.configuration.writing import remove_unfinished
from train.shared.files import check_folder

NAME = ".in-use"

PAUSE = 0.02
"""Seconds between two tries."""


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Hold a folder, which is made if it is not there, until the block or this process ends, however it ends.

    The system's own lock lies on a file in the folder: it goes with its process, so that none is ever left behind. What an earlier
    process that was killed had begun to write is removed; so are folders made here in which nothing was written.
    Raises ``ValueError`` of one sentence if another process holds the folder, or nothing can be written there.
    """
    check_folder(folder)
    made = [each for each in (folder, *folder.parents) if not each.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    try:
        with held(folder):
            remove_unfinished(folder)
            yield
    finally:
        with suppress(OSError):  # one that is not empty stays
            for each in made:
                each.rmdir()


@contextmanager
def held(folder: Path, patience: float = 0.0) -> Iterator[None]:
    """The lock alone, of a folder that is there, say to change one file in it that others may want to change too.

    Another process that holds it is waited for as many seconds as ``patience`` says, and then a ``ValueError`` of one sentence.
    """
    end = time.monotonic() + patience
    while (handle := _locked(folder, final=time.monotonic() >= end)) is None:
        time.sleep(PAUSE)
    try:
        yield
    finally:
        _let_go(handle, folder / NAME)


def _locked(folder: Path, final: bool) -> int | None:
    """The open file of the lock, which its last holder may have removed between being opened and being locked.

    If another process has it None, or ValueError where there is to be no further try.
    """
    path = folder / NAME
    while True:
        handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            _lock(handle)
            if path.exists() and os.path.samestat(os.fstat(handle), path.stat()):
                os.ftruncate(handle, 0)
                os.write(handle, f"{os.getpid()}\n".encode())
                return handle
        except BlockingIOError:
            holder = _holder(handle)
            os.close(handle)
            if not final:
                return None
            raise ValueError(
                f"folder = {str(folder)!r} is in use by {holder}: wait until that has ended, or name another folder."
            ) from None
        except FileNotFoundError:
            pass
        os.close(handle)


def _holder(handle: int) -> str:
    with suppress(OSError):  # Windows lets nobody else read it
        if number := os.read(handle, 32).decode(errors="replace").strip():
            return f"process {number}"
    return "another process"


def _let_go(handle: int, path: Path) -> None:
    with suppress(OSError):
        path.unlink()  # while it is locked: whoever opened it already finds that it is gone
    os.close(handle)


if sys.platform == "win32":

    def _lock(handle: int) -> None:
        import msvcrt

        try:
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        except OSError:
            raise BlockingIOError from None

else:

    def _lock(handle: int) -> None:
        """Raises BlockingIOError if another process has it."""
        import fcntl

        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
