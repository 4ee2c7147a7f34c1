"""Section 5.5.2.1: controlled responses with one voltage for all actuators."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from baselines import no_control
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Changes, Holds
from train.reproduce.studies.closed_loop import (
    blade,
    controlled,
    patches,
    peak_voltages,
    peaks,
    plant_of,
    response_panels,
    settling_times,
    simulate,
    under_pressure,
)
from train.reproduce.studies.study_patches import FIELD_OVER_THICKNESS, covering
from train.reproduce.thesis import Model
from train.reproduce.thesis.equations import CONTROLLED, HOST, UNIFORM_TENSION

Array = NDArray[np.float64]
Compute = Callable[[Model], Outcome]

LOOP = (*HOST, *CONTROLLED)
COVERAGES = (0.10, 0.25, 0.50, 1.00)


def mfc_or_pzt(angle_deg: float) -> Compute:
    """Figures 5.7 and 5.8."""

    def compute(model: Model) -> Outcome:
        beam = model.blade(angle_deg, pretwist_deg=30.0, presetting_deg=30.0)
        layouts = {
            "PZT": patches(ganged=True, material="PZT"),
            "MFC": patches(ganged=True),
            "MFC, V/thickness": patches(ganged=True, material=FIELD_OVER_THICKNESS),
        }
        blades = {name: blade(model, beam, layout) for name, layout in layouts.items()}
        found, pair = controlled(model, blades), ["PZT", "MFC"]
        plants = {name: plant_of(blades[name]) for name in pair}
        free = {name: simulate(plant, no_control(plant), model.load) for name, plant in plants.items()}
        evidence = {
            "settling": [found[name].settling for name in pair],
            "peak": [found[name].peak for name in pair],
            "voltage": [found[name].asked[0] for name in pair],
            "voltage-field": [found[name].asked[0] for name in ("PZT", "MFC, V/thickness")],
            "control": [free["MFC"].settling, found["MFC"].settling],
        }
        notes = [
            f"{name}: without control the tip settles after {free[name].settling:.2f} s from a peak of "
            f"{1e6 * free[name].peak:.1f} µm, "
            f"with control after {found[name].settling:.2f} s from {1e6 * found[name].peak:.1f} µm."
            for name in pair
        ]
        return Outcome(evidence, response_panels(found), notes=notes)

    return compute


def coverage(model: Model) -> Outcome:
    """Figure 5.9."""
    beam = model.blade(30.0)
    blades = {f"{share:.0%} of the span": blade(model, beam, covering(share * beam.length, beam.width)) for share in COVERAGES}
    found = controlled(model, blades)
    peak, settling, voltage = peaks(found), settling_times(found), peak_voltages(found)[:, 0]
    evidence = {
        "tip": peak[:3],
        "voltage": voltage[:3],
        "whole-tip": peak[2:],
        "whole-settling": settling[2:],
    }
    return Outcome(evidence, response_panels(found))


def two_plies(speed: float) -> Compute:
    """Figures 5.10 and 5.11."""

    def compute(model: Model) -> Outcome:
        found = controlled(
            model,
            {f"θ = {a:g}°": blade(model, model.blade(a), patches(ganged=True), speed=speed) for a in (30.0, 60.0)},
        )
        return Outcome({"tip": peaks(found), "voltage": peak_voltages(found).T}, response_panels(found))

    return compute


def ganged_taper(model: Model) -> Outcome:
    """Figure 5.12."""
    blades = {f"η = {t:g}": blade(model, model.blade(30.0, taper=t), patches(ganged=True)) for t in (1.0, 2.0, 3.0)}
    found, falling = controlled(model, blades), controlled(model, blades, loaded=under_pressure)
    evidence = {
        "tip": peaks(found),
        "voltage": peak_voltages(found).T,
        "settling": settling_times(found),
        "pressure-tip": peaks(falling),
        "pressure-voltage": peak_voltages(falling).T,
    }
    return Outcome(evidence, response_panels(found))


def ganged_pretwist(model: Model) -> Outcome:
    """Figure 5.13."""
    found = controlled(
        model, {f"β = {b:g}°": blade(model, model.blade(30.0, pretwist_deg=b), patches(ganged=True)) for b in (0.0, 30.0, 60.0)}
    )
    settling, voltage = settling_times(found), peak_voltages(found)[:, 0]
    return Outcome({"settling": settling[1:] > settling[0], "voltage": voltage[1:] < voltage[0]}, response_panels(found))


ASKED = "voltages compared as asked for, drawn as limited to ±1500 V"
LQG = f"sampled LQG from summed sensors, step of 30 N/m in flap; {ASKED}"
GANGED = f"one voltage on four MFC actuators of 80 mm × 57 mm; {LQG}"
EACH = f"four MFC actuators with a voltage each; sampled LQG, step of 30 N/m in flap; {ASKED}"
WHY_TAPER = (
    "The load per metre is the same while the blade gets thinner and lighter. By the thesis' equations, too, the tip goes less far "
    "only under a load that falls with the chord, see Figure 3.16."
)
UNDER_PRESSURE = (
    Statement("pressure-tip", "The tip displacement under a load that falls with the chord", Changes(-1), aside=True),
    Statement("pressure-voltage", "The voltages under such a load", Changes(-1), aside=True),
)
"""What taper does where the load is a pressure's: the thesis does not say how its own is spread."""
WHY_COVERAGE = (
    "The input weight is the energy the sheets can store, so larger ones are driven with less voltage to about the same effect; "
    "with the whole span covered, their stiffness lowers the peak."
)
WHY_PZT = (
    "A monolithic sheet puts V over 0.3 mm and not over 0.5 mm, is four times as stiff and pulls along and across: per volt it "
    "acts 2.5 times as much. "
    "With one Q, R rule it therefore takes less voltage. Eq. 5.2 divides the MFC's voltage by its thickness too."
)
WHY_PLIES = (
    "The input weight is the energy that the actuators store. In a stiffer blade "
    "they store less, so the same rule asks for more voltage. Eq. 5.9 has K where "
    "K⁻¹ belongs, so stiff modes weigh more; with the thesis' shear flow that "
    "reverses the order of 30° and 60°."
)


def mfc_study(name: str, angle_deg: float) -> Study:
    """Figure 5.7 or 5.8."""
    return Study(
        name,
        f"MFC against PZT, θ = {angle_deg:g}°",
        f"30° pretwist, 30° presetting, 200 rad/s; one voltage on four actuators of 80 mm × 57 mm; {LQG}; the same Q, R rule",
        (
            Statement("settling", "MFC settles sooner than PZT", Changes(-1)),
            Statement(
                "peak",
                "MFC has the smaller peak displacement",
                Changes(-1),
                "Stiffness matters as much as control here: see the peaks without it.",
            ),
            Statement("voltage", "MFC takes the smaller voltage", Changes(-1), WHY_PZT),
            Statement("voltage-field", "The same with the MFC's field taken as V/thickness", Changes(-1), aside=True),
            Statement("control", "Control shortens the settling time (MFC against none)", Changes(-1)),
        ),
        mfc_or_pzt(angle_deg),
        rests_on=LOOP,
    )


def plies_study(name: str, speed: float) -> Study:
    """Figure 5.10 or 5.11."""
    return Study(
        name,
        f"Two ply angles at {speed:g} rad/s",
        f"untwisted; {GANGED}",
        (
            Statement("tip", "60° plies have the smaller tip displacement", Changes(-1)),
            Statement("voltage", "60° plies take the smaller voltage", Changes(-1), WHY_PLIES),
        ),
        two_plies(speed),
        rests_on=LOOP,
    )


STUDIES = (
    mfc_study("figure-5.7", 30.0),
    mfc_study("figure-5.8", 60.0),
    Study(
        "figure-5.9",
        "Coverage by MFC from the root",
        f"θ = 30°, untwisted, 200 rad/s; one actuator and one sensor of the full width; {LQG}",
        (
            Statement("tip", "Tip displacement falls from 10 to 25 to 50 % coverage", Changes(-1), WHY_COVERAGE),
            Statement("voltage", "Voltage falls from 10 to 25 to 50 % coverage", Changes(-1)),
            Statement("whole-tip", "With 100 % coverage the tip displacement increases (against 50 %)", Changes(+1), WHY_COVERAGE),
            Statement("whole-settling", "With 100 % coverage the settling time increases (against 50 %)", Changes(+1)),
        ),
        coverage,
        rests_on=LOOP,
    ),
    plies_study("figure-5.10", 100.0),
    plies_study("figure-5.11", 200.0),
    Study(
        "figure-5.12",
        "Taper, one voltage",
        f"θ = 30°, untwisted, 200 rad/s; {GANGED}",
        (
            Statement("tip", "Taper lowers the tip displacement", Changes(-1), WHY_TAPER),
            Statement("voltage", "Taper lowers the voltage", Changes(-1), WHY_TAPER),
            Statement("settling", "Taper lengthens the settling time", Changes(+1)),
            *UNDER_PRESSURE,
        ),
        ganged_taper,
        rests_on=(*LOOP, UNIFORM_TENSION),
    ),
    Study(
        "figure-5.13",
        "Pretwist, one voltage",
        f"θ = 30°, 200 rad/s; {GANGED}",
        (
            Statement(
                "settling",
                "The untwisted blade settles sooner than 30° and 60° pretwist",
                Holds(),
                "The three times lie within 10 % of each other.",
            ),
            Statement("voltage", "The untwisted blade takes the higher peak voltage", Holds()),
        ),
        ganged_pretwist,
        rests_on=LOOP,
    ),
)
