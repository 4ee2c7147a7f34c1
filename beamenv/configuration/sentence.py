"""What is refused, in one sentence: the argument with its path, its value, what is allowed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from pydantic_core import ErrorDetails, ValidationError

from beamenv.configuration.near import meant

CLASS_EXPECTED = {"dataclass_exact_type": "class_name", "is_instance_of": "class"}
"""Complaints that something is no instance of a class, and where they have its name."""

NAMES = "names"
"""Where a complaint has the names of which one is allowed."""

METRES = "metres"
"""Where a complaint has the largest length that is allowed."""

LONGEST = 160
"""Characters of a value that are shown."""


class Refused(ValueError):
    """A value that its fields' kinds allow, and the rest of the table does not."""

    def __init__(self, name: str, value: Any, allowed: str, meant: str = "") -> None:
        super().__init__(f"{name} is {shown(value)}{meant}, but must be {allowed}.")
        self.name, self.value, self.allowed, self.meant = name, value, allowed, meant

    def __reduce__(self) -> tuple[type[Refused], tuple[str, Any, str, str]]:
        return Refused, (self.name, self.value, self.allowed, self.meant)  # from worker processes


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


def unknown_name(path: str, name: Any, known: Iterable[str], others: str = "") -> Refused:
    """What is said of a name that is none of those known, nor ``others``: which it may have been meant for, and all of them."""
    names = list(known)
    return Refused(path, name, f"one of {', '.join(names)}{others}", meant(name, names))


def unknown_field(path: str, name: Any, known: Sequence[str]) -> ValueError:
    """What is said of a key that a table does not have."""
    return ValueError(f"{path} has no field {shown(name)}{meant(name, known)}: its fields are {', '.join(known)}.")


def sentence(error: ValidationError, path: str, known: Sequence[str]) -> ValueError:
    """The first of pydantic's complaints as a ``ValueError`` of one sentence about ``path`` and its fields."""
    first, *others = error.errors(include_url=False)
    if _is_member(first):
        return _none_of_several(first, others, path, known)
    name = ".".join(str(part) for part in _named(first["loc"], known))
    where = f"{path}.{name}" if path and name else path or name
    if first["type"] in ("unexpected_keyword_argument", "unexpected_positional_argument"):
        return unknown_field(path, first["loc"][-1], known)
    if first["type"] in ("missing", "missing_argument"):
        return ValueError(f"{where} is missing.")
    if first["type"] == "value_error":
        cause = first["ctx"]["error"]
        if isinstance(cause, Refused):
            return Refused(joined(where, cause.name), cause.value, cause.allowed, cause.meant)
        return ValueError(str(cause))
    value, context = first["input"], first.get("ctx", {})
    hint = meant(value, context.get(NAMES, ())) or in_millimetres(value, context.get(METRES))
    return Refused(where, value, _allowed(first), hint)


def in_millimetres(value: Any, most: float | None) -> str:
    """What is put behind a length of more metres than it can have: whether they are millimetres."""
    lies = most is not None and isinstance(value, (int, float)) and 1e-3 * value <= most < value
    return " (did you give millimetres?)" if lies else ""


def _is_member(error: ErrorDetails) -> bool:
    """Whether it is the complaint of one of several classes that may stand there."""
    return error["type"] in CLASS_EXPECTED and len(error["loc"]) > 1 and error["loc"][-1] == _class_of(error)


def _none_of_several(first: ErrorDetails, others: Sequence[ErrorDetails], path: str, known: Sequence[str]) -> Refused:
    """What is said of what is none of the classes that may stand there."""
    where = first["loc"][:-1]
    classes = [_class_of(each) for each in (first, *others) if _is_member(each) and each["loc"][:-1] == where]
    name = ".".join([path, *(str(part) for part in _named(where, known))] if path else map(str, where))
    return Refused(name, first["input"], " or ".join(map(an, classes)))


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
    if error["type"] in CLASS_EXPECTED:
        return an(_class_of(error))
    return error["msg"].removeprefix("Input should be ")


def _class_of(error: ErrorDetails) -> str:
    return str(error["ctx"][CLASS_EXPECTED[error["type"]]])


def an(name: str) -> str:
    """A name with its article."""
    return f"{'an' if name[0] in 'AEIOU' else 'a'} {name}"
