"""The seeds that controllers are compared on, which nothing is trained or chosen on, and those that choose."""

from __future__ import annotations

from baselines.evaluation.episodes import MOST_SEEDS
from beamenv.configuration import Count

HELD_OUT = 1_000_000
"""The first of them: training draws from generators of its own."""

VALIDATION = 3_000_000
"""The first of those on which settings, checkpoints and contenders are chosen, on ``beamenv.knowledge.on_validation_bank``."""

SEEDS = Count(2, MOST_SEEDS)
"""How many of them: intervals need more than one episode."""


def held_out(seeds: int) -> range:
    """So many of them, the same for every controller."""
    return range(HELD_OUT, HELD_OUT + seeds)


def validation(seeds: int) -> range:
    """So many of those that choose."""
    return range(VALIDATION, VALIDATION + seeds)
