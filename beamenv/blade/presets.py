"""Named blades, and blades that depart from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np

from beamenv.blade.config import BeamConfig, BladeConfig
from beamenv.configuration import Refused, read
from beamenv.patches import PatchLayout

THESIS = BladeConfig()
CHANDRA_CHOPRA = BladeConfig(
    beam=BeamConfig(
        length=0.84455,
        width=(0.953 - 0.030) * 0.0254,
        depth=(0.537 - 0.030) * 0.0254,
        thickness=0.030 * 0.0254,
        hub_radius=0.06985,
        material="as4-3501-6",
        ply_angles_deg=(
            ("top", (60.0,) * 6),
            ("bottom", (-60.0,) * 6),
            ("left", (60.0, -60.0) * 3),
            ("right", (60.0, -60.0) * 3),
        ),
        pretwist_deg=0.0,
    ),
    patches=PatchLayout(width=0.007),
    speed=2.0 * np.pi * 1000.0 / 60.0,
)

PRESETS: Mapping[str, BladeConfig] = MappingProxyType(
    {
        "thesis": THESIS,
        "thesis-untwisted": replace(THESIS, beam=BeamConfig(pretwist_deg=0.0)),
        "thesis-pretwisted": replace(THESIS, beam=BeamConfig(presetting_deg=30.0)),
        "chandra-chopra": CHANDRA_CHOPRA,
    }
)
"""thesis: θ = 30°, pretwist 30°, 200 rad/s, four MFC actuators over four sensors; thesis-untwisted: Figs. 5.10–5.12;
thesis-pretwisted: with 30° presetting too, Figs. 5.2 and 5.7; chandra-chopra: the CAS box of Table 3.2 at 1000 rev/min with
7 mm wide MFC (M-8507-P1)."""


def blade_config(
    preset: str = "thesis", overrides: BladeConfig | Mapping[str, Any] | None = None, speed: float | None = None
) -> BladeConfig:
    """A preset with changes: a whole ``BladeConfig`` replaces it, a (nested) dictionary changes the fields it names.

    Raises ``ValueError`` for an unknown preset or field and for a value that is not allowed.
    """
    if not isinstance(preset, str) or preset not in PRESETS:
        raise Refused("preset", preset, f"one of {', '.join(PRESETS)}")
    config = PRESETS[preset] if overrides is None else read(PRESETS[preset], overrides)
    return config if speed is None else replace(config, speed=speed)
