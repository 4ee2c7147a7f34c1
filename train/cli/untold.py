"""What a blade's file leaves to the default blade, in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

OF_A_BOX = {"beam.width": "m", "beam.depth": "m", "beam.thickness": "m"}
"""What a file with a section of its own need not have."""

SIDES = ("patches.actuators", "patches.sensors")


def left_out(table: Mapping[str, Any]) -> list[str]:
    """Of what tells one blade from another, the fields that a file's table lacks, each with the default blade's value."""
    from beamenv.blade.files import to_dict
    from beamenv.blade.presets import THESIS

    default = to_dict(THESIS)
    return [_told(name, unit, _at(default, name)) for name, unit in _asked(table) if _at(table, name) is None]


def _asked(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    yield "beam.length", "m"
    if _at(table, "beam.section") is None:
        yield from OF_A_BOX.items()
    yield from (("beam.hub_radius", "m"), ("beam.material", ""), ("beam.ply_angles_deg", "°"))
    if _at(table, "beam.twist_table") is None:
        yield "beam.pretwist_deg", "°"
    yield "speed", "rad/s"
    yield from ((side, "") for side in SIDES)
    yield "voltage_limits", "V"


def _at(table: Any, name: str) -> Any:
    for part in name.split("."):
        table = table.get(part) if isinstance(table, Mapping) else None
    return table


def _told(name: str, unit: str, value: Any) -> str:
    if name == "beam.ply_angles_deg":
        value = value[0][1]
    text = " … ".join(f"{each:g}" for each in value) if name == "voltage_limits" else _text(value)
    return f"{name} {text}{'' if unit == '°' else ' '}{unit}".rstrip()


def _text(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(f"{each:g}" for each in value)
    return f"{value:g}" if isinstance(value, float) else str(value)
