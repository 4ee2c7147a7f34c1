"""The command ``beamenv speed``."""

from __future__ import annotations

from rich.table import Table

from train.cli.options import JsonOption, one_sentence, print_json, print_table
from train.shared.versions import machine
from train.speed.beside_cartpole import ROUNDS
from train.speed.beside_cartpole import speed as measured
from train.speed.rows import ROWS, TARGETS, met


def speed(as_json: JsonOption = False) -> None:
    """How fast it is: steps/s beside CartPole's, imports, assembly. About half a minute."""
    with one_sentence():
        results = measured()
    if as_json:
        print_json({"machine": machine(), **results})
    else:
        show(results)


def show(results: dict[str, float]) -> None:
    """Print the measurements as a table, with the targets."""
    table = Table(title=f"best of {ROUNDS} rounds, BLAS threads: {results['threads']:g}, on {machine()}")
    table.add_column("")
    table.add_column("measured", justify="right")
    table.add_column("target", justify="right")
    table.add_column("")
    for name, label, unit in ROWS:
        target = _number(TARGETS[name], unit) if name in TARGETS else ""
        if name in results:
            table.add_row(label, _number(results[name], unit), target, VERDICTS[met(name, results[name])])
        else:
            table.add_row(label, "needs torch", target, "")
    print_table(table)


VERDICTS = {None: "", True: "met", False: "[bold]missed[/bold]"}


def _number(value: float, unit: str) -> str:
    if unit == "steps/s":
        return f"{value / 1e6:.2f} M steps/s" if value >= 1e6 else f"{value / 1e3:.1f} k steps/s"
    return f"{value:.2f} {unit}".strip()
