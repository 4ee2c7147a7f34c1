"""The command ``beamenv speed``."""

from __future__ import annotations

from rich.table import Table

from train.cli.options import JsonOption, one_sentence, print_json, print_table
from train.tools.speed import ROUNDS, ROWS, TARGETS, met
from train.tools.speed import speed as measured


def speed(as_json: JsonOption = False) -> None:
    """How fast it is: steps/s beside CartPole's, imports, assembly. About 20 s."""
    with one_sentence():
        results = measured()
    if as_json:
        print_json(results)
    else:
        show(results)


def show(results: dict[str, float]) -> None:
    """Print the measurements as a table, with the targets."""
    table = Table(title=f"best of {ROUNDS} rounds, one BLAS thread")
    table.add_column("")
    table.add_column("measured", justify="right")
    table.add_column("target", justify="right")
    table.add_column("")
    for name, label, unit in ROWS:
        verdict = {None: "", True: "met", False: "[bold]missed[/bold]"}[met(name, results[name])]
        target = _number(TARGETS[name], unit) if name in TARGETS else ""
        table.add_row(label, _number(results[name], unit), target, verdict)
    print_table(table)


def _number(value: float, unit: str) -> str:
    if unit == "steps/s":
        return f"{value / 1e6:.2f} M steps/s" if value >= 1e6 else f"{value / 1e3:.1f} k steps/s"
    return f"{value:.2f} {unit}".strip()
