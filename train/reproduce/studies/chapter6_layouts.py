"""Section 6.5: Figures 6.4 to 6.7, the search for positions, and the blade with its patches where they belong."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import SIDES, positions_of
from beamenv.patches import PatchLayout
from train.figures.figure import Curve, Panel
from train.reproduce.judging.study import Outcome, Part, Parts, Statement, Study
from train.reproduce.judging.verdicts import Changes, Holds, Marginal, Small, Substantial
from train.reproduce.studies.closed_loop import (
    SHOWN,
    Response,
    blade,
    controlled,
    peak_voltages,
    peaks,
    plant_of,
    response_panels,
    settling_times,
    voltage_energy,
    weighed,
)
from train.reproduce.studies.placement_study import Layouts, convergence, depth, initial_and_optimal, placed, poles, table_row
from train.reproduce.studies.printed_layouts import UNPRINTED, with_printed_optimum
from train.reproduce.thesis import Model
from train.reproduce.thesis.equations import CONTROLLED, HOST, together
from train.reproduce.thesis.points import on_y
from train.reproduce.thesis.readings import read_by

Array = NDArray[np.float64]

READING = together((*HOST, *CONTROLLED))
"""The equations by which the thesis' own layouts are judged."""

POPULATIONS = (10, 20, 30)
SEEDS = range(5)
"""The genetic algorithm draws lots: its mean over these is judged."""
PULSES = (0.02, 0.05)
"""s: lengths of the rectangular pulse, which the thesis does not name; the first is drawn."""
LATER = 0.1
"""s after which voltages count as later ones."""
GENERATIONS, LAST_GENERATIONS = 50, 10
PRINTED_PEAKS = (429.0, 468.64)
"""V on the fourth actuator of Figure 6.5, initial and optimal."""


def placed_blade(model: Model, pretwist_deg: float = 0.0) -> BladeConfig:
    """Chapter 6's blade: plies at 30°, four and four patches of 85 mm."""
    return blade(model, model.blade(30.0, pretwist_deg=pretwist_deg), PatchLayout())


def fitness_parts(model: Model) -> Parts:
    """A run of every population by the seed, and the best layout known."""
    config = placed_blade(model)
    runs = {(size, seed): Part(convergence, (config, size, GENERATIONS, seed)) for size in POPULATIONS for seed in SEEDS}
    return {**runs, "best": Part(placed, ("actuators", 4, config))}


def fitness(model: Model, found: Mapping[Any, Any]) -> Outcome:
    """Figure 6.4."""
    runs, best = {size: [found[size, seed] for seed in SEEDS] for size in POPULATIONS}, found["best"].cost
    mean = {size: np.mean(of_size, axis=0) for size, of_size in runs.items()}
    largest = np.array(runs[POPULATIONS[-1]])
    evidence = {
        "falls": [[mean[size][0], mean[size][-1]] for size in POPULATIONS],
        "settles": largest[:, -1] / largest[:, -1 - LAST_GENERATIONS] - 1.0,
        "population": [[mean[size][-1] for size in POPULATIONS]],
        "neighbourhood": largest[:, -1] / best - 1.0,
    }
    generations = np.arange(1.0, largest.shape[1] + 1.0)
    curves = [Curve(generations, mean[size], f"{size} individuals") for size in POPULATIONS]
    curves.append(Curve(generations, np.full_like(generations, best), "best known", "dashed"))
    gaps = ", ".join(f"{100.0 * (mean[size][-1] / best - 1.0):.2g} % with {size}" for size in POPULATIONS)
    panel = Panel("mean of five runs, four actuators", "generation", "least tr(P) so far (s)", curves)
    return Outcome(evidence, [panel], notes=[f"After 50 generations GA stays above the best layout known by {gaps} individuals."])


def layout_parts(twists: Sequence[float], model: Model) -> Parts:
    """Initial and optimal layouts by pretwist in degrees."""
    blades = {twist: placed_blade(model, twist) for twist in twists}
    rows = {twist: Part(table_row, ("actuators", 4, each.speed, each)) for twist, each in blades.items()}
    return {twist: Part(initial_and_optimal, (each, rows[twist])) for twist, each in blades.items()}


def untwisted_response(model: Model, by_twist: Mapping[float, Layouts]) -> Outcome:
    """Figure 6.5."""
    layouts = by_twist[0.0]
    found = [struck(model, layouts.initial, layouts.optimal, pulse) for pulse in PULSES]
    notes = [positions_in_words(layouts), voltages_in_words(found[0])]
    *panels, fourth = response_panels(found[0])
    panels.append(on_y(fourth, *PRINTED_PEAKS))
    return Outcome(pulse_evidence(model, layouts.initial, layouts.optimal, found), panels, notes=notes)


def printed_response(model: Model) -> Mapping[str, Any]:
    """What Figure 6.5 states, of the thesis' own best layout by its own equations."""
    read = read_by(model, READING)
    initial = placed_blade(read)
    optimal = with_printed_optimum(initial)
    initial = replace(initial, sensor_full_scale=optimal.sensor_full_scale)
    return pulse_evidence(read, initial, optimal, [struck(read, initial, optimal, pulse) for pulse in PULSES])


def pulse_evidence(model: Model, initial: BladeConfig, optimal: BladeConfig, found: list[dict[str, Response]]) -> Mapping[str, Any]:
    """For each statement of Figure 6.5, from the responses to each pulse."""
    voltage = np.array([peak_voltages(each) for each in found])
    return {
        **reductions(model, initial, optimal, found),
        "voltage": np.concatenate([each[:, :3].T for each in voltage]),
        "fourth": voltage[:, 1, 3] / voltage[:, 0, 3] - 1.0,
        "later": [later_voltage(each["optimal"]) / later_voltage(each["initial"]) - 1.0 for each in found],
    }


def pretwisted_response(model: Model, by_twist: Mapping[float, Layouts]) -> Outcome:
    """Figure 6.6."""
    layouts = by_twist[30.0]
    found = struck(model, layouts.initial, layouts.optimal, None)
    voltage = peak_voltages(found)
    evidence = {
        **reductions(model, layouts.initial, layouts.optimal, [found]),
        "voltage": voltage[:, [0, 2, 3]].T,
        "second": [voltage[1, 1] / voltage[0, 1] - 1.0],
    }
    return Outcome(evidence, response_panels(found), notes=[positions_in_words(layouts), voltages_in_words(found)])


def struck(model: Model, initial: BladeConfig, optimal: BladeConfig, pulse: float | None) -> dict[str, Response]:
    """The controlled responses of the initial and of the optimal layout, to a pulse or (None) a step."""
    return controlled(model, {"initial": initial, "optimal": optimal}, pulse)


def reductions(model: Model, initial: BladeConfig, optimal: BladeConfig, found: list[dict[str, Response]]) -> dict[str, Array]:
    """What placing changes in settling and tip displacement, as shares, for each load; effort (loads, [initial, optimal]), J s."""
    pairs = {
        "settling": [settling_times(each) for each in found],
        "tip": [peaks(each) for each in found],
    }
    plants = {"initial": weighed(model, plant_of(initial)), "optimal": weighed(model, plant_of(optimal))}
    efforts = [[voltage_energy(each[name], plant) for name, plant in plants.items()] for each in found]
    shares = {key: np.array([optimal / initial - 1.0 for initial, optimal in values]) for key, values in pairs.items()}
    return {**shares, "effort": np.array(efforts)}


def later_voltage(response: Response) -> float:
    """V: root mean square on the fourth actuator, later on."""
    shown = (response.times >= LATER) & (response.times <= SHOWN)
    return float(np.sqrt(np.mean(response.voltages[shown, 3] ** 2)))


def positions_in_words(layouts: Layouts) -> str:
    """Where the optimal layout has its patches."""
    sides = (positions_of(layouts.optimal, side) for side in SIDES)
    shown = [", ".join(f"{at:.3f}" for at in side) for side in sides]
    return f"Optimal by GA then SQP: actuators begin {shown[0]} m and sensors {shown[1]} m from the root."


def voltages_in_words(found: dict[str, Response]) -> str:
    """The peak voltages that would be asked for without a limit, initial and optimal."""
    initial, optimal = (", ".join(f"{volts:.0f}" for volts in each) for each in peak_voltages(found))
    return f"Peak voltages asked for, were there no limit: {initial} V with the initial, {optimal} V with the optimal layout."


def all_poles(model: Model, by_twist: Mapping[float, Layouts]) -> Outcome:
    """Figure 6.7."""
    panels, depths = [], []
    for name, twist in (("untwisted", 0.0), ("pretwisted", 30.0)):
        shown = poles(by_twist[twist])
        for side, loop in (("actuators", "regulator"), ("sensors", "observer")):
            pairs = [shown[side, which] for which in ("initial", "optimal")]  # type: ignore[index]
            depths.append([depth(pair) for pair in pairs])
            curves = [
                Curve(pair.real, pair.imag, which, "points")
                for which, pair in zip(("initial", "optimal"), (each[each.imag >= 0.0] for each in pairs), strict=True)
            ]
            panels.append(Panel(f"{name}: {loop}", "real part (1/s)", "imaginary part (rad/s)", curves))
    deeper = np.diff(np.array(depths), axis=1)[:, 0] > 0.0
    evidence = {"slowest": deeper[:, 0], "mean": deeper[:, 1]}
    rates = "; ".join(f"{panel.title} {pair[0][0]:.3g} to {pair[1][0]:.3g}" for panel, pair in zip(panels, depths, strict=True))
    return Outcome(evidence, panels, notes=[f"Decay of the slowest pole, initial to optimal, in 1/s: {rates}."])


UNDER = (
    "200 rad/s; four actuators with a voltage each and four sensors, equally spaced or placed by GA then SQP; sampled LQG; "
    "30 N/m in flap"
)
WHY_TIP = "The load makes the first peak: ±1500 V change it little, wherever the patches are."
WHY_VOLTS = (
    "With R = ρFᵀK⁻¹F a volt is weighed by the energy that it stores, which differs from place to place: the effort falls although "
    "the voltages rise. The thesis' peaks are below 500 V; it prints neither its weights nor, for the pulse, its load."
)


def reduction_statements() -> tuple[Statement, ...]:
    """What the text says of Figure 6.5 as well as of Figure 6.6."""
    return (
        Statement("settling", "Substantial reduction in settling time", Substantial(-1)),
        Statement("tip", "Substantial reduction in tip displacement", Substantial(-1), WHY_TIP),
        Statement("effort", "Reduction in control effort (∫uᵀRu dt)", Changes(-1)),
    )


STUDIES = (
    Study(
        "figure-6.4",
        "Convergence of fitness for different population sizes",
        "θ = 30°, untwisted, 200 rad/s, four actuators; crossover 0.7, mutation 0.01, 50 generations; five seeds",
        (
            Statement("falls", "More generations give better solutions", Changes(-1)),
            Statement("settles", f"No improvement any more in the last {LAST_GENERATIONS} generations", Small(0.005, 0.02)),
            Statement("population", "A larger population ends lower (mean of five runs)", Changes(-1)),
            Statement("neighbourhood", "30 individuals come to the neighbourhood of the optimum", Small(0.02, 0.05)),
        ),
        fitness,
        fitness_parts,
        unprinted=UNPRINTED,
    ),
    Study(
        "figure-6.5",
        "Initial against optimal placement, untwisted, rectangular pulse",
        f"θ = 30°, {UNDER}; pulses of {PULSES[0]:g} s (shown) and {PULSES[1]:g} s, as the thesis names none",
        (
            *reduction_statements(),
            Statement("voltage", "Actuators 1, 2 and 3 need lower peak voltages", Changes(-1), WHY_VOLTS),
            Statement("fourth", "Actuator 4 needs a slightly higher one (468.64 V against 429 V)", Marginal(+1), WHY_VOLTS),
            Statement("later", "Later on its voltage is considerably lower (root mean square after 0.1 s)", Substantial(-1)),
        ),
        untwisted_response,
        partial(layout_parts, (0.0,)),
        printed=printed_response,
        unprinted=UNPRINTED,
    ),
    Study(
        "figure-6.6",
        "Initial against optimal placement, pretwisted, step",
        f"θ = 30°, 30° pretwist, {UNDER}",
        (
            *reduction_statements(),
            Statement("voltage", "Actuators 1, 3 and 4 need lower peak voltages", Changes(-1), WHY_VOLTS),
            Statement("second", "Actuator 2 needs a slightly higher one", Marginal(+1), WHY_VOLTS),
        ),
        pretwisted_response,
        partial(layout_parts, (30.0,)),
        unprinted=f"{UNPRINTED}, nor a layout of the pretwisted blade",
    ),
    Study(
        "figure-6.7",
        "Controller and observer poles",
        "θ = 30°, untwisted and with 30° pretwist, 200 rad/s; equally spaced patches against GA then SQP",
        (
            Statement("slowest", "Optimal poles lie deeper in the left half plane: the slowest of each loop", Holds()),
            Statement("mean", "Optimal poles lie deeper in the left half plane: their mean decay rate in each loop", Holds()),
        ),
        all_poles,
        partial(layout_parts, (0.0, 30.0)),
        unprinted=UNPRINTED,
    ),
)
