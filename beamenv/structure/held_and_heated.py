"""What of a blade's fields says how hot it is and how its tip is held: kinds, and what does not go together."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

from beamenv.configuration import Number, Numbers, Refused
from beamenv.structure.planform import Steps, check_table

KELVIN = Number(gt=0.0, le=5000.0, unit="K")
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


def check_data(temperatures: Steps | None, materials: Iterable[Material], path: str) -> None:
    """``ValueError`` for a temperature beyond the data of a material."""
    if temperatures is None:
        return
    try:
        for material in dict.fromkeys(materials):
            for _, temperature in temperatures:
                material.at(temperature)
    except Refused as error:
        raise Refused(f"{path}.temperature", error.value, error.allowed) from None


def check_held_and_heated(model: str, temperatures: Steps | None, springs: tuple[float, ...] | None, path: str = "beam") -> None:
    """``ValueError`` for a table that is none, and for heat or springs in the thesis' model."""
    if temperatures is not None:
        check_table(f"{path}.temperature_table", temperatures, least=0.0)
    if model != "thesis":
        return
    if temperatures is not None:
        raise Refused(f"{path}.temperature", temperatures[0][1], "None with model = 'thesis', which knows no heat")
    if springs is not None and any(springs):
        raise Refused(f"{path}.tip_springs", list(springs), "None with model = 'thesis', whose tip is free")
