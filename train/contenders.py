"""Controllers by name: the classical ones, each built from a plant, and trained agents."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType

from baselines import Controller, LinearController, PersistentLoad, lqg, lqr, no_control, velocity_feedback
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
        raise ValueError(
            f"controller = {name!r} must be one of {', '.join(CLASSICAL)}, an agent that ships, or the folder of a trained one."
        )
    return CLASSICAL[name](plant)


def contender(name: str, plant: Plant, scenario: str, seed: int | None = None) -> Controller:
    """A classical controller by its short name, a trained agent by its folder, or one that ships by its name.

    Of those that ship, it is the one trained on the scenario, or else the generalist. ``ValueError`` for an unknown one, or one
    trained on other plants than ``plant``.
    """
    if name in CLASSICAL:
        return classical(name, plant)
    from train.policy_files import load_policy
    from train.shipped import load_shipped, shipped

    if Path(name).is_dir():
        return load_policy(Path(name), plant)
    own = {each.scenario for each in shipped() if each.agent == name}
    if not own:
        return classical(name, plant)
    return load_shipped(name, scenario if scenario in own else "generalist", seed, plant)
