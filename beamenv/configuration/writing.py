"""Files that are written whole or not at all."""

from __future__ import annotations

import os
import re
import secrets
import stat
from contextlib import suppress
from pathlib import Path

UNFINISHED = re.compile(r"\..+\.[0-9a-f]{8}\.part")
"""Name of a file while it is written, beside its place."""


def write_whole(path: Path, content: bytes | str) -> None:
    """Write a file beside its place and move it there: no reader meets half of it, and no interruption leaves it.

    A new file has the permissions that the user's umask leaves, one that is replaced keeps its own; a link stays, and what it
    leads to is replaced. What is no file, say ``/dev/stdout``, is written to. Raises OSError.
    """
    data = content.encode() if isinstance(content, str) else content
    place = Path(os.path.realpath(path))
    place.parent.mkdir(parents=True, exist_ok=True)
    mode = place.stat().st_mode if place.exists() else None
    if mode is not None and not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):
        place.write_bytes(data)
        return
    name = place.with_name(f".{place.name[:200]}.{secrets.token_hex(4)}.part")
    handle = os.open(name, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        if mode is not None:
            with suppress(OSError):  # not every file system has permissions
                os.chmod(name, stat.S_IMODE(mode))
        os.replace(name, place)
    except BaseException:
        name.unlink(missing_ok=True)
        raise


def remove_unfinished(folder: Path) -> None:
    """Remove, in a folder and those within, what a process that was killed had begun to write: nobody else may be writing there."""
    for path in folder.rglob(".*.part"):
        if UNFINISHED.fullmatch(path.name):
            path.unlink(missing_ok=True)
