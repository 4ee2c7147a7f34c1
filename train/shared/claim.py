"""Whose a folder is: a run goes on in its own, and takes none that holds what it would replace."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

NAME = "configuration.json"
"""What a benchmark and a comparison write before anything else: it tells whose the folder is."""


def check_nothing_replaced(folder: Path, results: Sequence[str], of: str) -> None:
    """``ValueError`` for a folder without a configuration that holds a file or folder of a result's name."""
    if found := [name for name in results if (folder / name).exists()]:
        raise ValueError(f"folder = {str(folder)!r} holds {found[0]}, which no {of} there tells of: name another folder.")
