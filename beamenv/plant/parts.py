"""What the parts of a plant must be, each said in one sentence where it is not."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Number, Refused, checked
from beamenv.configuration.arrays import checked_array, real_numbers, shaped_array
from beamenv.plant.signals import usual_disturbances, usual_reference

Array = NDArray[np.float64]

_ROWS = ("natural_frequencies", "sensor_full_scale")
_EMPTY = ("D", "disturbance_input", "tip_displacement", "strain", "process_noise")
"""There may be no disturbance, no point whose displacement is known, and none whose strain is."""
_OTHERS = (
    *("control_interval", "interval", "electronic_states", "energy", "cross_weight", "reference_load", "time_scale"),
    *("disturbances", "sensors", "assumed"),
)
_ROUNDING = 1e-9
"""Of the largest entry: what an asymmetry or a negative eigenvalue may come to by rounding."""


def check_parts(plant: Any) -> None:
    """Each part as an array; ``ValueError`` for one that is none of real numbers, or of another number of dimensions."""
    for name in (each.name for each in fields(plant) if each.name not in _OTHERS):
        given = getattr(plant, name)
        there = _array(f"plant.{name}", given, 1 if name in _ROWS else 2, name in _EMPTY)
        if there is not given:
            object.__setattr__(plant, name, there)


def _array(name: str, given: Any, wanted: int, may_be_empty: bool) -> Array:
    if may_be_empty and (there := real_numbers(name, given)).ndim == wanted:
        return there
    return shaped_array(name, given, (None,) * wanted, "a row" if wanted == 1 else "rows and columns")


def half_squares(states: int, electronic: int) -> Array:
    """H (n, n) of the energy coordinates: ½ for each state but the last, electronic ones."""
    return np.diag(np.repeat([0.5, 0.0], [states - electronic, electronic]))


def checked_energy(given: Any, states: int, electronic: int) -> Array:
    """H (n, n), that of energy coordinates for None; ``ValueError`` unless it is symmetric and has no negative eigenvalue."""
    if given is None or (np.shape(given) not in ((), (states, states)) and _is_half_squares(given)):  # of a plant departed from
        return half_squares(states, electronic)
    energy = checked_array("plant.energy", given, (states, states), "a row and a column for each state")
    return not_negative("plant.energy", energy)


def checked_cross(given: Any, shape: tuple[int, ...]) -> Array:
    """N (n, m), zero for None, or where it was for a plant of another size."""
    if given is None or (np.shape(given) != shape and not np.any(given)):
        return np.zeros(shape)
    return checked_array("plant.cross_weight", given, shape, "a row for each state, a column for each voltage")


def _is_half_squares(given: Any) -> bool:
    there = isinstance(given, np.ndarray) and given.ndim == 2 and given.shape[0] == given.shape[1]
    return there and np.array_equal(given, half_squares(len(given), int(np.count_nonzero(np.diag(given) == 0.0))))


def not_negative(name: str, matrix: Array) -> Array:
    """A symmetric matrix without negative eigenvalues, as its symmetric part; ``ValueError`` for any other."""
    largest = float(np.abs(matrix).max(initial=0.0))
    if (skew := float(np.abs(matrix - matrix.T).max(initial=0.0))) > _ROUNDING * largest:
        raise ValueError(f"{name} differs from its transpose by {skew:.3g}, but must be symmetric.")
    lowest = float(np.linalg.eigvalsh(matrix).min(initial=0.0))
    if lowest < -_ROUNDING * largest:
        raise ValueError(f"{name} has the eigenvalue {lowest:.3g}, but must have none below 0.")
    return matrix if skew == 0.0 else np.asarray(0.5 * (matrix + matrix.T))


def checked_reference(given: Any, named: Any, disturbances: int) -> Array:
    """(k,), the usual ones of the ``named`` disturbances for None; ``ValueError`` unless none is negative and zeros come last."""
    signals = named if isinstance(named, tuple) and len(named) == disturbances else usual_disturbances(disturbances)
    usual = np.array(usual_reference(signals))
    if given is None:
        return usual
    loads = real_numbers("plant.reference_load", given)
    if loads.shape != usual.shape and loads.tolist() == usual_reference(tuple(named)):  # of a plant that this one departs from
        return usual
    fits = loads.shape == usual.shape and np.isfinite(loads).all() and not np.any(loads < 0.0)
    if not fits or np.any(np.diff((loads > 0.0).astype(int)) > 0):
        raise Refused("plant.reference_load", given, f"{disturbances} numbers, one for each disturbance, none below 0, zeros last")
    return loads


def check_clock(plant: Any, name: str) -> None:
    """``ValueError`` for an interval that is not positive and finite."""
    object.__setattr__(plant, name, checked(f"plant.{name}", getattr(plant, name), Number(gt=0.0, unit="s")))


def counts(B: Array, C: Array) -> str:
    """How many states, voltages and sensors, in words."""
    return f"{B.shape[0]} states, {B.shape[1]} voltages, {len(C)} sensors"


def span(first: float, last: float) -> str:
    """From the first frequency to the last, in words."""
    return f"{first:.4g} … {last:.4g} rad/s"
