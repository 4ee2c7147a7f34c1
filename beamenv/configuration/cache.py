"""What took long to work out is kept in the user's cache, under a key of all that it depends on."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from beamenv.configuration.writing import write_whole


def kept_at(name: str, *depends_on: Any) -> Path:
    """Where it lies: in ``$BEAMENV_CACHE``, or ``beamenv`` in ``$XDG_CACHE_HOME`` or ``~/.cache``; the key is of JSON's values."""
    home = os.environ.get("BEAMENV_CACHE") or Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "beamenv"
    return Path(home) / f"{name}-{key_of(*depends_on)}.json"


def key_of(*depends_on: Any) -> str:
    """24 hexadecimal digits that change with any of JSON's values."""
    return hashlib.sha256(json.dumps(list(depends_on), sort_keys=True).encode()).hexdigest()[:24]


def departing(table: Mapping[str, Any], usual: Mapping[str, Any]) -> dict[str, Any]:
    """What of a table is not as usual: a field that is yet to come leaves the key of what does without it as it is."""
    own = {name: value for name, value in table.items() if name not in usual or value != usual[name]}
    both = {name for name, value in own.items() if isinstance(value, Mapping) and isinstance(usual.get(name), Mapping)}
    return {name: departing(value, usual[name]) if name in both else value for name, value in own.items()}


def keep(path: Path, content: Any) -> None:
    """Write it as JSON; a cache that cannot be written to is ignored."""
    with suppress(OSError):
        write_whole(path, json.dumps(content))
