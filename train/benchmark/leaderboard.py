"""The leaderboard: a row for each entry, kept in ``leaderboard.csv`` and shown by ``leaderboard.md`` beside it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from baselines import Estimate
from beamenv.configuration import Count, FileName, Refused, Text, checked, shown
from beamenv.configuration.files import of_file
from beamenv.configuration.writing import UNFINISHED, write_whole
from beamenv.knowledge import TRUTH
from train.benchmark.score import SPLITS
from train.benchmark.table import UNSTABLE
from train.controllers.tiers import tiers_told
from train.shared import markdown
from train.shared.columns import Column, number, share
from train.shared.files import read_rows, write_csv
from train.shared.lock import held

NAME = "leaderboard.csv"
PAGE = "leaderboard.md"

PATIENCE = 20.0
"""Seconds that a row waits for another, which takes a moment to be written: it was long in being measured."""

ABOUT = ("name", "tier", "kind", "runs")
COSTS = tuple(f"cost {split}" for split in SPLITS)
"""Of each split the mean over its scenarios of J / J₀."""
SCORES = tuple(f"score {split}{end}" for split in SPLITS for end in ("", " low", " high"))
"""Of each split the score with its interval; empty where there is none."""
LAST = ("unstable", "training_seconds", "seeds", "digest", "versions", "date")
COLUMNS = (*ABOUT, *COSTS, *SCORES, *LAST)

WORDS = ("kind", "digest", "versions", "date")
WHOLE = {"tier": Count(0, TRUTH - 1), "runs": Count(), "seeds": Count()}
MAY_BE_EMPTY = (*COSTS, *SCORES, "training_seconds")

SCORE = Column("", "", 1.0, "{:.3f}", interval=True)

INTRODUCTION = """\
# Leaderboard

Each row of the leaderboard is measured by running the entry again, in every scenario and on the benchmark's held-out
episodes, together with no control, LQG and the clairvoyant controller. To train an agent and enter it:

```sh
beamenv train gradient --scenario generalist --folder mine
beamenv benchmark --submit mine
```

`--submit` takes the folder of a trained agent or of several runs of it, or the id of a controller, for example of your own
file in `train/controllers/named/`. It also takes the `.zip` file of a Stable-Baselines3 model, with `--trust`, because
loading such a file can run code. The entry is appended to `results/leaderboard.csv`, and with `--docs docs` to the table of
this page. If the entry's file does not say what it was told, say so with `--tier`. An interrupted run resumes.
"""


@dataclass(frozen=True, slots=True)
class Entry:
    """A row of the leaderboard."""

    values: Mapping[str, Any]
    """Of each of ``COLUMNS``: text, whole numbers, numbers, and None where it is empty."""

    @property
    def name(self) -> str:
        """What it is called."""
        return str(self.values["name"])

    @property
    def digest(self) -> str:
        """Of what was run."""
        return str(self.values["digest"])

    @property
    def place(self) -> tuple[float, ...]:
        """By which rows are ordered: tier by tier, the greatest mean score first, and by cost where there is none."""
        scores = [-math.inf if (score := self.values[f"score {split}"]) is None else score for split in SPLITS]
        return self.values["tier"], -sum(scores), *(math.inf if self.values[name] is None else self.values[name] for name in COSTS)


def read_leaderboard(path: Path) -> list[Entry]:
    """Its rows, none if there is no file; ``ValueError`` names the file, the line and what is wrong in it."""
    if not path.exists():
        return []
    rows = read_rows(path, "a leaderboard")
    if not rows or tuple(rows[0][1]) != COLUMNS:
        first = shown(",".join(rows[0][1]) if rows else "")
        raise ValueError(f"file {str(path)!r} has in line 1 {first}, but must have the columns {','.join(COLUMNS)}.")
    with of_file(path):
        entries = [_entry(f"line {line}", row) for line, row in rows[1:]]
    if doubled := [each.name for k, each in enumerate(entries) if each.name in {other.name for other in entries[:k]}]:
        raise ValueError(f"file {str(path)!r} has two rows called {doubled[0]!r}: remove one of them.")
    return entries


def _entry(line: str, row: Sequence[str]) -> Entry:
    if len(row) != len(COLUMNS):
        raise Refused(line, ",".join(row), f"{len(COLUMNS)} cells")
    return Entry({name: _value(f"{line}.{name}", name, cell) for name, cell in zip(COLUMNS, row, strict=True)})


def _value(path: str, name: str, cell: str) -> Any:
    if name == "name":
        return checked(path, cell, FileName())
    if name in WORDS:
        return checked(path, cell, Text())
    if name in WHOLE:
        return checked(path, int(cell) if cell.isdecimal() else cell, WHOLE[name])
    if not cell and name in MAY_BE_EMPTY:
        return None
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise Refused(path, cell, "a number")
    return value


def check_entry(path: Path, name: str, digest: str, overwrite: bool) -> None:
    """``ValueError`` of one sentence where an entry of that name stands in the way."""
    earlier = next((each for each in read_leaderboard(path) if each.name == name), None)
    if earlier is None:
        return
    if earlier.digest == digest:
        raise ValueError(
            f"submit = {name!r} is on the leaderboard {str(path)!r} already, the very same one: there is nothing to add."
        )
    if not overwrite:
        raise ValueError(
            f"submit = {name!r} is the name of another entry on the leaderboard {str(path)!r}: take --overwrite to replace that, "
            "or give yours another name."
        )


def enter(path: Path, entry: Entry, overwrite: bool) -> None:
    """Append a row, or put it in the place of the one of its name: page and CSV, each written whole or not at all.

    The CSV, which counts, comes last: one who is interrupted before is not refused the next time as being there already.
    ``ValueError`` as of ``check_entry``, and while another process is at work there for longer than ``PATIENCE``.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with held(path.parent, PATIENCE):
        check_entry(path, entry.name, entry.digest, overwrite)
        entries = read_leaderboard(path)
        names = [each.name for each in entries]
        _remove_unfinished(path)
        entries = [entry if each.name == entry.name else each for each in entries] + ([] if entry.name in names else [entry])
        write_whole(path.with_name(PAGE), page(entries))
        write_csv(path, [each.values for each in entries], COLUMNS)


def _remove_unfinished(path: Path) -> None:
    """What a process that was killed had begun to write; folders within may be another's, who is at work there."""
    for begun in path.parent.glob(f".{path.stem}.*"):
        if UNFINISHED.fullmatch(begun.name):
            begun.unlink(missing_ok=True)


def page(entries: Sequence[Entry]) -> str:
    """How to enter, and the table."""
    if not entries:
        return f"{INTRODUCTION}\nThere are no entries yet.\n"
    headings = ["entry", "tier", "kind", *(heading for split in SPLITS for heading in (f"J / J₀, {split}", f"score, {split}"))]
    rows = [cells(each) for each in sorted(entries, key=lambda each: each.place)]
    table = markdown.table([*headings, *("unstable", "training, s", "runs", "date", "digest")], rows, words=3)
    return f"{INTRODUCTION}\n{table}\n\n{legend()}\n"


def cells(entry: Entry) -> list[str]:
    """A row as text."""
    told = entry.values
    splits = [text for split in SPLITS for text in (_number(told[f"cost {split}"], "{:.3f}"), _score(told, split))]
    last = [share(told["unstable"]), _number(told["training_seconds"], "{:.0f}"), str(told["runs"]), told["date"], told["digest"]]
    return [entry.name, str(told["tier"]), told["kind"], *splits, *last]


def _number(value: float | None, form: str) -> str:
    return "–" if value is None else number(value, form)


def _score(told: Mapping[str, Any], split: str) -> str:
    value, low, high = (told[f"score {split}{end}"] for end in ("", " low", " high"))
    return "–" if None in (value, low, high) else SCORE.text(Estimate(value, low, high))


def legend() -> str:
    """What the numbers are."""
    splits = "; ".join(f"{split}: {', '.join(names)}" for split, names in SPLITS.items())
    return (
        "J / J₀: cost relative to no control, mean over a group's scenarios. Score: (J₀ − J) / (J₀ − J of clairvoyant), "
        "interquartile mean over those of them in which there is one, with its 95 % interval. Unstable: the share of all "
        f"episodes in which a blade fails or J > {UNSTABLE:g} J₀. Training: seconds a run, where its file tells them. Rows stand "
        f"tier by tier, the greatest score first. {splits}. {tiers_told()} No entry is of tier {TRUTH}."
    )
