"""What settings of trainers may be: beyond these a training fails, learns nothing, or does something else than it is asked."""

from __future__ import annotations

from beamenv.configuration import Count, Number

BLADES = Count(1, 65_536)
"""Environments stepped together."""

INSTANTS = Count(1, 10_000)
"""Of a window, of an action that is held, between updates."""

UNITS = Count(1, 4096)
"""Of a layer."""

SAMPLES = Count(2, 10_000_000)
"""Of a gradient step, which normalises by their spread, and of a memory."""

PASSES = Count(1, 1000)
"""Over experience; runs side by side."""

SEEN = ("history", "oscillators", "estimate", "belief")
"""What agents of Stable-Baselines3 may be shown."""

RATE = Number(gt=0.0, le=1.0)
"""What would stand still at zero and overshoot beyond one: learning rates, discounts, clipped ratios."""

LOGARITHM = Number(ge=-20.0, le=2.0)
"""Of a standard deviation: Stable-Baselines3's own bounds, between which its exponential is of use."""
