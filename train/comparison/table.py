"""The comparison as a table, in CSV and Markdown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from baselines import Evaluation
from beamenv.configuration.writing import write_whole
from beamenv.knowledge import TRUTH
from train.controllers.known import known_controllers
from train.controllers.tiers import tiers_told
from train.shared import markdown
from train.shared.columns import EVALUATION
from train.shared.files import write_csv

Tiers = Mapping[str, int] | None
"""Of controllers by their names, for a column of its own; None where there is none."""


def headings(tiers: Tiers = None) -> list[str]:
    """Of all columns."""
    return ["controller", *(["tier"] if tiers else []), *(column.heading for column in EVALUATION)]


def ranked(evaluations: Sequence[Evaluation]) -> list[Evaluation]:
    """Best first."""
    return sorted(evaluations, key=lambda evaluation: evaluation.relative_cost.value)


def cells(evaluation: Evaluation, tiers: Tiers = None) -> list[str]:
    """Name, then every column."""
    told = [str(tiers[evaluation.name])] if tiers else []
    return [evaluation.name, *told, *(column.text(getattr(evaluation, column.name)) for column in EVALUATION)]


def caption(evaluations: Sequence[Evaluation], tiers: Tiers = None) -> str:
    """What the table rests on."""
    return (
        f"{episodes_told(evaluations[0])}, the same for every controller; "
        f"brackets: {100 * evaluations[0].confidence:.0f} % bootstrap intervals over seeds. "
        f"{tiers_told() if tiers else told_of_references(evaluations)}"
    ).rstrip()


def episodes_told(evaluation: Evaluation) -> str:
    """Which episodes."""
    seeds = evaluation.episodes.seeds
    return f"{len(seeds)} held-out episodes (seeds {seeds[0]} to {seeds[-1]})"


def told_of_references(evaluations: Sequence[Evaluation]) -> str:
    """Empty where nobody is told what no sensor offers."""
    known = known_controllers()
    found = [each.name for each in evaluations if each.name in known and known[each.name].tier == TRUTH]
    return " ".join(f"{name}: {known[name].title} A reference, no rival." for name in found)


def markdown_table(evaluations: Sequence[Evaluation], tiers: Tiers = None) -> str:
    """The table in Markdown, best first, with its caption."""
    rows = [cells(evaluation, tiers) for evaluation in ranked(evaluations)]
    return f"{markdown.table(headings(tiers), rows, words=1)}\n\n{caption(evaluations, tiers)}\n"


def notes(left_out: Mapping[str, str]) -> list[str]:
    """One sentence on each law that could not be had."""
    return [f"{name} is left out: {sentence}" for name, sentence in left_out.items()]


def write_tables(
    folder: Path, evaluations: Sequence[Evaluation], tiers: Tiers = None, left_out: Mapping[str, str] = MappingProxyType({})
) -> None:
    """``table.csv``, in SI units with every interval, and ``table.md``."""
    about = [{"controller": each.name, **({"tier": tiers[each.name]} if tiers else {})} for each in ranked(evaluations)]
    rows = [{**whose, **each.row()} for whose, each in zip(about, ranked(evaluations), strict=True)]
    write_csv(folder / "table.csv", rows)
    told = "".join(f"\n{note}\n" for note in notes(left_out))
    write_whole(folder / "table.md", markdown_table(evaluations, tiers) + told)
