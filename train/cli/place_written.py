"""What ``beamenv place`` writes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console

from beamenv.configuration.files import checked_path
from train.shared.files import check_file, write_json


@dataclass(frozen=True, slots=True)
class Written:
    """Where what was found goes."""

    output: Path | None
    """The file of the blade."""
    drawn: Path | None
    """The picture."""
    as_json: bool

    def check(self) -> None:
        """``ValueError`` for a file that cannot be written, before anything is searched for."""
        if self.output is not None:
            check_file(checked_path("output", self.output, (".json",)), "output")

    def save(self, config: Any) -> None:
        """A blade, as a file that ``gymnasium.make`` and ``--blade`` take, where one is asked for."""
        if self.output is None:
            return
        from beamenv.blade.files import to_dict

        write_json(self.output, to_dict(config))
        Console(stderr=self.as_json).print(f"blade in {self.output}", soft_wrap=True, markup=False)
