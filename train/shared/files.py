"""Folders, JSON and CSV: files that are written whole or not at all."""

from __future__ import annotations

import csv
import io
import json
import os
import secrets
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from beamenv.configuration import Refused, shown
from beamenv.configuration.files import checked_path
from beamenv.configuration.writing import write_whole

SPACE = 16_000_000
"""Bytes that must be free where a run writes what it finds: checkpoints, tables, pictures, a page."""

PICTURE = 2**20
"""… where a single file is written."""

PICTURES = (".png",)

PROBE = 4096
"""Bytes of the file that is written on trial."""


def check_folder(folder: Path, name: str = "folder", space: int = SPACE) -> None:
    """``ValueError`` of one sentence if nothing can be written in a folder, there or to be made: told before work, not after it.

    A file is written and removed where the folder is or would be made, and ``space`` bytes must be free there.
    """
    place = _standing(folder, name)
    if not place.is_dir():
        what = "is a file" if place == folder.absolute() else f"{str(place)!r} is a file"
        raise ValueError(f"{name} = {shown(str(folder))} must be a folder, or not be there yet, but {what}.")
    try:
        _probe(place)
        free = shutil.disk_usage(place).free
    except OSError as error:
        raise ValueError(f"{name} = {shown(str(folder))} must be a folder that can be written in: {error.strerror}.") from None
    if free < space:
        raise ValueError(f"{name} = {shown(str(folder))} must have {space / 1e6:g} MB free on its disk, but has {free / 1e6:.1f}.")


def _standing(path: Path, name: str) -> Path:
    """The path, or the nearest of the folders that are to hold it that is there."""
    whole = path.absolute()
    for place in (whole, *whole.parents):
        try:
            place.stat()
        except (FileNotFoundError, NotADirectoryError):
            continue
        except (OSError, ValueError) as error:  # too long a name, a zero byte, no right to look
            raise ValueError(f"{name} = {shown(str(path))} cannot be looked at: {getattr(error, 'strerror', error)}.") from None
        return place
    return Path(whole.anchor)


def _probe(folder: Path) -> None:
    """OSError if no file can be made in a folder, or nothing written to it."""
    path = folder / f".probe.{secrets.token_hex(4)}.part"
    try:
        path.write_bytes(bytes(PROBE))
    finally:
        path.unlink(missing_ok=True)


def check_file(path: Path, name: str, space: int = PICTURE) -> None:
    """As ``check_folder`` of the folder that is to hold a file; and the file's own name is no folder's."""
    check_folder(path.parent, name, space)
    if path.is_dir():
        raise ValueError(f"{name} = {str(path)!r} must be a file, or not be there yet, but is a folder.")


def check_picture(path: Path, name: str = "picture") -> None:
    """As ``check_file``; and it ends in .png, for that is what is drawn."""
    check_file(checked_path(name, path, PICTURES), name)


def read_json(path: Path) -> Any:
    """What a JSON file holds; ``ValueError`` names one that cannot be read, or is damaged."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ValueError(f"file {str(path)!r} cannot be read: {error.strerror}.") from None
    except (ValueError, RecursionError) as error:
        raise ValueError(f"file {str(path)!r} cannot be read: {error}.") from None


LONGEST_NAME = 255
"""Characters of a file's name: no more on any usual system."""


def as_path(name: str, value: Any) -> Path:
    """A path, or the text of one; ``ValueError`` names what is neither."""
    text = os.fspath(value) if isinstance(value, os.PathLike) else value
    if not isinstance(text, str) or "\0" in text or max(map(len, Path(text).parts), default=0) > LONGEST_NAME:
        raise Refused(name, value, "a path")
    return Path(text)


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


def read_rows(path: Path, what: str) -> list[tuple[int, list[str]]]:
    """The rows of a CSV file, each with the number of its line; ``what`` it is to be the file of.

    ``ValueError`` of one sentence names the file if it cannot be read, or is none.
    """
    try:
        with path.open(encoding="utf-8", newline="") as file:
            lines = csv.reader(file, strict=True)
            return [(lines.line_num, row) for row in lines]
    except OSError as error:
        raise ValueError(f"file {str(path)!r} cannot be read: {error.strerror}.") from None
    except (csv.Error, UnicodeDecodeError) as error:
        raise ValueError(f"file {str(path)!r} cannot be read as the CSV file of {what}: {error}.") from None
