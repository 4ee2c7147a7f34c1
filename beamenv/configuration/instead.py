"""Fields of which one takes the place of another: to say both would leave one of them without effect."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, dataclass, fields
from numbers import Real
from typing import Any

from beamenv.configuration.sentence import Refused


@dataclass(frozen=True, slots=True)
class InsteadOf:
    """Annotation of a field that, unless it is None, stands for another one, which then is ``neutral``."""

    field: str
    neutral: float | None


def settled(cls: Any, given: Mapping[str, Any], path: str, usual: bool = False) -> dict[str, Any]:
    """What is given, with the neutral value of fields in whose place another one is given, and None for that one where it is they
    that are given; ``ValueError`` where both are. With ``usual`` a field may have its default beside the other.
    """
    values = dict(given)
    for name, rule in _rules(cls):
        stands = given.get(name) is not None
        if stands and rule.field in given and not _alike(given[rule.field], _allowed(cls, rule, usual)):
            raise Refused(f"{path}.{rule.field}", given[rule.field], f"left out, or {_said(rule.neutral)}, beside {name}")
        if stands:
            values[rule.field] = rule.neutral
        elif rule.field in given:
            values.setdefault(name, None)
    return values


def _rules(cls: Any) -> Iterator[tuple[str, InsteadOf]]:
    for name, field in cls.__pydantic_fields__.items():
        yield from ((name, each) for each in field.metadata if isinstance(each, InsteadOf))


def _said(neutral: float | None) -> str:
    return "None" if neutral is None else f"{neutral:g}"


def _allowed(cls: Any, rule: InsteadOf, usual: bool) -> tuple[float | None, ...]:
    default = next(each.default for each in fields(cls) if each.name == rule.field)
    return (rule.neutral, default) if usual and default is not MISSING else (rule.neutral,)


def _alike(value: Any, allowed: tuple[float | None, ...]) -> bool:
    return (value is None or isinstance(value, Real)) and value in allowed
