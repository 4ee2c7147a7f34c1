"""A study: one table or figure, what is stated of it, how we compute it, and what came out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.figures.figure import Panel
from train.reproduce.judging.verdicts import Judged, Judgement, Rule, Verdict, weakest
from train.reproduce.thesis import Model
from train.reproduce.thesis.equations import Reading, readings
from train.reproduce.thesis.readings import read_by

Array = NDArray[np.float64]

WITH_AND_WITHOUT = {"solid": "with gyroscopic coupling", "dotted": "without"}
"""The thesis' line styles."""


@dataclass(frozen=True, slots=True)
class Statement:
    """What the thesis says of a table or figure, and the rule that judges it."""

    key: str
    text: str
    rule: Rule
    remark: str = ""
    """What to know of it: why ours differs, or what the numbers mean."""
    aside: bool = False
    """Our own question beside the thesis' statement: shown, but no part of any verdict."""


@dataclass(frozen=True, slots=True)
class Grid:
    """A panel of text cells, for the tables of couplings."""

    title: str
    names: tuple[str, ...]
    cells: Mapping[tuple[str, str], str]
    """By (row, column)."""


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """What a study computed."""

    evidence: Mapping[str, Any]
    """What each statement, by its key, is judged by: numbers in any shape."""
    panels: Sequence[Panel | Grid]
    lines: Mapping[str, str] = field(default_factory=dict)
    """What solid, dotted and dashed stand for."""
    header: Sequence[str] = ()
    rows: Sequence[Sequence[object]] = ()
    """The numbers of a table; a figure's are those of its curves."""
    notes: Sequence[str] = ()
    """Sentences with numbers that were computed beside the evidence."""


@dataclass(frozen=True, slots=True)
class Part:
    """What a study is put together from, that takes long or that several share: found once, by whoever has time."""

    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    """Of which some may be parts themselves: the function is given what these come to."""

    @property
    def parts(self) -> tuple[Part, ...]:
        """Those among its arguments."""
        return tuple(each for each in self.arguments if isinstance(each, Part))

    def result(self) -> Any:
        """What it comes to, which depends on nothing else."""
        return self.function(*(each.result() if isinstance(each, Part) else each for each in self.arguments))


Parts = Mapping[Any, Part]
"""By what a study calls them."""


def no_parts(model: Model) -> Parts:
    """Of studies that are quick."""
    return {}


@dataclass(frozen=True, slots=True)
class Study:
    """One table or figure."""

    name: str
    """ "table-3.4", "figure-5.7"; "graded-walls" of our own work."""
    title: str
    configuration: str
    """What was computed, where the thesis leaves it open or misprints it."""
    statements: tuple[Statement, ...]
    outcome: Callable[..., Outcome]
    """From the model and, where it has parts, from what they came to."""
    parts: Callable[[Model], Parts] = no_parts
    rests_on: Reading = ()
    """Equations, by name, in which the thesis differs from us and which its numbers rest on; empty: what we compute is its own."""
    printed: Callable[[Model], Mapping[str, Any]] | None = None
    """Evidence for the second verdict where it follows from what the thesis prints, by the keys of the statements."""
    unprinted: str = ""
    """Why the thesis' equations cannot be evaluated for the other statements."""
    rows_on_page: bool = False
    """Whether the page shows the outcome's rows, as it always does for a table of the thesis."""

    @property
    def heading(self) -> str:
        """Name and title: "Table 3.4: …", "Graded walls: …"."""
        return f"{called(self.name)}: {self.title}"

    @property
    def tabulated(self) -> bool:
        """Whether its rows are shown on the page."""
        return self.rows_on_page or self.name.startswith("table-")

    def compute(self, model: Model, results: Mapping[Any, Any] | None = None) -> Outcome:
        """The outcome, from its parts' results if these are there already."""
        if results is None:
            results = {key: part.result() for key, part in self.parts(model).items()}
        return self.outcome(model, results) if results else self.outcome(model)

    def parts_by_reading(self, model: Model) -> Mapping[tuple[Reading, Any], Part]:
        """Its parts, and those of the model as the thesis' own equations have it."""
        again = () if self.printed is not None or self.unprinted else readings(self.rests_on)
        return {
            (reading, key): part
            for reading in dict.fromkeys(((), *again))
            for key, part in self.parts(read_by(model, reading) if reading else model).items()
        }

    @property
    def own_statements(self) -> tuple[Statement, ...]:
        """The thesis', asides left out."""
        return tuple(statement for statement in self.statements if not statement.aside)

    def verdict(self, judgements: Mapping[str, Judged]) -> Verdict:
        """The weakest verdict of the thesis' statements."""
        return weakest(self.verdicts(judgements))

    def verdicts(self, judgements: Mapping[str, Judged]) -> list[Verdict]:
        """Those of the thesis' statements, asides left out."""
        return [judgements[statement.key].verdict for statement in self.own_statements]

    def judge(self, outcome: Outcome) -> dict[str, Judgement]:
        """The judgement of every statement; ``ValueError`` unless the outcome has evidence for exactly these."""
        keys = [statement.key for statement in self.statements]
        if set(keys) != set(outcome.evidence):
            raise ValueError(f"evidence of {self.name} = {sorted(outcome.evidence)} must be for {sorted(keys)}.")
        return judged(self.statements, outcome.evidence)


def called(name: str) -> str:
    """A study's name as one says it: "Table 3.4", "Graded walls"."""
    return name.capitalize().replace("-", " ")


def judged(statements: Sequence[Statement], evidence: Mapping[str, Any]) -> dict[str, Judgement]:
    """The judgement of each statement, by key, from the evidence for it."""
    return {each.key: each.rule.judge(np.asarray(evidence[each.key], dtype=float)) for each in statements}
