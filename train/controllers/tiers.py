"""Tiers of information: whose is which, as their files and the controllers themselves tell, and in one sentence what each is."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from baselines.design.controller import LEAST_TIER
from beamenv.configuration import Count, checked
from beamenv.configuration.files import of_file
from beamenv.knowledge import TRUTH
from beamenv.titles import LEARNT as LEARNT
from beamenv.titles import TIERS
from train.controllers.policy_files import read_about
from train.controllers.runs import AGENT

TIER = "tier"
"""What an agent's own file tells; agents that ship tell none, and are of tier ``LEARNT``."""


def tiers_told() -> str:
    """What the tiers are."""
    known = ", ".join(f"{tier} {what}" for tier, what in TIERS.items())
    return (
        f"Tiers say what a controller is told and sees, each what those below it are too: {known}. "
        f"Tier {TRUTH}, which no real blade offers, is a reference and no rival."
    )


def told_tier(folder: Path) -> int | None:
    """The tier that an agent's own file tells; None if it tells none."""
    about = read_about(folder)
    with of_file(folder / AGENT):
        return checked(TIER, about[TIER], Count(0, TRUTH - 1)) if TIER in about else None


def own_tier(controller: Any) -> int:
    """Of a caller's controller: that of what it sees, and at least that of agents, for nobody knows what it was made from."""
    return max(LEARNT, LEAST_TIER.get(getattr(controller, "observes", "observation"), 0))
