"""Section 7.2, done: adaptive output feedback by a neural network; and what a recurrent agent remembers, its own adaptation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from baselines import AdaptiveNeural, adaptive_neural, reference_lqg
from baselines.design.controller import Controller
from beamenv.blade import BladeConfig
from beamenv.blade.build import Blade
from beamenv.plant.plant import Plant, sample
from train.figures.figure import Curve, Look, Panel
from train.probing.memories import QUESTIONS
from train.probing.table import FEATURES, Row, read_rows
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Holds, Small
from train.reproduce.thesis import Model

Array = NDArray[np.float64]

DESIGNED, TURNING = 200.0, 140.0
"""rad/s: the speed that the law is designed for, and that at which the blade turns."""
INSTANTS, SWITCHED = 1000, 500
LOAD = np.array([0.0, 15.0])
"""N/m of line load in lag and flap, from the start on."""
SMOOTHED = 40
"""Instants over which error energies are averaged, more than half a period of the first mode."""


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """What a blade did at T instants."""

    cost: Array
    """(T,), J s, added up."""
    tip: Array
    """(T,), m, in flap."""
    voltages: Array
    """(T, m), of the drive limit."""
    adaptation: Array
    """(T, 4): error energy, ‖W‖, ‖V − V₀‖, adaptive effort; zeros of a law that does not adapt."""


@lru_cache(maxsize=4)
def plant_at(speed: float) -> Plant:
    """All that is known of the default blade at a speed."""
    return Blade(BladeConfig(speed=speed)).truth


@lru_cache(maxsize=1)
def law() -> AdaptiveNeural:
    """Designed for ``DESIGNED``."""
    return adaptive_neural(plant_at(DESIGNED))


def run(plant: Plant, controller: Callable[[int], Controller]) -> Run:
    """A step of load in flap, white load and sensor noise, the same in every run, under the controller of each instant."""
    held, generator = sample(plant), np.random.default_rng(0)
    loads = LOAD + generator.normal(size=(INSTANTS, 2)) @ np.sqrt(held.process_noise)
    noise = generator.normal(size=(INSTANTS, len(held.C))) @ np.sqrt(held.sensor_noise)
    x, memory, full, drive = np.zeros(len(held.A)), None, plant.sensor_full_scale, np.abs(plant.voltage_limits).max(axis=0)
    costs, tips, voltages, adaptations = [], [], [], []
    for instant in range(INSTANTS):
        now = controller(instant)
        reading = np.clip((held.C @ x + noise[instant]) / full, -1.0, 1.0)
        action, memory = now.predict(reading, memory)
        whole = np.concatenate([x, action * drive, loads[instant]])
        costs.append(whole @ held.cost @ whole)
        x = held.A @ x + held.B @ (action * drive) + held.disturbance_input @ loads[instant]
        tips.append((plant.tip_displacement @ x)[1])
        voltages.append(action)
        adaptations.append(now.adaptation(memory) if isinstance(now, AdaptiveNeural) else np.zeros(4))
    return Run(np.cumsum(costs), np.array(tips), np.array(voltages), np.array(adaptations))


def adapted(model: Model) -> Outcome:
    """At another speed than the design's, with the adaptation on, off, and switched off in mid-episode; and on the design."""
    other, own, on = plant_at(TURNING), plant_at(DESIGNED), law()
    off, plain = on.switched(False), reference_lqg(own)
    runs = {
        "on": run(other, lambda _: on),
        "off": run(other, lambda _: off),
        "switched off at half time": run(other, lambda instant: on if instant < SWITCHED else off),
    }
    base, nominal, nominal_base = run(other, lambda _: plain), run(own, lambda _: on), run(own, lambda _: plain)
    late = slice(SWITCHED, None)
    switched, largest = (
        runs["switched off at half time"],
        np.array([on.learning.outer_bound, on.learning.inner_bound, on.authority]),
    )
    evidence = {
        "off": np.abs(runs["off"].voltages - base.voltages).max(),
        "cost": runs["on"].cost[-1] < base.cost[-1],
        "nominal": nominal.cost[-1] / nominal_base.cost[-1] - 1.0,
        "error": runs["on"].adaptation[late, 0].mean() < runs["off"].adaptation[late, 0].mean(),
        "bounds": runs["on"].adaptation[:, 1:].max(axis=0) <= largest * (1.0 + 1e-12),
        "bumpless": switched.voltages[: SWITCHED + 1] == runs["on"].voltages[: SWITCHED + 1],
        "back": switched.adaptation[-1, 3] < 0.01,
    }
    notes = (
        f"J over LQG's at {TURNING:g} rad/s: {runs['on'].cost[-1] / base.cost[-1]:.3f}, switched off at half time "
        f"{switched.cost[-1] / base.cost[-1]:.3f}; on the design {nominal.cost[-1] / nominal_base.cost[-1]:.4f}.",
    )
    return Outcome(evidence, _panels(runs, sample(other).interval), _LINES, notes=notes)


_LINES = {"solid": "adaptation on", "dotted": "off: LQG", "dashed": "switched off at 0.25 s"}
_STYLES = {"on": "solid", "off": "dotted", "switched off at half time": "dashed"}


def _panels(runs: dict[str, Run], interval: float) -> list[Panel]:
    time: Array = np.asarray(interval * np.arange(1, INSTANTS + 1), dtype=np.float64)

    def panel(title: str, unit: str, shown: Callable[[Run], Array], names: tuple[str, ...] = tuple(_STYLES)) -> Panel:
        curves = [Curve(time, shown(runs[name]), line=_STYLES[name]) for name in names]
        return Panel(title, "time (s)", unit, curves)

    learning = ("on", "switched off at half time")
    energy = panel("error energy EᵀPE", "innovations squared", lambda each: smoothed(each.adaptation[:, 0]))
    return [
        panel("J", "J (mJ s)", lambda each: 1e3 * each.cost),
        panel("tip in flap", "displacement (µm)", lambda each: 1e6 * each.tip, ("on", "off")),
        replace(energy, logarithmic=True),
        panel("outer weights", "norm of W", lambda each: each.adaptation[:, 1], learning),
        panel("inner weights", "norm of V − V₀", lambda each: each.adaptation[:, 2], learning),
        panel("adaptive voltage", "over the drive limit", lambda each: each.adaptation[:, 3], learning),
    ]


def smoothed(values: Array) -> Array:
    """Means over the latest ``SMOOTHED`` instants."""
    total = np.concatenate([np.zeros(1), np.cumsum(values)])
    last = np.arange(1, len(total))
    first = np.maximum(last - SMOOTHED, 0)
    return np.asarray((total[last] - total[first]) / (last - first))


def remembered(model: Model) -> Outcome:
    """From the table that ships: nothing is simulated here."""
    rows = read_rows()
    best = {question.name: {name: _peak(rows, question.name, name) for name in FEATURES} for question in QUESTIONS}
    evidence = {
        "above": [row.score.low > row.chance for row in rows if row.features == "memory" and row.time > 0.1],
        "window": [mean_score(rows, question.name, "memory") > mean_score(rows, question.name, "window") for question in QUESTIONS],
        "magnitudes": [best[name]["memory"] > best[name]["magnitudes"] for name in ("speed", "dead actuator")],
        "shuffled": [row.score.low <= row.chance for row in rows if row.features == "shuffled"],
    }
    notes = [
        f"{name.capitalize()}, best over time: " + ", ".join(f"{value:.2f} from {what}" for what, value in found.items()) + "."
        for name, found in best.items()
    ]
    panels = [_memory_panel([row for row in rows if row.question == question.name]) for question in QUESTIONS]
    return Outcome(evidence, panels, {"dashed": "its 95 % interval"}, notes=notes)


def mean_score(rows: list[Row], question: str, features: str) -> float:
    """Mean over time of how well a question is answered."""
    return float(np.mean([row.score.value for row in rows if (row.question, row.features) == (question, features)]))


def _peak(rows: list[Row], question: str, features: str) -> float:
    return max(row.score.value for row in rows if (row.question, row.features) == (question, features))


def _memory_panel(rows: list[Row]) -> Panel:
    """Scores over time, with their intervals as thin lines."""
    curves = []
    for name in FEATURES:
        of = [row for row in rows if row.features == name]
        time = np.array([row.time for row in of])
        curves.append(Curve(time, np.array([row.score.value for row in of]), name))
        if name in ("memory", "magnitudes"):
            for bound in ("low", "high"):
                faint = Look(width=0.9, opacity=0.6)
                curves.append(Curve(time, np.array([getattr(row.score, bound) for row in of]), name, "dashed", faint))
    first = rows[0]
    unit = f"balanced accuracy (guess {first.chance:.2f})" if first.classes else "R²"
    return Panel(f"{first.question} (scenario {first.scenario})", "time (s)", unit, curves, y_limits=(-0.2, 1.0))


STUDIES = (
    Study(
        "adaptive-feedback",
        "an LQG that a neural network augments",
        f"the default blade, its controller designed for {DESIGNED:g} rad/s and run at {TURNING:g}; a step of {LOAD[1]:g} N/m in "
        f"flap, "
        "white load, sensor noise",
        (
            Statement("off", "Switched off it is LQG to the last bit", Small(0.0, 0.0)),
            Statement("cost", "On, it lowers LQG's J on the blade that turns slower", Holds()),
            Statement("nominal", "On the design it costs what LQG costs, within 2 %", Small(0.02, 0.05)),
            Statement("error", "It lowers the energy of the model's error, in the mean over the second half", Holds()),
            Statement("bounds", "Weights stay within their bounds and the adaptive voltage within its share of the drive", Holds()),
            Statement("bumpless", "Switched off in mid-episode, the voltage of that instant is what it would have been", Holds()),
            Statement("back", "At the end of that episode the adaptive voltage is below 1 % of the drive", Holds()),
        ),
        adapted,
    ),
    Study(
        "recurrent-memory",
        "what the gated recurrent unit of a trained agent tells of the blade",
        "`gradient` trained on all scenarios, run 0, 48 units; ridge probes of the units over 50 ms, on episodes they were not "
        "fitted to; 128 validation episodes each, as `python -m train.probing` recorded them",
        (
            Statement(
                "above", "The memory tells speed, delay and dead actuator better than guessing does, always after 0.1 s", Holds()
            ),
            Statement("window", "It tells more than as many of the latest readings and voltages do", Holds()),
            Statement(
                "magnitudes",
                "Of speed and dead actuator it tells more, at best, than the magnitudes of readings and voltages do",
                Holds(),
                "The delay shows in magnitudes as well as in the memory: it lets vibration grow.",
            ),
            Statement("shuffled", "From shuffled answers nothing is learnt that is better than a guess", Holds()),
        ),
        remembered,
    ),
)
