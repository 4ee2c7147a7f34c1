"""Blades as plain dictionaries and as files, JSON or TOML."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any

from beamenv.blade.config import BladeConfig
from beamenv.blade.presets import THESIS
from beamenv.configuration import Refused, read
from beamenv.configuration.cache import departing
from beamenv.configuration.files import ENDINGS, of_file, read_table


def to_dict(config: Any) -> dict[str, Any]:
    """A configuration as plain dictionaries, lists, numbers and strings: what JSON can hold."""
    if not is_dataclass(config) or isinstance(config, type):
        raise Refused("config", config, "a configuration, such as a BladeConfig")
    plain: dict[str, Any] = json.loads(json.dumps(asdict(config)))
    return plain


def from_dict(values: Mapping[str, Any]) -> BladeConfig:
    """The configuration that ``to_dict`` wrote; fields left out take the thesis' values."""
    return read(THESIS, values)


def departures(config: BladeConfig) -> dict[str, Any]:
    """What of a blade is not as the thesis', as plain dictionaries, to nine digits: what keys are made of."""
    mine: dict[str, Any] = json.loads(json.dumps(to_dict(config)), parse_float=_to_nine_digits)
    return departing(mine, json.loads(json.dumps(to_dict(THESIS)), parse_float=_to_nine_digits))


def _to_nine_digits(number: str) -> float:
    return float(f"{float(number):.9g}")


def load_config(path: str | Path) -> BladeConfig:
    """A blade from a JSON or TOML file, fields left out as in the thesis; ``ValueError`` names the file and what is wrong in it."""
    content = read_table(path)
    with of_file(path):
        return from_dict(content)


def of_path(blade: Any) -> Any:
    """What the file says that a path, or text that ends as one, names; anything else as it is."""
    if isinstance(blade, Path) or (isinstance(blade, str) and blade.lower().endswith(ENDINGS)):
        return load_config(blade)
    return blade


def blade_schema() -> dict[str, Any]:
    """The JSON schema of a blade's files."""
    from beamenv.configuration.schema import json_schema

    return json_schema(BladeConfig)
