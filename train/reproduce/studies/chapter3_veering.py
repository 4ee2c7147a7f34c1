"""Figures 3.8 to 3.10: loci of lag and extension over speed, the zero of the lag mode, and the veerings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from beamenv.structure import RotatingBeam
from beamenv.structure.sweep import frequency_sweep
from train.figures.figure import Curve, Panel
from train.reproduce.judging.study import WITH_AND_WITHOUT, Outcome, Statement, Study
from train.reproduce.judging.verdicts import Holds, Matches
from train.reproduce.studies.parameter_studies import ORDINALS
from train.reproduce.thesis import Model
from train.reproduce.thesis.points import on_x, with_points
from train.reproduce.thesis.shapes import STATIONS, normalised
from train.reproduce.thesis.veering import LAG_EXTENSION, Veering, exchange, locate_veering

SPEEDS = np.linspace(0.0, 1500.0, 301)
NEAR = np.linspace(300.0, 1300.0, 201)
"""Where veerings are looked for."""
LOWER_LOCI = (1, 3)
"""Second lag with first extension, third lag with second extension: the lower locus of each pair (the third locus lies between)."""
PRINTED = (430.0, 925.0)
PRINTED_CRITICAL = (1480.0,)
"""rad/s, where the first frequency is zero."""
CLOSE = 50.0
"""rad/s on either side of a veering: the "small change in rotational speed" that ought to exchange the modes."""


def veerings(beam: RotatingBeam) -> list[Veering]:
    """Both of them."""
    return [locate_veering(beam, lower, NEAR) for lower in LOWER_LOCI]


def uncoupled_crossings(beam: RotatingBeam) -> list[float]:
    """Speeds (rad/s) at which the second lag meets the first extension and the third the second, without gyroscopic coupling."""
    lag, extension = (frequency_sweep(beam, NEAR, 3, (motion,), gyroscopic=False) for motion in ("lag", "extension"))
    speeds = []
    for overtaking, overtaken in ((1, 0), (2, 1)):
        gap = lag[:, overtaking] - extension[:, overtaken]
        speeds.append(float(np.interp(0.0, gap, NEAR)))
    return speeds


def loci(model: Model) -> Outcome:
    """Figure 3.8."""
    beam = model.beam(0.0)
    paths = {line: frequency_sweep(beam, SPEEDS, 5, LAG_EXTENSION, line == "solid") for line in WITH_AND_WITHOUT}
    found, crossings, critical = veerings(beam), uncoupled_crossings(beam), beam.critical_speed
    curves = [Curve(SPEEDS, paths[line][:, k], f"{ORDINALS[k]} locus", line) for k in range(5) for line in WITH_AND_WITHOUT]
    panel = Panel(
        "lag and extension", "speed (rad/s)", "natural frequency (rad/s)", curves, marked=[*(v.speed for v in found), critical]
    )
    panel = with_points(on_x(panel, *PRINTED), PRINTED_CRITICAL, (0.0,))
    rows = [["critical speed", f"{critical:.2f}", ""]]
    rows += [[f"veering {k + 1}", f"{v.speed:.1f}", f"{v.gap:.1f}"] for k, v in enumerate(found)]
    rows += [[f"crossing {k + 1} without coupling", f"{speed:.1f}", "0"] for k, speed in enumerate(crossings)]
    evidence = {
        "critical": [critical],
        "lag-buckles": lag_buckles(beam),
        "rises-then-falls": [0 < paths["solid"][:, 0].argmax() < np.searchsorted(SPEEDS, critical) - 1],
        "uncoupled": uncoupled_trends(beam),
        "veerings": [v.speed for v in found],
        "crossings": crossings,
    }
    return Outcome(evidence, [panel], WITH_AND_WITHOUT, ["quantity", "speed (rad/s)", "gap (rad/s)"], rows)


def lag_buckles(beam: RotatingBeam) -> list[bool]:
    """With coupling the locus that starts as first lag ends at zero; without, the one that starts as first extension does."""
    near = 0.9999 * beam.critical_speed
    start = beam.modes(0.0, 3, LAG_EXTENSION)
    coupled, uncoupled = (beam.natural_frequencies(near, 1, LAG_EXTENSION, gyroscopic)[0] for gyroscopic in (True, False))
    alone = beam.natural_frequencies(near, 1, ("lag",), gyroscopic=False)[0]
    small = 0.05 * start.natural_frequencies[2]
    return [start.families[0] == "lag" and bool(coupled < small), bool(uncoupled < small), bool(alone > small)]


def uncoupled_trends(beam: RotatingBeam) -> list[bool]:
    """Without coupling lag rises and extension falls with speed; with it the first extension rises."""
    below = SPEEDS[0.3 * beam.critical_speed > SPEEDS]
    lag, extension = (frequency_sweep(beam, SPEEDS, 1, (motion,), gyroscopic=False)[:, 0] for motion in ("lag", "extension"))
    coupled = frequency_sweep(beam, below, 3, LAG_EXTENSION)[:, 2]
    return [
        bool(np.all(np.diff(lag) > 0.0)),
        bool(np.all(np.diff(extension[beam.critical_speed > SPEEDS]) < 0.0)),
        bool(np.all(np.diff(coupled) > 0.0)),
    ]


def mode_exchange(which: int) -> Callable[[Model], Outcome]:
    """Figures 3.9 and 3.10: the shapes of both loci before, at and after a veering, and how alike they stay."""

    def compute(model: Model) -> Outcome:
        beam = model.beam(0.0)
        veering = veerings(beam)[which]
        distances = np.arange(10.0, 331.0, 20.0)
        alike = np.array([exchange(beam, veering, distance) for distance in distances])
        near = [veering, replace(veering, speed=PRINTED[which])]
        abrupt = [swapped(exchange(beam, place, CLOSE)) for place in near]
        across = Panel(
            f"assurance across {veering.speed:.0f} rad/s",
            "distance before and after (rad/s)",
            "modal assurance criterion",
            [
                Curve(distances, alike[:, 0, 0], "lower locus with itself"),
                Curve(distances, alike[:, 1, 1], "upper locus with itself"),
                Curve(distances, alike[:, 0, 1], "lower with upper locus"),
            ],
        )
        evidence = {"abrupt": abrupt, "exchange": [swapped(alike[-1])]}
        rows = [[f"{d:g}", *(f"{value:.4f}" for value in a.ravel())] for d, a in zip(distances, alike, strict=True)]
        header = ["rad/s before and after", "lower–lower", "lower–upper", "upper–lower", "upper–upper"]
        return Outcome(evidence, [*shapes_through(beam, veering), across], {}, header, rows)

    return compute


def swapped(alike: np.ndarray) -> list[bool]:
    """Whether each locus resembles the other one more than itself across a veering, by their criteria (2, 2)."""
    return [bool(alike[0, 1] > alike[0, 0]), bool(alike[1, 0] > alike[1, 1])]


def shapes_through(beam: RotatingBeam, veering: Veering) -> list[Panel]:
    """Lag displacement of both loci at three speeds."""
    rows = beam.displacements(STATIONS * beam.length)["u"]
    panels = []
    for offset, name in enumerate(("lower locus, lag", "upper locus, lag")):
        curves: list[Curve] = []
        for step in (-100.0, 0.0, 100.0):
            modes = beam.modes(veering.speed + step, veering.lower + 2, LAG_EXTENSION)
            shape = normalised(rows @ modes.mode_shapes[:, veering.lower + offset])
            sign = -1.0 if curves and curves[0].y @ shape < 0.0 else 1.0
            curves.append(Curve(STATIONS, sign * shape, f"{veering.speed + step:.0f} rad/s"))
        panels.append(Panel(name, "z/L", "displacement / largest", curves))
    return panels


def exchange_study(name: str, title: str, which: int) -> Study:
    """Figure 3.9 or 3.10."""
    wide = (
        "The loci stay a wide gap apart (Figure 3.8's CSV): gyroscopic coupling is strong there, so the modes change over "
        "hundreds of rad/s. Shapes are compared by the modal "
        "assurance criterion (MAC), weighted with the mass matrix."
    )
    return Study(
        name,
        title,
        "θ = 0°, untwisted; at the least gap found by us, and at the thesis' speed",
        (
            Statement(
                "abrupt",
                f"Mode shapes change abruptly for a small change of speed: exchanged within ±{CLOSE:g} rad/s",
                Holds(),
                wide,
            ),
            Statement("exchange", "The loci exchange their modes: exchanged within ±330 rad/s", Holds(), wide),
        ),
        mode_exchange(which),
    )


STUDIES = (
    Study(
        "figure-3.8",
        "First five lag–extension loci to 1500 rad/s",
        "θ = 0°, untwisted; vertical lines: both veerings and the critical speed",
        (
            Statement(
                "critical",
                "The first frequency becomes zero at about 1480 rad/s",
                Matches(PRINTED_CRITICAL, 0.02, 0.10, "rad/s"),
                "The extension's stiffness is used up at Ω* = (π/2L)√(a11/b1) for every hub radius; the thesis reads its value "
                "off the plot. This is so about the blade at rest. In the blade's model, about the steady state, the first "
                "frequency rises to 272 rad/s at 800 rad/s, and the blade is unstable before 850.",
            ),
            Statement(
                "lag-buckles",
                "With coupling the lag mode becomes zero, without it the extension mode",
                Holds(),
                "Both vanish at the same Ω*, where the stretch has lost its stiffness: followed from rest, the locus that "
                "vanishes is the first lag, "
                "but at 1400 rad/s 82 % of its kinetic energy is in extension.",
            ),
            Statement("rises-then-falls", "The first lag frequency rises with speed, then falls as coupling dominates", Holds()),
            Statement("uncoupled", "Without coupling lag rises and extension falls with speed; with it extension rises", Holds()),
            Statement(
                "veerings",
                "Second lag and first extension, third lag and second extension veer at 430 and 925 rad/s: least gap",
                Matches(PRINTED, 0.02, 0.10, "rad/s"),
                "The speeds the thesis reads off are near those at which the uncoupled loci cross; the coupled loci are closest "
                "later.",
            ),
            Statement(
                "crossings",
                "The same, taken as where the loci cross without coupling",
                Matches(PRINTED, 0.02, 0.10, "rad/s"),
                aside=True,
            ),
        ),
        loci,
    ),
    exchange_study("figure-3.9", "Mode shapes through the first veering", 0),
    exchange_study("figure-3.10", "Mode shapes through the second veering", 1),
)
