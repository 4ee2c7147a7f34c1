"""What a worker on another machine does with a parcel, and whether it would come to the same there."""

from __future__ import annotations

import pickle
import platform
import socket
from functools import lru_cache
from typing import Any

from train.shared.digests import source_digest
from train.shared.versions import versions
from train.workers.parcel import packed, unpacked

WINGS = ("beamenv", "baselines", "train")
SHOWS = ("plotly",)
"""What only draws."""


class Unlike(ValueError):
    """A machine of the cluster has something else installed."""


@lru_cache(maxsize=1)
def terms() -> dict[str, str]:
    """What two machines must share for one to do another's work to the last bit; processors of one kind come on top."""
    python = ".".join(platform.python_version_tuple()[:2])
    own = {name: version for name, version in versions().items() if name not in SHOWS}
    return {**own, "Python": python, "beamenv": f"{own['beamenv']} of sources {source_digest(WINGS)}"}


def carried_out(wanted: dict[str, str], parcel: bytes) -> bytes:
    """(whether it went well, the result or the exception) as bytes, of a parcel of (work, piece)."""
    try:
        check_terms(wanted)
        work, piece = unpacked(parcel)
        return packed((True, work(piece)))
    except Exception as error:  # noqa: BLE001 - it is raised where the piece came from
        return _told(error)


def _told(error: Exception) -> bytes:
    try:
        told = packed((False, error))
        pickle.loads(pickle.loads(told)[0])
    except Exception:  # noqa: BLE001 - not every exception can be sent
        return packed((False, RuntimeError(f"{type(error).__name__}: {error}")))
    return told


def check_terms(wanted: dict[str, str]) -> None:
    """``Unlike`` says in one sentence in what this machine differs."""
    own = terms()
    for name in {**wanted, **own}:
        if own.get(name) != wanted.get(name):
            raise Unlike(unlike(name, own.get(name), wanted.get(name)))


def unlike(name: str, there: str | None, here: str | None) -> str:
    """The sentence, said on the other machine."""
    return (
        f"cluster has a machine, {socket.gethostname()!r}, with {name} {there or 'not installed'} where the one that hands out "
        f"work has {here or 'it not installed'}: install the same on all of them."
    )


def opened(result: bytes) -> Any:
    """What ``carried_out`` gives, raised if it is an exception."""
    well, found = unpacked(result)
    if not well:
        raise found
    return found
