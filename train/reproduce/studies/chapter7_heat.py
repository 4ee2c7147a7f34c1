"""Section 7.2, done: temperature, in free and in forced vibration and under control, and what checks it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from baselines import no_control, reference_lqg, robust_lqg
from baselines.analysis.stationary import stationary_cost
from beamenv import Design, RotatingBeamEnv
from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.structure import BoxSection, Lamina, Layup, RotatingBeam, StripSection
from beamenv.structure.walls.laminate import Ply
from train.figures.figure import Curve, Panel
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Below, Changes, Holds, Small
from train.reproduce.studies.closed_loop import SHOWN, simulate
from train.reproduce.thesis import Model

Array = NDArray[np.float64]

ROOM = 300.0
"""K."""
CELSIUS = (-50.0, -25.0, 0.0, 26.85, 50.0, 75.0, 100.0)
MODES = 4
AT = (0.0, 200.0)
"""rad/s."""
DRAWN = (-50.0, 26.85, 100.0)

ALPHA, STEEL_ALPHA = 23e-6, 12e-6
"""1/K."""
ALUMINIUM = Lamina.isotropic(70e9, 0.3, 2700.0, ALPHA)
STEEL = Lamina.isotropic(210e9, 0.3, 7850.0, STEEL_ALPHA)
WIDTHS = (0.002, 0.01, 0.1)
THICKNESS = 0.002
"""m, of two equal layers."""
SLENDER = 6.0
"""m, of a box 0.1 m wide."""
CLAMPED = (1e12,) * 6
SHARES = (0.0, 0.2, 0.4, 0.6, 0.8, 0.9)
"""Of the buckling load."""


def bent_strips() -> Array:
    """Curvatures per K of strips of steel on aluminium over Timoshenko's, less 1."""
    n, plies = STEEL.E1 / ALUMINIUM.E1, (Ply(STEEL, 0.0), Ply(ALUMINIUM, 0.0))
    by_hand = 24.0 * (ALPHA - STEEL_ALPHA) / (THICKNESS * (12.0 + (1.0 + n) * (1.0 + 1.0 / n)))
    found = []
    for width in WIDTHS:
        beam = RotatingBeam(StripSection(width, THICKNESS), Layup(plies), 1.0, temperature=ROOM + 1.0)
        expansion = beam.exact.sections.solid.expansion
        assert expansion is not None
        found.append(abs(expansion.strain[0, 3, 0]))
    return np.array(found) / by_hand - 1.0


def compressed(share: float) -> float:
    """(β L)² of the lowest vibration of a clamped-clamped beam under a share of its buckling load, 4 π² EI/L²."""
    half = 2.0 * np.pi**2 * share

    def equation(frequency: float) -> float:
        root = np.sqrt(half**2 + frequency**2)
        a, b = np.sqrt(root - half), np.sqrt(root + half)
        return float(2.0 * a * b * (1.0 - np.cosh(a) * np.cos(b)) + (a * a - b * b) * np.sinh(a) * np.sin(b))

    return float(brentq(equation, 1.0, 24.0))


def held_bars(model: Model) -> Outcome:
    """A box that is clamped at both ends and heated, and strips of two metals."""
    bar = RotatingBeam(BoxSection(0.1, 0.05, 0.004), Layup.uniform(ALUMINIUM, [0.0]), SLENDER, terms=10, tip_springs=CLAMPED)
    solid = bar.exact.sections.solid
    compliance = np.linalg.inv(solid.stiffness[0])
    euler = 4.0 * np.pi**2 / (SLENDER**2 * compliance[3, 3])
    load = euler / (1.0 + euler * compliance[1, 1])
    rise = load / (solid.stiffness[0, 2, 2] * ALPHA)
    found = [_lowest(replace(bar, temperature=ROOM + share * rise)) for share in SHARES]
    expected = [compressed(share) for share in SHARES]
    ratios, by_hand = np.array(found) / found[0], np.array(expected) / expected[0]
    low, high = 0.5 * rise, 1.5 * rise
    while high - low > 1e-4 * rise:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _stands(bar, middle) else (low, middle)
    evidence = {"strip": bent_strips(), "buckling": low / rise - 1.0, "vibration": (ratios - by_hand)[1:]}
    shares = np.linspace(0.0, 0.99, 100)
    curve = np.array([compressed(share) for share in shares]) / compressed(0.0)
    curves = [
        Curve(shares, curve, "characteristic equation"),
        Curve(shares, np.sqrt(1.0 - shares), "√(1 − P/P_cr)", "dotted"),
        Curve(np.array(SHARES), ratios, "the heated blade", "points"),
    ]
    panel = Panel("clamped at both ends", "thermal force over the buckling load", "frequency over that without heat", curves)
    return Outcome(evidence, [panel])


def _lowest(beam: RotatingBeam) -> float:
    return float(beam.natural_frequencies(0.0, 1, ("flap",))[0])


def _stands(beam: RotatingBeam, rise: float) -> bool:
    try:
        replace(beam, temperature=ROOM + rise).at(0.0)
    except ValueError:
        return False
    return True


@lru_cache(maxsize=1)
def at_room() -> Blade:
    """The default blade with the instruments that it has there."""
    return Blade(BladeConfig()).with_fixed_range()


@lru_cache(maxsize=len(CELSIUS))
def warm(celsius: float) -> Blade:
    """The same at another temperature."""
    room = at_room()
    return room.changed(replace(room.config, beam=replace(room.config.beam, temperature=celsius + 273.15)))


def free(model: Model) -> Outcome:
    """Frequencies of the blade over temperature, at rest and turning."""
    loci = np.array([[warm(each).beam.natural_frequencies(speed, MODES) for speed in AT] for each in CELSIUS])
    x = np.array(CELSIUS)
    panels = [
        Panel(f"{speed:g} rad/s", "temperature (°C)", "frequency (rad/s)", [
            Curve(x, loci[:, k, mode], f"mode {mode + 1}") for mode in range(MODES)
        ])
        for k, speed in enumerate(AT)
    ]  # fmt: skip
    evidence = {
        "rest": loci[:, 0].T,
        "turning": loci[:, 1].T,
        "less": (np.ptp(loci, axis=0) / loci[0])[1] < (np.ptp(loci, axis=0) / loci[0])[0],
    }
    header = ["°C", *(f"mode {mode + 1} at {speed:g} rad/s (rad/s)" for speed in AT for mode in range(MODES))]
    rows = [[f"{each:g}", *row.ravel().tolist()] for each, row in zip(CELSIUS, loci, strict=True)]
    return Outcome(evidence, panels, header=header, rows=rows)


def controlled(model: Model) -> Outcome:
    """Step of load and settled J over temperature, of the plant that moves: without control, under what is designed at room
    temperature, and under LQG told the blade.
    """
    design = Design.of(at_room())
    untold = (reference_lqg(design.full_plant), robust_lqg(design))
    rows, curves = [], []
    for celsius in CELSIUS:
        plant = warm(celsius).truth
        laws = (no_control(plant), *untold, reference_lqg(Design.of(warm(celsius)).full_plant))
        responses = [simulate(plant, law, model.load, 0.5) for law in (laws[0], laws[2])]
        rows.append([*(each.peak for each in responses), responses[1].settling, *(stationary_cost(plant, law) for law in laws)])
        if celsius in DRAWN:
            shown = responses[0].times <= SHOWN
            for response, line in zip(responses, ("dotted", "solid"), strict=True):
                curves.append(Curve(response.times[shown], 1e3 * response.tip[shown], f"{celsius:.0f} °C".replace("-", "−"), line))
    table = np.array(rows)
    alone, plain, robust, told = table[:, 3:].T
    x, stable = np.array(CELSIUS), np.isfinite(plain)
    shares = [
        Curve(x[stable], (plain / alone)[stable], "LQG of 27 °C"),
        Curve(x, robust / alone, "robust LQG of 27 °C"),
        Curve(x, told / alone, "LQG told the blade"),
    ]
    panels = [
        Panel("step in flap", "time (s)", "tip displacement (mm)", curves),
        Panel("settled J over that without control", "temperature (°C)", "share", shares),
    ]
    evidence = {
        "forced": table[:, 0],
        "robust": np.isfinite(robust),
        "plain": stable == (x < 60.0),
        "better": robust < 0.45 * alone,
        "told": told <= (1.0 + 1e-6) * np.minimum(plain, robust),
    }
    header = ["°C", "peak without control (mm)", "peak, robust (mm)", "settling, robust (s)"]
    header += [f"J, {law} (J/s)" for law in ("no control", "LQG of 27 °C", "robust", "LQG told")]
    scaled = table * np.array([1e3, 1e3, 1.0, 1.0, 1.0, 1.0, 1.0])
    listed = [[f"{each:g}", *row.tolist()] for each, row in zip(CELSIUS, scaled, strict=True)]
    notes = [
        f"Robust LQG, not told the temperature, costs up to {100.0 * (robust / told - 1.0).max():.2g} % more than LQG that is."
    ]
    styles = {"solid": "left: under robust LQG of 27 °C", "dotted": "left: no control"}
    return Outcome(evidence, panels, styles, header=header, rows=listed, notes=notes)


RISING = {
    "temperature": ROOM,
    "temperature_change": 3.0,
    "drift_onset": 0.05,
    "drift_duration": 0.3,
    "pyroelectric": True,
    "bank": 2,
}
QUIET = {**dict.fromkeys(("step", "pulse", "deflection", "harmonic"), 0.0), "white_load": False, "sensor_noise": False}


def pyroelectric(model: Model) -> Outcome:
    """What LQG of all modes makes of patches that warm by 3 K in 0.3 s while nothing else happens."""
    env = RotatingBeamEnv(scenario=QUIET | {"plants": RISING}, dtype="float64")
    law, memory = reference_lqg(env.task.design.full_plant), None
    reading, _ = env.reset(seed=0)
    shown, tips = [reading], [np.zeros(2)]
    for _ in range(env.task.steps):
        action, memory = law.predict(reading, memory)
        reading, _, _, _, info = env.step(action)
        shown.append(reading)
        tips.append(info["tip_displacement"])
    times: Array = env.task.config.control_interval * np.arange(len(tips), dtype=np.float64)
    truth = at_room().truth
    step = simulate(truth, no_control(truth), model.load, SHOWN).peak
    moved = np.linalg.norm(tips, axis=1)
    panels = [
        Panel("first patch's reading", "time (s)", "share of its range", [Curve(times, np.array(shown)[:, 0])]),
        Panel("tip, LQG", "time (s)", "displacement (µm)", [
            Curve(times, 1e6 * along, name) for name, along in zip(("lag", "flap"), np.array(tips).T, strict=True)
        ]),
    ]  # fmt: skip
    evidence = {"reading": 100.0 * np.abs(shown).max(), "moved": moved.max() / step}
    return Outcome(evidence, panels)


BLADE = (
    "the default blade, 30° pretwist, graphite-epoxy that softens as a dry epoxy does, MFC patches; free of thermal strain at 27 °C"
)

STUDIES = (
    Study(
        "heat-checks",
        "bimetal strips, and a heated bar that is held",
        "steel on aluminium, 2 … 100 mm wide and 2 mm thick; an aluminium box, 6 m long, held by springs of 10¹² N/m, N m/rad",
        (
            Statement("strip", "A two-layer strip bends as Timoshenko (1925) says, whatever its width", Small(1e-9, 1e-3)),
            Statement("buckling", "The bar buckles at Euler's load over EA α, with shear", Small(5e-3, 2e-2)),
            Statement("vibration", "Until then its frequency is that of the compressed clamped beam", Small(1e-2, 3e-2)),
        ),
        held_bars,
    ),
    Study(
        "heat-blade",
        "frequencies over temperature",
        f"{BLADE}; −50 … 100 °C, 0 and 200 rad/s",
        (
            Statement("rest", "At rest all four frequencies fall as the blade warms", Changes(-1)),
            Statement("turning", "At 200 rad/s as well", Changes(-1)),
            Statement("less", "Turning, they change by less", Holds()),
        ),
        free,
        rows_on_page=True,
    ),
    Study(
        "heat-control",
        "forced and controlled response over temperature",
        f"{BLADE}; 200 rad/s, all modes and the electronics, step of 30 N/m in flap; J under the white load",
        (
            Statement("forced", "The warmer the blade, the further the load throws its tip", Changes(+1)),
            Statement("plain", "LQG of all modes at 27 °C is stable from −50 to 50 °C, but not at 75 and 100 °C", Holds()),
            Statement("robust", "Robust LQG of 27 °C is stable at all of them", Holds()),
            Statement("better", "It leaves less than 45 % of J at all of them", Holds()),
            Statement("told", "Knowing the temperature never costs anything", Holds()),
        ),
        controlled,
        rows_on_page=True,
    ),
    Study(
        "heat-pyroelectric",
        "patches that feel their own warming",
        "the default blade at 27 °C, LQG of all modes; 3 K in 0.3 s, nothing else happens",
        (
            Statement("reading", "A patch's current shows less than 5 % of its range", Below(5.0, "%")),
            Statement(
                "moved", "LQG, misled, moves the tip by less than a twentieth of what a step of 30 N/m does", Below(0.05, "of it")
            ),
        ),
        pyroelectric,
    ),
)
