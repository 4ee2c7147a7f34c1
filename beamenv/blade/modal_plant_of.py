"""The modal plant of a blade, to be kept in a file: with its loads and its sensors."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.configuration import Instance, checked
from beamenv.plant.modal_plant import ModalPlant
from beamenv.sensors.kinds import PatchSensor

Array = NDArray[np.float64]


def modal_plant_of(config: BladeConfig) -> ModalPlant:
    """The true plant of a blade by its modes: what ``save_plant`` writes and ``plants.truth`` takes.

    It has the loads in ``config.loads`` and, of the sensors that are listed, those that are no patches; the strains of vibration,
    unless its limit is on the total. ``ValueError`` for what is no configuration, or a blade that cannot be.
    """
    blade = Blade(checked("config", config, Instance(BladeConfig)))
    modal, full, shapes = blade.true_modal, blade.full, blade.true_modal.mode_shapes
    return ModalPlant(
        natural_frequencies=modal.natural_frequencies,
        gyroscopic=modal.gyroscopic,
        actuation=shapes.T @ full.forces,
        charges=full.charges @ shapes,
        line_load=shapes.T @ full.line_load,
        tip=full.tip @ shapes,
        strain=None if config.strain_limit == "total" else full.strain @ shapes,
        damping_ratio=np.full(len(modal.natural_frequencies), config.damping_ratio),
        speed=config.speed,
        **further_signals(blade, shapes),
    )


def further_signals(blade: Blade, shapes: Array) -> dict[str, Any]:
    """The fields of a modal plant with mode shapes (N, r) that tell of further loads, and of sensors that are no patches."""
    loads = blade.config.loads
    acting = {"further_loads": shapes.T @ blade.further_loads, "load_places": _json([asdict(each) for each in loads])}
    return {**(acting if loads else {}), **_sensors(blade, shapes)}


def _sensors(blade: Blade, shapes: Array) -> dict[str, Any]:
    own, rows = blade.config.sensors, blade.sensor_rows
    told = [k for k, each in enumerate(own) if not isinstance(each, PatchSensor)]
    if rows is None or not told:
        return {}
    these = np.isin(rows.item, told)
    parts = {"position": rows.position, "rate": rows.rate, "acceleration": rows.acceleration}
    felt = [{name: value for name, value in asdict(own[k]).items() if name not in ("range", "noise")} for k in told]
    static = {"sensor_static": rows.static_position[these], "sensor_static_rate": rows.static_rate[these]}
    return {f"sensor_{name}": part[these] @ shapes for name, part in parts.items()} | static | {"sensor_list": _json(felt)}


def _json(tables: list[dict[str, Any]]) -> str:
    return json.dumps(tables) if tables else ""
