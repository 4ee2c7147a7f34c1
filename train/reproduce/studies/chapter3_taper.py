"""Section 3.6.2: taper."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from beamenv.structure.sweep import frequency_sweep
from train.figures.figure import Curve, Panel
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Changes, Holds, Matches, Small
from train.reproduce.studies.parameter_studies import (
    PLY_ANGLES_DEG,
    SPEEDS,
    Beams,
    along_parameter,
    along_x,
    bending_alone,
    locus_panels,
    shape_panels,
    step_responses,
    turns_at,
    worst_newmark_error,
)
from train.reproduce.studies.responses import ForcedResponses
from train.reproduce.thesis import Model
from train.reproduce.thesis.bending_stiffness import bending_stiffness
from train.reproduce.thesis.equations import HOST, TURNING, UNIFORM_TENSION
from train.reproduce.thesis.points import on_x, with_points

TAPERED = (*HOST, UNIFORM_TENSION)
TAPERS = (1.0, 2.0, 3.0, 4.0)
PRINTED_PEAKS = (1.0 - 0.2587, 1.0 - 0.4149, 1.0 - 0.5219)
TURN_DEG = 45.0
BENT = "straightness: mean distance of the shape, at most one, from the line between root and tip"


def tapered(model: Model, angle_deg: float = 30.0, pretwist_deg: float = 0.0) -> Beams:
    """A blade for each taper."""
    return {f"η = {taper:g}": model.beam(angle_deg, pretwist_deg=pretwist_deg, taper=taper) for taper in TAPERS}


def shapes(family: str) -> Callable[[Model], Outcome]:
    """Figures 3.11 and 3.12."""

    def compute(model: Model) -> Outcome:
        panels, bows, _ = shape_panels(tapered(model), model.speed, family)
        return Outcome({"first": bows[:1], "higher": bows[1:]}, panels)

    return compute


def over_speed(model: Model) -> Outcome:
    """Figure 3.13."""
    beams = tapered(model)
    loci = frequency_sweep(list(beams.values()), SPEEDS, 4)
    uniform = beams["η = 1"]
    start, end = (uniform.modes(speed, 2).families for speed in (0.0, SPEEDS[-1]))
    evidence = {
        "lower": along_parameter(loci, [0, 1]),
        "higher": along_parameter(loci, [2, 3]),
        "bending": along_parameter(bending_alone(model, beams), [0, 1]),
        "speed": along_x(loci),
        "exchange": [one != two for one, two in zip(start, end, strict=True)],
    }
    return Outcome(evidence, locus_panels(list(beams), SPEEDS, "speed (rad/s)", loci))


def over_ply_angle(model: Model) -> Outcome:
    """Figure 3.14."""
    loci = np.stack(
        [frequency_sweep(list(tapered(model, angle, 30.0).values()), [model.speed], 2)[:, 0] for angle in PLY_ANGLES_DEG], axis=1
    )
    evidence = {"taper": (loci[1:] > loci[:1]).astype(float), "turn": turns_at(loci, PLY_ANGLES_DEG, TURN_DEG)}
    return Outcome(evidence, turning_panels(list(tapered(model)), loci))


def turning_panels(labels: list[str], loci: np.ndarray) -> list[Panel]:
    """Frequencies (labels, angles, modes) over ply angle, with the one at which the thesis has them turn."""
    return [on_x(panel, TURN_DEG) for panel in locus_panels(labels, PLY_ANGLES_DEG, "ply angle (°)", loci)]


def stiffness_panels(labels: list[str], values: np.ndarray) -> list[Panel]:
    """a22 and a33 (labels, angles, 2) over ply angle."""
    return [
        Panel(
            f"{name} at mid-span",
            "ply angle (°)",
            "bending stiffness (N m²)",
            [Curve(PLY_ANGLES_DEG, values[k, :, column], label) for k, label in enumerate(labels)],
            logarithmic=True,
        )
        for column, name in enumerate(("a22 (lag)", "a33 (flap)"))
    ]


def stiffness(model: Model) -> Outcome:
    """Figure 3.15."""
    values = np.array(
        [[bending_stiffness(beam) for beam in tapered(model, angle, 30.0).values()] for angle in PLY_ANGLES_DEG]
    ).transpose(1, 0, 2)
    evidence = {"taper": along_parameter(values, [0, 1]), "turn": turns_at(values, PLY_ANGLES_DEG, TURN_DEG)}
    return Outcome(evidence, [on_x(panel, TURN_DEG) for panel in stiffness_panels(list(tapered(model)), values)])


def forced(model: Model) -> Outcome:
    """Figure 3.16."""
    beams = tapered(model, 30.0, 30.0)
    uniform, pressure = step_responses(model, beams), step_responses(model, beams, pressure=True)
    panels = [
        replace(response.panel, title=f"{response.panel.title}, {name}")
        for name, responses in (("uniform", uniform), ("falling with the chord", pressure))
        for response in responses.values()
    ]
    panels.append(peak_panel(uniform, pressure))
    cases = [*uniform.values(), *pressure.values()]
    evidence = {
        "peak": [bool(np.all(np.diff(case.peaks) < 0.0)) for case in cases],
        "flap": uniform["flap"].peaks,
        "lag": uniform["lag"].peaks,
        "pressure-flap": pressure["flap"].peaks,
        "pressure-lag": pressure["lag"].peaks,
        "reductions": uniform["flap"].peaks[1:] / uniform["flap"].peaks[0],
        "reductions-pressure": pressure["lag"].peaks[1:] / pressure["lag"].peaks[0],
        "newmark": worst_newmark_error(uniform),
    }
    return Outcome(evidence, panels, {"points": "Newmark, thesis' constants"})


def peak_panel(uniform: Mapping[str, ForcedResponses], pressure: Mapping[str, ForcedResponses]) -> Panel:
    """Peaks over that of the uniform blade, with those printed."""
    curves = [
        Curve(np.array(TAPERS), response.peaks / response.peaks[0], f"{direction}, {spread}", line)
        for spread, line, found in (("uniform", "solid", uniform), ("falling with the chord", "dashed", pressure))
        for direction, response in found.items()
    ]
    panel = Panel("largest tip displacement", "taper η", "over that of η = 1", curves)
    return with_points(panel, TAPERS, (1.0, *PRINTED_PEAKS))


SHAPE_STATEMENTS = (
    Statement("first", "In the first mode taper bends the beam more", Changes(+1)),
    Statement("higher", "In the second and third mode taper straightens the beam", Changes(-1)),
)
WHY_TAPER = (
    "A tapered blade is thinner, and lighter outboard, so that less centrifugal tension holds it: under one and the same load per "
    "metre its tip "
    "goes further. The thesis does not say how its load is spread, and takes the tension of a uniform beam."
)
WHY_PEAKS = (
    "With the tension of a uniform beam the tip goes less far as taper grows, if the load falls with the chord: in lag by 28, 40 "
    "and 47 %, near what the thesis prints. That, by its own equations, is the likely origin of its figure."
)
WHY_TURN = (
    "The modulus along the span, Q̄22 − Q̄12²/Q̄11, rises without a minimum from 5.2 GPa at 0° to 207 GPa at 90° for this "
    "lamina. What we compute rises with it, with the thesis' own shear "
    "flow as well. With Q22 in place of Q12 in Q̄12 (Eq. 4.5) it falls by 8 % to a minimum, but at "
    "25°, and Tables 3.3 and 3.4 were not computed so."
)
UNNAMED = f"θ = 30°, untwisted, 200 rad/s (the thesis names none); {BENT}"

STUDIES = (
    Study("figure-3.11", "Lag mode shapes over taper", UNNAMED, SHAPE_STATEMENTS, shapes("lag"), rests_on=TAPERED),
    Study("figure-3.12", "Flap mode shapes over taper", UNNAMED, SHAPE_STATEMENTS, shapes("flap"), rests_on=TAPERED),
    Study(
        "figure-3.13",
        "First four frequencies over speed and taper",
        "θ = 30°, untwisted",
        (
            Statement("lower", "Taper raises the first two frequencies", Changes(+1)),
            Statement(
                "higher", "Taper lowers the third and fourth frequencies", Changes(-1), "Twist is among our first four modes."
            ),
            Statement("bending", "The same in bending alone, up to 200 rad/s", Changes(-1), aside=True),
            Statement("speed", "Every frequency rises with speed", Changes(+1)),
            Statement(
                "exchange", "In the first two modes the dominant motion changes from flap to lag and vice versa (η = 1)", Holds()
            ),
        ),
        over_speed,
        rests_on=TAPERED,
    ),
    Study(
        "figure-3.14",
        "First two frequencies over ply angle and taper",
        "30° pretwist, 200 rad/s",
        (
            Statement("taper", "A tapered beam has higher frequencies than a uniform one", Holds()),
            Statement("turn", "Frequencies fall up to a ply angle of about 45° and rise beyond", Holds(), WHY_TURN),
        ),
        over_ply_angle,
        rests_on=TAPERED,
    ),
    Study(
        "figure-3.15",
        "Bending stiffness over ply angle and taper",
        "30° pretwist, at mid-span",
        (
            Statement("taper", "Taper lowers both bending stiffnesses", Changes(-1)),
            Statement("turn", "The bending stiffness falls up to about 45° and rises beyond", Holds(), WHY_TURN),
        ),
        stiffness,
        rests_on=TURNING,
    ),
    Study(
        "figure-3.16",
        "Forced response over taper",
        "θ = 30°, 30° pretwist, 200 rad/s; steps of 30 N/m at the root, 1 % modal damping; the thesis names neither direction nor "
        "spread",
        (
            Statement(
                "peak",
                "Taper lowers the tip displacement (in lag and in flap, with two spreads of the load)",
                Holds(share=0.5),
                WHY_TAPER,
            ),
            Statement(
                "reductions",
                "The peak falls by 25.87, 41.49 and 52.19 % for η = 2, 3, 4: peaks over that of η = 1 (uniform, flap)",
                Matches(PRINTED_PEAKS, 0.05, 0.25),
                WHY_TAPER,
            ),
            Statement(
                "reductions-pressure",
                "The same peaks under a load in lag that falls with the chord",
                Matches(PRINTED_PEAKS, 0.05, 0.25),
                WHY_PEAKS,
                aside=True,
            ),
            Statement("lag", "Tip displacement under a uniform load in lag", Changes(-1), aside=True),
            Statement("flap", "Tip displacement under a uniform load in flap", Changes(-1), aside=True),
            Statement("pressure-lag", "Tip displacement under a load in lag that falls with the chord", Changes(-1), aside=True),
            Statement("pressure-flap", "Tip displacement under a load in flap that falls with the chord", Changes(-1), aside=True),
            Statement(
                "newmark", "Newmark's method with the thesis' constants gives the exact response", Small(0.01, 0.05), aside=True
            ),
        ),
        forced,
        rests_on=TAPERED,
    ),
)
