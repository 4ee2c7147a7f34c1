"""Named blades, and blades that depart from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np

from beamenv.blade.config import ON_EVERY_WALL, BeamConfig, BladeConfig
from beamenv.blade.lab_presets import AIRFOIL_BLADE, ALUMINIUM_CANTILEVER, TAKACS_BEAM
from beamenv.configuration import read, unknown_name
from beamenv.patches import PatchLayout
from beamenv.patches.layout import OUTERMOST
from beamenv.plant.signals import REFERENCE_LOAD

THESIS = BladeConfig()
SOUND_EDGES = tuple(np.linspace(THESIS.beam.depth, OUTERMOST * THESIS.beam.length - THESIS.patches.length, 4).tolist())
"""m: equally spaced as the thesis' patches are, the first one a section's depth away from the clamp."""
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
    reference_load=REFERENCE_LOAD,
)
SOUND = replace(
    THESIS,
    beam=BeamConfig(ply_angles_deg=((ON_EVERY_WALL, (75.0, -75.0) * 3),)),
    patches=PatchLayout(actuators=SOUND_EDGES, sensors=SOUND_EDGES),
    speed=100.0,
    strain_limit="total",
)

PRESETS: Mapping[str, BladeConfig] = MappingProxyType(
    {
        "thesis": THESIS,
        "sound-blade": SOUND,
        "thesis-untwisted": replace(THESIS, beam=BeamConfig(pretwist_deg=0.0)),
        "thesis-pretwisted": replace(THESIS, beam=BeamConfig(presetting_deg=30.0)),
        "chandra-chopra": CHANDRA_CHOPRA,
        "aluminium-cantilever": ALUMINIUM_CANTILEVER,
        "takacs-beam": TAKACS_BEAM,
        "airfoil-blade": AIRFOIL_BLADE,
    }
)
"""``beamenv.titles.BLADES`` says what each is; those that lie on benches are in ``lab_presets``. The MFC of chandra-chopra is the
M-8507-P1.

No real blade could turn as the thesis' does: at 200 rad/s its tip moves at 445 m/s, faster than sound, and its steady rotation
alone strains its outer face by 2.8 %, stretches it by 32 mm and unwinds half of its pretwist. Its patches are rated for 0.45 %, and
a ply of AS4/3501-6 breaks at 1.4 % along and 0.44 % across its fibres (Soden, Hinton and Kaddour 1998). What is limited there is
the strain of vibration alone.

sound-blade: the same box and hub, as a blade that could be built. Plies at ±75°, 15° either way of the span, so that fibres carry
the centrifugal pull: the outer face is strained by 0.03 % at 100 rad/s, where the tip moves at 223 m/s as a helicopter's does (a
UH-60A's at 221), and by 0.27 % at 300 rad/s, to which the scenario spin-up takes it. Its limit is on the total strain. The first
patches begin a section's depth away from the clamp. 1500 V on all patches move the tip as far as 2.7 to 4.9 N/m of line load do,
whichever way it is to go; on the thesis' blade as far as 1.3 to 6.3 N/m. The first mode is at 231, the eleventh at 5551 rad/s,
below the Nyquist frequency, 6283 rad/s."""


def blade_config(
    preset: str = "thesis", overrides: BladeConfig | Mapping[str, Any] | None = None, speed: float | None = None
) -> BladeConfig:
    """A preset with changes: a whole ``BladeConfig`` replaces it, a (nested) dictionary changes the fields it names.

    Raises ``ValueError`` for an unknown preset or field and for a value that is not allowed.
    """
    if not isinstance(preset, str) or preset not in PRESETS:
        raise unknown_name("preset", preset, PRESETS)
    config = PRESETS[preset] if overrides is None else read(PRESETS[preset], overrides)
    return config if speed is None else replace(config, speed=speed)
