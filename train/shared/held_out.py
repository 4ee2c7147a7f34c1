"""The seeds that controllers are compared on, which nothing is trained or chosen on, and those that choose."""

from __future__ import annotations

from typing import Any

from baselines.evaluation.episodes import MOST_SEEDS
from beamenv.configuration import Count, Refused, checked

HELD_OUT = 1_000_000
"""The first of them: training draws from generators of its own."""

VALIDATION = 3_000_000
"""The first of those on which settings, checkpoints and contenders are chosen, on ``beamenv.knowledge.on_validation_bank``."""

RECORDED = VALIDATION + MOST_SEEDS
"""The first of those of episodes recorded for offline learning, on ``beamenv.knowledge.on_recording_bank``, unless others are asked
for: behind all that compare, tune (``beamenv.knowledge.TUNING``) and choose."""

SEEDS = Count(2, MOST_SEEDS)
"""How many of them: intervals need more than one episode."""


def held_out(seeds: int) -> range:
    """So many of them, the same for every controller."""
    return range(HELD_OUT, HELD_OUT + seeds)


def validation(seeds: int) -> range:
    """So many of those that choose."""
    return range(VALIDATION, VALIDATION + seeds)


def recorded(first: Any, episodes: int) -> range:
    """So many seeds from ``first`` on, of episodes to learn from; ``ValueError`` if one is for comparing, tuning or choosing."""
    first = checked("seed", first, Count(0, 2**63 - 1 - MOST_SEEDS))
    if first + episodes > HELD_OUT and first < RECORDED:
        reserved = f"on the seeds between, {HELD_OUT} to {RECORDED - 1}, controllers are compared, tuned and chosen"
        raise Refused("seed", first, f"at most {HELD_OUT - episodes} for {episodes} episodes, or at least {RECORDED}: {reserved}")
    return range(first, first + episodes)
