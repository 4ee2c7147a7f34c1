"""What a machine has room for: counts that would fill its memory are refused before anything is built."""

from __future__ import annotations

import os
from pathlib import Path

from beamenv.configuration.sentence import Refused

LIMITS = (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"))
"""Where Linux says how much a container may take."""

UNKNOWN = 2**36
"""Bytes that are taken for the memory of a machine that does not tell: 64 GiB."""


def memory() -> int:
    """Bytes: the machine's, or those that its container may take."""
    try:
        known = [os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")]
    except (AttributeError, OSError, ValueError):
        known = [UNKNOWN]
    return min([*known, *filter(None, map(_limit, LIMITS))])


def _limit(path: Path) -> int | None:
    try:
        return int(path.read_text(encoding="ascii"))
    except (OSError, ValueError):  # no such file, or "max"
        return None


def check_room(name: str, count: int, bytes_each: int, what: str) -> None:
    """``Refused`` for a count of things, of as many bytes each, that do not fit into memory together."""
    most = memory() // max(bytes_each, 1)
    if count > most:
        raise Refused(name, count, f"at most {most} {what}: so many fit into memory")
