"""Sections 5.5.2.2 to 5.5.2.6: controlled responses with a voltage for each actuator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from baselines import lqg
from beamenv.blade.config import BladeConfig
from train.figures.figure import Curve, Panel
from train.reproduce.judging.study import WITH_AND_WITHOUT, Outcome, Statement, Study
from train.reproduce.judging.verdicts import Below, Changes, Holds, Large
from train.reproduce.studies.chapter5_one_voltage import EACH, LOOP, UNDER_PRESSURE, WHY_PLIES, WHY_TAPER
from train.reproduce.studies.closed_loop import (
    PULSE,
    UNLIMITED,
    blade,
    controlled,
    peak_voltages,
    peaks,
    plant_of,
    response_panels,
    settling_times,
    simulate,
    under_pressure,
    weighed,
)
from train.reproduce.thesis import Model
from train.reproduce.thesis.equations import CONTROLLED, UNIFORM_TENSION

Array = NDArray[np.float64]
Compute = Callable[[Model], Outcome]

OPEN_WEIGHTS = (0.05, 0.5, 5.0)
"""ρ of the input weight, which the thesis does not print."""
OPEN_LOADS = (30.0, 500.0)
"""N/m: ours, and chapter 6's "500 kg/m" read as N/m."""


def individual_ply_angle(model: Model) -> Outcome:
    """Figure 5.14."""
    found = controlled(model, {f"θ = {a:g}°": blade(model, model.blade(a)) for a in (30.0, 60.0, 90.0)})
    settling = settling_times(found)
    evidence = {"tip": peaks(found), "voltage": peak_voltages(found).T, "settling": settling[[0, 2]]}
    return Outcome(evidence, response_panels(found))


def individual_taper(model: Model) -> Outcome:
    """Figure 5.15."""
    blades = {f"η = {t:g}": blade(model, model.blade(30.0, taper=t, pretwist_deg=30.0)) for t in (1.0, 2.0, 3.0)}
    found, falling = controlled(model, blades), controlled(model, blades, loaded=under_pressure)
    voltage = peak_voltages(found)
    evidence = {
        "tip": peaks(found),
        "pressure-tip": peaks(falling),
        "pressure-voltage": peak_voltages(falling)[:, [0, 2, 3]].T,
        "voltage": voltage[:, [0, 2, 3]].T,
        "second": voltage[:, 1],
        "limit": voltages_over_what_is_open(model, blades["η = 1"]),
    }
    return Outcome(evidence, response_panels(found))


def voltages_over_what_is_open(model: Model, config: BladeConfig) -> Array:
    """Peak voltages, were there no limit, for each input weight and load that the thesis leaves open."""
    found = []
    for weight in OPEN_WEIGHTS:
        plant = weighed(model, plant_of(replace(config, effort_weight=weight, voltage_limits=(-UNLIMITED, UNLIMITED))), weight)
        found.append(simulate(plant, lqg(plant), model.load, 0.1).asked.max() / model.load)
    return np.outer(found, OPEN_LOADS).ravel()


def individual_pretwist(model: Model) -> Outcome:
    """Figure 5.16."""
    blades = {f"β = {b:g}°": blade(model, model.blade(30.0, pretwist_deg=b)) for b in (30.0, 60.0, 90.0)}
    found = controlled(model, blades, pulse=PULSE)
    settling, voltage = settling_times(found), peak_voltages(found)
    evidence = {
        "settling": settling[1:] > settling[0],
        "first-three": (voltage[1:, :3] < voltage[0, :3]).astype(float),
        "fourth": [voltage[1, 3] > voltage[0, 3]],
    }
    return Outcome(evidence, response_panels(found))


def gyroscopic(model: Model) -> Outcome:
    """Figure 5.17."""
    beam = model.blade(0.0)
    panels: list[Panel] = []
    lags, apart = [], []
    for direction in ("lag", "flap"):
        found = {
            line: controlled(model, {"": blade(model, beam, gyroscopic=line == "solid")}, direction=direction)[""]
            for line in WITH_AND_WITHOUT
        }
        drawn = [
            [Curve(c.x, c.y, "", line) for c in (panel.curves[0] for panel in response_panels({"": r}, direction))]
            for line, r in found.items()
        ]
        names = response_panels({"": found["solid"]}, direction)
        panels += [
            replace(panel, curves=curves, title=f"{panel.title}, step in {direction}" if k else panel.title)
            for k, (panel, curves) in enumerate(zip(names, zip(*drawn, strict=True), strict=True))
        ]
        lags.append(
            turning_time(found["dotted"].times, found["dotted"].tip) > turning_time(found["solid"].times, found["solid"].tip)
        )
        apart.append(float(np.abs(found["dotted"].tip - found["solid"].tip).max() / found["solid"].peak))
    evidence = {"visible": apart, "phase-lag": lags}
    return Outcome(evidence, panels, WITH_AND_WITHOUT)


def turning_time(times: Array, tip: Array, turn: int = 3) -> float:
    """When the tip turns back for the ``turn``-th time, in s, between samples by a parabola."""
    slope = np.diff(tip)
    at = np.flatnonzero(np.diff(np.sign(slope)) != 0)[turn - 1]
    return float(times[at + 1] + (times[1] - times[0]) * (slope[at] / (slope[at] - slope[at + 1]) - 0.5))


WHY_PULSE = (
    "The thesis names neither pulse nor weights; most differences are 10 to 20 %. "
    "The order of its voltages comes from Eq. 5.9, which weighs volts by stiffness."
)

STUDIES = (
    Study(
        "figure-5.14",
        "Ply angle, individual voltages",
        f"untwisted, 200 rad/s; {EACH}",
        (
            Statement("tip", "Tip displacement falls as the ply angle grows", Changes(-1)),
            Statement("voltage", "The voltages fall as the ply angle grows", Changes(-1), WHY_PLIES),
            Statement("settling", "90° plies settle sooner than 30°", Changes(-1)),
        ),
        individual_ply_angle,
        rests_on=LOOP,
    ),
    Study(
        "figure-5.15",
        "Taper, individual voltages",
        f"θ = 30°, 30° pretwist, 200 rad/s; {EACH}",
        (
            Statement("tip", "Taper lowers the tip displacement", Changes(-1), WHY_TAPER),
            Statement("voltage", "Taper lowers the peak voltage on actuators 1, 3 and 4", Changes(-1), WHY_TAPER),
            Statement("second", "Taper raises the voltage on actuator 2", Changes(+1)),
            *UNDER_PRESSURE,
            Statement(
                "limit",
                "Voltages stay well below 1500 V",
                Below(1500.0, "V"),
                "Chapter 5 prints neither its load nor its input weight: 30 N/m and 500 N/m (section 6.5's 500 kg/m taken as N/m), "
                "ρ from 0.05 to 5.",
            ),
        ),
        individual_taper,
        rests_on=(*LOOP, UNIFORM_TENSION),
    ),
    Study(
        "figure-5.16",
        "Pretwist, individual voltages, rectangular pulse",
        f"θ = 30°, 200 rad/s; pulse of {PULSE:g} s (the thesis names none); {EACH}",
        (
            Statement("settling", "30° pretwist settles sooner than 60° and 90°", Holds(), WHY_PULSE),
            Statement(
                "first-three", "30° pretwist takes slightly higher peak voltages on the first three actuators", Holds(), WHY_PULSE
            ),
            Statement("fourth", "On the fourth actuator 60° pretwist takes the higher one", Holds(), WHY_PULSE),
        ),
        individual_pretwist,
        rests_on=LOOP,
    ),
    Study(
        "figure-5.17",
        "Controlled response with and without gyroscopic coupling",
        "θ = 0°, untwisted, 200 rad/s; steps of 30 N/m in lag and in flap; four MFC actuators with a voltage each; sampled LQG",
        (
            Statement(
                "visible",
                "The difference can be readily seen",
                Large(),
                "In an untwisted blade of θ = 0° the patches reach the lag mode through gyroscopic coupling alone: without it "
                "their voltages stay zero.",
            ),
            Statement(
                "phase-lag",
                "Without gyroscopic coupling the response lags: third turning point later (in lag and in flap)",
                Holds(share=0.5),
                "In flap it does. In lag, where coupling acts, it softens the mode (Figure 3.5): the response without it is ahead.",
            ),
        ),
        gyroscopic,
        rests_on=CONTROLLED,
    ),
)
