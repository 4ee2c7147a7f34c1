"""Hysteresis of the actuators: the Prandtl–Ishlinskii operator (Brokate and Sprekels 1996), NumPy and torch alike.

    v = w₀ u + w Σⱼ Pⱼ[u],        Pⱼ[u](k) = max(u(k) − rⱼ, min(u(k) + rⱼ, Pⱼ(k−1)))

with J plays of equally spaced radii rⱼ = j R/(J+1), R being half of the drive's range, and one weight for them all. Rate
independent; from rest (Pⱼ = 0) a small voltage acts with the gain w₀, the larger limit with the gain 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import namespace

PLAYS = 8
_HALVINGS = 40


@dataclass(frozen=True, slots=True, eq=False)
class Hysteresis:
    """Radii and weights of one operator; voltages in any one unit."""

    radii: Any
    """(J,)"""
    direct: float
    """w₀"""
    weight: float
    """w of every play."""

    def convert(self, to_array: Callable[[Any], Any]) -> Hysteresis:
        """The same operator with its radii passed through ``to_array``."""
        return replace(self, radii=to_array(self.radii))

    def step(self, voltages: Any, plays: Any) -> tuple[Any, Any]:
        """Effective voltages (N, m) and the plays' outputs (N, m, J), from voltages (N, m) and the plays' last outputs."""
        array = namespace(voltages)
        upper, lower = voltages[..., None] + self.radii, voltages[..., None] - self.radii
        plays = array.maximum(lower, array.minimum(upper, plays))
        return self.direct * voltages + self.weight * plays.sum(-1), plays

    def inverse(self, effective: Any, plays: Any, lowest: Any, highest: Any) -> Any:
        """Voltages (N, m) within the limits (m,) that act as ``effective`` ones (N, m) after these plays, or come nearest.

        By bisection, for what acts rises with the voltage: to 2⁻⁴⁰ of the range.
        """
        array = namespace(effective)
        low, high = lowest + 0.0 * effective, highest + 0.0 * effective
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            more = self.step(middle, plays)[0] < effective
            low, high = array.where(more, middle, low), array.where(more, high, middle)
        return 0.5 * (low + high)


def prandtl_ishlinskii(loop: float, lowest: float, highest: float, plays: int = PLAYS) -> Hysteresis:
    """The operator whose loop, swept from ``lowest`` to ``highest``, is ``loop`` times its stroke wide at mid-range.

    With R half the range and M the larger limit: at mid-range a play's branches are 2 min(r, R − r) apart, its stroke is
    2(R − r), and w₀ M + w Σ (M − r) = M. No voltage within the limits so acts with a gain above 1.
    """
    half, larger = 0.5 * (highest - lowest), max(-lowest, highest)
    radii: NDArray[np.float64] = half * np.arange(1, plays + 1) / (plays + 1)
    lost = 2.0 * (1.0 - half / larger) * float(np.sum(radii))  # of the stroke, per weight, where the limits are not symmetric
    weight = loop * 2.0 * half / (float(np.sum(2.0 * np.minimum(radii, half - radii))) + loop * lost)
    direct = 1.0 - weight * float(np.sum(larger - radii)) / larger
    return Hysteresis(radii, direct, weight)
