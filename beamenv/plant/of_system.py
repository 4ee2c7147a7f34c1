"""A plant from a system of python-control and what is known besides."""

from __future__ import annotations

from typing import Any

import control

from beamenv.configuration import Refused
from beamenv.plant.matrices import PlantMatrices
from beamenv.plant.state_space import plant_of_arguments


def plant_of_system(system: control.StateSpace, about: dict[str, Any]) -> PlantMatrices:
    """The plant that ``state_space.plant_of_model`` makes of a system's matrices and clock, and of what is known ``about`` it."""
    if not isinstance(system, control.StateSpace):
        try:
            system = control.ss(system)
        except Exception:  # noqa: BLE001 - python-control complains of what is no system in ways of its own
            raise Refused("system", system, "a control.StateSpace, or what control.ss makes one of") from None
    if system.dt is True:
        raise ValueError("system has dt = True, but must say how long a sample is, in s, or be in continuous time.")
    for name in ("A", "B", "C", "D", "dt"):
        if name in about:
            raise Refused(name, about[name], "left out: system has its own")
    clock = None if system.dt in (None, 0) else float(system.dt)
    return plant_of_arguments({"A": system.A, "B": system.B, "C": system.C, "D": system.D, "dt": clock, **about})
