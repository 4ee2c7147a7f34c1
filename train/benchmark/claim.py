"""Whose a folder is: a benchmark goes on in its own, and takes none that holds what it would replace."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from beamenv.configuration import checked_table
from beamenv.configuration.files import of_file
from train.shared.claim import NAME, check_nothing_replaced
from train.shared.files import read_json, write_json

KEYS = ("seeds", "environment", "scenarios", "controllers", "versions")
"""What a benchmark's configuration holds."""

RUNS = "runs"
"""How many runs of an agent take part, in what a configuration tells of a controller; all if it does not tell."""

RESULTS = ("cells", "table.csv", "table.md", "benchmark.json", "heat_map.png", "report.html")


def claim(folder: Path, configuration: Mapping[str, Any]) -> None:
    """Write the configuration of a benchmark to its folder, before anything else.

    A benchmark that contains the one in the folder goes on there: nothing of that is lost, nor measured again. ``ValueError`` says
    what another one holds that this one has not, or names the file that tells of none; the folder is then as it was.
    """
    told = _told(folder)
    if told is not None and (lost := "; ".join(_lost(told, json.loads(json.dumps(configuration))))):
        raise ValueError(f"folder = {str(folder)!r} holds another benchmark, with {lost}: name another folder, or empty this one.")
    write_json(folder / NAME, configuration)


def _told(folder: Path) -> dict[str, Any] | None:
    """The configuration of the benchmark that a folder holds; None if it holds none."""
    for path, within in ((folder / NAME, False), (folder / "benchmark.json", True)):
        if path.exists():
            content = read_json(path)
            with of_file(path):
                told = content.get("configuration") if within and isinstance(content, dict) else content
                return checked_table("the configuration of a benchmark", told, KEYS)
    check_nothing_replaced(folder, RESULTS, "benchmark")
    return None


def _lost(told: Mapping[str, Any], configuration: Mapping[str, Any]) -> Iterator[str]:
    """What of one benchmark another one does not contain."""
    for name in ("seeds", "environment"):
        if told.get(name) != configuration[name]:
            yield f"{name} {json.dumps(told.get(name))}"
    for name in ("scenarios", "controllers"):
        earlier = told.get(name)
        others = (
            [each for each in earlier if not _holds(configuration[name].get(each), earlier[each])]
            if isinstance(earlier, dict)
            else [name]
        )
        if others:
            yield f"{name} {', '.join(others)}"


def _holds(now: Any, earlier: Any) -> bool:
    """Whether what is told of a scenario or a controller is what was told of it earlier, or of a controller with further runs."""
    if now == earlier or not isinstance(now, dict) or not isinstance(earlier, dict):
        return bool(now == earlier)
    fewer = earlier.get(RUNS)
    same = {**now, RUNS: fewer} == earlier
    return same and isinstance(fewer, int) and now.get(RUNS, fewer) >= fewer
