"""Thicknesses of some walls, by their names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic_core import CoreSchema, core_schema

from beamenv.configuration import Number
from beamenv.configuration.kinds import JsonSchema, Kind, plain

METRES = Number(gt=0.0, unit="m")


@dataclass(frozen=True, slots=True)
class ByWall(Kind):
    """A mapping of walls to thicknesses; kept as pairs."""

    @property
    def allowed(self) -> str:
        """Say, {"web": 0.002}."""
        return f"a table of walls, each with a thickness, {METRES.allowed}"

    def core(self) -> CoreSchema:
        """Pairs of a wall and its thickness."""
        pair = core_schema.tuple_schema([core_schema.str_schema(strict=True), METRES.inner()], strict=True)
        pairs = core_schema.tuple_variable_schema(pair, strict=True)
        return core_schema.no_info_after_validator_function(_once, core_schema.no_info_before_validator_function(_pairs, pairs))

    def json(self) -> JsonSchema:
        """An object of numbers, or an array of pairs."""
        pair = {"type": "array", "prefixItems": [{"type": "string"}, METRES.json()], "minItems": 2, "maxItems": 2}
        return {"anyOf": [{"type": "object", "additionalProperties": METRES.json()}, {"type": "array", "items": pair}]}


def _pairs(value: Any) -> Any:
    return plain(tuple(value.items()) if isinstance(value, Mapping) else value)


def _once(pairs: tuple[tuple[str, float], ...]) -> tuple[tuple[str, float], ...]:
    if len(dict(pairs)) < len(pairs):
        raise ValueError
    return pairs


Thicknesses = Annotated[tuple[tuple[str, float], ...], ByWall()]
"""Field of a section: walls that have a thickness of their own."""
