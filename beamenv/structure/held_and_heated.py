"""What of a blade's fields says how hot it is and how its tip is held: kinds, and what does not go together."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

from beamenv.configuration import Number, Numbers, Refused, checked
from beamenv.structure.planform import Steps, check_table
from beamenv.structure.walls.materials import Lamina

BLADE_KELVIN = Number(ge=100.0, le=5000.0, unit="K")
"""Lower ones, in which no blade turns, are degrees Celsius or Fahrenheit."""

DIFFERENCE = Number(ge=-5000.0, le=5000.0, unit="K")
SPRINGS = Numbers(
    Number(ge=0.0, le=1e15), least=6, most=6, of="stiffnesses: 3 (N/m) along lag, flap and span, 3 (N m/rad) about them"
)


def temperatures_of(temperature: float | None, table: Steps | None, difference: float, reference: float) -> Steps | None:
    """Shares of the span and the temperature (K) there, beside a difference that of the reference unless it is said; None: none."""
    if table is not None:
        return table
    hot = reference if temperature is None and difference else temperature
    return None if hot is None else ((0.0, hot), (1.0, hot))


class Material(Protocol):
    """Whatever has constants at a temperature."""

    def at(self, temperature_K: float) -> object:
        """The same at a temperature; ``Refused`` beyond its data."""
        ...


def check_data(beam: Any, materials: Iterable[Material], path: str) -> None:
    """``ValueError`` for a temperature of a beam's beyond the data of a material."""
    for material in dict.fromkeys(materials):
        for _, temperature in beam.temperatures or ():
            _check_at(material, temperature, f"{path}.{_said_by(beam)}")


def _check_at(material: Material, temperature: float, path: str) -> None:
    try:
        material.at(temperature)
    except Refused as error:
        at_fault = error.name != "temperature"
        allowed = f"one at which {error.name} is {error.allowed}, not {error.value:g}" if at_fault else error.allowed
        raise Refused(path, temperature, allowed) from None


def check_expansion(path: str, lamina: Lamina) -> None:
    """``ValueError`` for a lamina, called by its path, whose expansion is unknown."""
    try:
        _ = lamina.expansion
    except Refused as error:
        raise Refused(error.name.replace("material", path, 1), error.value, error.allowed) from None


def _said_by(beam: Any) -> str:
    """Which of its fields says how hot a beam is at its axis."""
    if beam.temperature_table is not None:
        return "temperature_table"
    return "reference_temperature" if beam.temperature is None else "temperature"


def check_held_and_heated(model: str, beam: Any, path: str = "beam") -> None:
    """``ValueError`` for a table that is none, and for heat or springs in the thesis' model."""
    if beam.temperature_table is not None:
        check_table(f"{path}.temperature_table", beam.temperature_table)
        for _, temperature in beam.temperature_table:
            checked(f"{path}.temperature_table", temperature, BLADE_KELVIN)
    if model != "thesis":
        return
    for name in ("temperature", "temperature_table", "temperature_difference"):
        if getattr(beam, name):
            raise Refused(f"{path}.{name}", getattr(beam, name), "left out with model = 'thesis', which knows no heat")
    if beam.tip_springs is not None and any(beam.tip_springs):
        raise Refused(f"{path}.tip_springs", list(beam.tip_springs), "None with model = 'thesis', whose tip is free")
