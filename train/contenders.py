"""The classical controllers that agents are compared with, by name, each built from a plant."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

from baselines import LinearController, PersistentLoad, lqg, lqr, no_control, velocity_feedback
from beamenv.plant import Plant

CLASSICAL: MappingProxyType[str, Callable[[Plant], LinearController]] = MappingProxyType(
    {
        "none": no_control,
        "velocity": velocity_feedback,
        "lqg-thesis": lambda plant: lqg(plant, design="continuous"),
        "lqg": lqg,
        "lqg-load": lambda plant: lqg(plant, persistent_load=PersistentLoad()),
        "lqr": lqr,
        "lqr-load": lambda plant: lqr(plant, persistent_load=PersistentLoad()),
    }
)
"""Short names, as the command line takes them. The two LQR see the true state, which no real blade offers."""


def classical(name: str, plant: Plant) -> LinearController:
    """A controller by its short name; ``ValueError`` lists the known ones."""
    if name not in CLASSICAL:
        raise ValueError(f"controller = {name!r} must be one of {', '.join(CLASSICAL)}, or the folder of a trained agent.")
    return CLASSICAL[name](plant)
