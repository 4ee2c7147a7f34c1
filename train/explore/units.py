"""Units whose prefix follows from the numbers that are shown, and numbers with as many digits as tell them apart."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor, isfinite, log10
from typing import Any

import numpy as np

PREFIXES = {-15: "f", -12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
MANY = 2e4
"""rad/s from which on it is krad/s: what a blade does has numbers up to there."""
ROUND = (1.0, 2.0, 5.0, 10.0)


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit with its prefix."""

    name: str
    per: float
    """How many of it make one without a prefix."""

    def __call__(self, value: float, digits: int = 4) -> str:
        """A value without prefix as a number with its unit."""
        return f"{bare(number(self.per * value, digits))} {self.name}"


def unit_of(values: Any, symbol: str) -> Unit:
    """The unit in which the largest of finite values, given without a prefix, is from 1 to 1000; without a prefix for zero."""
    largest = float(np.abs(values).max(initial=0.0))
    power = 3 * floor(log10(largest * (1.0 + 1e-12)) / 3) if largest > 0.0 else 0
    power = min(max(power, min(PREFIXES)), max(PREFIXES))
    return Unit(PREFIXES[power] + symbol, 10.0**-power)


def angular(largest: float) -> tuple[Unit, str]:
    """Unit of angular frequencies up to the largest, in rad/s, and that of frequencies beside it: rad/s and Hz, or k of both."""
    power = 0 if largest < MANY else 3 if largest < 1e3 * MANY else 6
    return Unit(PREFIXES[power] + "rad/s", 10.0**-power), PREFIXES[power] + "Hz"


def number(value: float, digits: int = 4) -> str:
    """With so many digits, and no exponent within reason: 181.1, 0.03251, 12 340; the sign of one beyond all bounds."""
    if not isfinite(value):
        return "∞" if value > 0.0 else "−∞" if value < 0.0 else "no number"
    if value == 0.0:
        return "0"
    size = floor(log10(abs(value)))
    if not -5 <= size <= 8:
        return f"{value:.{digits - 1}e}".replace("-", "−")
    return f"{value:.{max(digits - 1 - size, 0)}f}".replace("-", "−")


def signed(value: float) -> str:
    """As it is, with a minus sign that is one."""
    return f"{value:g}".replace("-", "−")


def bare(text: str) -> str:
    """A number as text without zeros at its end that say nothing."""
    return text.rstrip("0").rstrip(".") if "." in text and "e" not in text else text


def nearest_round(value: float) -> float:
    """1, 2 or 5 times a power of ten."""
    power = 10.0 ** floor(log10(value))
    return float(f"{power * min(ROUND, key=lambda digit: abs(log10(value / power / digit))):.12g}")


def one_digit(value: float) -> float:
    """The next number, no smaller, that has one digit that is not zero."""
    power = 10.0 ** floor(log10(value))
    return float(f"{power * ceil(value / power - 1e-9):.12g}")
