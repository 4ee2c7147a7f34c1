"""Figures 5.1 and 5.2: how many modes a controller's model needs, and how many states balanced truncation needs instead."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, expm, solve_continuous_lyapunov, svd

from baselines import lqr
from beamenv.blade.build import Blade, build_plant
from beamenv.blade.config import BladeConfig
from beamenv.plant.plant import Plant, drive_limit
from train.figures.figure import Curve, Panel
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Small
from train.reproduce.studies.closed_loop import Response, blade, patches, simulate, weighed
from train.reproduce.thesis import Model
from train.reproduce.thesis.equations import CONTROLLED, HOST, together
from train.reproduce.thesis.points import on_x
from train.reproduce.thesis.response import free_motion

Array = NDArray[np.float64]

REFERENCE_MODES = 24
MODES = tuple(range(1, 17))
ENOUGH = 0.05
"""Relative root mean square error of a converged response."""
LOOSE = 0.25
DRAWN = (1, 3, 5, 11)
DURATION = 0.2
"""s."""
CONTROL_INTERVAL = 1e-4
"""s: fine enough for the highest mode of the reference."""


def lqr_responses(
    model: Model, pretwist_deg: float, presetting_deg: float, numbers: tuple[int, ...] = MODES
) -> dict[int, Response]:
    """LQR-controlled responses of models with each number of modes, and of the reference, to a step in flap."""
    config = blade(model, model.blade(30.0, pretwist_deg=pretwist_deg, presetting_deg=presetting_deg), patches(ganged=True))
    whole, responses = Blade(config), {}
    for modes in (*numbers, REFERENCE_MODES):
        plant = weighed(model, whole.changed(with_modes(config, modes)).plant)
        responses[modes] = simulate(plant, lqr(plant), model.load, DURATION)
    return responses


def with_modes(config: BladeConfig, modes: int) -> BladeConfig:
    """A blade's configuration with another number of retained modes, sampled finely."""
    return replace(config, modes=modes, control_interval=CONTROL_INTERVAL)


def error(found: Array, reference: Array) -> float:
    """Root mean square difference over the root mean square of the reference."""
    return float(np.sqrt(((found - reference) ** 2).mean() / (reference**2).mean()))


def balanced(plant: Plant, inputs: Array, outputs: Array) -> tuple[Array, Array, Array]:
    """Balanced realisation (A, B, C), states by falling Hankel singular value (Moore, IEEE Trans. Automatic Control 26, 1981)."""
    reach = cholesky(regular(solve_continuous_lyapunov(plant.A, -inputs @ inputs.T)), lower=True)
    observe = cholesky(regular(solve_continuous_lyapunov(plant.A.T, -outputs.T @ outputs)), lower=True)
    left, values, right = svd(observe.T @ reach)
    root = np.sqrt(values)
    to_states, from_states = reach @ right.T / root, (left / root).T @ observe.T
    return from_states @ plant.A @ to_states, from_states @ inputs, outputs @ to_states


def regular(gramian: Array) -> Array:
    """Symmetric and positive definite to round-off."""
    return 0.5 * (gramian + gramian.T) + 1e-13 * np.trace(gramian) / len(gramian) * np.eye(len(gramian))


def step_outputs(A: Array, B: Array, C: Array, steps: int) -> Array:
    """(steps, outputs · inputs): responses to a unit step on each input, every control interval."""
    transition = expm(A * CONTROL_INTERVAL)
    final = -np.linalg.solve(A, B)
    moved = np.stack([free_motion(transition, -column, steps + 1)[1:] + column for column in final.T])
    return (C @ moved.transpose(1, 2, 0)).reshape(steps, -1)


def truncation_errors(plant: Plant) -> dict[str, Array]:
    """Error of the step responses (voltage and flap load to current and flap tip) over the number of states, two ways."""
    count, drive = len(plant.natural_frequencies), drive_limit(plant)
    inputs = np.hstack([plant.B * drive, 30.0 * plant.disturbance_input[:, 1:]])
    outputs = np.vstack([plant.C.sum(axis=0, keepdims=True), plant.tip_displacement[1:]])
    steps = round(DURATION / CONTROL_INTERVAL)
    reference = step_outputs(plant.A, inputs, outputs, steps)
    outputs = outputs / np.repeat(
        np.sqrt((reference.reshape(steps, 2, -1) ** 2).mean(axis=(0, 2)))[:, None], outputs.shape[1], axis=1
    )
    reference = step_outputs(plant.A, inputs, outputs, steps)
    A, B, C = balanced(plant, inputs, outputs)
    errors: dict[str, list[float]] = {"modal truncation": [], "balanced truncation": []}
    for modes in MODES:
        kept = np.r_[0:modes, count : count + modes]
        modal = step_outputs(plant.A[np.ix_(kept, kept)], inputs[kept], outputs[:, kept], steps)
        states = 2 * modes
        errors["modal truncation"].append(error(modal, reference))
        errors["balanced truncation"].append(error(step_outputs(A[:states, :states], B[:states], C[:, :states], steps), reference))
    return {name: np.array(values) for name, values in errors.items()}


def convergence(enough: int, pretwist_deg: float, presetting_deg: float) -> Callable[[Model], Outcome]:
    """Figure 5.1 or 5.2."""

    def compute(model: Model) -> Outcome:
        numbers = MODES[MODES.index(enough) :] if model.reading else MODES
        found = lqr_responses(model, pretwist_deg, presetting_deg, numbers)
        reference = found[REFERENCE_MODES]
        tip = np.array([error(found[r].tip, reference.tip) for r in numbers])
        voltage = np.array([error(found[r].voltages, reference.voltages) for r in numbers])
        at = numbers.index(enough)
        evidence = {"tip": tip[at:], "voltage": voltage[at:]}
        if model.reading:
            return Outcome(evidence, [])
        config = blade(model, model.blade(30.0, pretwist_deg=pretwist_deg, presetting_deg=presetting_deg), patches(ganged=True))
        truncated = truncation_errors(build_plant(with_modes(config, REFERENCE_MODES)))
        controlled, opened = error_panels(tip, voltage, truncated)
        panels = [*few_modes_panels(found), on_x(controlled, enough), opened]
        rows = [
            [r, f"{t:.4g}", f"{v:.4g}", 2 * r, *(f"{values[k]:.4g}" for values in truncated.values())]
            for k, (r, t, v) in enumerate(zip(MODES, tip, voltage, strict=True))
        ]
        header = ["modes", "tip error (LQR)", "voltage error (LQR)", "states", *(f"{name}, open loop" for name in truncated)]
        return Outcome(evidence, panels, {}, header, rows, [needed(tip, voltage, truncated)])

    return compute


def few_modes_panels(found: dict[int, Response]) -> list[Panel]:
    """Tip displacement and voltage of models with some numbers of modes."""
    labels = {r: f"{r} mode{'s' if r > 1 else ''}" for r in (*DRAWN, REFERENCE_MODES)}
    shown = found[REFERENCE_MODES].times <= 0.1
    times = found[REFERENCE_MODES].times[shown]
    tips = [Curve(times, 1e3 * found[r].tip[shown], name) for r, name in labels.items()]
    voltages = [Curve(times, found[r].voltages[shown, 0], name) for r, name in labels.items()]
    return [
        Panel("tip displacement in flap", "time (s)", "displacement (mm)", tips),
        Panel("voltage", "time (s)", "voltage (V)", voltages),
    ]


def error_panels(tip: Array, voltage: Array, truncated: dict[str, Array]) -> list[Panel]:
    """Errors over the number of modes and of states."""
    modes = np.array(MODES, dtype=float)
    controlled = [Curve(modes, tip, "tip"), Curve(modes, voltage, "voltage")]
    steps = [Curve(2.0 * modes, values, name) for name, values in truncated.items()]
    return [
        Panel("controlled response", "modes", f"error against {REFERENCE_MODES} modes", controlled, logarithmic=True),
        Panel("open-loop steps", "states", f"error against {2 * REFERENCE_MODES} states", steps, logarithmic=True),
    ]


def needed(tip: Array, voltage: Array, truncated: dict[str, Array]) -> str:
    """What each criterion needs, in words."""

    def first(errors: Array, each: int, what: str) -> str:
        late = np.flatnonzero(errors > ENOUGH)
        at = 0 if not len(late) else late[-1] + 1
        return f"{MODES[at] * each} {what}" if at < len(MODES) else f"more than {MODES[-1] * each} {what}"

    return (
        f"To within {ENOUGH:.0%}: the controlled tip needs {first(tip, 1, 'modes')}, the voltage {first(voltage, 1, 'modes')}; "
        f"the open-loop "
        f"step responses of current and tip need {first(truncated['modal truncation'], 2, 'states')} by modal truncation and "
        f"{first(truncated['balanced truncation'], 2, 'states')} by balanced truncation."
    )


VOLTAGE = (
    "A step in voltage excites high modes that the tip hardly shows; the thesis judged by eye, and does not print its weights."
)


def study(name: str, title: str, configuration: str, enough: int, pretwist_deg: float, presetting_deg: float) -> Study:
    """Figure 5.1 or 5.2."""
    within = f"from {enough} modes on, within {ENOUGH:.0%} of {REFERENCE_MODES} modes (RMS over {DURATION:g} s)"
    return Study(
        name,
        title,
        f"{configuration}; LQR on the true state, ganged voltages, step of 30 N/m in flap",
        (
            Statement("tip", f"The tip displacement has converged {within}", Small(ENOUGH, LOOSE)),
            Statement("voltage", f"The actuator voltage has converged {within}", Small(ENOUGH, LOOSE), VOLTAGE),
        ),
        convergence(enough, pretwist_deg, presetting_deg),
        rests_on=together((*HOST, *CONTROLLED)),
    )


STUDIES = (
    study("figure-5.1", "Modes needed by the untwisted blade", "θ = 30° (text; the caption has 0°), untwisted", 5, 0.0, 0.0),
    study("figure-5.2", "Modes needed by the pretwisted blade", "θ = 30° (text; the caption has 0°), β = γ = 30°", 11, 30.0, 30.0),
)
