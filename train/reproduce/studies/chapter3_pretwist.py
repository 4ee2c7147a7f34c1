"""Section 3.6.3: pretwist."""

from __future__ import annotations

from typing import Any

import numpy as np

from beamenv.structure.sweep import frequency_sweep
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Changes, Holds, Marginal, Matches, Small
from train.reproduce.studies.chapter3_taper import BENT
from train.reproduce.studies.parameter_studies import (
    SPEEDS,
    Beams,
    along_parameter,
    bending_alone,
    locus_panels,
    shape_panels,
    step_responses,
    worst_newmark_error,
)
from train.reproduce.thesis import Model
from train.reproduce.thesis.equations import HOST
from train.reproduce.thesis.points import on_x

ANGLES_DEG = (0.0, 30.0, 60.0, 90.0)
PRINTED_CROSSOVER = 120.0


def pretwisted(model: Model) -> Beams:
    """A blade of θ = 30° for each pretwist."""
    return {f"β = {angle:g}°": model.beam(30.0, pretwist_deg=angle) for angle in ANGLES_DEG}


def lag_shapes(model: Model) -> Outcome:
    """Figure 3.17."""
    panels, bows, apart = shape_panels(pretwisted(model), model.speed, "lag")
    return Outcome({"first": bows[:1], "higher": bows[1:], "marginal": apart[0]}, panels)


def flap_shapes(model: Model) -> Outcome:
    """Figure 3.18."""
    panels, bows, apart = shape_panels(pretwisted(model), model.speed, "flap")
    evidence = {"odd": bows[[0, 2]], "second": bows[1:2], "marginal": apart}
    return Outcome(evidence, panels)


def pretwist_over_speed(model: Model) -> Outcome:
    """Figure 3.19."""
    beams = pretwisted(model)
    loci = frequency_sweep(list(beams.values()), SPEEDS, 4)
    first_two = loci[..., :2] / loci[:1, :, :2] - 1.0
    bending = bending_alone(model, beams)
    at = int(np.abs(SPEEDS - model.speed).argmin())
    evidence = {
        "crossover": [crossover(SPEEDS, loci[0, :, 0], twisted[:, 0]) for twisted in loci[1:]],
        "first": [bool(change[at, 0] < 0.0 < change[0, 0]) for change in first_two[1:]],
        "second": [bool(change[0, 1] < 0.0 < change[at, 1]) for change in first_two[1:]],
        "third": along_parameter(loci, [2]),
        "fourth": along_parameter(loci, [3]),
        "third-bending": along_parameter(bending, [0]),
        "fourth-bending": along_parameter(bending, [1]),
        "at-rest": loci[:, 0, 0][None],
        "lag-at-rest": loci[:, 0, 1][None],
        "shallow": first_two[1:].ravel(),
    }
    first, *others = locus_panels(list(beams), SPEEDS, "speed (rad/s)", loci)
    return Outcome(evidence, [on_x(first, PRINTED_CROSSOVER), *others])


def crossover(speeds: np.ndarray, one: np.ndarray, other: np.ndarray) -> float:
    """The speed at which two loci cross, or the nearer end of the range when they do not."""
    gap = other - one
    crossed = np.flatnonzero(np.diff(np.sign(gap)))
    if not len(crossed):
        return float(speeds[np.abs(gap).argmin()])
    at = crossed[0]
    return float(speeds[at] - gap[at] * (speeds[at + 1] - speeds[at]) / (gap[at + 1] - gap[at]))


def pretwist_forced(model: Model) -> Outcome:
    """Figure 3.20."""
    found = step_responses(model, pretwisted(model))
    tips = [response.peaks[1:] / response.peaks[0] - 1.0 for response in found.values()]
    evidence: dict[str, Any] = {
        "tip": [bool(np.all(np.diff(tip, prepend=0.0) > 0.0)) for tip in tips],
        "settling": [bool(np.all(np.diff(response.settling) > 0.0)) for response in found.values()],
        "newmark": worst_newmark_error(found),
    }
    for direction, response in found.items():
        evidence[f"tip-{direction}"] = response.peaks[1:] / response.peaks[0] - 1.0
        evidence[f"settling-{direction}"] = response.settling
    return Outcome(evidence, [response.panel for response in found.values()], {"points": "Newmark, thesis' constants"})


NEWMARK = Statement(
    "newmark", "Newmark's method with the thesis' constants gives the exact response", Small(0.01, 0.05), aside=True
)
WHY_FLAP = (
    "In flap at 200 rad/s the blade is held by centrifugal tension more than by bending, so that pretwist changes next to nothing; "
    "the thesis does not name its direction."
)
UNNAMED = f"θ = 30°, γ = 0°, 200 rad/s (the thesis names none); {BENT}"
MIXED = "With 60° and 90° of pretwist the higher modes are as much lag as flap: a family is the larger share of kinetic energy."
THIRD = "Twist is among our first four modes: at 400 rad/s it is the third, before that the fourth."
STEP = "steps of 30 N/m, 1 % modal damping"

STUDIES = (
    Study(
        "figure-3.17",
        "Lag mode shapes over pretwist",
        UNNAMED,
        (
            Statement("first", "In the first mode pretwist bends the beam", Changes(+1)),
            Statement("higher", "In the second and third mode pretwist straightens the beam", Changes(-1), MIXED),
            Statement("marginal", "Marginal influence on the first mode: largest difference of the shapes", Small(0.05, 0.10)),
        ),
        lag_shapes,
        rests_on=HOST,
    ),
    Study(
        "figure-3.18",
        "Flap mode shapes over pretwist",
        UNNAMED,
        (
            Statement("odd", "In the first and third mode pretwist straightens the beam", Changes(-1), MIXED),
            Statement("second", "In the second mode pretwist bends the beam", Changes(+1)),
            Statement(
                "marginal", "Marginal influence on the flap shapes: largest difference of the shapes", Small(0.05, 0.10), MIXED
            ),
        ),
        flap_shapes,
        rests_on=HOST,
    ),
    Study(
        "figure-3.19",
        "First four frequencies over speed and pretwist",
        "θ = 30°, γ = 0°",
        (
            Statement(
                "crossover",
                "Pretwist stiffens the first mode up to about 120 rad/s and softens it beyond (β = 30, 60, 90°)",
                Matches((PRINTED_CROSSOVER,) * 3, 0.05, 0.90, "rad/s"),
                "The speed depends on the bending stiffness: 29 rad/s for θ = 30°, 45 for 60°, 154 for 90°. Table 3.1, too, says "
                "that the "
                "thesis' 30° blade was stiffer than its data.",
            ),
            Statement("first", "The same without the number: stiffer at rest, softer at 200 rad/s", Holds(), aside=True),
            Statement(
                "second",
                "Pretwist softens the second mode at low speed (rest) and stiffens it at high speed (200 rad/s)",
                Holds(),
                "At 200 rad/s no pretwist changes it by as much as 0.1 %.",
            ),
            Statement("third", "Pretwist stiffens the third mode", Changes(+1), THIRD),
            Statement("fourth", "Pretwist softens the fourth mode", Changes(-1), THIRD),
            Statement(
                "third-bending", "Pretwist stiffens the third mode in bending alone, up to 200 rad/s", Changes(+1), aside=True
            ),
            Statement(
                "fourth-bending", "Pretwist softens the fourth mode in bending alone, up to 200 rad/s", Changes(-1), aside=True
            ),
            Statement("at-rest", "The first flap frequency rises with pretwist (at rest)", Changes(+1)),
            Statement("lag-at-rest", "The first lag frequency falls with pretwist (at rest)", Changes(-1)),
            Statement(
                "shallow",
                "Pretwist has a shallow effect on the first two frequencies",
                Small(0.05, 0.10),
                remark="The first lag frequency at rest falls by 4, 14 and 23 % for 30, 60 and 90°; at 200 rad/s the two change "
                "by at most 4 %.",
            ),
        ),
        pretwist_over_speed,
        rests_on=HOST,
    ),
    Study(
        "figure-3.20",
        "Forced response over pretwist",
        f"θ = 30°, γ = 0°, 200 rad/s; {STEP}",
        (
            Statement(
                "tip", "The tip displacement increases marginally with pretwist (in lag and in flap)", Holds(share=0.5), WHY_FLAP
            ),
            Statement("settling", "The settling time increases with pretwist (in lag and in flap)", Holds(share=0.5), WHY_FLAP),
            Statement("tip-lag", "Tip displacement in lag", Marginal(+1), aside=True),
            Statement("tip-flap", "Tip displacement in flap", Marginal(+1), aside=True),
            Statement("settling-lag", "Settling time in lag", Changes(+1), aside=True),
            Statement("settling-flap", "Settling time in flap", Changes(+1), aside=True),
            NEWMARK,
        ),
        pretwist_forced,
        rests_on=HOST,
    ),
)
