"""The table as files: CSV with every estimate, Markdown for readers, JSON for programs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from baselines import Estimate
from baselines.evaluation.metrics import finite
from beamenv.configuration.writing import write_whole
from train.benchmark.contests import Contest, contests, corrected
from train.benchmark.score import Aggregate, Headroom, aggregates, by_split, headrooms
from train.benchmark.showing.contests import agents_and_laws, leaders
from train.benchmark.showing.legend import legend
from train.benchmark.showing.scores import headroom, scores
from train.benchmark.showing.section import Section
from train.benchmark.table import BenchmarkTable, Row
from train.benchmark.targets import findings
from train.shared.columns import Column, number, share
from train.shared.files import write_csv, write_json
from train.shared.markdown import escaped
from train.shared.markdown import table as markdown_table

COLUMNS = (
    Column("relative_cost", "J / J₀", 1.0, "{:.3f}", interval=True),
    Column("score", "score", 1.0, "{:.3f}", interval=True),
    Column("relative_cost_iqm", "IQM of J / J₀", 1.0, "{:.3f}", interval=True),
    Column("difference_to_lqg", "J / J₀ less LQG's", 1.0, "{:+.3f}", interval=True),
    Column("improvement_on_lqg", "P(J < LQG's)", 1.0, "{:.2f}", interval=True),
    Column("unstable", "unstable, %", 100.0, "{:.0f}"),
    Column("settling_time", "settling, s", 1.0, "{:.3f}"),
    Column("settled", "settled, %", 100.0, "{:.0f}"),
    Column("peak_tip", "peak tip, µm", 1e6, "{:.0f}"),
    Column("rms_tip", "RMS tip, µm", 1e6, "{:.1f}"),
    Column("peak_voltage", "peak, V", 1.0, "{:.0f}", fine=True),
    Column("effort", "effort, mJ s", 1e3, "{:.3g}"),
    Column("saturation", "saturated, %", 100.0, "{:.1f}"),
)

HEADINGS = ("controller", "tier", "kind", "runs", "saved", "lost")
"""Of what ``about`` says of a row."""

ABOUT = ("scenario", "controller", "title", "tier", "kind", "runs", "seeds")
"""Fields of a row besides its estimates."""

COUNTS = ("fail_without", "saved", "lost")
"""Episodes with a blade that fails, of ``Failures``."""


def write_files(folder: Path, table: BenchmarkTable) -> None:
    """``table.csv``, ``table.md`` and ``benchmark.json``."""
    rows = [csv_row(row) for row in table.rows]
    columns = dict.fromkeys(name for row in rows for name in row)
    write_csv(folder / "table.csv", [{name: row.get(name) for name in columns} for row in rows])
    write_whole(folder / "table.md", markdown(table))
    write_json(folder / "benchmark.json", as_json(table))


def csv_row(row: Row) -> dict[str, Any]:
    """One flat row in SI units: value, low and high of each estimate; infinite ones as "inf"."""
    flat: dict[str, Any] = {name: getattr(row, name) for name in ABOUT} | counts(row)
    for name, estimate in row.estimates.items():
        flat |= {name: estimate.value, f"{name}_low": estimate.low, f"{name}_high": estimate.high}
    return flat | {"sentence": " ".join(row.sentences)}


def counts(row: Row) -> dict[str, int | None]:
    """Blades that fail without control, that are saved and that are lost; None where nothing was measured."""
    return {name: None if row.failures is None else getattr(row.failures, name) for name in COUNTS}


def as_json(table: BenchmarkTable) -> dict[str, Any]:
    """Configuration, findings and rows; None for what is infinite."""
    rows = []
    for row in table.rows:
        fields = {name: getattr(row, name) for name in ABOUT}
        found = {name: estimate_json(each) for name, each in row.estimates.items()}
        rows.append({**fields, **counts(row), "estimates": found, "sentences": list(row.sentences)})
    judged = [{"sentence": each.sentence, "met": each.met} for each in findings(table)]
    return {
        "configuration": dict(table.configuration),
        "findings": judged,
        "refused": dict(table.refused),
        "left_out": list(table.left_out),
        "contests": [contest_json(*each) for each in zip(contests(table), corrected(contests(table)), strict=True)],
        "aggregates": [aggregate_json(each) for each in aggregates(table)],
        "headroom": [headroom_json(each) for each in headrooms(table)],
        "rows": rows,
    }


def estimate_json(estimate: Estimate | None) -> dict[str, float | None] | None:
    """None for what is infinite, and for no estimate."""
    return None if estimate is None else {name: finite(getattr(estimate, name)) for name in ("value", "low", "high")}


def contest_json(one: Contest, left: str) -> dict[str, Any]:
    """An agent against the laws of a scenario, with the verdict that is ``left`` when all scenarios are judged together."""
    names = {name: getattr(one, name).controller for name in ("agent", "law", "hardest")}
    gaps = {name: estimate_json(getattr(one, name)) for name in ("gap", "least_clear")}
    said = {name: getattr(one, name) for name in ("scenario", "verdict", "agent_chosen", "law_chosen")}
    return {**said, "all_judged_together": left, "overtaken": one.overtaken, **names, **gaps}


def aggregate_json(one: Aggregate) -> dict[str, Any]:
    """A controller's score over a split."""
    whose = {name: getattr(one, name) for name in ("split", "controller", "tier", "kind")}
    over = {"scenarios": list(one.scenarios), "without": list(one.without)}
    return {**whose, "score": estimate_json(one.score), "less_lqg": estimate_json(one.less_lqg), **over}


def headroom_json(one: Headroom) -> dict[str, Any]:
    """What is left to gain in a scenario."""
    best = {"controller": one.best.controller, "tier": one.best.tier, "kind": one.best.kind}
    return {"scenario": one.scenario, "best": best, "relative_cost": estimate_json(one.cost), "score": estimate_json(one.score)}


def markdown(table: BenchmarkTable) -> str:
    """Findings, overview, a table for each scenario, what went wrong, and how it was made."""
    parts = [found(table), *(each.markdown() for each in sections(table)), *overviews(table), legend(table)]
    parts += [f"### {escaped(name)}\n\n{scenario_table(table.within(name))}" for name in table.scenarios]
    if table.left_out:
        parts.append("### What was left out\n\n" + "\n".join(f"- {escaped(each)}" for each in table.left_out))
    if table.sentences:
        lines = "\n".join(f"- {escaped(where)}: {escaped(sentence)}" for where, sentence in table.sentences.items())
        parts.append(f"### What went wrong\n\n{lines}")
    return "\n\n".join(part for part in parts if part) + "\n"


def found(table: BenchmarkTable) -> str:
    """The findings as a list."""
    verdict = {True: " **Met.**", False: " **Missed.**", None: ""}
    return "\n".join(f"- {escaped(each.sentence)}{verdict[each.met]}" for each in findings(table))


def sections(table: BenchmarkTable) -> list[Section]:
    """What the table comes to; those without rows are left out."""
    found = (agents_and_laws(table), leaders(table), scores(table), headroom(table))
    return [each for each in found if each.rows]


def overviews(table: BenchmarkTable) -> list[str]:
    """J / J₀ of every controller in every scenario, a table for each split."""
    splits = by_split(table)
    names = {split: [name for name, each in splits.items() if each == split] for split in dict.fromkeys(splits.values())}
    return [f"### J / J₀: {split}\n\n{overview(table, scenarios)}" for split, scenarios in names.items()]


def overview(table: BenchmarkTable, scenarios: Sequence[str]) -> str:
    """J / J₀ of everyone who has something to do there; the share of unstable episodes where there are any."""
    rows = []
    for name in table.controllers:
        found = [table.row(scenario, name) for scenario in scenarios]
        one = next((row for row in found if row is not None), None)
        if one is not None:
            rows.append([name, str(one.tier), one.kind, *(overview_cell(row) for row in found)])
    return markdown_table(["controller", "tier", "kind", *scenarios], rows, words=3)


def overview_cell(row: Row | None) -> str:
    """A dash where a controller has nothing to do, "failed" where nothing could be measured."""
    if row is None:
        return "–"
    if not row.measured:
        return "failed"
    unstable = row.estimates["unstable"].value
    return number(row.estimates["relative_cost"].value, "{:.3f}") + (f" ({share(unstable)} unstable)" if unstable else "")


def scenario_table(rows: Sequence[Row]) -> str:
    """Every estimate, the least J first."""
    lines = []
    for row in sorted(rows, key=lambda each: each.mean_cost):
        cells = [column.text(row.estimates.get(column.name)) for column in COLUMNS]
        lines.append([*(str(each) for each in about(row)), *cells])
    table = markdown_table([*HEADINGS, *(column.heading for column in COLUMNS)], lines, words=3)
    return f"{without_control(rows)}\n\n{table}"


def about(row: Row) -> tuple[str | int, ...]:
    """What a table says of a row before its estimates; dashes where nothing was counted."""
    found = counts(row)
    saved, lost = ("–" if each is None else each for each in (found["saved"], found["lost"]))
    return row.controller, row.tier, row.kind, row.runs, saved, lost


def without_control(rows: Sequence[Row]) -> str:
    """How many blades of a scenario fail without control."""
    each = next((row.failures for row in rows if row.controller == "none"), None)
    if each is None:
        return "How many blades fail without control could not be measured."
    return f"Without control the blade fails in {each.fail_without or 'none'} of {each.episodes} episodes."
