"""Plants as python-control has systems, and back; ``control`` takes a second to import, so plants import this where it is used.

``Plant`` and ``SampledPlant`` hand themselves over; nothing of them is imported here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any, TypeVar

import control
import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.configuration.sentence import unknown_field

Array = NDArray[np.float64]
Plant = TypeVar("Plant", bound=Any)


def plant_to_control(plant: Any) -> control.StateSpace:
    """The plant from [voltages, line loads] to [currents, tip displacements]."""
    inputs, outputs = np.hstack([plant.B, plant.disturbance_input]), np.vstack([plant.C, plant.tip_displacement])
    feedthrough = np.zeros((len(outputs), inputs.shape[1]))
    feedthrough[: len(plant.C), : plant.B.shape[1]] = plant.D
    names = {"inputs": _numbered("voltage", plant.B.shape[1]) + _loads(plant), "outputs": _sensors(plant) + _tip(plant)}
    return control.ss(plant.A, inputs, outputs, feedthrough, **names)


def sampled_to_control(held: Any) -> control.StateSpace:
    """The sampled plant from [voltages, line loads], held over each interval, to currents."""
    feedthrough = np.hstack([held.D, np.zeros((len(held.C), held.disturbance_input.shape[1]))])
    k = held.disturbance_input.shape[1]
    loads = ["load_lag", "load_flap"] if k == 2 else _numbered("load", k)
    names = {"inputs": _numbered("voltage", held.B.shape[1]) + loads, "outputs": _numbered("current", len(held.C))}
    return control.ss(held.A, np.hstack([held.B, held.disturbance_input]), held.C, feedthrough, dt=held.interval, **names)


def plant_from_control(system: control.StateSpace, like: Plant, **changes: Any) -> Plant:
    """The plant whose system ``plant_to_control`` would give: dynamics from ``system``, all else from ``like`` and ``changes``.

    ``system`` has the inputs and outputs of ``like.to_control()`` and its states in energy coordinates, ½ xᵀx being joules; if it
    has another number of them than ``like``, ``changes`` must give the ``strain`` rows (k, n), and the cost is again the energy. It
    then has no ``electronic_states``, unless ``changes`` say how many of the last are such. Natural frequencies are taken to be the
    magnitudes of the blade's own poles, one of each pair. Raises ``ValueError`` for a sampled system,
    other numbers of inputs or outputs, a feedthrough that is not from voltages to currents, or strain rows of another length.
    """
    _check_changes(system, like, changes)
    (n, m), p, k, q = like.B.shape, len(like.C), like.disturbance_input.shape[1], len(like.tip_displacement)
    if system.dt not in (None, 0):
        raise ValueError(f"system has dt = {system.dt!r}, but must be in continuous time.")
    if (system.ninputs, system.noutputs) != (m + k, p + q):
        raise ValueError(
            f"system has {system.ninputs} inputs and {system.noutputs} outputs, but must have {m + k}, voltages and {k} line "
            f"loads, and {p + q}, currents and {q} tip displacements."
        )
    A, B, C, D = (np.array(part, dtype=np.float64) for part in (system.A, system.B, system.C, system.D))
    if np.any(D[p:]) or np.any(D[:, m:]):
        raise ValueError("system has a feedthrough from line loads or to tip displacements, but must have none.")
    strain = np.asarray(changes.pop("strain", like.strain), dtype=np.float64)
    if strain.ndim != 2 or strain.shape[1] != len(A):
        raise ValueError(f"strain has shape {strain.shape}, but must have rows of {len(A)} numbers, one for each state of system.")
    electronic = changes.pop("electronic_states", like.electronic_states if len(A) == n else 0)
    blade = len(A) - electronic
    own = {} if len(A) == n else {"state_weight": 0.5 * np.diag(np.arange(len(A)) < blade), "energy": None, "cross_weight": None}
    parts = {"A": A, "B": B[:, :m], "C": C[:p], "D": D[:p, :m], "disturbance_input": B[:, m:], "tip_displacement": C[p:]}
    frequencies = np.sort(np.abs(np.linalg.eigvals(A[:blade, :blade])))[::2]
    found = {"strain": strain, "natural_frequencies": frequencies, "electronic_states": electronic}
    return replace(like, **{**parts, **own, **found, **changes})


def sampled_from_control(system: control.StateSpace, like: Plant, **changes: Any) -> Plant:
    """The sampled plant whose system ``sampled_to_control`` would give: dynamics from ``system``, the rest from ``like``.

    ``system`` has the clock, inputs and outputs of ``like.to_control()`` and its states, to which the cost of an interval belongs;
    if it has another number of them, ``changes`` must give the ``cost`` (n+m+2, n+m+2). Raises ``ValueError`` for another clock,
    other numbers of inputs, outputs or states, and for a feedthrough that is not from voltages to currents.
    """
    _check_changes(system, like, changes)
    (_, m), p, k = like.B.shape, len(like.C), like.disturbance_input.shape[1]
    clock = getattr(system, "dt", None)
    if clock is not True and not (clock and np.isclose(clock, like.interval, rtol=1e-6)):
        raise ValueError(f"system has dt = {clock!r}, but must be sampled as like is, every {like.interval:g} s.")
    A, B, C, D = (np.array(part, dtype=np.float64) for part in (system.A, system.B, system.C, system.D))
    if D.shape != (p, m + k):
        raise ValueError(
            f"system has {D.shape[1]} inputs and {len(D)} outputs, but must have {m + k}, voltages and loads, and {p}."
        )
    if np.any(D[:, m:]):
        raise ValueError("system has a feedthrough from line loads, but must have none.")
    cost = np.asarray(changes.pop("cost", like.cost), dtype=np.float64)
    if cost.shape != (len(A) + m + k,) * 2:
        raise ValueError(
            f"cost has shape {cost.shape}, but must have {len(A) + m + k} rows and columns: states, voltages and loads."
        )
    parts = {"A": A, "B": B[:, :m], "C": C, "D": D[:, :m], "disturbance_input": B[:, m:], "cost": cost}
    return replace(like, **{**parts, **changes})


def _check_changes(system: Any, like: Any, changes: Mapping[str, Any]) -> None:
    """``ValueError`` for what is no system, and for a change of what ``like`` does not have."""
    if not isinstance(system, control.StateSpace):
        raise Refused("system", system, "a control.StateSpace")
    known = [each.name for each in fields(like)]
    for name in changes:
        if name not in known:
            raise unknown_field(type(like).__name__, name, known)


def _loads(plant: Any) -> list[str]:
    return ["load_" + each.name.replace(" ", "_") for each in plant.disturbances]


def _sensors(plant: Any) -> list[str]:
    return [each.name.replace("current ", "current").replace(" ", "_") for each in plant.sensors]


def _tip(plant: Any) -> list[str]:
    count = len(plant.tip_displacement)
    return ["tip_lag", "tip_flap"] if count == 2 else _numbered("tip", count)


def _numbered(name: str, count: int) -> list[str]:
    return [f"{name}{k}" for k in range(count)]
