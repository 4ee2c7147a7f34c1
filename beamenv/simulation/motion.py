"""What blades did in a control interval."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Motion(NamedTuple):
    """What one control interval brought to each blade, in fresh arrays; "…" is N, or nothing for a single blade."""

    observation: Array
    """(…, p) sensor readings, clipped to full scale."""
    reward: Array
    """(…,)"""
    failed: NDArray[np.bool_]
    """(…,) strained beyond what the blade bears (``strain_limit``), or no longer finite."""
    volts: Array
    """(…, m), V, asked for, after saturation: what the patches get unless delay, hysteresis or failure are between."""
    tip_displacement: Array
    """(…, q), m: lag, flap, at the end of the interval; none where the plant does not tell."""
    energy: Array
    """(…,), J: vibration energy at the end of the interval."""
    effort: Array
    """(…,), J s: the actuators' share uᵀRu Δt of the cost increment."""
    cost_increment: Array
    """(…,), J s: ∫(xᵀQx + uᵀRu)dt over the interval."""
