"""A controller that is to be written: its diagram, and what a reader of the file must know of it."""

from __future__ import annotations

import keyword
import re
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

import beamenv
from baselines.design.controller import name_of
from beamenv.configuration import Choice, Refused, Text, checked
from beamenv.plant.fingerprint import fingerprint
from beamenv.plant.plant import Plant
from train.export.c_words import C_WORDS
from train.export.described import diagram_of
from train.export.diagram import Diagram

PRECISIONS = ("double", "single")

LONGEST = 31
"""Characters of a name: what C99 promises to tell apart of one that linkers see, less what is put behind it."""


@dataclass(frozen=True, slots=True, eq=False)
class Exported:
    """A controller's diagram with its names, plant and precision."""

    name: str
    """Of functions, types and files."""
    controller: str
    """What tables and figures call it."""
    source: Any
    """The controller itself."""
    diagram: Diagram
    plant: Plant
    precision: str
    note: str = ""
    """What else its reader is told."""

    @property
    def facts(self) -> dict[str, str]:
        """What stands in every file, in its order."""
        return {
            "controller": self.controller,
            **({"note": self.note} if self.note else {}),
            "design plant": f"fingerprint {fingerprint(self.plant)}",
            "interval": f"{self.plant.control_interval!r} s",
            **self._measured,
            **self._driven,
            "precision": self.precision,
            "written by": f"beamenv {beamenv.__version__}",
        }

    @property
    def _measured(self) -> dict[str, str]:
        """What each measurement is."""
        each = zip(self.plant.sensors, self.plant.sensor_full_scale, strict=True)
        shown = {f"sensors[{k}]": f"{of.name}, {of.unit}, clipped to ±{full:.9g}" for k, (of, full) in enumerate(each)}
        return {**shown, **{further.label: further.unit for further in self.diagram.inputs[1:]}}

    @property
    def _driven(self) -> dict[str, str]:
        """What each voltage is."""
        limits = self.plant.voltage_limits.T
        return {f"volts[{k}]": f"V, clipped to {low:.9g} … {high:.9g}" for k, (low, high) in enumerate(limits)}

    def check_range(self) -> None:
        """``ValueError`` for a number that its precision cannot hold."""
        if self.precision == "double":
            return
        for block in self.diagram.order:
            for value in (getattr(block, each.name) for each in fields(block)):
                if isinstance(value, np.ndarray) and np.abs(value).max(initial=0.0) > np.finfo(np.float32).max:
                    raise Refused(
                        "precision", self.precision, "double: a number of the controller is larger than single precision holds"
                    )


def exported(controller: Any, plant: Plant, *, precision: str = "double", name: str | None = None, note: str = "") -> Exported:
    """The controller as a diagram from what sensors show to voltages in V; ``ValueError`` says why one cannot be exported."""
    precision, note = checked("precision", precision, Choice(PRECISIONS)), checked("note", note, Text())
    title = name_of(controller)
    own = identifier(title) if name is None else _checked_name(name)
    return Exported(own, title, controller, diagram_of(controller, plant), plant, precision, note)


def identifier(title: str) -> str:
    """A name that C, Python and MATLAB take, made of any text."""
    plain = re.sub(r"\W+", "_", title, flags=re.ASCII).strip("_").lower()
    name = plain if plain[:1].isalpha() else f"law_{plain}"
    return name[:LONGEST] if not _taken(name) else f"law_{name}"


def _taken(name: str) -> bool:
    return name in C_WORDS or keyword.iskeyword(name)


def _checked_name(name: Any) -> str:
    plain = isinstance(name, str) and len(name) <= LONGEST and re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name)
    if not plain or _taken(name):
        raise Refused(
            "name", name, f"a letter, then letters, digits and underscores, {LONGEST} at most, and no word of C or Python"
        )
    return str(name)
