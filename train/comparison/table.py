"""The comparison as a table: CSV and Markdown for files, rich for the screen."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.table import Table

from baselines import Evaluation
from train.shared.files import write_csv, write_whole

COLUMNS = (
    ("relative_cost", "J / J without control", 1.0, "{:.3f}"),
    ("settling_time", "settling (5 %), s", 1.0, "{:.3f}"),
    ("peak_tip", "peak tip, µm", 1e6, "{:.0f}"),
    ("rms_tip", "RMS tip, µm", 1e6, "{:.1f}"),
    ("peak_voltage", "peak, V", 1.0, "{:.0f}"),
    ("rms_voltage", "RMS, V", 1.0, "{:.0f}"),
    ("saturation", "saturated, %", 100.0, "{:.1f}"),
)
"""Estimate, heading, factor from SI, format."""


def ranked(evaluations: Sequence[Evaluation]) -> list[Evaluation]:
    """Best first."""
    return sorted(evaluations, key=lambda evaluation: evaluation.relative_cost.value)


def cells(evaluation: Evaluation) -> list[str]:
    """Name, then every column; the cost with its interval."""
    row = [evaluation.name]
    for name, _, factor, pattern in COLUMNS:
        estimate = getattr(evaluation, name)
        text = pattern.format(factor * estimate.value)
        if name == "relative_cost":
            text += f" [{pattern.format(estimate.low)}, {pattern.format(estimate.high)}]"
        row.append(text)
    return row


def caption(evaluations: Sequence[Evaluation]) -> str:
    """What the table rests on."""
    first = evaluations[0]
    seeds = first.episodes.seeds
    return (
        f"{len(seeds)} held-out episodes (seeds {seeds[0]} to {seeds[-1]}), the same for every controller; "
        f"brackets: {100 * first.confidence:.0f} % bootstrap intervals over seeds. "
        "Laws marked (true state) see what no sensor shows: bounds, not rivals."
    )


def markdown(evaluations: Sequence[Evaluation]) -> str:
    """The table in Markdown, best first, with its caption."""
    headings = ["controller", *(heading for _, heading, _, _ in COLUMNS)]
    lines = [headings, ["---", *["---:"] * len(COLUMNS)], *(cells(evaluation) for evaluation in ranked(evaluations))]
    table = "\n".join("| " + " | ".join(line) + " |" for line in lines)
    return f"{table}\n\n{caption(evaluations)}\n"


def screen_table(evaluations: Sequence[Evaluation]) -> Table:
    """The table for a terminal."""
    table = Table(title="Controllers compared", caption=caption(evaluations))
    table.add_column("controller")
    for _, heading, _, _ in COLUMNS:
        table.add_column(heading, justify="right")
    for evaluation in ranked(evaluations):
        table.add_row(*cells(evaluation))
    return table


def write_tables(folder: Path, evaluations: Sequence[Evaluation]) -> None:
    """``table.csv``, in SI units with every interval, and ``table.md``."""
    write_csv(folder / "table.csv", [evaluation.row() for evaluation in ranked(evaluations)])
    write_whole(folder / "table.md", markdown(evaluations))
