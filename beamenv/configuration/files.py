"""Tables as files: TOML and JSON through one reader, on every Python."""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Iterator
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


def read_table(path: str | Path) -> dict[str, Any]:
    """The table in a .toml or .json file.

    Raises ``ValueError`` of one sentence for a name that ends otherwise, for a file that cannot be read, with the position of
    what is wrong in it, and for one that holds no table.
    """
    path = Path(path)
    if path.suffix not in ENDINGS:
        raise Refused("path", str(path), f"a file that ends in {' or '.join(ENDINGS)}")
    try:
        return parsed_table(path.read_text(encoding="utf-8"), str(path))
    except OSError as error:
        raise ValueError(f"file {str(path)!r} cannot be read: {error.strerror}.") from None
    except UnicodeDecodeError as error:
        raise ValueError(f"file {str(path)!r} cannot be read: {error}.") from None


def parsed_table(text: str, source: str) -> dict[str, Any]:
    """The table in a text, JSON where the name of its source ends so and TOML otherwise; ``ValueError`` names the source."""
    try:
        content = json.loads(text) if source.endswith(".json") else tomllib.loads(text)
    except (json.JSONDecodeError, tomllib.TOMLDecodeError, RecursionError) as error:
        raise ValueError(f"file {source!r} cannot be read: {error}.") from None
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
def of_file(path: str | Path) -> Iterator[None]:
    """Name the file in what is said of its content."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"file {str(path)!r}: {error}") from None
