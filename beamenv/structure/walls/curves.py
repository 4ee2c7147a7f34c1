"""Properties over temperature as shares of a material's constants: points joined by straight lines, or Touloukian's polynomial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from pydantic_core import CoreSchema, core_schema

from beamenv.configuration import Number, Real, Refused, configuration
from beamenv.configuration.kinds import JsonSchema, Kind, plain
from beamenv.configuration.reading import made

ROOM = 300.0
"""K: where Touloukian's polynomials give a material's constants (Reddy and Chin's reference)."""

DATA_KELVIN = Number(gt=0.0, le=1e4, unit="K")

PROPERTIES = ("E1", "E2", "G12", "G13", "G23", "nu12", "alpha1", "alpha2")
"""What may have a curve; mass does not depend on temperature."""


@configuration("touloukian")
class Touloukian:
    """P(T) = P0 (P₋₁/T + 1 + P1 T + P2 T² + P3 T³), T in K, over its value at 300 K, which is the material's constant.

    Touloukian, Thermophysical Properties of High Temperature Solid Materials, 1967, as printed by Reddy and Chin, Journal of
    Thermal Stresses 21, 1998. Raises ``ValueError`` where the range is empty or the polynomial is zero at 300 K.
    """

    least_K: Annotated[float, DATA_KELVIN]
    most_K: Annotated[float, DATA_KELVIN]
    """Where it holds, K."""
    P_minus1: Real = 0.0
    """K."""
    P1: Real = 0.0
    P2: Real = 0.0
    P3: Real = 0.0
    """1/K, 1/K², 1/K³."""

    def __post_init__(self) -> None:
        if not self.least_K < self.most_K:
            raise Refused("most_K", self.most_K, f"above least_K = {self.least_K:g} (K)")
        if not 0.0 < abs(self._polynomial(ROOM)) < np.inf:
            raise Refused("P1", self.P1, f"such that the property at {ROOM:g} K is neither zero nor infinite")

    def share(self, temperature_K: float) -> float:
        """What the property is over its constant."""
        return self._polynomial(temperature_K) / self._polynomial(ROOM)

    def constant(self, P0: float) -> float:
        """The property at 300 K, for its published P0."""
        return P0 * self._polynomial(ROOM)

    def _polynomial(self, T: float) -> float:
        return self.P_minus1 / T + 1.0 + self.P1 * T + self.P2 * T**2 + self.P3 * T**3


Points = tuple[tuple[float, float], ...]
"""Pairs of a temperature (K), rising, and the share of the constant there."""

Curve = Points | Touloukian


def range_of(curve: Curve) -> tuple[float, float]:
    """Lowest and highest temperature (K) at which a curve holds."""
    return (curve.least_K, curve.most_K) if isinstance(curve, Touloukian) else (curve[0][0], curve[-1][0])


def share(curve: Curve, temperature_K: float) -> float:
    """What a property is over its constant, within the curve's range."""
    if isinstance(curve, Touloukian):
        return curve.share(temperature_K)
    temperatures, shares = zip(*curve, strict=True)
    return float(np.interp(temperature_K, temperatures, shares))


@dataclass(frozen=True, slots=True)
class Curves(Kind):
    """Curves of some properties: a mapping, or pairs of a property and its curve; kept as pairs."""

    @property
    def allowed(self) -> str:
        """Both forms of a curve."""
        return (
            f"a table of any of {', '.join(PROPERTIES)}, each with two or more pairs [K, share of the constant] of rising K, or "
            "with least_K, most_K and any of P_minus1, P1, P2, P3"
        )

    def core(self) -> CoreSchema:
        """Pairs of a property and its curve."""
        point = core_schema.tuple_schema([DATA_KELVIN.inner(), Number().inner()], strict=True)
        points = core_schema.tuple_variable_schema(point, min_length=2, max_length=100, strict=True)
        rising = core_schema.no_info_after_validator_function(_rising, points)
        curve = core_schema.union_schema([core_schema.is_instance_schema(Touloukian), rising])
        pair = core_schema.tuple_schema([core_schema.literal_schema(list(PROPERTIES)), curve], strict=True)
        pairs = core_schema.tuple_variable_schema(pair, strict=True)
        once = core_schema.no_info_after_validator_function(_each_once, pairs)
        return core_schema.no_info_before_validator_function(_by_property, once)

    def json(self) -> JsonSchema:
        """An object of the properties, or an array of pairs."""
        point = {"type": "array", "prefixItems": [DATA_KELVIN.json(), Number().json()], "minItems": 2, "maxItems": 2}
        numbers = {"least_K": DATA_KELVIN.json(), "most_K": DATA_KELVIN.json()}
        numbers |= {name: Number().json() for name in ("P_minus1", "P1", "P2", "P3")}
        polynomial = {"type": "object", "properties": numbers, "additionalProperties": False}
        curve = {"anyOf": [{"type": "array", "items": point, "minItems": 2, "maxItems": 100}, polynomial]}
        table = {"type": "object", "properties": dict.fromkeys(PROPERTIES, curve), "additionalProperties": False}
        pair = {"type": "array", "prefixItems": [{"enum": list(PROPERTIES)}, curve], "minItems": 2, "maxItems": 2}
        return {"anyOf": [table, {"type": "array", "items": pair}]}


def _by_property(value: Any) -> Any:
    pairs = tuple(value.items()) if isinstance(value, Mapping) else plain(value)
    if not isinstance(pairs, tuple) or not all(isinstance(pair, tuple) and len(pair) == 2 for pair in pairs):
        raise ValueError
    return tuple((name, _curve(curve)) for name, curve in pairs)


def _curve(value: Any) -> Any:
    return made(Touloukian, value, "touloukian") if isinstance(value, Mapping) else plain(value)


def _rising(points: Points) -> Points:
    if any(low >= high for (low, _), (high, _) in zip(points[:-1], points[1:], strict=True)):
        raise ValueError
    return points


def _each_once(pairs: tuple[tuple[str, Curve], ...]) -> tuple[tuple[str, Curve], ...]:
    if len({name for name, _ in pairs}) < len(pairs):
        raise ValueError
    return pairs
