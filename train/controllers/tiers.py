"""Tiers of information as tables show them: the agents', and in one sentence what each is."""

from __future__ import annotations

from beamenv.knowledge import TIERS, TRUTH

LEARNT = 1
"""The tier of agents: what they train on is the scenario's distribution, and they see the readings alone."""

TIER = "tier"
"""What an agent's own file tells; agents that ship tell none, and are of tier ``LEARNT``."""


def tiers_told() -> str:
    """What the tiers are."""
    known = ", ".join(f"{tier} {what}" for tier, what in TIERS.items())
    return (
        f"Tiers say what a controller is told and sees, each what those below it are too: {known}. "
        f"Tier {TRUTH}, which no real blade offers, is a reference and no rival."
    )
