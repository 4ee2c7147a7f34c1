"""Section 7.2, done: a finite-element model of the same energies, how fast it converges, and where polynomials agree with it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.config import BeamConfig, BladeConfig
from beamenv.structure import BoxSection, Lamina, Layup, RotatingBeam
from train.figures.figure import Curve, Panel
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Changes, Matches, Small
from train.reproduce.thesis import Model

Array = NDArray[np.float64]

BOX = BoxSection(width=0.1, depth=0.1, thickness=0.002)
METAL = Lamina.isotropic(E=70e9, nu=0.0, density=2700.0)
DEPTHS = 1000.0
"""Of the box in its length."""
MODE = 2
ORDERS = (2, 3, 4)
COUNTS = (2, 4, 8, 16)
RATED = {2: (2, 3), 3: (1, 2), 4: (1, 2)}
"""Between which two of these meshes the rate is taken: the last that is not near the first mode's rounding."""

BENDING_ROOT = 4.694091132974175
"""kL of a cantilever's second bending mode, cos kL cosh kL = −1."""

SMOOTH = {
    "uniform": BeamConfig(),
    "tapered 1.5 : 1": BeamConfig(taper=1.5),
    "without shear": BeamConfig(shear="rigid"),
}
AT = (0.0, 200.0)
"""rad/s."""
MODES = 8
POLYNOMIALS = (10, 16, 24)
MESHES = (4, 8, 16)


def elements(blade: BeamConfig, count: int, order: int) -> BeamConfig:
    """The blade made of finite elements."""
    return replace(blade, discretisation="finite-elements", elements=count, element_order=order)


def excess(motion: str, order: int) -> Array:
    """By how much the second eigenvalue of a slender box lies above the closed form, for even meshes of ``COUNTS``."""
    length = DEPTHS * BOX.depth
    layup = Layup.uniform(METAL, [0.0])
    axial, bending = np.diag(BOX.stiffness(layup, shear="rigid", model="thesis"))[:2]
    mass = axial / METAL.E1 * METAL.density
    wave = {"flap": BENDING_ROOT**4 * bending / length**4, "extension": (1.5 * np.pi) ** 2 * axial / length**2}[motion]
    inertia = {"flap": BENDING_ROOT**2 * rotary(bending / axial) / length**2, "extension": 0.0}[motion]
    found = []
    for count in COUNTS:
        mesh = tuple(np.linspace(0.0, 1.0, count + 1))
        bare = RotatingBeam(BOX, layup, length, shear="rigid", model="thesis")
        beam = replace(bare, discretisation="finite-elements", mesh=mesh, element_order=order)
        found.append(beam.natural_frequencies(0.0, MODE, (motion,))[MODE - 1] ** 2)
    return np.array(found) / (wave / mass) * (1.0 + inertia) - 1.0


def rotary(radius_squared: float) -> float:
    """What rotary inertia adds to the modal mass of the second mode, over k²: r² ∫w'²/∫w² by k², of a cantilever."""
    k, z = BENDING_ROOT, np.linspace(0.0, 1.0, 4001)
    share = (np.cosh(k) + np.cos(k)) / (np.sinh(k) + np.sin(k))
    shape = np.cosh(k * z) - np.cos(k * z) - share * (np.sinh(k * z) - np.sin(k * z))
    slope = np.sinh(k * z) + np.sin(k * z) - share * (np.cosh(k * z) - np.cos(k * z))
    return radius_squared * float(np.trapezoid(slope**2, z) / np.trapezoid(shape**2, z))


def rate(errors: Array, order: int) -> float:
    """The power of an element's length."""
    first, second = RATED[order]
    return float(np.log2(errors[first] / errors[second]))


@lru_cache
def finest(speed: float) -> Array:
    """Frequencies of the uniform blade."""
    return elements(BeamConfig(), 16, 6).build().natural_frequencies(speed, MODES)


def worst(blade: BeamConfig) -> tuple[int, float]:
    """Coefficients, and the largest deviation of the uniform blade's frequencies at rest."""
    beam = blade.build()
    return beam.space.size, float(np.abs(beam.natural_frequencies(0.0, MODES) / finest(0.0) - 1.0).max())


def converging(model: Model) -> Outcome:
    """Errors over meshes, and over the number of coefficients of the thesis' blade."""
    counts = np.array(COUNTS, dtype=np.float64)
    panels, rates, above = [], [], []
    for title, motion in (("bending: Hermite's elements", "flap"), ("extension: Lagrange's elements", "extension")):
        errors = {order: excess(motion, order) for order in ORDERS}
        rates += [rate(errors[order], order) for order in ORDERS]
        above += [errors[order][:3] for order in ORDERS]
        curves = [Curve(counts[errors[p] > 0], errors[p][errors[p] > 0], f"order {p}") for p in ORDERS]
        panels.append(Panel(title, "elements", "error of eigenvalue 2", curves, True, x_logarithmic=True))
    by = {
        "polynomials": np.array([worst(replace(BeamConfig(), terms=terms)) for terms in POLYNOMIALS]),
        **{f"order {p}": np.array([worst(elements(BeamConfig(), count, p)) for count in MESHES]) for p in ORDERS},
    }
    lines = {"polynomials": "dashed"}
    curves = [Curve(each[:, 0], each[:, 1], label, lines.get(label, "solid")) for label, each in by.items()]
    label = "coefficients", "worst of 8 frequencies"
    panels.append(Panel("the thesis' blade at rest, bare", *label, curves, logarithmic=True))
    falling = np.stack([by[f"order {p}"][:, 1] for p in ORDERS])
    return Outcome({"rates": rates, "above": np.array(above), "blade": falling}, panels)


def agreement(model: Model) -> Outcome:
    """Frequencies both ways, and what a volt does to the tip."""
    found = {name: both_ways(blade) for name, blade in SMOOTH.items()}
    apart = {f"{name}, {speed:g} rad/s": each for name, both in found.items() for speed, each in zip(AT, both, strict=True)}
    exact, *others = (
        tip_per_volt(Blade(BladeConfig(beam=beam, speed=0.0)))
        for beam in (elements(BeamConfig(), 16, 5), elements(BeamConfig(), 12, 4), BeamConfig())
    )
    edges = dict(zip(("12 elements of order 4", "16 polynomials"), (each / exact - 1.0 for each in others), strict=True))
    modes, patches = np.arange(1.0, MODES + 1.0), middles(BladeConfig())
    panels = [
        Panel("no patches", "mode", "frequencies apart", [
            Curve(modes, np.abs(each), name) for name, each in apart.items()
        ], logarithmic=True),
        Panel("default blade at rest", "middle of the patch (m)", "tip in flap per volt off", [
            Curve(patches, np.abs(each[1]), name, "dashed") for name, each in edges.items()
        ], logarithmic=True),
    ]  # fmt: skip
    evidence = {"smooth": np.array(list(apart.values())), **dict(zip(("elements", "polynomials"), edges.values(), strict=True))}
    compared = [(name, f"{MODES} frequencies, elements and polynomials", each) for name, each in apart.items()]
    compared += [("default blade at rest", f"tip per volt, {name}", each) for name, each in edges.items()]
    rows = [[blade, of, f"{np.abs(each).max():.1e}"] for blade, of, each in compared]
    return Outcome(evidence, panels, header=["blade", "of", "largest deviation"], rows=rows)


def middles(config: BladeConfig) -> Array:
    """(m,): where the actuators are, m."""
    placed = config.patches.only("actuators").inlays("actuators", config.beam.length)
    return np.array([inlay.start + 0.5 * inlay.length for inlay in placed])


def both_ways(blade: BeamConfig) -> Array:
    """(speeds, MODES): frequencies of finite elements over those of polynomials, less 1."""
    beams = elements(blade, 8, 6).build(), replace(blade, terms=24).build()
    one, other = (np.array([beam.natural_frequencies(speed, MODES) for speed in AT]) for beam in beams)
    return np.asarray(one / other - 1.0)


def tip_per_volt(blade: Blade) -> Array:
    """(2, m), m/V: lag and flap of the tip at rest."""
    return np.asarray(blade.full.tip @ np.linalg.solve(blade.beam.at(0.0).stiffness, blade.full.forces))


STUDIES = (
    Study(
        "element-convergence",
        "finite elements converge",
        "a slender box of the thesis' model without shear, even meshes, against closed forms (rotary inertia taken out to first "
        "order); and the thesis' bare blade against 16 elements of order 6",
        (
            Statement(
                "rates",
                "Eigenvalues converge with the power 2p of an element's length: 4, 6 and 8 for orders 2, 3 and 4, of both kinds",
                Matches((4.0, 6.0, 8.0) * 2, 0.1, 0.2),
            ),
            Statement("above", "Errors are positive and fall with every finer mesh", Changes(-1)),
            Statement("blade", "So they do on the thesis' blade, its clamp's layer included", Changes(-1)),
        ),
        converging,
    ),
    Study(
        "element-agreement",
        "finite elements and polynomials agree where both converge",
        "8 elements of order 6 and 24 polynomials; the default blade with its patches by default numbers of both, against 16 "
        "elements of order 5",
        (
            Statement("smooth", "Without edges of patches: eight frequencies within 1e-6, at rest and turning", Small(1e-6, 1e-5)),
            Statement("elements", "With them: the tip per volt within 1e-5 by the default elements", Small(1e-5, 1e-4)),
            Statement(
                "polynomials",
                "And within 3 % by the default polynomials, which cannot follow what patches do to strains",
                Small(0.03, 0.1),
            ),
        ),
        agreement,
        rows_on_page=True,
    ),
)
