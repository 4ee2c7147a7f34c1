"""Section 7.2, done: patches sized together with their places, both sides placed at once, and one patch on a beam by hand."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import lru_cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines.placement import JointProblem, SizingProblem
from baselines.placement.sizing.blades import cost_on_plant
from baselines.placement.sizing.designs import Designs
from baselines.placement.sizing.front import Patch, feasible, point
from baselines.placement.sizing.limits import Sizes
from baselines.placement.sizing.own_layouts import layouts_of
from beamenv.blade.config import BladeConfig
from beamenv.blade.presets import blade_config
from train.figures.figure import Curve, Look, Marker, Panel
from train.figures.patches import patches_panel, rows_of
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Changes, Marginal, Matches, Small, Substantial
from train.reproduce.thesis import Model

Array = NDArray[np.float64]

STEP = 5e-5
"""m: of differences."""
APART = (0.1, 0.45, 0.8, 1.2, 0.05, 0.3, 0.6, 1.0)
LENGTHS = (0.1, 0.06, 0.12, 0.08, 0.07, 0.09, 0.05, 0.1)
"""m: a design none of whose edges meet, where the cost has slopes."""
FROM_THE_ROOT = "from the root (m)"
NODE = 0.216575
"""Of a cantilever's span: where its second mode has no curvature."""
BETA = (1.8751040687, 4.6940911330)
"""Of a cantilever's first two modes."""


@lru_cache(maxsize=1)
def kept() -> dict[str, Any]:
    """Designs that ``beamenv place --size`` found, and layouts that ``--together`` found, which only their evaluation is quick."""
    content: dict[str, Any] = json.loads(files("train.reproduce.studies").joinpath("sized_front.json").read_text("utf-8"))
    return content


def designs_of(rows: list[list[float]]) -> Designs:
    """From rows of starts, lengths and sizes, m."""
    return Designs.of_rows(np.array(rows))


def front(model: Model) -> Outcome:
    """The trade-off, evaluated anew, beside the thesis' layout and the best of its patches."""
    config = BladeConfig()
    problem, designs, span = SizingProblem.of(config), designs_of(kept()["front"]), config.beam.length
    mass, cost = problem.mass(designs), problem.cost(designs)
    layouts = layouts_of(problem, config, placed=False)
    thesis = layouts[-1]
    some = list(range(0, len(designs), 4))
    on_plants = np.array([cost_on_plant(problem, point(problem, designs[[k]], 0.0)) for k in some])
    exact, numeric = slopes_both_ways(problem, designs_of([[*APART, *LENGTHS, *problem.own_sizes]]))
    evidence = {
        "front": cost,
        "cheaper": [cost[mass <= thesis.mass].min() / thesis.cost - 1.0],
        "lighter": [mass[cost <= thesis.cost].min() / thesis.mass - 1.0],
        "plants": cost[some] / on_plants - 1.0,
        "slopes": (exact - numeric) / np.abs(exact).max(),
        "made": [0.0 if feasible(problem, designs) else 1.0],
    }
    curves = [Curve(1e3 * mass, 1e6 * cost, "sized and placed", look=Look(marker=Marker(size=3.5)), joined="begins")]
    for each, marker in zip(layouts, (Marker(size=8, fill="none"), Marker(size=3.5)), strict=True):  # one lies upon the other
        look = Look(marker=marker, above=True)
        curves.append(Curve(np.array([1e3 * each.mass]), np.array([1e6 * each.cost]), f"own size, {each.name}", "points", look))
    quantities = "mass of piezo sheet (g)", "stationary cost of LQG (µJ)"
    panels = [
        Panel("cost against mass", *quantities, curves, logarithmic=True, x_logarithmic=True),
        replace(patches_panel([point(problem, designs[[k]], 0.0) for k in range(len(designs))], span), x_label=FROM_THE_ROOT),
    ]
    return Outcome(evidence, panels)


def slopes_both_ways(problem: SizingProblem, design: Designs) -> tuple[Array, Array]:
    """Slopes of the cost by starts and lengths of the patches that are there, exact and by differences, J/m."""
    exact = problem.cost_and_slopes(design)[1]
    there = np.flatnonzero(np.tile(design.lengths[0] > 0.0, 2))
    shifts = STEP * np.eye(design.rows.shape[1])[there]
    further, back = (problem.cost(Designs.of_rows(design.rows + way * shifts)) for way in (1.0, -1.0))
    return exact[there], (further - back) / (2.0 * STEP)


def together(model: Model) -> Outcome:
    """Both sides at once over one after the other, on two blades."""
    gains, rows, curves = [], [], []
    for name, layouts in kept()["together"].items():
        problem = JointProblem.of(blade_config(name))
        half, length = problem.bounds[0].count, problem.bounds[0].length
        costs = problem.cost(np.array([layouts["in turn"], layouts["at once"]]))
        gains.append(costs[1] / costs[0] - 1.0)
        for how, cost in zip(("in turn", "at once"), costs, strict=True):
            above, below = layouts[how][:half], layouts[how][half:]
            rows.append([name, how, *(" ".join(f"{each:.3f}" for each in side) for side in (above, below)), f"{1e6 * cost:.2f}"])
            actuators, sensors = ([Patch(start, length) for start in side] for side in (above, below))
            curves += rows_of(actuators, sensors, len(rows), problem.config.beam.length)
    names = [f"{blade}, placed {how}" for blade, how, *_ in rows]
    panel = Panel("patches along the span", FROM_THE_ROOT, "", curves, y_names=names)
    return Outcome({"gain": gains}, [panel], header=["blade", "placed", "actuators (m)", "sensors (m)", "cost (µJ)"], rows=rows)


def one_patch(model: Model) -> Outcome:
    """A patch without mass or stiffness on a uniform cantilever, whose authority over a mode is a difference of slopes."""
    strip = blade_config("aluminium-cantilever")
    own, span = strip.patches.only("actuators"), strip.beam.length
    exactly = (own.width, own.width), (own.patch.thickness, own.patch.thickness)
    light = replace(strip, patches=strip.patches.without_mass())
    problem = SizingProblem.of(light, Sizes(length=(0.005, span), width=exactly[0], thickness=exactly[1]))

    def authority(starts: Array, lengths: Array) -> Array:
        still = np.full(starts.shape, 0.05)
        sizes = np.tile(problem.own_sizes, (len(starts), 1))
        designs = Designs(np.column_stack([starts, still]), np.column_stack([lengths, still]), sizes)
        return problem.reduced(designs).input[:, strip.modes :, 0]

    starts, length = np.linspace(0.05, 0.25, 41), np.full(41, 0.05)
    found, curves, errors = authority(starts, length), [], []
    for mode, name in enumerate(("first", "second")):
        by_hand = slope(mode, (starts + length) / span) - slope(mode, starts / span)
        ours = found[:, mode] / (found[:, mode] @ by_hand / (by_hand @ by_hand))
        errors.append((ours - by_hand) / np.abs(by_hand).max())
        curves += [Curve(starts, ours, f"{name} mode"), Curve(starts, by_hand, f"{name} mode, by hand", "dashed")]
    begins = np.linspace(0.2, 0.24, 81) * span
    to_tip = authority(begins, span - begins)[:, 1]
    rooted = authority(np.linspace(0.0, 0.25, 26), np.full(26, 0.05))[:, 0]
    evidence = {
        "slopes": np.array(errors),
        "root": np.abs(rooted[[0, -1]]) / np.abs(rooted).max(),
        "node": [begins[np.abs(to_tip).argmax()] / span],
    }
    panel = Panel("a patch of 50 mm on a strip of 300 mm", "its root-side edge (m)", "authority (slopes, over 1/L)", curves)
    return Outcome(evidence, [panel])


def slope(mode: int, share: Array) -> Array:
    """φ′ of Euler and Bernoulli's cantilever at shares of its span."""
    beta = BETA[mode]
    ratio = (np.cosh(beta) + np.cos(beta)) / (np.sinh(beta) + np.sin(beta))
    return np.asarray(
        beta * (np.sinh(beta * share) + np.sin(beta * share) - ratio * (np.cosh(beta * share) - np.cos(beta * share)))
    )


STUDIES = (
    Study(
        "sizing-front",
        "patches sized and placed together",
        "the default blade; four and four patches at most, half to twice an M-8557-P1 in length, width and thickness; volts weigh "
        "alike in all designs; designs as found by beamenv place --size, evaluated anew",
        (
            Statement("front", "The closed loop's cost falls with the mass of the patches", Changes(-1)),
            Statement("cheaper", "With no more mass than the thesis' layout the cost is substantially lower", Substantial(-1, 0.2)),
            Statement("lighter", "The cost of the thesis' layout is reached with substantially less mass", Substantial(-1, 0.2)),
            Statement("plants", "Costs are those of the plants built of the designs", Small(0.02, 0.05)),
            Statement("slopes", "Slopes by place and length agree with finite differences", Small(1e-4, 1e-3)),
            Statement("made", "Every design lies on the blade, without overlaps, within the sizes", Small(0.0, 0.0)),
        ),
        front,
    ),
    Study(
        "joint-placement",
        "both sides placed at once",
        "four and four patches of the blade's own size, by the stationary cost of LQG; layouts as found by beamenv place "
        "--together, evaluated anew",
        (Statement("gain", "Placed at once they cost a little less than placed one side after the other", Marginal(-1)),),
        together,
        rows_on_page=True,
    ),
    Study(
        "one-patch",
        "one patch on a uniform cantilever",
        "300 mm of aluminium; a patch without mass or stiffness; Euler and Bernoulli's modes by hand (Crawley and de Luis 1987; "
        "Devasia, Meressi, Paden and Bayo 1993)",
        (
            Statement("slopes", "Authority over a mode is the difference of its slopes at the patch's ends", Small(0.02, 0.05)),
            Statement("root", "Over the first mode it is greatest at the root, and next to nothing at the tip", Changes(-1)),
            Statement(
                "node",
                "Over the second it is greatest for a patch that reaches from the point without curvature to the tip",
                Matches((NODE,), 0.02, 0.1),
            ),
        ),
        one_patch,
    ),
)
