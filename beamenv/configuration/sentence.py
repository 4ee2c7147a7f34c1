"""What is refused, in one sentence: the argument with its path, its value, what is allowed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pydantic_core import ErrorDetails, ValidationError

LONGEST = 160
"""Characters of a value that are shown."""


class Refused(ValueError):
    """A value that its fields' kinds allow, and the rest of the table does not."""

    def __init__(self, name: str, value: Any, allowed: str) -> None:
        super().__init__(f"{name} is {shown(value)}, but must be {allowed}.")
        self.name, self.value, self.allowed = name, value, allowed

    def __reduce__(self) -> tuple[type[Refused], tuple[str, Any, str]]:
        return Refused, (self.name, self.value, self.allowed)  # from worker processes


def shown(value: Any) -> str:
    """A value on one line, cut where it is long."""
    try:
        text = " ".join(repr(value).split())
    except Exception:  # noqa: BLE001 - an object that cannot even be shown is refused all the same
        text = f"an object of type {type(value).__name__}"
    return cut(text)


def cut(text: str) -> str:
    """Text of no more than ``LONGEST`` characters and a sign that there were more."""
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}…"


def clause(error: object) -> str:
    """What an error says as a part of a sentence: on one line, without a full stop at its end."""
    return cut(" ".join(str(error).split()).rstrip("."))


def unknown_field(path: str, name: Any, known: Sequence[str]) -> ValueError:
    """What is said of a key that a table does not have."""
    return ValueError(f"{path} has no field {shown(name)}: its fields are {', '.join(known)}.")


def sentence(error: ValidationError, path: str, known: Sequence[str]) -> ValueError:
    """The first of pydantic's complaints as a ``ValueError`` of one sentence about ``path`` and its fields."""
    first = error.errors(include_url=False)[0]
    name = ".".join(str(part) for part in _named(first["loc"], known))
    where = f"{path}.{name}" if path and name else path or name
    if first["type"] in ("unexpected_keyword_argument", "unexpected_positional_argument"):
        return unknown_field(path, first["loc"][-1], known)
    if first["type"] in ("missing", "missing_argument"):
        return ValueError(f"{where} is missing.")
    if first["type"] == "value_error":
        cause = first["ctx"]["error"]
        if isinstance(cause, Refused):
            return Refused(joined(where, cause.name), cause.value, cause.allowed)
        return ValueError(str(cause))
    return Refused(where, first["input"], _allowed(first))


def joined(path: str, name: str) -> str:
    """A field's path from that of its table; what both have in common, the path's end and the name's beginning, is said once."""
    parts, own = path.split("."), name.split(".")
    common = next((k for k in range(min(len(parts), len(own)), 0, -1) if parts[-k:] == own[:k]), 0)
    return ".".join([*parts, *own[common:]]) if path else name


def _named(location: tuple[int | str, ...], known: Sequence[str]) -> tuple[int | str, ...]:
    """Where the complaint is, fields given by their place in the constructor by name."""
    by_place = location and isinstance(location[0], int) and location[0] < len(known)
    return (known[location[0]], *location[1:]) if by_place else location  # type: ignore[index]


def _allowed(error: ErrorDetails) -> str:
    if error["type"] == "dataclass_exact_type":
        return an(error["ctx"]["class_name"])
    if error["type"] == "is_instance_of":
        return an(error["ctx"]["class"])
    return error["msg"].removeprefix("Input should be ")


def an(name: str) -> str:
    """A name with its article."""
    return f"{'an' if name[0] in 'AEIOU' else 'a'} {name}"
