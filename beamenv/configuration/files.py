"""Tables as files: TOML and JSON through one reader, on every Python."""

from __future__ import annotations

import io
import json
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from beamenv.configuration.sentence import Refused

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ENDINGS = (".toml", ".json")

SCHEMA = "$schema"
"""What an editor reads of a JSON file, and nobody else."""


def read_table(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The table in a .toml or .json file.

    Raises ``ValueError`` of one sentence for a name that ends otherwise, for a file that cannot be read, with the position of
    what is wrong in it, and for one that holds no table.
    """
    path = checked_path("path", path, ENDINGS)
    try:
        text = content_of(path).decode("utf-8")
    except UnicodeDecodeError as error:
        raise ValueError(f"file {str(path)!r} cannot be read: {error}.") from None
    return parsed_table(text, str(path))


def checked_path(name: str, value: Any, endings: Sequence[str], allowed: str | None = None) -> Path:
    """A path with one of some endings; ``ValueError`` for another, and for what is no path."""
    text = os.fspath(value) if isinstance(value, (str, os.PathLike)) else value
    if not isinstance(text, str) or "\0" in text or Path(text).suffix not in endings:
        raise Refused(name, text, allowed or f"a file that ends in {' or '.join(endings)}")
    return Path(text)


def content_of(path: Path) -> bytes:
    """What is in a file; ``ValueError`` names one that cannot be read."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise ValueError(f"file {str(path)!r} cannot be read: {error.strerror}.") from None
    except MemoryError:
        raise ValueError(f"file {str(path)!r} cannot be read: it is larger than the memory.") from None


def parsed_table(text: str, source: str) -> dict[str, Any]:
    """The table in a text, JSON where the name of its source ends so and TOML otherwise; ``ValueError`` names the source."""
    try:
        content = json.loads(text) if source.endswith(".json") else tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # of syntax, and of integers of too many digits
        raise ValueError(f"file {source!r} cannot be read: {' '.join(str(error).split()).rstrip('.')}.") from None
    if not isinstance(content, dict):
        raise Refused(f"file {source!r}", content, "a table of fields")
    return {name: value for name, value in content.items() if name != SCHEMA}


def parsed_arrays(content: bytes, source: str) -> dict[str, Any]:
    """The arrays in the content of an .npz archive, no objects of Python's; ``ValueError`` of one sentence names its source."""
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as archive:  # which a single array is not
            return {key: archive[key] for key in archive.files}
    except Exception as error:  # noqa: BLE001 - a damaged archive makes zipfile, zlib and NumPy raise whatever comes first
        why = "it holds Python objects" if "Object arrays" in str(error) else "it is no .npz archive of arrays"
        raise ValueError(f"file {source!r} cannot be read: {why}.") from None


@contextmanager
def of_file(path: str | os.PathLike[str]) -> Iterator[None]:
    """Name the file in what is said of its content."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"file {str(path)!r}: {error}") from None
