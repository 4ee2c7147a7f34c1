"""Section 3.6.1: what gyroscopic coupling does to shapes, frequencies and responses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from beamenv.structure.sweep import frequency_sweep
from train.figures.figure import Curve, Panel
from train.reproduce.judging.study import WITH_AND_WITHOUT, Outcome, Statement, Study
from train.reproduce.judging.verdicts import Changes, Holds, Large, Marginal, Small
from train.reproduce.studies.parameter_studies import ORDINALS, SPEEDS
from train.reproduce.studies.responses import forced_responses
from train.reproduce.thesis import Model
from train.reproduce.thesis.equations import HOST
from train.reproduce.thesis.response import ForcedBlade
from train.reproduce.thesis.shapes import STATIONS, Shape, family_shapes

PLY_ANGLES_DEG = (0.0, 30.0, 45.0, 60.0, 90.0)
LAG_EXTENSION = ("lag", "extension")
AT_REST = {"solid": "200 rad/s, with gyroscopic coupling", "dotted": "200 rad/s, without", "dashed": "at rest"}


def shapes_with_and_without(model: Model, family: str) -> dict[str, list[Shape]]:
    """Three shapes of a family at rest, rotating, and rotating without gyroscopic coupling (θ = 0°)."""
    beam = model.beam(0.0)
    return {
        "rest": family_shapes(beam, 0.0, family),
        "with": family_shapes(beam, model.speed, family),
        "without": family_shapes(beam, model.speed, family, gyroscopic=False),
    }


def shape_panels(found: dict[str, list[Shape]]) -> list[Panel]:
    """One panel a mode."""
    styles = {"with": "solid", "without": "dotted", "rest": "dashed"}
    return [
        Panel(
            f"{ORDINALS[mode]} mode",
            "z/L",
            "displacement / largest",
            [Curve(STATIONS, found[key][mode].values, "", line) for key, line in styles.items()],
        )
        for mode in range(3)
    ]


def bows(found: list[Shape]) -> np.ndarray:
    """(modes,): how far each shape is from straight."""
    return np.array([shape.bow for shape in found])


def lag_shapes(model: Model) -> Outcome:
    """Figure 3.2."""
    found = shapes_with_and_without(model, "lag")
    straightened = np.column_stack([bows(found["rest"]), bows(found["without"])])
    coupled = np.column_stack([bows(found["without"]), bows(found["with"])])
    apart = [np.abs(one.values - two.values).max() for one, two in zip(found["with"], found["without"], strict=True)]
    evidence = {"rotation": straightened, "coupling": coupled, "significant": apart}
    return Outcome(evidence, shape_panels(found), AT_REST)


def unaffected_shapes(family: str) -> Callable[[Model], Outcome]:
    """Figures 3.3 and 3.4: shapes on which gyroscopic coupling has no effect."""

    def compute(model: Model) -> Outcome:
        found = shapes_with_and_without(model, family)
        apart = [np.abs(one.values - two.values).max() for one, two in zip(found["with"], found["without"], strict=True)]
        evidence = {"rotation": np.column_stack([bows(found["rest"]), bows(found["with"])]), "coupling": apart}
        return Outcome(evidence, shape_panels(found), AT_REST)

    return compute


def lag_extension_frequencies(model: Model) -> Outcome:
    """Figure 3.5."""
    beams = [model.beam(angle) for angle in PLY_ANGLES_DEG]
    loci = {line: frequency_sweep(beams, SPEEDS, 4, LAG_EXTENSION, line == "solid") for line in WITH_AND_WITHOUT}
    effect = loci["solid"][:, 1:] / loci["dotted"][:, 1:] - 1.0
    panels = [
        Panel(
            f"{ORDINALS[mode]} natural frequency",
            "speed (rad/s)",
            "natural frequency (rad/s)",
            [
                Curve(SPEEDS, loci[line][k, :, mode], f"θ = {angle:g}°", line)
                for k, angle in enumerate(PLY_ANGLES_DEG)
                for line in WITH_AND_WITHOUT
            ],
        )
        for mode in range(4)
    ]
    evidence = {
        "considerable": effect,
        "softening": (effect[..., [0, 1, 3]] < 0.0).astype(float),
        "stiffening": (effect[..., 2] > 0.0).astype(float),
        "ply-angle": np.abs(effect).max(axis=(1, 2)),
    }
    return Outcome(evidence, panels, WITH_AND_WITHOUT)


def forced_vibration(model: Model) -> Outcome:
    """Figure 3.6: a step in lag, since coupling acts between lag and extension."""
    beam = model.beam(0.0)
    blades = {line: ForcedBlade(beam, model.speed, "lag", model.damping_ratio, line == "solid") for line in WITH_AND_WITHOUT}
    result = forced_responses(model, {"": blades["solid"], "without": blades["dotted"]})
    peaks = result.peaks
    curves = [Curve(c.x, c.y, "", "dotted" if c.label == "without" and c.line == "solid" else c.line) for c in result.panel.curves]
    panel = Panel("lag", result.panel.x_label, result.panel.y_label, curves)
    exact = [curve.y for curve in result.panel.curves if curve.line == "solid"]
    apart = np.abs(exact[0] - exact[1]).max() / np.abs(exact[1]).max()
    evidence = {"tip": peaks[0] / peaks[1] - 1.0, "considerable": apart, "newmark": result.newmark_error}
    return Outcome(evidence, [panel], WITH_AND_WITHOUT | {"points": "Newmark, thesis' constants"})


def frequency_response(model: Model) -> Outcome:
    """Figure 3.7."""
    beam = model.beam(0.0)
    blades = {line: ForcedBlade(beam, model.speed, "lag", model.damping_ratio, line == "solid") for line in WITH_AND_WITHOUT}
    frequencies = np.linspace(20.0, 1600.0, 6001)
    responses = {line: blade.frequency_response(frequencies) for line, blade in blades.items()}
    peaks = np.array([resonances(amplitude)[:2] for amplitude in responses.values()])
    curves = [Curve(frequencies, 1e6 * amplitude, "", line) for line, amplitude in responses.items()]
    panel = Panel("lag", "excitation frequency (rad/s)", "tip amplitude (µm per N/m)", curves, logarithmic=True)
    return Outcome({"amplitude": peaks[0] / peaks[1] - 1.0}, [panel], WITH_AND_WITHOUT)


def resonances(amplitude: np.ndarray) -> np.ndarray:
    """The amplitudes at the local maxima."""
    inner = amplitude[1:-1]
    return inner[(inner > amplitude[:-2]) & (inner > amplitude[2:])]


STRAIGHT = "straightness: mean distance of the shape, at most one, from the line between root and tip"
BOX = "θ = 0°, untwisted, 200 rad/s"

STUDIES = (
    Study(
        "figure-3.2",
        "First three lag mode shapes",
        f"{BOX}; {STRAIGHT}",
        (
            Statement("rotation", "Rotation straightens the beam", Changes(-1)),
            Statement("coupling", "Gyroscopic coupling straightens it more", Changes(-1)),
            Statement(
                "significant",
                "Gyroscopic coupling has a significant effect on the lag–extension mode shapes",
                Large(),
                "At 200 rad/s; the effect grows with speed.",
            ),
        ),
        lag_shapes,
    ),
    Study(
        "figure-3.3",
        "First three flap mode shapes",
        f"{BOX}; {STRAIGHT}",
        (
            Statement("rotation", "Rotation straightens the beam", Changes(-1)),
            Statement("coupling", "The shapes with and without gyroscopic coupling coincide", Small(0.01, 0.05)),
        ),
        unaffected_shapes("flap"),
    ),
    Study(
        "figure-3.4",
        "First three twist mode shapes",
        f"{BOX}; caption says twist, text says extension; {STRAIGHT}",
        (
            Statement("rotation", "Rotation straightens the beam", Changes(-1)),
            Statement("coupling", "Gyroscopic coupling has no considerable effect on the twist shapes", Small(0.01, 0.05)),
        ),
        unaffected_shapes("twist"),
    ),
    Study(
        "figure-3.5",
        "First four lag–extension frequencies over speed and ply angle",
        "untwisted; the speeds of Table 3.3",
        (
            Statement("considerable", "Considerable variation between the analyses with and without gyroscopic coupling", Large()),
            Statement(
                "softening",
                "Coupling softens the first, second and fourth frequency",
                Holds(),
                "The fourth of 60° is the first extension, which it stiffens.",
            ),
            Statement(
                "stiffening",
                "Coupling stiffens the third frequency",
                Holds(),
                "So it does for θ ≤ 45°, where the third mode is the first extension; for 60° and 90° the extension lies higher.",
            ),
            Statement(
                "ply-angle", "The effect is more pronounced at small ply angles and becomes negligible at high ones", Changes(-1)
            ),
        ),
        lag_extension_frequencies,
        rests_on=HOST,
    ),
    Study(
        "figure-3.6",
        "Forced response with and without gyroscopic coupling",
        f"{BOX}; step of 30 N/m in lag, 1 % modal damping (the thesis names neither)",
        (
            Statement("tip", "Gyroscopic forces tend to increase the tip displacement", Marginal(+1)),
            Statement("considerable", "The effect on the forced response is considerable: responses apart, over the peak", Large()),
            Statement(
                "newmark",
                "Newmark's method with the thesis' constants (a₃, a₄ corrected) gives the exact response",
                Small(0.01, 0.05),
                aside=True,
            ),
        ),
        forced_vibration,
    ),
    Study(
        "figure-3.7",
        "Frequency response with and without gyroscopic coupling",
        f"{BOX}; lag, 1 % modal damping; amplitudes at the first two resonances",
        (
            Statement(
                "amplitude",
                "Gyroscopic coupling marginally decreases the amplitude",
                Marginal(-1),
                "It decreases the second resonance, but raises the first: with the same damping ratio a softer mode swings "
                "further.",
            ),
        ),
        frequency_response,
    ),
)
