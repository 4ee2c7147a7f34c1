"""What the title line of a picture says: scenario, controller and seed."""

from __future__ import annotations

from beamenv.scenarios.scenario import SCENARIOS, Scenario

BETWEEN = "  ·  "
LONGEST = 10
"""Digits of a seed that is worth telling; a longer one was drawn by the machine."""
MOST = 200
"""Letters of a controller's name."""


def in_a_line(*parts: str) -> str:
    """Those that are not empty."""
    return BETWEEN.join(part for part in parts if part)


def of_episode(controller: str, seed: int, episode: int, blade: int | None = None) -> str:
    """Who acts, and the seed with how many episodes it has begun and which blade of a batch it is, where that matters."""
    known = f"seed {seed}" if 0 <= seed < 10**LONGEST else ""
    which = [known] if known else []
    which += [f"episode {episode}"] if episode > 1 or not known else []
    which += [] if blade is None else [f"blade {blade + 1}"]
    return in_a_line(str(controller)[:MOST], ", ".join(which))


def named_scenario(scenario: Scenario) -> str:
    """Its name, or that it is one of the user's own."""
    return next((f"scenario {name}" for name, each in SCENARIOS.items() if each == scenario), "scenario of one's own")
