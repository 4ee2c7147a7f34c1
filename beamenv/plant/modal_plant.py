"""A plant by its modes alone: what a finite-element program or a modal test of a blade can hand over, and what files hold.

With the modal coordinates η, in √kg m, of r undamped modes of unit modal mass, at one rotor speed,

    η̈ + (G + 2ζω) η̇ + ω² η = F u + P d,        q = C η,        tip = T η

with u the actuator voltages (V), d the uniform line loads in lag and flap (N/m), q the charges of the sensors (C), whose rates
are the sensed currents, and the tip displacement in lag and flap (m). Signs of modes are free. Further loads act by ΨᵀP′ and are
told by tables of their places; further sensors show R η + S η̇ + T η̈ and are told by tables as in a blade's ``sensors``.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Count, Number, Refused, Text, checked
from beamenv.configuration.arrays import checked_array
from beamenv.configuration.read_only import ReadOnly

Array = NDArray[np.float64]

SKEW_WITHIN = 1e-9
"""Largest |G + Gᵀ| over the largest |G| or the first frequency: what is left of a skew matrix that a program has rounded."""

SLOWEST, FASTEST = 1e-3, 1e9
"""rad/s: natural frequencies beyond are a mistake of units."""

SENSED = ("sensor_position", "sensor_rate", "sensor_acceleration")
STATIC = ("sensor_static", "sensor_static_rate")
_NEEDED = ("gyroscopic", "actuation", "charges", "line_load", "tip")

_DAMPING = Number(ge=0.0, lt=1.0)


@dataclass(frozen=True, slots=True, eq=False)
class ModalPlant(ReadOnly):
    """r modes, m actuators, p sensors. Raises ``ValueError`` of one sentence for a part that is missing or cannot be."""

    natural_frequencies: Array
    """ω (r,), rad/s, ascending: of the undamped modes without gyroscopic coupling."""
    gyroscopic: Array
    """G = ΨᵀGΨ (r, r), 1/s, skew."""
    actuation: Array
    """F = ΨᵀF (r, m), √kg m/s² per V."""
    charges: Array
    """C = C_sΨ (p, r), C per √kg m; of a blade without sensor patches none."""
    line_load: Array
    """P = ΨᵀP (r, 2), √kg m/s² per N/m: lag, flap."""
    tip: Array
    """T (2, r), m per √kg m: lag, flap."""
    strain: Array | None = None
    """(k, r), spanwise strain per √kg m at points of the outer face; None: not known."""
    damping_ratio: Array | None = None
    """ζ (r,), or one number for all; None: the blade's configuration says."""
    speed: float | None = None
    """rad/s: the rotor speed at which the modes were found; None: any."""
    blade: str = ""
    """The blade that it is of: JSON of a table as in a blade's file, of fields that a configuration must have alike; "": any."""
    origin: str = ""
    """Where the numbers come from, in words."""
    further_loads: Array | None = None
    """P′ (r, l), per unit of each further load; None: there is none."""
    load_places: str = ""
    """Which these are: JSON of a list of tables as in a scenario's ``loads``, of their places."""
    sensor_position: Array | None = None
    """R (s, r), of each further sensor: what it shows of η."""
    sensor_rate: Array | None = None
    """S (s, r): what it shows of η̇."""
    sensor_acceleration: Array | None = None
    """T (s, r): what it shows of η̈."""
    sensor_static: Array | None = None
    """(s, m): what of R η and of modes that the file has not a constant volt shows in all; None: not known, no more than R η."""
    sensor_static_rate: Array | None = None
    """(s, m): likewise of S η, whose rate is shown."""
    sensor_list: str = ""
    """Which these are: JSON of a list of tables as in a blade's ``sensors``."""

    def __post_init__(self) -> None:
        r = _checked_frequencies(self)
        for name, shape, what in (
            ("gyroscopic", (r, r), "a row and a column for each mode"),
            ("actuation", (r, None), "a row for each mode, a column for each actuator"),
            ("charges", (None, r), "a row for each sensor, a column for each mode"),
            ("line_load", (r, 2), "a row for each mode, columns for lag and flap"),
            ("tip", (2, r), "rows for lag and flap, a column for each mode"),
            ("strain", (None, r), "a row for each point, a column for each mode"),
            ("further_loads", (r, None), "a row for each mode, a column for each load"),
            *((name, (None, r), "a row for each sensor, a column for each mode") for name in SENSED),
            *((name, (None, np.shape(self.actuation)[-1]), "a row for each sensor, a column for each actuator") for name in STATIC),
        ):
            if name == "charges" and np.shape(self.charges) == (0, r):  # of a blade that is read by other sensors
                _keep(self, name, np.zeros((0, r)))
            elif getattr(self, name) is not None or name in _NEEDED:
                _keep(self, name, _matrix(name, getattr(self, name), shape, what))
        _check_told(self, "load_places", None if self.further_loads is None else self.further_loads.shape[1], "further_loads")
        for name in (*SENSED, *STATIC):
            rows = getattr(self, name)
            if rows is not None or name in SENSED:
                _check_told(self, "sensor_list", None if rows is None else len(rows), name)
        skew, largest = (np.abs(part).max() for part in (self.gyroscopic + self.gyroscopic.T, self.gyroscopic))
        if skew > SKEW_WITHIN * max(largest, self.natural_frequencies[0]):
            raise ValueError(
                f"plant.gyroscopic differs from minus its transpose by {skew:.3g}, but must be skew: such forces do no work."
            )
        if self.damping_ratio is not None:
            _keep(self, "damping_ratio", _checked_damping(self.damping_ratio, r))
        if self.speed is not None:
            _keep(self, "speed", checked("plant.speed", self.speed, Number(ge=0.0, unit="rad/s")))
        _keep(self, "blade", _checked_blade(self.blade))
        _keep(self, "origin", checked("plant.origin", self.origin, Text()))
        ReadOnly.__post_init__(self)

    def __eq__(self, other: object) -> bool:
        """Of the same numbers and words."""
        if not isinstance(other, ModalPlant):
            return NotImplemented
        return all(np.array_equal(getattr(self, each.name), getattr(other, each.name)) for each in fields(self))

    def __hash__(self) -> int:
        return hash(self.natural_frequencies.tobytes())

    def first(self, modes: int | None) -> ModalPlant:
        """The plant of the first modes alone; None: of all. ``ValueError`` for more than there are."""
        if modes is None:
            return self
        modes = checked("modes", modes, Count(1, len(self.natural_frequencies)))
        damping = self.damping_ratio
        return replace(
            self,
            natural_frequencies=self.natural_frequencies[:modes],
            gyroscopic=self.gyroscopic[:modes, :modes],
            actuation=self.actuation[:modes],
            charges=self.charges[:, :modes],
            line_load=self.line_load[:modes],
            tip=self.tip[:, :modes],
            strain=None if self.strain is None else self.strain[:, :modes],
            further_loads=None if self.further_loads is None else self.further_loads[:modes],
            sensor_position=None if self.sensor_position is None else self.sensor_position[:, :modes],
            sensor_rate=None if self.sensor_rate is None else self.sensor_rate[:, :modes],
            sensor_acceleration=None if self.sensor_acceleration is None else self.sensor_acceleration[:, :modes],
            damping_ratio=None if damping is None else damping[:modes],
        )


def _keep(plant: ModalPlant, name: str, value: Any) -> None:
    object.__setattr__(plant, name, value)


def _checked_frequencies(plant: ModalPlant) -> int:
    """How many there are."""
    omega = _matrix("natural_frequencies", plant.natural_frequencies, (None,), "one for each mode")
    if np.any(omega < SLOWEST) or np.any(omega > FASTEST) or np.any(np.diff(omega) < 0.0):
        raise Refused("plant.natural_frequencies", omega.tolist(), f"numbers from {SLOWEST:g} to {FASTEST:g} (rad/s) that ascend")
    _keep(plant, "natural_frequencies", omega)
    return len(omega)


def _check_told(plant: ModalPlant, name: str, there: int | None, of: str) -> None:
    """``ValueError`` unless the text in one field lists as many tables as another field has loads or sensors."""
    text = checked(f"plant.{name}", getattr(plant, name), Text())
    try:
        tables = json.loads(text) if text else []
    except ValueError:
        tables = None
    if not isinstance(tables, list) or not all(isinstance(each, dict) for each in tables):
        raise Refused(f"plant.{name}", text, "empty or the text of a JSON list of objects")
    if len(tables) != (there or 0):
        raise ValueError(f"plant.{name} has {len(tables)} tables, but must have {there or 0}, as many as plant.{of} has.")
    _keep(plant, name, text)


def _checked_blade(given: Any) -> str:
    text = checked("plant.blade", given, Text())
    try:
        table = json.loads(text) if text else {}
    except ValueError:
        table = None
    if not isinstance(table, dict):
        raise Refused("plant.blade", given, "empty or the text of a JSON object, fields of a blade")
    return text


def _checked_damping(given: Any, modes: int) -> Array:
    if not isinstance(given, (list, tuple)) and np.ndim(given) == 0:
        return np.full(modes, checked("plant.damping_ratio", given, _DAMPING))
    ratios = _matrix("damping_ratio", given, (modes,), "one for each mode, or be one number")
    if np.any((ratios < 0.0) | (ratios >= 1.0)):
        raise Refused("plant.damping_ratio", ratios.tolist(), f"each {_DAMPING.allowed}")
    return ratios


def _matrix(name: str, given: Any, shape: tuple[int | None, ...], what: str) -> Array:
    """The numbers as float64, of the shape (None: one or more); ``ValueError`` for any others."""
    return checked_array(f"plant.{name}", given, shape, what)
