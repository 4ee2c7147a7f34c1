"""Evaluations as a terminal shows them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from baselines import Estimate, Evaluation
from train.benchmark.runs import Runs
from train.benchmark.table import UNSTABLE
from train.cli.options import say
from train.cli.tables import Column, show_table
from train.comparison.table import Tiers, episodes_told, ranked, told_of_references
from train.controllers.tiers import tiers_told
from train.shared.columns import EVALUATION, number, share
from train.shared.columns import Column as Quantity

SHARES = ("settled", "unstable")

LIST = (
    Quantity("relative_cost", "J / J without control", 1.0, "{:.3f}"),
    Quantity("cost", "J, mJ s", 1e3, "{:#.3g}"),
    Quantity("effort", "the actuators' part of J, mJ s", 1e3, "{:#.3g}"),
    Quantity("settling_time", "settling time (5 %), s", 1.0, "{:.3f}"),
    Quantity("settled", "episodes that settle", 1.0, ""),
    Quantity("unstable", "episodes that are unstable", 1.0, ""),
    Quantity("peak_tip", "peak displacement of the tip, µm", 1e6, "{:.0f}"),
    Quantity("rms_tip", "RMS displacement of the tip, µm", 1e6, "{:.1f}"),
    Quantity("peak_voltage", "peak voltage, V", 1.0, "{:.0f}", fine=True),
    Quantity("rms_voltage", "RMS voltage, V", 1.0, "{:.0f}", fine=True),
    Quantity("saturation", "time at a voltage limit, %", 100.0, "{:.1f}"),
)
"""What is told of one controller."""

HEADINGS = {
    "settling_time": "settles\n(5 %), s",
    "peak_tip": "peak tip,\nµm",
    "rms_tip": "RMS tip,\nµm",
    "peak_voltage": "peak,\nV",
    "rms_voltage": "RMS,\nV",
    "saturation": "at limit,\n%",
}
"""Of a table's columns beside J, which take two lines."""


def show_one(runs: Runs, where: str) -> None:
    """A controller's estimates in a list, ``where`` it is told; of several runs their mean and spread, and then each in a row."""
    several, first = len(runs.evaluations) > 1, runs.first
    found = runs.estimates() if several else {**first.estimates(), "unstable": runs.unstable}
    columns = [Column("", words=True), Column("mean" if several else "value"), Column(_interval(first))]
    rows = [[each.heading, *_value(each, found, duration(first))] for each in LIST]
    if several:
        columns.append(Column("± over runs"))
        spread = runs.spread()
        rows = [[*row, row[2] and _deviation(each, spread[each.name].deviation)] for each, row in zip(LIST, rows, strict=True)]
    show_table(columns, rows, f"{runs.name}, {f'mean of {len(runs.evaluations)} runs, ' if several else ''}{where}")
    if several:
        _show_rows(runs.evaluations, "", "run")
    say(f"{episodes_told(first)}; intervals: bootstrap over {'runs and ' if several else ''}episodes.")
    _tell([found["settled"]], duration(first))
    if found["unstable"].value:
        say(f"An episode is unstable if the blade fails, or if J is more than {UNSTABLE:g} times what it is without control.")
    if further := told_of_references([first]):
        say(further)


def show_compared(evaluations: Sequence[Evaluation], tiers: Tiers = None) -> None:
    """One row a controller, best first."""
    _show_rows({each.name: each for each in ranked(evaluations)}, "Controllers compared", "controller", tiers)
    first = evaluations[0]
    say(f"{episodes_told(first)}, the same for every controller; intervals: bootstrap over episodes. J₀: J without control.")
    _tell([each.settled for each in evaluations], duration(first))
    if further := tiers_told() if tiers else told_of_references(evaluations):
        say(further)


def duration(evaluation: Evaluation) -> float:
    """Of an episode, s."""
    return evaluation.episodes.interval * len(evaluation.episodes.time)


def _show_rows(evaluations: Mapping[str, Evaluation], title: str, of: str, tiers: Tiers = None) -> None:
    first = next(iter(evaluations.values()))
    cost, settling, *others = EVALUATION
    columns = [Column(of, words=True), *([Column("tier")] if tiers else []), Column("J / J₀"), Column(_interval(first))]
    columns += [Column(HEADINGS[each.name], wide=each is not settling) for each in (settling, *others)]
    show_table(columns, [_row(name, each, tiers) for name, each in evaluations.items()], title)


def _row(name: str, evaluation: Evaluation, tiers: Tiers) -> list[str]:
    cost, settling, *others = EVALUATION
    found, length = evaluation.estimates(), duration(evaluation)
    told = [str(tiers[evaluation.name])] if tiers else []
    further = [each.number(found[each.name].value) for each in others]
    return [name, *told, *_value(cost, found, length), _value(settling, found, length)[0], *further]


def _tell(settled: Sequence[Estimate], length: float) -> None:
    """What a settling time is where something does not settle, but not all."""
    if any(0.0 < each.value < 1.0 for each in settled):
        say(f"An episode that does not settle counts with its whole length, {length:g} s.")


def _interval(evaluation: Evaluation) -> str:
    return f"{100 * evaluation.confidence:.0f} % interval"


def _value(quantity: Quantity, found: Mapping[str, Estimate], length: float) -> tuple[str, str]:
    """A value and its interval; of what never settles that it takes longer than an episode."""
    estimate = found[quantity.name]
    if quantity.name == "settling_time" and found["settled"].value == 0.0:
        return f"> {length:g}", ""
    as_text = _share if quantity.name in SHARES else quantity.number
    value, low, high = map(as_text, (estimate.value, estimate.low, estimate.high))
    return value, "" if value == "–" else f"{low} to {high}"


def _share(value: float) -> str:
    return share(value) if value == value else "–"  # NaN where no displacement is told


def _deviation(quantity: Quantity, value: float) -> str:
    return number(100.0 * value, "{:.1f} %") if quantity.name in SHARES else quantity.number(value)
