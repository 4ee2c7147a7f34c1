"""What of a blade's fields says how hot it is and how its tip is held: kinds, and what does not go together."""

from __future__ import annotations

from beamenv.configuration import Number, Numbers, Refused
from beamenv.structure.geometrically_exact.heat import Heat
from beamenv.structure.planform import Steps, check_table

ROOM = 293.15
"""K, 20 °C: at which blades are free of thermal strain unless said otherwise."""

KELVIN = Number(gt=0.0, le=5000.0, unit="K")
DIFFERENCE = Number(ge=-5000.0, le=5000.0, unit="K")
SPRINGS = Numbers(
    Number(ge=0.0, le=1e15), least=6, most=6, of="stiffnesses: 3 (N/m) along lag, flap and span, 3 (N m/rad) about them"
)


def temperatures_of(temperature: float | None, table: Steps | None) -> Steps | None:
    """Shares of the span and the temperature (K) there; None where there is none."""
    if table is not None:
        return table
    return None if temperature is None else ((0.0, temperature), (1.0, temperature))


def heat_of(temperatures: Steps | None, reference: float, difference: float) -> Heat | None:
    """What heats a blade, or None."""
    return None if temperatures is None else Heat(reference, difference)


def check_held_and_heated(
    model: str, temperatures: Steps | None, difference: float, springs: tuple[float, ...] | None, path: str = "beam"
) -> None:
    """``ValueError`` for a difference of temperature beside no temperature, and for either or springs in the thesis' model."""
    if temperatures is not None:
        check_table(f"{path}.temperature_table", temperatures, least=0.0)
    if difference and temperatures is None:
        raise Refused(f"{path}.temperature_difference", difference, "0 where the blade has no temperature (K)")
    if model != "thesis":
        return
    if temperatures is not None:
        hot = [list(each) for each in temperatures]
        raise Refused(f"{path}.temperature", hot[0][1], "None with model = 'thesis', which knows no heat")
    if springs is not None and any(springs):
        raise Refused(f"{path}.tip_springs", list(springs), "None with model = 'thesis', whose tip is free")
