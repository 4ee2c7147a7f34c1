"""Objects that users hand in."""

from __future__ import annotations

from typing import Any, TypeVar

from beamenv.configuration import Refused

T = TypeVar("T")


def instance(name: str, value: Any, kind: type[T], allowed: str) -> T:
    """The object; ``ValueError`` of one sentence for what is not of its kind."""
    if isinstance(value, kind):
        return value
    raise Refused(name, value, allowed)


def optional_instance(name: str, value: Any, kind: type[T], allowed: str) -> T | None:
    """The object or None; ``ValueError`` of one sentence for anything else."""
    return None if value is None else instance(name, value, kind, f"None or {allowed}")
