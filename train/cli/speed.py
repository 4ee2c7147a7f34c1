"""The command ``beamenv speed``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

import typer

from train.cli.options import JsonOption, one_sentence, print_json, say
from train.cli.tables import Column, show_table
from train.shared.versions import machine
from train.speed.beside_cartpole import ROUNDS
from train.speed.beside_cartpole import speed as measured
from train.speed.rows import ROWS, TARGETS, met


def speed(
    check: Annotated[
        bool, typer.Option("--check", help="Also show the targets of this project's machine; exit status 1 if one is missed.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Measure the speed: steps per second beside CartPole's, imports, assembly. About half a minute."""
    with one_sentence():
        results = measured()
    missed = [name for name in TARGETS if name in results and not met(name, results[name])] if check else []
    if as_json:
        targets = {"targets": TARGETS, "missed": missed} if check else {}
        print_json({"machine": machine(), **results, **targets})
    else:
        show(results, check)
    if missed:
        raise typer.Exit(1)


def show(results: Mapping[str, float], check: bool = False) -> None:
    """Print machine and threads, the measurements, and beside them the targets where these are asked for."""
    say(f"{machine()}; threads of linear algebra: {results['threads']:g}; best of {ROUNDS} rounds")
    columns = [Column("", words=True), Column("measured"), Column("", words=True), *([Column("target")] if check else [])]
    show_table(columns, [_row(results, *each)[: len(columns)] for each in ROWS])


def _row(results: Mapping[str, float], name: str, label: str, unit: str) -> list[str]:
    target = _number(TARGETS[name], unit) if name in TARGETS else ""
    if name not in results:
        return [label, "needs torch", "", target]
    verdict = VERDICTS[met(name, results[name])]
    return [label, _number(results[name], unit), unit, f"{target} {verdict}".strip()]


VERDICTS = {None: "", True: "   met", False: "missed"}


def _number(value: float, unit: str) -> str:
    if unit == "steps/s":
        return f"{value / 1e6:.2f} M" if value >= 1e6 else f"{value / 1e3:.1f} k"
    return f"{value:.2f}"
