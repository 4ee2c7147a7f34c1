"""Which of a plant file's further loads and sensors a scenario and a blade ask for.

Both are told by tables: a load of one's own is the file's load of the same place, a sensor that is listed the file's of the same
fields, range and noise aside. The charges and currents of patches are those that every file has.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import BladeConfig
from beamenv.blade.presets import THESIS
from beamenv.configuration import Refused, read, shown
from beamenv.plant.modal_plant import ModalPlant
from beamenv.sensors.kinds import PatchCharge, PatchSensor, Sensor, StrainGauge
from beamenv.sensors.rows import SensorRows

Array = NDArray[np.float64]

_INSTRUMENT = ("range", "noise")
"""Fields of a sensor that say nothing of what it feels."""


def loads_of(model: ModalPlant, config: BladeConfig) -> Array:
    """(r, l): the modal forces of a blade's further loads; ``ValueError`` for one that the file has not."""
    there = read(THESIS, {"loads": json.loads(model.load_places or "[]")}, "plant").loads
    told = [asdict(each) for each in there]
    columns = [_found(f"scenario.loads[{k}]", asdict(each), told, "loads") for k, each in enumerate(config.loads)]
    return np.zeros((len(model.natural_frequencies), 0)) if model.further_loads is None else model.further_loads[:, columns]


def check_listed(model: ModalPlant, config: BladeConfig) -> None:
    """``ValueError`` for a sensor that is listed and that the file has not."""
    _places(model, config)


def rows_of(model: ModalPlant, config: BladeConfig, beam: SensorRows) -> SensorRows:
    """The rows of a blade's sensors by the file's modes, from those by the beam's trial functions.

    What modes beyond the file's add to the static state the file may tell; if not, it is the beam's of charges and gauges, which
    strains beneath patches make, and nothing of other sensors.
    """
    r, groups = len(model.natural_frequencies), config.patches.groups("sensors")
    first = np.cumsum([0, *(group.channels for group in groups)])
    position, rate, acceleration = np.zeros((3, len(beam.item), r))
    static_position, static_rate = np.array(beam.static_position), np.array(beam.static_rate)
    for k, (sensor, place) in enumerate(zip(config.sensors, _places(model, config), strict=True)):
        rows = beam.item == k
        if isinstance(sensor, PatchSensor):
            charges = model.charges[first[sensor.group] : first[sensor.group + 1]]
            (position if isinstance(sensor, PatchCharge) else rate)[rows] = charges
            continue
        known = model.sensor_position, model.sensor_rate, model.sensor_acceleration
        position[rows], rate[rows], acceleration[rows] = (part[place] for part in known)  # type: ignore[index] # all three are there
        given = (static_position, model.sensor_static, position), (static_rate, model.sensor_static_rate, rate)
        for static, told, seen in given:
            if told is not None:
                static[rows] = told[place]
            elif not isinstance(sensor, StrainGauge):
                static[rows] = seen[rows] @ (model.actuation / model.natural_frequencies[:, None] ** 2)
    none = np.zeros_like(rate)
    return replace(
        beam,
        position=position,
        rate=rate,
        acceleration=acceleration,
        coriolis=none,
        euler=none,
        static_position=static_position,
        static_rate=static_rate,
    )


def _places(model: ModalPlant, config: BladeConfig) -> list[int]:
    """Where in the file each of the sensors is; −1 of patches."""
    there = read(THESIS, {"sensors": json.loads(model.sensor_list)}, "plant").sensors if model.sensor_list else ()
    told = [_felt(each) for each in there]
    return [
        -1 if isinstance(each, PatchSensor) else _found(f"blade.sensors[{k}]", _felt(each), told, "sensors besides its patches")
        for k, each in enumerate(config.sensors)
    ]


def _felt(sensor: Sensor) -> dict[str, Any]:
    return {name: value for name, value in asdict(sensor).items() if name not in _INSTRUMENT}


def _found(name: str, wanted: dict[str, Any], told: Sequence[dict[str, Any]], what: str) -> int:
    """Which of the tables is the wanted one, numbers but for rounding."""
    for k, each in enumerate(told):
        if each.keys() == wanted.keys() and all(_alike(each[field], wanted[field]) for field in each):
            return k
    has = f"one of its {what}, {shown(list(told))}" if told else f"left out, for it has no {what}"
    raise Refused(name, wanted, has)


def _alike(one: Any, other: Any) -> bool:
    if one is None or other is None or isinstance(one, str):
        return bool(one == other)
    return np.shape(one) == np.shape(other) and bool(np.allclose(one, other, rtol=1e-9, atol=1e-12))
