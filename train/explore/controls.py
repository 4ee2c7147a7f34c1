"""The controls of the page of a blade: what each is called, what it goes through, and where it begins."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, TypeAlias, get_args

from beamenv.blade.config import BladeConfig
from beamenv.blade.files import departures
from beamenv.blade.layouts import SIDES, Side
from beamenv.blade.presets import THESIS
from beamenv.configuration import Choice, Number, Numbers, Text, checked
from beamenv.configuration.cache import key_of
from beamenv.patches.group import PatchGroup
from train.explore.along import as_table, as_text
from train.explore.blade import built, highest_speed
from train.explore.section_picture import first_patch
from train.explore.settings import Direction, Settings
from train.explore.units import unit_of

Value = float | list[float] | str
Control: TypeAlias = "Range | Options | Words"

ROUND_OFF = 1e-6
"""How far a slider's last step may lie beyond its end, over the end's size where that is more than 1."""
STEPS = 153
"""Of a slider for patches: the thesis' four, 51 of them apart, lie on its grid. Dash 4 counts what handles are apart in steps,
whatever it says."""
SPEED_STEPS = 80
PER_DECADE = 20
"""Steps of a logarithmic slider."""
BLADE, PATCHES, NOISE, WEIGHTS, LOAD = "Blade", "Patches", "Noise", "Weights of LQG", "Load"
GROUPS = (BLADE, PATCHES, NOISE, WEIGHTS, LOAD)
TABLES = {"twist_table": "twist table: share of span, degrees", "chord_table": "chord table: share of span, size over the root's"}
SHOWN = "Shown"
"""Group of what changes the picture and not the blade."""
PAIR = ("actuator", "sensor")


@dataclass(frozen=True, slots=True)
class Range:
    """What a slider goes through; with several values, one handle each."""

    label: str
    unit: str
    low: float
    high: float
    step: float
    value: float | list[float]
    apart: int = 0
    """Steps that keep handles from one another."""
    group: str = BLADE
    logarithmic: bool = False
    """Whether the slider is of the logarithm to base 10, and ``step`` of that; its ends and its value are not."""
    times: float = 1.0
    """How many of its unit make one of the settings'."""

    @property
    def kind(self) -> Number | Numbers:
        """What its value may be."""
        low, high = (ROUND_OFF * max(1.0, abs(end)) if not self.logarithmic else ROUND_OFF * end for end in (self.low, self.high))
        each = Number(ge=self.low - low, le=self.high + high, unit=self.unit)
        return Numbers(each, len(self.value), len(self.value)) if isinstance(self.value, list) else each

    @property
    def several(self) -> bool:
        """Whether it has a handle for each of several patches."""
        return isinstance(self.value, list)

    def setting(self, value: Any) -> Any:
        """A value in the unit of the settings, without the digits that rounding adds."""
        if isinstance(value, (list, tuple)):
            return tuple(self.setting(each) for each in value)
        return value if self.times == 1.0 else round(value / self.times, 9)

    def entries(self, name: str) -> list[str]:
        """Ids of the fields that take its values as numbers."""
        return [f"{name}-entry-{k}" for k in range(len(self.value))] if isinstance(self.value, list) else [f"{name}-entry"]


@dataclass(frozen=True, slots=True)
class Options:
    """What can be chosen from."""

    label: str
    options: tuple[str, ...]
    value: str
    group: str = LOAD

    @property
    def kind(self) -> Choice:
        """What its value may be."""
        return Choice(self.options)

    def setting(self, value: Any) -> Any:
        """A number where it is one."""
        return int(value) if value.isdecimal() else value

    def entries(self, name: str) -> list[str]:  # noqa: ARG002 - as a Range has it
        """It takes no numbers."""
        return []


@dataclass(frozen=True, slots=True)
class Words:
    """A table that is written as text; empty for none."""

    label: str
    name: str
    value: str
    group: str = BLADE

    @property
    def kind(self) -> Text:
        """What its value may be."""
        return Text()

    def setting(self, value: Any) -> Any:
        """The table."""
        return as_table(self.name, value)

    def entries(self, name: str) -> list[str]:  # noqa: ARG002 - as a Range has it
        """It takes no single numbers."""
        return []


@dataclass(frozen=True, slots=True)
class Page:
    """The blade that a page begins with, and its controls: of what it has, and has in one way that a control can change."""

    base: BladeConfig
    ranges: Mapping[str, Range]
    choices: Mapping[str, Options]
    tables: Mapping[str, Words]
    name: str = "blade"
    """What the blade is called: a preset, or a file."""

    @classmethod
    def of(cls, base: BladeConfig, name: str = "blade") -> Page:
        """That of a blade, and what it is called."""
        beam, highest = base.beam, highest_speed(base)
        found = {
            "ply_angle_deg": _plies(base),
            "speed": _within("rotor speed", "rad/s", 0.0, highest, highest / SPEED_STEPS, base.speed),
            "pretwist_deg": _within(
                "pretwist", "°", min(0.0, beam.pretwist_deg), max(90.0, beam.pretwist_deg), 1.0, beam.pretwist_deg
            ),
            "taper": _within("taper, root chord over tip chord", "", min(1.0, beam.taper), max(3.0, beam.taper), 0.05, beam.taper),
        }
        found |= dict(_all_patches(base))
        length = unit_of(0.1 * beam.length, "m")
        last = _rounded(length.per * beam.length)
        where = _rounded(length.per * first_patch(base))
        found |= {
            "white_load": _decades("white load, standard deviation", "N/m", base.white_load, NOISE, 100.0),
            "sensor_noise_fraction": _decades(
                "sensor noise, of full scale", "%", 100.0 * base.sensor_noise_fraction, NOISE, 100.0, times=100.0
            ),
            "strain_energy_weight": _decades("Q: weight of strain energy", "×", 1.0, WEIGHTS, 1000.0),
            "kinetic_energy_weight": _decades("Q: weight of kinetic energy", "×", 1.0, WEIGHTS, 1000.0),
            "actuator_energy_weight": _decades("R: weight of the actuators' energy", "×", 1.0, WEIGHTS, 1000.0),
            "station": Range("section at, from the root", length.name, 0.0, last, last / STEPS, where, 0, SHOWN, times=length.per),
        }
        blade = built(base)
        load = unit_of(blade.reference_load, "N/m")
        choices = {"load": Options(f"step load of {load(blade.reference_load, 3)} in", get_args(Direction), "flap")}
        for end, count in zip(PAIR, (blade.plant.B.shape[1], len(blade.plant.C)), strict=True):
            choices[end] = Options(end, tuple(str(k + 1) for k in range(count)), "1", "Bode")
        ranges = {each: entry for each, entry in found.items() if entry is not None}
        whole = {each: Words(label, each, as_text(getattr(beam, each))) for each, label in TABLES.items()}
        tables = whole if base.model != "thesis" else {}
        return cls(base, MappingProxyType(ranges), MappingProxyType(choices), MappingProxyType(tables), name)

    @property
    def key(self) -> str:
        """The blade's name with some digits that tell it from every other blade, as the page's link says it."""
        return f"{self.name}-{key_of(departures(self.base))[:8]}"

    @property
    def controls(self) -> Mapping[str, Control]:
        """Sliders, choices and tables by their ids."""
        return {**self.ranges, **self.choices, **self.tables}

    @property
    def start(self) -> dict[str, Value]:
        """The values that they begin with."""
        return {name: entry.value for name, entry in self.controls.items()}

    def checked(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Values as the controls can have them; ``ValueError`` names the first that is not."""
        return {name: checked(name, values[name], entry.kind) for name, entry in self.controls.items()}

    def settings(self, values: Mapping[str, Any]) -> Settings:
        """What the controls' values stand for; those where their controls began stay the blade's own.

        Raises ``ValueError`` for values that no control can have.
        """
        read, start = self.checked(values), self.start
        moved = [name for name, value in read.items() if _plain(value) != start[name]]
        given = {name: self.controls[name].setting(read[name]) for name in moved if _side(name) is None}
        for side in {side for name in moved if (side := _side(name))}:
            given[side] = sum((self.ranges[name].setting(read[name]) for name in self.ranges if _side(name) == side), ())
        return Settings(**given)


def _plain(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _side(name: str) -> Side | None:
    """Whose patches a slider moves, by its id."""
    return next((side for side in SIDES if name.partition("-")[0] == side), None)


def _within(label: str, unit: str, low: float, high: float, step: float, value: float) -> Range | None:
    return Range(label, unit, low, high, step, value) if low <= value <= high else None


def _decades(label: str, unit: str, value: float, group: str, either_way: float, times: float = 1.0) -> Range | None:
    """From so many times less to so many times more; none where there is nothing to multiply."""
    if value <= 0.0:
        return None
    value = float(f"{value:.12g}")
    return Range(label, unit, value / either_way, value * either_way, 1.0 / PER_DECADE, value, 0, group, True, times)


def _plies(base: BladeConfig) -> Range | None:
    """Where all plies of all walls have one angle, either way."""
    angles = {abs(angle) for _, each in base.beam.ply_angles_deg for angle in each}
    return _within("ply angle from the contour", "°", 0.0, 90.0, 1.0, angles.pop()) if len(angles) == 1 else None


def _all_patches(base: BladeConfig) -> Iterator[tuple[str, Range | None]]:
    """A slider for each group; none for a side one of whose groups has no room to move."""
    for side in SIDES:
        groups = base.patches.groups(side)
        found = [_patches(base, side, group, "" if len(groups) == 1 else f" {k}") for k, group in enumerate(groups, start=1)]
        if all(each is not None for each in found):
            yield from ((side if len(groups) == 1 else f"{side}-{k}", each) for k, each in enumerate(found, start=1))


def _patches(base: BladeConfig, side: Side, group: PatchGroup, number: str) -> Range | None:
    length = base.beam.length
    unit = unit_of(0.1 * length, "m")
    last = _rounded(unit.per * (group.outermost * length - group.length))
    step = _rounded(last / STEPS)
    where = {"top": "on top", "bottom": "below"}.get(group.wall, f"on the {group.wall} wall")
    edges = [_rounded(unit.per * edge) for edge in group.at(side, length)]
    if step <= 0.0:
        return None
    apart = math.ceil(unit.per * group.length / step)
    return Range(f"{side}{number} {where}, from the root at", unit.name, 0.0, last, step, edges, apart, PATCHES, times=unit.per)


def _rounded(value: float) -> float:
    return round(value, 6)


THESIS_PAGE = Page.of(THESIS, "thesis")
RANGES = THESIS_PAGE.ranges
