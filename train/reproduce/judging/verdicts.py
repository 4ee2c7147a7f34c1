"""The rules by which numbers become verdicts: each is stated in words and applied to evidence, nothing is typed in."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Verdict(str, Enum):
    """What became of a statement of the thesis."""

    REPRODUCED = "reproduced"
    TREND = "trend reproduced"
    NOT_REPRODUCED = "not reproduced"
    UNTESTABLE = "cannot be tested"


SEVERITY = (Verdict.NOT_REPRODUCED, Verdict.TREND, Verdict.REPRODUCED)


def weakest(verdicts: list[Verdict]) -> Verdict:
    """The verdict of several statements together: the weakest of those that can be tested; untestable when none can."""
    return next((verdict for verdict in SEVERITY if verdict in verdicts), Verdict.UNTESTABLE)


@dataclass(frozen=True, slots=True)
class Judgement:
    """One statement's verdict with the numbers it was computed from, ready to print."""

    verdict: Verdict
    thesis: str
    ours: str
    deviation: str


class Judged(Protocol):
    """A first or a second judgement."""

    @property
    def verdict(self) -> Verdict:
        """What became of the statement."""
        ...


class Rule(ABC):
    """Evidence in, judgement out."""

    def judge(self, evidence: Array) -> Judgement:
        """The judgement; ``ValueError`` for evidence that is empty or not finite."""
        values = np.asarray(evidence, dtype=float)
        if values.size == 0 or not np.all(np.isfinite(values)):
            raise ValueError(f"evidence = {evidence!r} must be finite numbers.")
        return self._judge(values)

    @abstractmethod
    def _judge(self, evidence: Array) -> Judgement: ...

    @property
    def words(self) -> str:
        """The rule in words."""
        return self._words()

    @abstractmethod
    def _words(self) -> str: ...


@dataclass(frozen=True, slots=True)
class Matches(Rule):
    """The thesis prints numbers: ours must lie within ``tolerance`` of each, or within ``trend`` to keep the trend."""

    printed: tuple[float, ...]
    tolerance: float
    trend: float
    unit: str = ""

    def _judge(self, evidence: Array) -> Judgement:
        ours, printed = evidence.ravel(), np.array(self.printed)
        if ours.shape != printed.shape:
            raise ValueError(f"evidence = {evidence!r} must be {len(printed)} numbers, one for each that is printed.")
        off = ours / printed - 1.0
        worst = float(np.abs(off).max())
        verdict = (
            Verdict.REPRODUCED if worst <= self.tolerance else Verdict.TREND if worst <= self.trend else Verdict.NOT_REPRODUCED
        )
        return Judgement(verdict, listed(printed, self.unit), listed(ours, self.unit), deviations(off))

    def _words(self) -> str:
        return (
            f"reproduced within {percent(self.tolerance)} of every number, trend within {percent(self.trend)}, else not reproduced"
        )


@dataclass(frozen=True, slots=True)
class Changes(Rule):
    """The thesis says a quantity rises or falls along a sequence; evidence (series, values) or (values,) in that order."""

    direction: int
    """+1 rises, −1 falls."""

    def _judge(self, evidence: Array) -> Judgement:
        series = np.atleast_2d(evidence)
        steps = self.direction * np.diff(series, axis=1) > 0.0
        overall = series[:, -1] / series[:, 0] - 1.0
        verdict = Verdict.NOT_REPRODUCED
        if np.all(steps):
            verdict = Verdict.REPRODUCED
        elif np.all(self.direction * overall > 0.0):
            verdict = Verdict.TREND
        ours = f"{int(steps.sum())} of {steps.size} steps {self._verb}"
        return Judgement(verdict, self._verb, ours, f"first to last {span(overall)}")

    @property
    def _verb(self) -> str:
        return "rise" if self.direction > 0 else "fall"

    def _words(self) -> str:
        return f"reproduced if every step {self._verb}s, trend if first to last {self._verb}s in every series"


@dataclass(frozen=True, slots=True)
class Small(Rule):
    """The thesis says there is no or hardly any effect; evidence: relative changes."""

    limit: float
    trend: float

    def _judge(self, evidence: Array) -> Judgement:
        largest = float(np.abs(evidence).max())
        verdict = (
            Verdict.REPRODUCED if largest <= self.limit else Verdict.TREND if largest <= self.trend else Verdict.NOT_REPRODUCED
        )
        return Judgement(verdict, f"no effect (≤ {percent(self.limit)})", f"at most {percent(largest)}", span(evidence))

    def _words(self) -> str:
        return f"reproduced if no change exceeds {percent(self.limit)}, trend up to {percent(self.trend)}"


@dataclass(frozen=True, slots=True)
class Large(Rule):
    """The thesis says an effect is considerable; evidence: relative changes."""

    limit: float = 0.05
    trend: float = 0.01

    def _judge(self, evidence: Array) -> Judgement:
        largest = float(np.abs(evidence).max())
        verdict = (
            Verdict.REPRODUCED if largest >= self.limit else Verdict.TREND if largest >= self.trend else Verdict.NOT_REPRODUCED
        )
        return Judgement(verdict, f"considerable (≥ {percent(self.limit)})", f"up to {percent(largest)}", span(evidence))

    def _words(self) -> str:
        return f"reproduced if the largest change is at least {percent(self.limit)}, trend from {percent(self.trend)}"


@dataclass(frozen=True, slots=True)
class Marginal(Rule):
    """The thesis says a quantity rises or falls marginally; evidence: relative changes."""

    direction: int
    limit: float = 0.1

    def _judge(self, evidence: Array) -> Judgement:
        rightly = np.all(self.direction * evidence > 0.0)
        small = np.abs(evidence).max() <= self.limit
        verdict = Verdict.NOT_REPRODUCED if not rightly else Verdict.REPRODUCED if small else Verdict.TREND
        return Judgement(verdict, f"marginally {'up' if self.direction > 0 else 'down'}", span(evidence), span(evidence))

    def _words(self) -> str:
        way = "up" if self.direction > 0 else "down"
        return f"reproduced if every change is {way} by at most {percent(self.limit)}, trend if {way} by more"


@dataclass(frozen=True, slots=True)
class Substantial(Rule):
    """The thesis says a quantity rises or falls substantially; evidence: relative changes."""

    direction: int
    limit: float = 0.05

    def _judge(self, evidence: Array) -> Judgement:
        along = self.direction * evidence
        verdict = Verdict.NOT_REPRODUCED
        if np.all(along >= self.limit):
            verdict = Verdict.REPRODUCED
        elif np.all(along > 0.0):
            verdict = Verdict.TREND
        ours = f"{int((along > 0.0).sum())} of {along.size} {self._way}, {int((along >= self.limit).sum())} of them substantially"
        return Judgement(verdict, f"substantially {self._way}", ours, span(evidence))

    @property
    def _way(self) -> str:
        return "up" if self.direction > 0 else "down"

    def _words(self) -> str:
        return f"reproduced if every change is {self._way} by at least {percent(self.limit)}, trend if {self._way} by less"


@dataclass(frozen=True, slots=True)
class Below(Rule):
    """The thesis says a quantity stays below a limit; evidence: its values over the range of what the thesis leaves open."""

    limit: float
    unit: str

    def _judge(self, evidence: Array) -> Judgement:
        low, high = float(evidence.min()), float(evidence.max())
        verdict = Verdict.REPRODUCED if high < self.limit else Verdict.UNTESTABLE if low < self.limit else Verdict.NOT_REPRODUCED
        margin = f"{span(np.array([low, high]) / self.limit - 1.0)} of the limit"
        return Judgement(verdict, f"below {self.limit:g} {self.unit}", f"{low:.4g} … {high:.4g} {self.unit}", margin)

    def _words(self) -> str:
        return (
            f"reproduced if below {self.limit:g} {self.unit} whatever is left open, not reproduced if above, "
            "cannot be tested if what is left open decides"
        )


@dataclass(frozen=True, slots=True)
class Holds(Rule):
    """The thesis states a fact of several cases; evidence: one (true) or zero (false) for each."""

    share: float = 0.75

    def _judge(self, evidence: Array) -> Judgement:
        held = float(evidence.mean())
        verdict = Verdict.REPRODUCED if held == 1.0 else Verdict.TREND if held >= self.share else Verdict.NOT_REPRODUCED
        ours = f"holds in {int(round(evidence.sum()))} of {evidence.size} cases"
        return Judgement(verdict, "holds in all cases", ours, exceptions(evidence))

    def _words(self) -> str:
        return f"reproduced if it holds in every case, trend from {percent(self.share)} of them"


@dataclass(frozen=True, slots=True)
class WhateverIsOpen(Rule):
    """The thesis states a fact but not all that it depends on; evidence: one or zero for each choice of what is left open."""

    def _judge(self, evidence: Array) -> Judgement:
        held = float(evidence.mean())
        verdict = Verdict.REPRODUCED if held == 1.0 else Verdict.NOT_REPRODUCED if held == 0.0 else Verdict.UNTESTABLE
        ours = f"holds for {int(round(evidence.sum()))} of {evidence.size} choices"
        return Judgement(verdict, "holds", ours, exceptions(evidence))

    def _words(self) -> str:
        return "reproduced if it holds whatever is left open, not reproduced if it never does, cannot be tested if that decides"


def percent(share: float) -> str:
    """0.0123 as 1.23 %."""
    return f"{100.0 * share:.3g} %"


def span(shares: Array) -> str:
    """Relative changes as one signed percentage, or as the range they span."""
    low, high = 100.0 * float(np.min(shares)), 100.0 * float(np.max(shares))
    return f"{low:+.3g} %" if np.isclose(low, high) else f"{low:+.3g} … {high:+.3g} %"


def exceptions(evidence: Array) -> str:
    """How many of the ones and zeros are zero, in words."""
    fail = evidence.size - int(round(evidence.sum()))
    return f"{fail or 'no'} exception{'' if fail == 1 else 's'}"


def listed(values: Array, unit: str) -> str:
    """A few numbers in full, many by their count."""
    if len(values) > 6:
        return f"{len(values)} numbers{f' in {unit}' if unit else ''}"
    return f"{', '.join(f'{value:.5g}' for value in values)} {unit}".rstrip()


def deviations(off: Array) -> str:
    """A few deviations in full, many by the worst."""
    if len(off) > 6:
        return f"at most {percent(float(np.abs(off).max()))}"
    return ", ".join(f"{100.0 * value:+.2g} %" for value in off)
