"""What blades did in a control interval."""

from __future__ import annotations

from typing import Any, NamedTuple


class Motion(NamedTuple):
    """What one control interval brought to each blade, in fresh arrays or tensors; "…" is N, or nothing for a single blade."""

    observation: Any
    """(…, p) sensor readings, clipped to full scale."""
    reward: Any
    """(…,)"""
    failed: Any
    """(…,) strained beyond what the blade bears (``strain_limit``), or no longer finite."""
    volts: Any
    """(…, m), V, asked for, after saturation: what the patches get unless delay, hysteresis or failure are between."""
    tip_displacement: Any
    """(…, q), m: lag, flap, at the end of the interval; none where the plant does not tell."""
    energy: Any
    """(…,), J: vibration energy at the end of the interval."""
    effort: Any
    """(…,), J s: the actuators' share uᵀRu Δt of the cost increment."""
    cost_increment: Any
    """(…,), J s: ∫(xᵀQx + uᵀRu)dt over the interval."""
