"""The table as files: CSV with every estimate, Markdown for readers, JSON for programs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from baselines import Estimate
from baselines.evaluation.metrics import finite
from train.benchmark.statistics import CONFIDENCE, RESAMPLES
from train.benchmark.table import UNSTABLE, BenchmarkTable, Row
from train.benchmark.targets import findings
from train.shared.files import write_csv, write_json, write_whole

COLUMNS = (
    ("relative_cost", "J / J₀", 1.0, "{:.3f}", True),
    ("relative_cost_iqm", "IQM of J / J₀", 1.0, "{:.3f}", True),
    ("difference_to_lqg", "J / J₀ less LQG's", 1.0, "{:+.3f}", True),
    ("improvement_on_lqg", "P(J < LQG's)", 1.0, "{:.2f}", True),
    ("unstable", "unstable, %", 100.0, "{:.0f}", False),
    ("settling_time", "settling, s", 1.0, "{:.3f}", False),
    ("settled", "settled, %", 100.0, "{:.0f}", False),
    ("peak_tip", "peak tip, µm", 1e6, "{:.0f}", False),
    ("rms_tip", "RMS tip, µm", 1e6, "{:.1f}", False),
    ("peak_voltage", "peak, V", 1.0, "{:.0f}", False),
    ("effort", "effort, mJ s", 1e3, "{:.3g}", False),
    ("saturation", "saturated, %", 100.0, "{:.1f}", False),
)
"""Estimate, heading, factor from SI, format, whether its interval is shown."""


def write_files(folder: Path, table: BenchmarkTable) -> None:
    """``table.csv``, ``table.md`` and ``benchmark.json``."""
    rows = [csv_row(row) for row in table.rows]
    columns = dict.fromkeys(name for row in rows for name in row)
    write_csv(folder / "table.csv", [{name: row.get(name) for name in columns} for row in rows])
    write_whole(folder / "table.md", markdown(table))
    write_json(folder / "benchmark.json", as_json(table))


def csv_row(row: Row) -> dict[str, Any]:
    """One flat row in SI units: value, low and high of each estimate; infinite ones as "inf"."""
    flat: dict[str, Any] = {name: getattr(row, name) for name in ("scenario", "controller", "title", "kind", "runs", "seeds")}
    for name, estimate in row.estimates.items():
        flat |= {name: estimate.value, f"{name}_low": estimate.low, f"{name}_high": estimate.high}
    return flat | {"sentence": " ".join(row.sentences)}


def as_json(table: BenchmarkTable) -> dict[str, Any]:
    """Configuration, findings and rows; None for what is infinite."""
    rows = []
    for row in table.rows:
        about = {name: getattr(row, name) for name in ("scenario", "controller", "title", "kind", "runs", "seeds")}
        found = {
            name: {"value": finite(each.value), "low": finite(each.low), "high": finite(each.high)}
            for name, each in row.estimates.items()
        }
        rows.append({**about, "estimates": found, "sentences": list(row.sentences)})
    told = [{"sentence": each.sentence, "met": each.met} for each in findings(table)]
    return {"configuration": dict(table.configuration), "findings": told, "refused": dict(table.refused), "rows": rows}


def markdown(table: BenchmarkTable) -> str:
    """Findings, overview, a table for each scenario, what went wrong, and how it was made."""
    parts = [found(table), overview(table), legend(table)]
    parts += [f"### {name}\n\n{scenario_table(table.within(name))}" for name in table.scenarios]
    if table.sentences:
        lines = "\n".join(f"- {where}: {sentence}" for where, sentence in table.sentences.items())
        parts.append(f"### What went wrong\n\n{lines}")
    return "\n\n".join(part for part in parts if part) + "\n"


def found(table: BenchmarkTable) -> str:
    """The findings as a list."""
    verdict = {True: " **Met.**", False: " **Missed.**", None: ""}
    return "\n".join(f"- {each.sentence}{verdict[each.met]}" for each in findings(table))


def overview(table: BenchmarkTable) -> str:
    """J / J₀ of every controller in every scenario; the share of unstable episodes where there are any."""
    rows = [["controller", "kind", *table.scenarios], ["---", "---", *["---:"] * len(table.scenarios)]]
    for name in table.controllers:
        found = [table.row(scenario, name) for scenario in table.scenarios]
        kind = next(row.kind for row in found if row is not None)
        rows.append([name, kind, *(overview_cell(row) for row in found)])
    return lines(rows)


def overview_cell(row: Row | None) -> str:
    """A dash where a controller has nothing to do, "failed" where nothing could be measured."""
    if row is None:
        return "–"
    if not row.measured:
        return "failed"
    unstable = row.estimates["unstable"].value
    return number(row.estimates["relative_cost"].value, "{:.3f}") + (f" ({share(unstable)} unstable)" if unstable else "")


def share(value: float) -> str:
    """In per cent, never rounded to none or all."""
    return "< 1 %" if 0.0 < value < 0.01 else "> 99 %" if 0.99 < value < 1.0 else f"{100.0 * value:.0f} %"


def scenario_table(rows: Sequence[Row]) -> str:
    """Every estimate, the least J first."""
    headings = ["controller", "kind", "runs", *(heading for _, heading, *_ in COLUMNS)]
    table = [headings, ["---", "---", *["---:"] * (len(headings) - 2)]]
    for row in sorted(rows, key=lambda each: each.mean_cost):
        cells = [text(row.estimates.get(name), factor, form, wide) for name, _, factor, form, wide in COLUMNS]
        table.append([row.controller, row.kind, str(row.runs), *cells])
    return lines(table)


def text(estimate: Estimate | None, factor: float, form: str, wide: bool) -> str:
    """A value, with its interval if that is to be shown."""
    if estimate is None:
        return "–"
    value, low, high = (number(factor * each, form) for each in (estimate.value, estimate.low, estimate.high))
    return f"{value} [{low}, {high}]" if wide else value


def number(value: float, form: str) -> str:
    """Three digits at most where it is large; ∞ for a blade that broke."""
    if abs(value) == float("inf"):
        return "∞" if value > 0 else "−∞"
    return f"{value:.3g}" if abs(value) >= 1e3 and form != "{:.0f}" else form.format(value)


def lines(rows: Sequence[Sequence[str]]) -> str:
    """Rows of a Markdown table."""
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def legend(table: BenchmarkTable) -> str:
    """What the numbers are, and by which rules."""
    first, last = table.configuration["seeds"]
    return (
        f"J₀ is J without control on the same episodes: {last - first + 1} held-out seeds, {first} to {last}, equal for every "
        "controller. J / J₀: ratio of the means over seeds and training runs. IQM: interquartile mean of J / J₀, seed by seed and "
        f"run by run. Brackets: {100 * CONFIDENCE:.0f} % bootstrap intervals, {RESAMPLES} resamples of seeds and of training runs. "
        "P(J < LQG's): probability of improvement, ties half. An episode is unstable if the blade fails, which makes J infinite, "
        f"or if J > {UNSTABLE:g} J₀; none is left out. Settling, peaks and effort are means over episodes. Controllers of the kind "
        "“bound” see the true state, which no sensor shows."
    )
