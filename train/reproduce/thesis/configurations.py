"""What every study is computed from: the thesis' box, the validation box of Table 3.2, and the few quantities it leaves open."""

from __future__ import annotations

from dataclasses import dataclass, replace

from beamenv.blade.config import ON_EVERY_WALL, BeamConfig
from beamenv.blade.presets import CHANDRA_CHOPRA
from beamenv.patches import PatchLayout
from beamenv.plant.signals import REFERENCE_LOAD
from beamenv.structure import RotatingBeam
from train.reproduce.thesis.equations import Reading
from train.reproduce.thesis.sheets import layout_by

WORLD = "thesis"
"""The model of every blade here: the thesis' wall kinematics, about the blade at rest, and its plant."""

CONSISTENT = "consistent"
"""The shear flow unless a study says otherwise: a closed cell asks for it. The thesis' own is judged beside it."""

PLIES = 6

Plies = tuple[tuple[str, tuple[float, ...]], ...]


def plies(angle_deg: float) -> tuple[float, ...]:
    """Six plies at one angle."""
    return (float(angle_deg),) * PLIES


def every_wall(angle_deg: float) -> Plies:
    """The circumferentially uniform stiffness (CUS) of the thesis."""
    return ((ON_EVERY_WALL, plies(angle_deg)),)


def antisymmetric(angle_deg: float) -> Plies:
    """The circumferentially antisymmetric stiffness (CAS): top and bottom mirrored, sides alternating."""
    alternating = (float(angle_deg), -float(angle_deg)) * (PLIES // 2)
    return (("top", plies(angle_deg)), ("bottom", plies(-angle_deg)), ("left", alternating), ("right", alternating))


def built(blade: BeamConfig, layout: PatchLayout | None = None) -> RotatingBeam:
    """The blade in the thesis' world, with the inlays of passive patches when a layout is given."""
    return blade.build(layout, WORLD)


@dataclass(frozen=True, slots=True)
class Model:
    """Everything the studies are computed from; change a field and the verdicts may change."""

    box: BeamConfig = BeamConfig(ply_angles_deg=every_wall(0.0), pretwist_deg=0.0, shear_flow=CONSISTENT)
    """The thesis' box, untwisted, θ = 0: c = 0.127 m and b = 0.0254 m are halves of its mid-line, R₀ = 0.1 L."""
    validation_box: BeamConfig = replace(CHANDRA_CHOPRA.beam, shear_flow=CONSISTENT)
    """The box of Chandra and Chopra, top and bottom mirrored, fibres at 30° from the span."""
    speed: float = 200.0
    """rad/s, where a caption gives none."""
    load: float = REFERENCE_LOAD
    """N/m of uniform step: the thesis names no load (but 500 kg/m in chapter 6); with this one ±1500 V matters."""
    damping_ratio: float = 0.01
    """Of every mode, as in chapter 6."""
    reading: Reading = ()
    """Equations that are taken as the thesis has them (``readings.read_by``)."""

    def blade(self, angle_deg: float = 0.0, **changes: float | str | int) -> BeamConfig:
        """The thesis' box with all plies at ``angle_deg`` and other fields of ``BeamConfig`` changed."""
        return replace(self.box, ply_angles_deg=every_wall(angle_deg), **changes)  # type: ignore[arg-type]

    def beam(self, angle_deg: float = 0.0, **changes: float | str | int) -> RotatingBeam:
        """That blade, without patches."""
        return built(self.blade(angle_deg, **changes))

    def layout(self, layout: PatchLayout) -> PatchLayout:
        """A layout of patches with the sheets as they are read."""
        return layout_by(layout, self.reading) if self.reading else layout
