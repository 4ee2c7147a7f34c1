"""Section 7.2, done: functionally graded walls, in free vibration, under load and under control."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from baselines import lqg, no_control
from baselines.analysis.stationary import stationary_cost
from beamenv.blade import BladeConfig, blade_config
from beamenv.structure import FunctionallyGraded, Lamina, Layup, RotatingBeam, StripSection
from beamenv.structure.sweep import frequency_sweep
from beamenv.structure.walls.named import SILICON_NITRIDE, SUS304
from train.figures.figure import Curve, Panel
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Changes, Holds, Matches, Small
from train.reproduce.studies.closed_loop import SHOWN, plant_of, simulate
from train.reproduce.thesis import Model

Array = NDArray[np.float64]

EXPONENTS = (0.0, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 50.0, 1e6)
"""Silicon nitride alone, ever more steel, and steel alone."""
CONTROLLED = (0.0, 0.1, 0.5, 1.0, 2.0, 10.0, 1e6)
DRAWN = slice(1, -1)
AT = (0.0, 200.0)
"""rad/s."""
MODES = 4
HEATED, KELVIN = (0.5, 5.0), (300.0, 600.0, 900.0)

SPEEDS = (0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0)
PRINTED = (3.516015, 4.137320, 5.585001, 7.360373, 9.256838, 11.202328, 13.170150)
"""First flap frequency of a uniform cantilever that turns at these speeds about its root, both times √(m L⁴/EI) (Wright, Smith,
Thresher and Wang, Journal of Applied Mechanics 49, 1982, and others)."""
SLENDERNESS = 5000.0
STRIP = StripSection(0.02, 0.01)


@lru_cache(maxsize=16)
def blade(material: FunctionallyGraded | Lamina) -> BladeConfig:
    """The thesis' blade with walls of it."""
    return blade_config("thesis", {"beam": {"material": material, "ply_angles_deg": [0.0]}})


def graded(exponent: float) -> FunctionallyGraded:
    """Steel within, silicon nitride outside."""
    return FunctionallyGraded("sus304", "silicon-nitride", exponent)


def moments(material: FunctionallyGraded) -> tuple[Array, float]:
    """A, B, D of a strip by hand, from ∫ξᵖ ξᵏ dξ = 1/(p + k + 1), for a metre of width; and its mass."""
    (inner, outer), p, h = material.constituents, material.exponent, STRIP.thickness

    def through(first: float, last: float) -> Array:
        whole, changing = (np.array([1.0 / (q + k + 1.0) for k in range(3)]) for q in (0.0, p))
        of_face = first * whole + (last - first) * changing
        about_middle = np.array([[1.0, 0.0, 0.0], [-0.5, 1.0, 0.0], [0.25, -1.0, 1.0]]) @ of_face
        return np.asarray(about_middle * h ** np.arange(1, 4))

    return through(inner.E1, outer.E1), float(through(inner.density, outer.density)[0])


def turning_strip(exponent: float) -> tuple[Array, Array]:
    """First flap frequencies times T at ``SPEEDS``; and by how much EA, ES and EI of its section differ from those by hand.

    Moduli and densities are 1 : 10, so that the mass lies on the neutral axis, where D − B²/A is the bending stiffness.
    """
    material = FunctionallyGraded(Lamina.isotropic(1.44e9, 0.0, 1220.0), Lamina.isotropic(14.4e9, 0.0, 12200.0), exponent)
    layup = Layup.uniform(material, [0.0])
    (A, B, D), mass = moments(material)
    bending = D - B**2 / A
    length = SLENDERNESS * float(np.sqrt(bending / A))
    time = float(np.sqrt(mass * length**4 / bending))
    beam = RotatingBeam(STRIP, layup, length, 0.0, shear="rigid", terms=12)
    found = [time * beam.natural_frequencies(speed / time, 1, ("flap", "extension"), gyroscopic=False)[0] for speed in SPEEDS]
    stiffness = STRIP.properties(layup).classical_stiffness / STRIP.width
    return np.array(found), np.array([stiffness[0, 0] / A, abs(stiffness[0, 1] / B), stiffness[1, 1] / D]) - 1.0


def turning_strips(model: Model) -> Outcome:
    """A strip whose frequencies are printed."""
    exponents = (0.5, 1.0, 10.0)
    found, hand = zip(*(turning_strip(exponent) for exponent in exponents), strict=True)
    curves = [Curve(np.array(SPEEDS), row, f"exponent {p:g}", "points") for p, row in zip(exponents, found, strict=True)]
    apart = [Curve(np.array(SPEEDS), 1e6 * (row / np.array(PRINTED) - 1.0), c.label) for c, row in zip(curves, found, strict=True)]
    panels = [
        Panel("first flap", "speed × T", "frequency × T", [Curve(np.array(SPEEDS), np.array(PRINTED), "printed"), *curves]),
        Panel("what hides there", "speed × T", "off what is printed (10⁻⁶)", apart),
    ]
    rows = [[f"{speed:g}", printed, *numbers] for speed, printed, *numbers in zip(SPEEDS, PRINTED, *found, strict=True)]
    header = ["speed × T", "printed", *(f"exponent {p:g}" for p in exponents)]
    return Outcome({"printed": np.concatenate(found), "hand": np.concatenate(hand)}, panels, header=header, rows=rows)


def free(model: Model) -> Outcome:
    """Frequencies over the exponent, at rest and turning."""
    loci = frequency_sweep([blade(graded(exponent)).beam.build() for exponent in EXPONENTS], list(AT), MODES)
    alone = frequency_sweep([blade(each).beam.build() for each in (SILICON_NITRIDE, SUS304)], list(AT), MODES)
    hot = [[blade(graded(exponent).at(kelvin)).beam.build() for kelvin in KELVIN] for exponent in HEATED]
    heated = np.stack([frequency_sweep(beams, list(AT), MODES) for beams in hot])
    evidence = {
        "hot": heated.swapaxes(1, -1).reshape(-1, len(KELVIN)),
        "limits": loci[[0, -1]] / alone - 1.0,
        "steel": loci.reshape(len(EXPONENTS), -1).T,
        "speed": loci[:, 1] > loci[:, 0],
    }
    x = np.array(EXPONENTS[DRAWN])
    panels = [
        Panel(f"{speed:g} rad/s", "exponent", "frequency (rad/s)", [
            Curve(x, loci[DRAWN, k, mode], f"mode {mode + 1}") for mode in range(MODES)
        ], x_linear_within=0.1)
        for k, speed in enumerate(AT)
    ]  # fmt: skip
    header = ["exponent", *(f"mode {mode + 1} at {speed:g} rad/s" for speed in AT for mode in range(MODES))]
    rows = [[f"{p:g}", *row.ravel().tolist()] for p, row in zip(EXPONENTS, loci, strict=True)]
    return Outcome(evidence, panels, header=header, rows=rows)


def controlled(model: Model) -> Outcome:
    """A step of load, with and without LQG, and the settled J of both under the white load."""
    tips, costs, curves, still = [], [], [], []
    for exponent in CONTROLLED:
        plant = plant_of(blade(graded(exponent)))
        laws = (no_control(plant), lqg(plant))
        responses = [simulate(plant, law, model.load) for law in laws]
        at_rest = plant_of(replace(blade(graded(exponent)), speed=0.0))
        still.append(simulate(at_rest, no_control(at_rest), model.load, SHOWN).peak)
        tips.append([each.peak for each in responses])
        costs.append([stationary_cost(plant, law) for law in laws])
        if exponent in (0.1, 1.0, 10.0):
            shown = responses[0].times <= SHOWN
            for response, line in zip(responses, ("dotted", "solid"), strict=True):
                curves.append(Curve(response.times[shown], 1e6 * response.tip[shown], f"exponent {exponent:g}", line))
    peaks, settled = np.array(tips), np.array(costs)
    x = np.array(CONTROLLED[DRAWN])
    share = Panel(
        "settled J, LQG over none",
        "exponent",
        "share",
        [Curve(x, (settled[:, 1] / settled[:, 0])[DRAWN])],
        x_linear_within=0.1,
    )
    evidence = {
        "turning": peaks[:, 0],
        "still": still,
        "peak": peaks[:, 1] < peaks[:, 0],
        "better": settled[:, 1] < 0.3 * settled[:, 0],
        "share": settled[:, 1] / settled[:, 0],
    }
    header = ["exponent", "peak at rest (µm)", "peak (µm)", "peak with LQG (µm)", "settled J (J/s)", "settled J with LQG (J/s)"]
    numbers = np.column_stack([1e6 * np.array(still), 1e6 * peaks, settled])
    rows = [[f"{p:g}", *row.tolist()] for p, row in zip(CONTROLLED, numbers, strict=True)]
    panels = [Panel("step in flap", "time (s)", "tip displacement (µm)", curves), share]
    return Outcome(evidence, panels, {"solid": "LQG", "dotted": "no control"}, header=header, rows=rows)


PAIR = "the thesis' blade, 30° pretwist, with walls of steel (SUS304) within and silicon nitride outside, Voigt's mixture at 300 K"

STUDIES = (
    Study(
        "graded-strip",
        "a rotating graded beam against printed frequencies",
        "a strip with E and ρ 1 : 10 through its thickness, L/r = 5000; times T = √(m L⁴/EI), EI = D − B²/A by hand",
        (
            Statement(
                "printed",
                "Exponents 0.5, 1 and 10: the first flap frequency is that of the uniform beam of the same EI, at all speeds",
                Matches(PRINTED * 3, 1e-4, 1e-2),
                "EI is 9 to 28 % less than D, the stiffness about the mid-line.",
            ),
            Statement("hand", "EA, its first moment and EI are what integration by hand gives", Small(1e-9, 1e-6)),
        ),
        turning_strips,
        rows_on_page=True,
    ),
    Study(
        "graded-blade",
        "frequencies over the exponent",
        f"{PAIR}; 0 and 200 rad/s",
        (
            Statement("limits", "Exponents 0 and ∞ are the blade of one material", Small(1e-12, 1e-9)),
            Statement(
                "steel", "All four frequencies fall as steel takes the place of the lighter and stiffer ceramic", Changes(-1)
            ),
            Statement("hot", "All four fall from 300 to 600 and 900 K, by the moduli of both materials alone", Changes(-1)),
            Statement("speed", "Turning stiffens all four at every exponent", Holds()),
        ),
        free,
    ),
    Study(
        "graded-control",
        "forced and controlled response over the exponent",
        f"{PAIR}; 200 rad/s, step of 30 N/m in flap; J under the white load",
        (
            Statement("still", "At rest the tip is thrown further the more of the wall is steel, the softer material", Changes(+1)),
            Statement("turning", "At 200 rad/s it is thrown less far: the heavier blade is the tighter one", Changes(-1)),
            Statement("peak", "LQG lowers the peak at every exponent", Holds()),
            Statement("better", "LQG leaves less than 30 % of the settled J at every exponent", Holds()),
            Statement("share", "The share that it leaves rises with the steel, whose mass the same patches move", Changes(+1)),
        ),
        controlled,
    ),
)
