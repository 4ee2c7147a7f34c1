"""What moves while episodes are unrolled, as tensors: taken for a checkpoint, and put back, so training goes on bit for bit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np
import torch
from torch import Tensor

from beamenv.scenarios.load_cases import LoadCases
from beamenv.simulation.blades import Blades, Electronics
from beamenv.simulation.plants.allotment import Allotment
from beamenv.simulation.signals.disturbances import SharedDisturbances
from beamenv.simulation.signals.faults import Faults
from train.learning.through_plant.windows import Windows

MOVING: Mapping[type[Any], tuple[str, ...]] = {
    Windows: ("_phase", "_loads", "_state", "_readings", "_memory", "_signals", "_faults", "_blades"),
    Blades: ("_joined", "plants", "_disturbances", "electronics"),
    SharedDisturbances: ("_rows", "_amplitude", "_steps", "_gusts", "_cases"),
    Electronics: ("faults", "memory"),
    LoadCases: tuple(each.name for each in fields(LoadCases)),
    Faults: tuple(each.name for each in fields(Faults)),
}
"""The attributes of each that are not the same from its construction on."""


def take(moving: Any) -> Any:
    """Tensors, lists and dictionaries that ``put`` makes the same again."""
    if moving is None:
        return None
    if isinstance(moving, Allotment):
        return take(moving.index)
    if isinstance(moving, np.ndarray):
        return torch.as_tensor(np.ascontiguousarray(moving).copy())
    if isinstance(moving, Tensor):
        return moving.detach().clone()
    if isinstance(moving, tuple):
        return [take(part) for part in moving]
    present = (name for name in MOVING[type(moving)] if hasattr(moving, name))  # perfect electronics have no faults
    return {name: take(getattr(moving, name)) for name in present}


def put(moving: Any, saved: Any) -> Any:
    """``moving`` as it was when ``saved`` was taken; arrays in place, for others are views of them."""
    if saved is None or (moving is None and isinstance(saved, Tensor)):
        return saved
    if isinstance(moving, Allotment):
        moving.allot(np.arange(len(saved)), saved.numpy())
        return moving
    if isinstance(moving, np.ndarray):
        if not moving.flags.writeable:
            return saved.numpy().astype(moving.dtype)
        moving[...] = saved.numpy()
        return moving
    if isinstance(saved, Tensor):
        return saved.clone()
    if isinstance(saved, list):
        parts = [put(part, own) for part, own in zip(moving or [None] * len(saved), saved, strict=True)]
        return type(moving)(*parts) if hasattr(moving, "_fields") else tuple(parts)
    for name, own in saved.items():
        object.__setattr__(moving, name, put(getattr(moving, name), own))
    return moving
