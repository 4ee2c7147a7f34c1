"""What figures over a parameter (taper, pretwist, presetting) share: shapes, loci and their panels, one curve a value."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from beamenv.structure import RotatingBeam
from beamenv.structure.sweep import frequency_sweep
from train.figures.figure import Curve, Panel
from train.reproduce.studies.responses import ForcedResponses, forced_responses
from train.reproduce.thesis import Model
from train.reproduce.thesis.response import ForcedBlade
from train.reproduce.thesis.shapes import STATIONS, family_shapes

Array = NDArray[np.float64]
Beams = Mapping[str, RotatingBeam]

ORDINALS = ("first", "second", "third", "fourth", "fifth")
SPEEDS = np.linspace(0.0, 400.0, 41)
FEW_PERIODS = 0.12
"""s: what can be distinguished of four responses in one panel."""
PLY_ANGLES_DEG = np.linspace(0.0, 90.0, 19)


def shape_panels(beams: Beams, speed: float, family: str) -> tuple[list[Panel], Array, Array]:
    """A panel for each of three modes of a family, how bowed each shape is and how far from the first beam's, (modes, beams)."""
    shapes = {label: family_shapes(beam, speed, family) for label, beam in beams.items()}
    panels = [
        Panel(
            f"{ORDINALS[mode]} {family} mode",
            "z/L",
            "displacement / largest",
            [Curve(STATIONS, found[mode].values, label) for label, found in shapes.items()],
        )
        for mode in range(3)
    ]
    bows = np.array([[found[mode].bow for found in shapes.values()] for mode in range(3)])
    values = np.array([[found[mode].values for found in shapes.values()] for mode in range(3)])
    return panels, bows, np.abs(values - values[:, :1]).max(axis=2)


def locus_panels(labels: list[str], x: Array, x_label: str, loci: Array) -> list[Panel]:
    """A panel for each mode of ``loci`` (labels, x, modes), rad/s."""
    return [
        Panel(
            f"{ORDINALS[mode]} natural frequency",
            x_label,
            "natural frequency (rad/s)",
            [Curve(x, loci[k, :, mode], label) for k, label in enumerate(labels)],
        )
        for mode in range(loci.shape[2])
    ]


def bending_alone(model: Model, beams: Beams) -> Array:
    """Third and fourth frequency (labels, speeds, 2) of lag and flap without twist and stretch, up to the model's speed."""
    loci = frequency_sweep(list(beams.values()), SPEEDS[model.speed >= SPEEDS], 4, ("lag", "flap"), gyroscopic=False)
    return loci[..., 2:]


def along_parameter(loci: Array, modes: list[int], skip: int = 0) -> Array:
    """(series, labels): each chosen mode at each x (but the first ``skip``) as a sequence over the parameter."""
    return loci[:, skip:, modes].reshape(len(loci), -1).T


def along_x(loci: Array) -> Array:
    """(series, x): every mode of every label as a sequence over x."""
    return loci.transpose(0, 2, 1).reshape(-1, loci.shape[1])


def turns_at(loci: Array, x: Array, turn: float) -> Array:
    """Whether each step along x falls before ``turn`` and rises after it, over all labels and modes."""
    rising = np.diff(along_x(loci), axis=1) > 0.0
    return (rising == (x[:-1] >= turn)).astype(float)


def step_responses(model: Model, beams: Beams, pressure: bool = False) -> dict[str, ForcedResponses]:
    """Responses to a step load in lag and in flap, the thesis' y-direction, with gyroscopic coupling."""
    return {
        direction: forced_responses(
            model,
            {
                label: ForcedBlade(beam, model.speed, direction, model.damping_ratio, pressure=pressure)
                for label, beam in beams.items()
            },
            FEW_PERIODS,
        )
        for direction in ("lag", "flap")
    }


def worst_newmark_error(responses: Mapping[str, ForcedResponses]) -> Array:
    """Of all directions and blades."""
    return np.concatenate([response.newmark_error for response in responses.values()])
