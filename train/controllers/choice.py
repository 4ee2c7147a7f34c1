"""A controller by what a person types: its name, that of an agent that ships, or a trained agent's folder."""

from __future__ import annotations

from pathlib import Path

from baselines import Controller
from beamenv import Design
from train.controllers.named import discover, named
from train.controllers.policy_files import load_policy
from train.controllers.shipped import load_shipped, shipped


def chosen(name: str, design: Design, scenario: str, seed: int | None = None) -> Controller:
    """The controller for a design; of agents that ship, the one trained on the scenario, or else the generalist.

    Raises ``ValueError`` for an unknown one, or one trained on other plants than the design's.
    """
    if name not in discover():
        if Path(name).is_dir():
            return load_policy(Path(name), design.plant)
        if own := {each.scenario for each in shipped() if each.agent == name}:
            return load_shipped(name, scenario if scenario in own else "generalist", seed, design.plant)
    return named(name).build(design)
