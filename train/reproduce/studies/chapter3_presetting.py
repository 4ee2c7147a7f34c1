"""Section 3.6.4: presetting."""

from __future__ import annotations

from typing import Any

import numpy as np

from beamenv.structure.sweep import frequency_sweep
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Changes, Holds, Small
from train.reproduce.studies.chapter3_pretwist import ANGLES_DEG, NEWMARK, STEP
from train.reproduce.studies.chapter3_taper import TURN_DEG, WHY_TURN, stiffness_panels, turning_panels
from train.reproduce.studies.parameter_studies import (
    PLY_ANGLES_DEG,
    SPEEDS,
    Beams,
    along_parameter,
    bending_alone,
    locus_panels,
    step_responses,
    turns_at,
    worst_newmark_error,
)
from train.reproduce.thesis import Model
from train.reproduce.thesis.bending_stiffness import bending_stiffness
from train.reproduce.thesis.equations import HOST

FAMILIES = ("flap", "lag", "flap", "lag")


def preset(model: Model, ply_angle_deg: float = 30.0, pretwist_deg: float = 30.0) -> Beams:
    """A blade for each presetting."""
    return {f"γ = {angle:g}°": model.beam(ply_angle_deg, pretwist_deg=pretwist_deg, presetting_deg=angle) for angle in ANGLES_DEG}


def preset_over_speed(model: Model) -> Outcome:
    """Figure 3.21."""
    beams = preset(model)
    loci = frequency_sweep(list(beams.values()), SPEEDS, 4)
    bending = bending_alone(model, beams)
    families = [beam.modes(model.speed, 4).families for beam in beams.values()]
    evidence = {
        "first": along_parameter(loci, [0], skip=1),
        "third": along_parameter(loci, [2], skip=1),
        "second": along_parameter(loci, [1], skip=1),
        "fourth": along_parameter(loci, [3], skip=1),
        "third-bending": along_parameter(bending, [0])[1:],
        "fourth-bending": along_parameter(bending, [1])[1:],
        "families": [name == printed for found in families for name, printed in zip(found, FAMILIES, strict=True)],
        "at-rest": loci[1:, 0] / loci[:1, 0] - 1.0,
    }
    return Outcome(evidence, locus_panels(list(beams), SPEEDS, "speed (rad/s)", loci))


def preset_over_ply_angle(model: Model) -> Outcome:
    """Figure 3.22."""
    loci = np.stack(
        [frequency_sweep(list(preset(model, angle).values()), [model.speed], 2)[:, 0] for angle in PLY_ANGLES_DEG], axis=1
    )
    evidence = {
        "first": along_parameter(loci, [0]),
        "second": along_parameter(loci, [1]),
        "turn": turns_at(loci, PLY_ANGLES_DEG, TURN_DEG),
    }
    return Outcome(evidence, turning_panels(list(preset(model)), loci))


def preset_stiffness(model: Model) -> Outcome:
    """Figure 3.23."""
    values = np.array([[bending_stiffness(beam) for beam in preset(model, angle, 0.0).values()] for angle in PLY_ANGLES_DEG])
    values = values.transpose(1, 0, 2)
    evidence = {"a22": along_parameter(values, [0]), "a33": along_parameter(values, [1])}
    return Outcome(evidence, stiffness_panels(list(preset(model)), values))


def preset_forced(model: Model) -> Outcome:
    """Figure 3.24."""
    found = step_responses(model, preset(model, 0.0, 0.0))
    evidence: dict[str, Any] = {f"peak-{direction}": response.peaks for direction, response in found.items()}
    evidence["peak"] = [bool(np.all(np.diff(response.peaks) < 0.0)) for response in found.values()]
    evidence["newmark"] = worst_newmark_error(found)
    return Outcome(evidence, [response.panel for response in found.values()], {"points": "Newmark, thesis' constants"})


STUDIES = (
    Study(
        "figure-3.21",
        "First four frequencies over speed and presetting",
        "θ = 30°, 30° pretwist",
        (
            Statement("first", "The first frequency falls with presetting", Changes(-1)),
            Statement("second", "The second frequency rises with presetting", Changes(+1)),
            Statement(
                "third",
                "The third frequency falls with presetting",
                Changes(-1),
                "Beyond about 280 rad/s our third mode is the first twist.",
            ),
            Statement(
                "fourth",
                "The fourth frequency rises with presetting",
                Changes(+1),
                "At most speeds our fourth mode is the first twist.",
            ),
            Statement(
                "third-bending",
                "The third frequency falls with presetting in bending alone, up to 200 rad/s",
                Changes(-1),
                aside=True,
            ),
            Statement(
                "fourth-bending",
                "The fourth frequency rises with presetting in bending alone, up to 200 rad/s",
                Changes(+1),
                aside=True,
            ),
            Statement(
                "families",
                "The first and third mode are flap, the second and fourth lag (200 rad/s, by kinetic energy)",
                Holds(),
                "At 200 rad/s centrifugal tension has lifted the first flap above the first lag.",
            ),
            Statement("at-rest", "Presetting has no effect on a blade at rest", Small(1e-6, 0.01)),
        ),
        preset_over_speed,
        rests_on=HOST,
    ),
    Study(
        "figure-3.22",
        "First two frequencies over ply angle and presetting",
        "30° pretwist, 200 rad/s",
        (
            Statement("first", "Presetting softens the first frequency", Changes(-1)),
            Statement("second", "Presetting stiffens the second frequency", Changes(+1)),
            Statement("turn", "Frequencies fall up to a ply angle of about 45° and rise beyond", Holds(), WHY_TURN),
        ),
        preset_over_ply_angle,
        rests_on=HOST,
    ),
    Study(
        "figure-3.23",
        "Bending stiffness over ply angle and presetting",
        "untwisted (the thesis names no pretwist); a22 is the stiffness in lag and a33 in flap, which the text confuses",
        (
            Statement("a22", "a22 falls with presetting", Changes(-1)),
            Statement("a33", "a33 rises with presetting", Changes(+1)),
        ),
        preset_stiffness,
        rests_on=HOST,
    ),
    Study(
        "figure-3.24",
        "Forced response over presetting",
        f"θ = 0°, untwisted, 200 rad/s; {STEP}",
        (
            Statement(
                "peak",
                "Presetting lowers the tip displacement (in lag and in flap)",
                Holds(share=0.5),
                "Presetting turns the stiff direction of the box from lag into flap: what it lowers in flap it must raise in lag.",
            ),
            Statement("peak-flap", "Tip displacement in flap", Changes(-1), aside=True),
            Statement("peak-lag", "Tip displacement in lag", Changes(-1), aside=True),
            NEWMARK,
        ),
        preset_forced,
    ),
)
