"""7.2, done: which of its equations the thesis computed with, by what it prints itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.structure import GRAPHITE_EPOXY
from train.figures.figure import Curve, Panel
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Holds, Large, Matches, Small
from train.reproduce.studies.chapter3_tables import DOUBTED, PRINTED_3_3, UNDER_CONVERGED_TERMS
from train.reproduce.studies.parameter_studies import PLY_ANGLES_DEG
from train.reproduce.thesis import Model
from train.reproduce.thesis.as_printed import printed_stiffness, uniform_tension
from train.reproduce.thesis.equations import PRINTED_Q12
from train.reproduce.thesis.frequencies import presetting_and_speed, wall_thickness
from train.reproduce.thesis.printed import numbers
from train.reproduce.thesis.readings import read_by

Array = NDArray[np.float64]

TABLE_3_3 = tuple(PRINTED_3_3[~DOUBTED])
TAPERS = (1.0, 2.0, 4.0)
SHARES = np.linspace(0.0, 1.0, 41)
"""z/L."""


def span_modulus(stiffness: Array) -> float:
    """Q̄22 − Q̄12²/Q̄11, Pa: of a wall that is free to contract around the contour."""
    return float(stiffness[1, 1] - stiffness[0, 1] ** 2 / stiffness[0, 0])


def tensions(model: Model, taper: float) -> tuple[Array, Array]:
    """The tension's share of the uniform blade's at the root (41,), true and as the thesis takes it, of mass as the perimeter."""
    length, hub = model.box.length, model.box.hub_radius
    z, narrowing = SHARES * length, (1.0 - 1.0 / taper) / length
    inner = hub * (length - z) + 0.5 * (length**2 - z**2)
    missing = narrowing * (0.5 * hub * (length**2 - z**2) + (length**3 - z**3) / 3.0)
    return (inner - missing) / inner[0], uniform_tension(1.0 - narrowing * z, hub, length, z) / inner[0]


def equations(model: Model) -> Outcome:
    """What the thesis' Tables 3.3 and 3.4 say of its equations, and what two of these do."""
    by_jones, as_printed = (
        np.array([span_modulus(q(angle)) for angle in np.radians(PLY_ANGLES_DEG)])
        for q in (GRAPHITE_EPOXY.transformed_stiffness, lambda angle: printed_stiffness(GRAPHITE_EPOXY, angle))
    )
    table_3_4 = np.array(numbers("table-3.4", "thesis"))
    taken = {taper: tensions(model, taper) for taper in TAPERS}
    evidence = {
        "jones": wall_thickness(model) / table_3_4 - 1.0,
        "misprint": wall_thickness(read_by(model, (PRINTED_Q12,))) / table_3_4 - 1.0,
        "six": presetting_and_speed(model, UNDER_CONVERGED_TERMS)[~DOUBTED],
        "tapered": [printed[0] / true[0] - 1.0 for true, printed in list(taken.values())[1:]],
        "minimum": [bool(np.all(np.diff(by_jones) > 0.0)), 0 < int(np.argmin(as_printed)) < len(as_printed) - 1],
    }
    curves = [
        Curve(PLY_ANGLES_DEG, 1e-9 * by_jones, "Jones"),
        Curve(PLY_ANGLES_DEG, 1e-9 * as_printed, "Eq. 4.5 as printed", "dotted"),
    ]
    tension = [
        Curve(SHARES, values, f"η = {taper:g}", line)
        for taper, pair in taken.items()
        for values, line in zip(pair, ("solid", "dotted"), strict=True)
    ]
    panels = [
        Panel("modulus along the span", "ply angle (°)", "Q̄22 − Q̄12²/Q̄11 (GPa)", curves, logarithmic=True),
        Panel("centrifugal tension", "z/L", "tension (uniform, root: 1)", tension),
    ]
    return Outcome(evidence, panels, {"solid": "true", "dotted": "as the thesis takes it"})


STUDIES = (
    Study(
        "thesis-equations",
        "what the thesis' own tables say of them",
        "Tables 3.3 and 3.4 as above; the lamina of Table 5.1; mass per length as the perimeter",
        (
            Statement("jones", "With Jones' Q̄ its Table 3.4 comes out", Small(1e-3, 1e-2)),
            Statement("misprint", "With the Q̄12 of its Eq. 4.5 it does not (largest deviation)", Large(5e-3, 1e-3)),
            Statement("six", "With six trial functions its Table 3.3 does", Matches(TABLE_3_3, 5e-4, 0.02, "rad/s")),
            Statement("tapered", "Its tension, b₁(z) R(z), is too large under taper (at the root, η = 2 and 4)", Large(0.2, 0.05)),
            Statement("minimum", "The modulus along the span has a minimum by Eq. 4.5 alone", Holds()),
        ),
        equations,
    ),
)
