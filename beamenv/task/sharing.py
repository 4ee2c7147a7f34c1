"""Blades and tasks that somebody has: an equal one shares what it has built, for none of it can be changed."""

from __future__ import annotations

from typing import Any, TypeVar
from weakref import ReferenceType, WeakKeyDictionary, ref

_Made = TypeVar("_Made")
_ALIVE: WeakKeyDictionary[Any, ReferenceType[Any]] = WeakKeyDictionary()
"""Neither end is held: what nobody has any longer is gone, with all that it has built."""


def shared(made: _Made) -> _Made:
    """An equal blade or task that somebody has, or else the one given, which later ones then share."""
    known = _ALIVE.get(made)
    alive: _Made | None = None if known is None else known()
    if alive is None:
        _ALIVE[made] = ref(made)
        return made
    return alive
