"""Blades as plain dictionaries and as files, JSON or TOML."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from beamenv.blade.config import BladeConfig, changed
from beamenv.blade.presets import THESIS


def to_dict(config: Any) -> dict[str, Any]:
    """A configuration as plain dictionaries, lists, numbers and strings: what JSON can hold."""
    plain: dict[str, Any] = json.loads(json.dumps(asdict(config)))
    return plain


def from_dict(values: Mapping[str, Any]) -> BladeConfig:
    """The configuration that ``to_dict`` wrote; fields left out take the thesis' values."""
    config: BladeConfig = changed(THESIS, values, "blade")
    return config


def load_config(path: str | Path) -> BladeConfig:
    """A blade from a JSON or TOML file (TOML needs Python 3.11)."""
    path = Path(path)
    if path.suffix == ".json":
        return from_dict(json.loads(path.read_text()))
    if path.suffix == ".toml":
        import tomllib

        return from_dict(tomllib.loads(path.read_text()))
    raise ValueError(f"path = {str(path)!r} must end in .json or .toml.")
