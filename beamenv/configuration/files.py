"""Tables as files: TOML and JSON through one reader, on every Python."""

from __future__ import annotations

import io
import json
import os
import re
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from beamenv.configuration.sentence import Refused, clause, shown

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ENDINGS = (".toml", ".json")

SCHEMA = "$schema"
"""What an editor reads of a JSON file, and nobody else."""

LARGEST = 1_000_000
"""Bytes of a table's file: a blade or a scenario has some thousand."""

DEEPEST = 100
"""Parts of a dotted key, more than any table here has: reading TOML takes time and memory as the square of their number."""

_PART = r"""(?:(?<![\w-])[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_TOO_DEEP = re.compile(rf"{_PART}(?:[ \t]*\.[ \t]*{_PART}){{{DEEPEST}}}")


def read_table(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The table in a .toml or .json file.

    It is UTF-8, with or without a byte-order mark. Raises ``ValueError`` of one sentence for a name that ends otherwise, for a file
    that cannot be read, with the position of what is wrong in it, for one of more than a megabyte, and for one that holds no table.
    """
    path = checked_path("path", path, ENDINGS)
    content = content_of(path, LARGEST + 1)
    _not_too_large(len(content), str(path))
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"file {shown(str(path))} cannot be read: {error}.") from None
    return parsed_table(text, str(path))


def checked_path(name: str, value: Any, endings: Sequence[str], allowed: str | None = None) -> Path:
    """A path with one of some endings, in small letters or capitals; ``ValueError`` for another, and for what is no path."""
    text = os.fspath(value) if isinstance(value, (str, os.PathLike)) else value
    if not isinstance(text, str) or "\0" in text or Path(text).suffix.lower() not in endings:
        raise Refused(name, text, allowed or f"a file that ends in {' or '.join(endings)}")
    return Path(text)


def content_of(path: Path, most: int = -1) -> bytes:
    """What is in a file, or the first so many bytes of it; ``ValueError`` names one that cannot be read."""
    try:
        with path.open("rb") as file:
            return file.read(most)
    except OSError as error:
        raise ValueError(f"file {shown(str(path))} cannot be read: {error.strerror}.") from None
    except MemoryError:
        raise ValueError(f"file {shown(str(path))} cannot be read: it is larger than the memory.") from None


def parsed_table(text: str, source: str) -> dict[str, Any]:
    """The table in a text, JSON where the name of its source ends so and TOML otherwise; ``ValueError`` names the source."""
    _not_too_large(len(text), source)
    try:
        content = _json(text) if source.lower().endswith(".json") else _toml(text)
    except (ValueError, RecursionError) as error:  # of syntax, and of integers of too many digits
        raise ValueError(f"file {shown(source)} cannot be read: {clause(error)}.") from None
    if not isinstance(content, dict):
        raise Refused(f"file {shown(source)}", content, "a table of fields")
    return {name: value for name, value in content.items() if name != SCHEMA}


def _not_too_large(size: int, source: str) -> None:
    if size > LARGEST:
        raise ValueError(f"file {shown(source)} is too large, but must have at most {LARGEST} bytes.")


def _toml(text: str) -> Any:
    if deep := _TOO_DEEP.search(text):
        where = text.count("\n", 0, deep.start()) + 1
        raise ValueError(f"a key on line {where} has more than the {DEEPEST} parts that are allowed")
    return tomllib.loads(text)


def _json(text: str) -> Any:
    return json.loads(text, object_pairs_hook=_each_once)


def _each_once(pairs: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """An object of JSON, whose keys are there once, as those of TOML are."""
    table: dict[str, Any] = {}
    for key, value in pairs:
        if key in table:
            raise ValueError(f"key {shown(key)} is there twice, but must be there once")
        table[key] = value
    return table


def parsed_arrays(content: bytes, source: str) -> dict[str, Any]:
    """The arrays in the content of an .npz archive, no objects of Python's; ``ValueError`` of one sentence names its source."""
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as archive:  # which a single array is not
            return {key: archive[key] for key in archive.files}
    except Exception as error:  # noqa: BLE001 - a damaged archive makes zipfile, zlib and NumPy raise whatever comes first
        why = "it holds Python objects" if "Object arrays" in str(error) else "it is no .npz archive of arrays"
        raise ValueError(f"file {shown(source)} cannot be read: {why}.") from None


@contextmanager
def of_file(path: str | os.PathLike[str]) -> Iterator[None]:
    """Name the file in what is said of its content."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"file {shown(str(path))}: {error}") from None
