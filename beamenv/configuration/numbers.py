"""What an argument that is a number may be, or several of them: annotations as in ``kinds``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic_core import CoreSchema, core_schema

from beamenv.configuration.kinds import JsonSchema, Kind, plain, whole, wholes

UNBOUNDED = 10**9
"""A count beyond this is a mistake."""

TURNED = 3.6e4
"""Degrees, either way: a hundred turns; beyond, an angle is a mistake, and at last has no digits of a turn left."""


@dataclass(frozen=True, slots=True)
class Number(Kind):
    """A finite number within bounds."""

    gt: float | None = None
    ge: float | None = None
    lt: float | None = None
    le: float | None = None
    unit: str = ""

    @property
    def allowed(self) -> str:
        """Say, a positive number (m)."""
        return _with_unit(_bounded("number", self.gt, self.ge, self.lt, self.le), self.unit)

    def core(self) -> CoreSchema:
        """A float."""
        return core_schema.no_info_before_validator_function(plain, self.inner())

    def inner(self) -> CoreSchema:
        """Of a number of Python's."""
        inner = core_schema.float_schema(gt=self.gt, ge=self.ge, lt=self.lt, le=self.le, allow_inf_nan=False, strict=True)
        return core_schema.no_info_before_validator_function(_python_number, inner)

    def json(self) -> JsonSchema:
        """A number."""
        bounds = {"exclusiveMinimum": self.gt, "minimum": self.ge, "exclusiveMaximum": self.lt, "maximum": self.le}
        return {"type": "number", **{name: bound for name, bound in bounds.items() if bound is not None}}


DEGREES = Number(ge=-TURNED, le=TURNED, unit="degrees")


@dataclass(frozen=True, slots=True)
class Count(Kind):
    """A whole number within bounds."""

    ge: int = 1
    le: int = UNBOUNDED

    @property
    def allowed(self) -> str:
        """Say, a whole number from 1 to 30."""
        return f"a whole number{_span(self.ge, self.le)}" + (f" and not above {UNBOUNDED}" if self.le == UNBOUNDED else "")

    def core(self) -> CoreSchema:
        """An integer."""
        return core_schema.no_info_before_validator_function(whole, self.inner())

    def inner(self) -> CoreSchema:
        """Of an integer of Python's."""
        return core_schema.int_schema(ge=self.ge, le=self.le, strict=True)

    def json(self) -> JsonSchema:
        """An integer."""
        return {"type": "integer", "minimum": self.ge, "maximum": self.le}


@dataclass(frozen=True, slots=True)
class Range(Kind):
    """Two numbers (or whole numbers) that do not fall, within bounds; one number means both ends."""

    ge: float = -math.inf
    le: float = math.inf
    encloses: float | None = None
    """A number strictly between the two."""
    apart: float = 0.0
    """Least difference of the two."""
    whole: bool = False
    unit: str = ""
    falls: bool = False
    """Whether the second may be the smaller one: a course from the first to the second."""

    @property
    def allowed(self) -> str:
        """Say, a number or a range [low, high] from 0 to 1."""
        ends = "two numbers [first, last]" if self.falls else "a range [low, high]"
        kind = f"a whole number or {ends} of whole numbers" if self.whole else f"a number or {ends}"
        if self.encloses is not None:
            wide = f" and is at least {self.apart:g} wide" if self.apart else ""
            kind = f"a range [low, high] that encloses {self.encloses:g}{wide}"
        return _with_unit(kind + _span(self.ge, self.le), self.unit)

    def core(self) -> CoreSchema:
        """Two floats, or two integers."""
        end = Count(int(self.ge), int(self.le)).inner() if self.whole else Number(ge=_finite(self.ge), le=_finite(self.le)).inner()
        ends = core_schema.no_info_before_validator_function(self._both, core_schema.tuple_schema([end, end], strict=True))
        return core_schema.no_info_after_validator_function(self._rising, ends)

    def json(self) -> JsonSchema:
        """A number or an array of two."""
        end = Count(int(self.ge), int(self.le)).json() if self.whole else Number(ge=_finite(self.ge), le=_finite(self.le)).json()
        pair = {"type": "array", "items": end, "minItems": 2, "maxItems": 2}
        if self.encloses is None:
            return {"anyOf": [end, pair]}
        ends = [{**end, "exclusiveMaximum": self.encloses}, {**end, "exclusiveMinimum": self.encloses}]
        return {"type": "array", "prefixItems": ends, "minItems": 2, "maxItems": 2}

    def _both(self, value: Any) -> Any:
        value = plain(value)
        ends = value if isinstance(value, tuple) else (value, value)
        return tuple(map(whole, ends)) if self.whole else ends

    def _rising(self, ends: tuple[Any, Any]) -> tuple[Any, Any]:
        low, high = ends
        if (
            (low > high and not self.falls)
            or (self.apart and high - low < self.apart)
            or not (self.encloses is None or low < self.encloses < high)
        ):
            raise ValueError
        return ends


@dataclass(frozen=True, slots=True)
class Numbers(Kind):
    """A sequence of numbers, or of counts."""

    each: Number | Count = Number()
    least: int = 0
    """How many."""
    most: int | None = None
    of: str = "numbers"

    @property
    def allowed(self) -> str:
        """Say, a list of one or more finite numbers."""
        count = {0: "", 1: " one or more"}.get(self.least, f" {'' if self.least == self.most else 'at least '}{self.least}")
        most = "" if self.most in (None, self.least) else f", at most {self.most}"
        return f"a list of{count} {self.of}{most}, each {self.each.allowed}"

    def core(self) -> CoreSchema:
        """A tuple of floats, or of integers."""
        return core_schema.no_info_before_validator_function(plain if isinstance(self.each, Number) else wholes, self.inner())

    def inner(self) -> CoreSchema:
        """Of a tuple of Python's numbers."""
        return core_schema.tuple_variable_schema(self.each.inner(), min_length=self.least, max_length=self.most, strict=True)

    def json(self) -> JsonSchema:
        """An array."""
        most = {} if self.most is None else {"maxItems": self.most}
        return {"type": "array", "items": self.each.json(), "minItems": self.least, **most}


@dataclass(frozen=True, slots=True)
class Points(Kind):
    """A sequence of points of a plane, or an array (K, 2)."""

    least: int = 0
    most: int | None = None
    unit: str = ""

    @property
    def allowed(self) -> str:
        """Say, a list of at least 3 points [x, y] (m)."""
        return _with_unit(f"a list of {self.least} to {self.most} points [x, y]", self.unit)

    def core(self) -> CoreSchema:
        """A tuple of pairs."""
        point = core_schema.tuple_schema([Number().inner()] * 2, strict=True)
        points = core_schema.tuple_variable_schema(point, min_length=self.least, max_length=self.most, strict=True)
        return core_schema.no_info_before_validator_function(plain, points)

    def json(self) -> JsonSchema:
        """An array of arrays."""
        point = {"type": "array", "items": Number().json(), "minItems": 2, "maxItems": 2}
        return {"type": "array", "items": point, "minItems": self.least, **({} if self.most is None else {"maxItems": self.most})}


@dataclass(frozen=True, slots=True)
class Patches(Kind):
    """A number of patches, or their positions."""

    @property
    def allowed(self) -> str:
        """Either."""
        return "a number of patches, at least one, or a list of one or more finite positions (m)"

    def core(self) -> CoreSchema:
        """An integer, or a tuple of floats."""
        either = core_schema.union_schema([Count().inner(), Numbers(least=1).inner()], mode="left_to_right")
        return core_schema.no_info_before_validator_function(whole, either)

    def json(self) -> JsonSchema:
        """An integer, or an array."""
        return {"anyOf": [Count().json(), Numbers(least=1).json()]}


def _python_number(value: Any) -> Any:
    """Itself: what merely can be made a float, such as a fraction or a tensor of true and false, is no number."""
    if not isinstance(value, (int, float)):
        raise ValueError
    return value


def _finite(bound: float) -> float | None:
    return bound if math.isfinite(bound) else None


def _with_unit(text: str, unit: str) -> str:
    return f"{text} ({unit})" if unit else text


def _span(least: float, most: float) -> str:
    if least == -math.inf and most == math.inf:
        return ""
    if most in (math.inf, UNBOUNDED):
        return f" not below {least:g}"
    return f" not above {most:g}" if least == -math.inf else f" from {least:g} to {most:g}"


def _bounded(noun: str, gt: float | None, ge: float | None, lt: float | None, le: float | None) -> str:
    upper = f"below {lt:g}" if lt is not None else f"at most {le:g}" if le is not None else ""
    if gt == 0.0 and not upper:
        return f"a positive {noun}"
    if ge == 0.0 and not upper:
        return f"zero or a positive {noun}"
    if ge is not None and le is not None:
        return f"a {noun} from {ge:g} to {le:g}"
    lower = f"above {gt:g}" if gt is not None else f"of at least {ge:g}" if ge is not None else ""
    bounds = " and ".join(part for part in (lower, upper) if part)
    return f"a {noun} {bounds}" if bounds else f"a finite {noun}"


Real = Annotated[float, Number()]
Positive = Annotated[float, Number(gt=0.0)]
Share = Annotated[float, Number(ge=0.0, le=1.0)]
Whole = Annotated[int, Count()]
Natural = Annotated[int, Count(0)]
