"""Fields that do something only beside certain values of another: given elsewhere they are refused, not passed over in silence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

from beamenv.configuration.sentence import Refused

Heeded = Sequence[tuple[str, str, tuple[Any, ...]]]
"""A field, another one, and that one's values beside which the first counts."""


def check_heeded(table: Any, heeded: Heeded) -> None:
    """``ValueError`` for the first field of a dataclass that differs from its default where nothing is made of it."""
    defaults = {each.name: each.default for each in fields(table)}
    for name, other, values in heeded:
        if getattr(table, name) != defaults[name] and getattr(table, other) not in values:
            raise Refused(name, getattr(table, name), f"left out where {other} is {getattr(table, other)!r}")
