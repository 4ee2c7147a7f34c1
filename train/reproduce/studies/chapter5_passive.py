"""Section 5.5.1: what the mass and stiffness of patches do to the frequencies."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.patches import PatchLayout
from beamenv.structure import RotatingBeam
from beamenv.structure.sweep import frequency_sweep
from train.figures.figure import Curve, Panel
from train.reproduce.judging.study import Outcome, Part, Parts, Statement, Study
from train.reproduce.judging.verdicts import Changes, Holds, Large
from train.reproduce.studies.closed_loop import patches
from train.reproduce.studies.parameter_studies import ORDINALS, PLY_ANGLES_DEG, SPEEDS
from train.reproduce.studies.study_patches import PRINTED_DENSITY
from train.reproduce.thesis import Model
from train.reproduce.thesis.bending_stiffness import shear_bending_stiffness
from train.reproduce.thesis.configurations import built
from train.reproduce.thesis.equations import HOST, MFC_DENSITY
from train.reproduce.thesis.points import on_x

Array = NDArray[np.float64]

SHEETS: dict[str, PatchLayout | None] = {
    "no patches": None,
    "MFC": patches(actuators=6, sensors=6),
    "PZT": patches(material="PZT", actuators=6, sensors=6),
    "MFC, printed density": patches(material=PRINTED_DENSITY, actuators=6, sensors=6),
}
TURN_DEG = 75.0
TAPERS = (1.0, 2.0, 3.0, 4.0)


def frequencies_over_ply_angle(model: Model) -> tuple[Array, Array]:
    """(sheets, angles, 4), rad/s, at rest and at the model's speed."""
    beams = [[built(model.blade(angle), layout and model.layout(layout)) for angle in PLY_ANGLES_DEG] for layout in SHEETS.values()]
    found = np.stack([frequency_sweep(row, [0.0, model.speed], 4) for row in beams])
    return found[:, :, 0], found[:, :, 1]


def ply_angle_parts(model: Model) -> Parts:
    """What Figures 5.3 and 5.4 share."""
    return {"frequencies": Part(frequencies_over_ply_angle, (model,))}


def change_panels(x: Array, x_label: str, found: Array) -> list[Panel]:
    """The change of each frequency by each kind of patch."""
    change = 100.0 * (found / found[:1] - 1.0)
    return [
        Panel(
            f"{ORDINALS[mode]} natural frequency",
            x_label,
            "change by patches (%)",
            [Curve(x, change[k, :, mode], name) for k, name in enumerate(SHEETS) if k],
        )
        for mode in range(4)
    ]


def frequency_rows(x: Array, found: Array) -> list[list[object]]:
    """The frequencies themselves, for the CSV."""
    return [[f"{value:g}", name, *(f"{f:.6g}" for f in found[k, i])] for k, name in enumerate(SHEETS) for i, value in enumerate(x)]


HEADER = ["blade", *(f"{name} frequency (rad/s)" for name in ORDINALS[:4])]


def over_ply_angle(rotating: bool) -> Callable[[Model, Mapping[Any, Any]], Outcome]:
    """Figures 5.3 and 5.4."""

    def compute(model: Model, parts: Mapping[Any, Any]) -> Outcome:
        at_rest, turning = parts["frequencies"]
        found = turning if rotating else at_rest
        change = found[1:] / found[:1] - 1.0
        low, high = PLY_ANGLES_DEG <= TURN_DEG, PLY_ANGLES_DEG > TURN_DEG
        evidence = {
            "softened": (change[0, low] < 0.0).astype(float),
            "printed-density": (change[2, low] < 0.0).astype(float),
            "stiffened": (change[0, high] > 0.0).astype(float),
            "significant": change[0],
        }
        if rotating:
            evidence["alike"] = (np.sign(change[:2]) == np.sign(at_rest[1:3] / at_rest[:1] - 1.0)).astype(float)
        panels = [on_x(panel, TURN_DEG) for panel in change_panels(PLY_ANGLES_DEG, "ply angle (°)", found)]
        rows = frequency_rows(PLY_ANGLES_DEG, found)
        return Outcome(evidence, panels, {}, ["ply angle (°)", *HEADER], rows, [added_mass(model)])

    return compute


def added_mass(model: Model) -> str:
    """What the patches add to the blade, in words."""
    bare, patched = (mass(built(model.blade(0.0), SHEETS[name])) for name in ("no patches", "MFC"))
    return f"Twelve MFC in place of the plies there add {1e3 * (patched - bare):.0f} g to the blade's {bare:.1f} kg."


def mass(beam: RotatingBeam) -> float:
    """Of the blade, kg."""
    middles = (np.arange(2000) + 0.5) / 2000 * beam.length
    return float(beam.walls_at(middles).inertia().mass_per_length.mean() * beam.length)


def over_speed(model: Model) -> Outcome:
    """Figure 5.6."""
    beams = [built(model.blade(0.0), layout and model.layout(layout)) for layout in SHEETS.values()]
    found = frequency_sweep(beams, SPEEDS, 4)
    difference = np.abs(found[1] - found[0])
    evidence = {
        "softened": (found[1:3, :] < found[:1]).astype(float),
        "softened-printed": (found[3] < found[0]).astype(float),
        "first": difference[SPEEDS <= 100.0, 0],
        "others": difference[:, 1:].T,
    }
    panels = change_panels(SPEEDS, "speed (rad/s)", found)
    return Outcome(evidence, panels, {}, ["speed (rad/s)", *HEADER], frequency_rows(SPEEDS, found))


def shear_bending(model: Model) -> Outcome:
    """Figure 5.5."""
    values = np.array([[shear_bending_stiffness(model.beam(a, taper=taper)) for a in PLY_ANGLES_DEG] for taper in TAPERS])
    thesis = np.array(
        [[shear_bending_stiffness(model.beam(a, taper=taper, shear_flow="thesis")) for a in PLY_ANGLES_DEG] for taper in TAPERS]
    )
    curves = [
        Curve(PLY_ANGLES_DEG, 1e-3 * row, f"η = {taper:g}", line)
        for taper, mine, theirs in zip(TAPERS, values, thesis, strict=True)
        for row, line in ((mine, "solid"), (theirs, "dotted"))
    ]
    panel = on_x(Panel("ã2 at mid-span", "ply angle (°)", "ã2 (kN m)", curves), TURN_DEG)
    beyond = PLY_ANGLES_DEG >= TURN_DEG
    return Outcome(
        {"falls": np.abs(values[:, beyond])},
        [panel],
        {"solid": "constant shear flow around the cell", "dotted": "thesis' shear flow"},
    )


PATCHES = "six MFC or PZT actuators and sensors of 80 mm × 57 mm, equally spaced over 0 … 0.7 L; untwisted"
WHY_STIFFENED = (
    "Sheets of 30 GPa (MFC) and 124 GPa (PZT) stiffen a wall of hoop plies (5.2 GPa "
    "along the span at θ = 0°) and soften one of spanwise plies (207 GPa at θ = "
    "90°). The thesis has it the other way round, and its text contradicts itself "
    "on what happens beyond 75°."
)
WHY_LESS = (
    "As speed grows, centrifugal tension takes over from bending stiffness, and modes change places (at about 130 and 220 rad/s)."
)
WHY_TURNS_LATER = "With a closed cell's shear flow it still rises from 75 to 80°, and falls from there."
SOFTENED = "MFC lowers the first four frequencies up to θ = 75°"


def ply_angle_study(name: str, title: str, rotating: bool, extra: tuple[Statement, ...] = ()) -> Study:
    """Figure 5.3 or 5.4."""
    return Study(
        name,
        title,
        PATCHES,
        (
            Statement("softened", SOFTENED, Holds(), WHY_STIFFENED),
            Statement(
                "printed-density", f"{SOFTENED}: with the printed density of 8528 kg/m³ (data sheet: 5440)", Holds(), aside=True
            ),
            Statement("stiffened", "MFC raises them beyond 75°", Holds(), WHY_STIFFENED),
            Statement(
                "significant",
                "The change is significant",
                Large(),
                "Sheets of 0.3 mm in walls of 10 mm can hardly do more; nor do they with the thesis' shear flow and 8528 kg/m³.",
            ),
            *extra,
        ),
        over_ply_angle(rotating),
        ply_angle_parts,
        rests_on=(*HOST, MFC_DENSITY),
    )


STUDIES = (
    ply_angle_study("figure-5.3", "Passive effect of patches over ply angle, at rest", False),
    ply_angle_study(
        "figure-5.4",
        "Passive effect of patches over ply angle, 200 rad/s",
        True,
        (
            Statement(
                "alike",
                "The trends at rest and rotating are similar: the same sign of each change",
                Holds(),
                remark="While the blade turns all changes are below 1.2 %. Flap and lag have changed "
                "places, so the first frequency is that of another mode.",
            ),
        ),
    ),
    Study(
        "figure-5.5",
        "Stiffness quantity ã2 over ply angle and taper",
        "untwisted, at mid-span, without patches; ã2 is what the higher-order theory adds to the coupling of θx' with γx",
        (Statement("falls", "ã2 decreases beyond 75°", Changes(-1), WHY_TURNS_LATER),),
        shear_bending,
        rests_on=HOST,
    ),
    Study(
        "figure-5.6",
        "Passive effect of patches over speed",
        f"θ = 0°; {PATCHES}",
        (
            Statement("softened", "Piezoelectric material softens the rotating beam", Holds(), WHY_STIFFENED),
            Statement("softened-printed", "The same for MFC with the printed density", Holds(), aside=True),
            Statement("first", "The difference in the first frequency grows with speed (up to 100 rad/s)", Changes(+1), WHY_LESS),
            Statement("others", "The difference in the second to fourth frequency shrinks with speed", Changes(-1), WHY_LESS),
        ),
        over_speed,
        rests_on=(MFC_DENSITY,),
    ),
)
