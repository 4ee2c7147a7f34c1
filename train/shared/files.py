"""Folders, JSON and CSV: files that are written whole or not at all."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from beamenv.configuration.writing import write_whole


def check_folder(folder: Path) -> None:
    """``ValueError`` if a file has the name of the folder: better raised before a training than after it."""
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"folder = {str(folder)!r} must be a folder, or not be there yet, but is a file.")


def read_json(path: Path) -> Any:
    """What a JSON file holds; ``ValueError`` names one that cannot be read, or is damaged."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ValueError(f"file {str(path)!r} cannot be read: {error.strerror}.") from None
    except (ValueError, RecursionError) as error:
        raise ValueError(f"file {str(path)!r} cannot be read: {error}.") from None


def write_json(path: Path, content: Any) -> None:
    """Indented JSON; what is not a number must have been made None before."""
    write_whole(path, json.dumps(content, indent=2, allow_nan=False) + "\n")


def write_csv(path: Path, rows: Sequence[Mapping[str, Any]], columns: Sequence[str] | None = None) -> None:
    """Rows of one set of columns: those of the first row, unless they are named; text as ``in_a_cell`` has it."""
    text = io.StringIO()
    writer = csv.DictWriter(text, fieldnames=list(rows[0] if columns is None else columns), lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: in_a_cell(value) for name, value in row.items()} for row in rows)
    write_whole(path, text.getvalue())


def in_a_cell(value: Any) -> Any:
    """A value of a CSV file: text on one line, and with an apostrophe before it where a spreadsheet would take it for a formula."""
    if not isinstance(value, str):
        return value
    text = on_one_line(value)
    return f"'{text}" if text.lstrip().startswith(_FORMULA) else text


_FORMULA = ("=", "+", "-", "@")


def on_one_line(text: str) -> str:
    """Text with a space for each line break, tab and control character in it."""
    return "".join(letter if letter.isprintable() else " " for letter in text)
