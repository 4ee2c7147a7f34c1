"""What is kept of a tuning: a file for each trial, written whole as soon as it is looked at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from train.shared.files import read_json, write_json
from train.tuning.trial import Look

FINISHED, STOPPED, FAILED = "finished", "stopped", "failed"


@dataclass(frozen=True, slots=True)
class Record:
    """What is known of a trial."""

    trial: int
    """0 is the recipe as it is."""
    settings: dict[str, Any]
    """Those that are tried, by their names, as they were drawn."""
    looks: tuple[Look, ...] = ()
    ended: str = ""
    """"finished" with all its updates, "stopped" for others did better by then, "failed", or "" where it is still to go on."""
    sentence: str = ""
    """Why it failed."""

    def looked(self, look: Look) -> Record:
        """With one look more, unless it is known."""
        known = any(each.updates == look.updates for each in self.looks)
        return self if known else replace(self, looks=(*self.looks, look))

    @property
    def updates(self) -> int:
        """At the last look."""
        return self.looks[-1].updates if self.looks else 0

    @property
    def seconds(self) -> float:
        """Of training until then."""
        return self.looks[-1].seconds if self.looks else 0.0


def keep(folder: Path, record: Record) -> None:
    """Write a record."""
    write_json(_place(folder, record.trial), asdict(record))


def known(folder: Path, fresh: Record) -> Record:
    """What the folder holds of a trial, or ``fresh``; ``ValueError`` names a file that is damaged."""
    path = _place(folder, fresh.trial)
    if not path.is_file():
        return fresh
    content = read_json(path)
    try:
        looks = tuple(Look(**each) for each in content.pop("looks"))
        found = Record(**content, looks=looks)
    except (AttributeError, KeyError, TypeError):
        raise ValueError(f"file {str(path)!r} must be the record of a trial, but is damaged or something else.") from None
    if found.settings != fresh.settings:
        raise ValueError(f"file {str(path)!r} must be the record of trial {fresh.trial}, but is of other settings.")
    return found


def _place(folder: Path, trial: int) -> Path:
    return folder / "trials" / f"{trial}.json"


def checkpoints(folder: Path, trial: int) -> Path:
    """The folder of a trial's checkpoint, until it has ended."""
    return folder / "trials" / str(trial)


def finished(records: Sequence[Record]) -> list[Record]:
    """Those that had all their updates, the best first; of equals the earlier."""
    return sorted((each for each in records if each.ended == FINISHED), key=lambda each: (each.looks[-1].cost, each.trial))


def rows(records: Sequence[Record]) -> list[dict[str, Any]]:
    """As ``trials.csv`` has them."""
    return [
        {
            "trial": each.trial,
            "ended": each.ended,
            "updates": each.updates,
            "cost": each.looks[-1].cost if each.looks else "",
            "apart": each.looks[-1].apart if each.looks else "",
            "seconds": round(each.seconds, 1),
            **each.settings,
        }
        for each in records
    ]
