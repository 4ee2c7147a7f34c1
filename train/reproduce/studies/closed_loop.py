"""Controlled step and pulse responses of blades with patches: LQG in the loop, exact, without noise."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from baselines import Instruments, LinearController, lqg
from baselines.analysis.response import linear_response
from beamenv.blade.build import Blade, build_plant
from beamenv.blade.config import BeamConfig, BladeConfig
from beamenv.patches import PatchLayout
from beamenv.plant.plant import Plant, sample
from beamenv.plant.reduction import acting_on_velocities
from train.figures.figure import Curve, Panel
from train.reproduce.thesis import Model
from train.reproduce.thesis.configurations import WORLD
from train.reproduce.thesis.equations import INPUT_WEIGHT
from train.reproduce.thesis.response import ForcedBlade, settling_time

Array = NDArray[np.float64]

PATCH_LENGTH, PATCH_WIDTH = 0.08, 0.057
"""m: chapter 5's patches."""
DURATION, SHOWN = 2.0, 0.25
"""s: long enough to settle, and what is drawn."""
EFFORT_WEIGHT = BladeConfig().effort_weight
UNLIMITED = 1e6
"""V: a drive limit that no voltage reaches; voltages are compared as the law asks for them, which saturation would hide."""
PULSE = 0.05
"""s: length of a rectangular pulse; the thesis names none."""
DIRECTIONS = ("lag", "flap")
"""Order of loads and tip displacements; flap is the thesis' y-direction."""


def patches(**changes: object) -> PatchLayout:
    """Chapter 5's four sensors and four actuators, spaced equally over 0 … 0.7 L."""
    return replace(PatchLayout(length=PATCH_LENGTH, width=PATCH_WIDTH), **changes)  # type: ignore[arg-type]


def blade(model: Model, beam: BeamConfig, layout: PatchLayout | None = None, **changes: object) -> BladeConfig:
    """A blade of chapter 5 at the model's speed and damping."""
    placed = model.layout(layout or patches())
    config = BladeConfig(beam=beam, patches=placed, model=WORLD, speed=model.speed, damping_ratio=model.damping_ratio)
    return replace(config, **changes)  # type: ignore[arg-type]


def one_loop(plant: Plant) -> Plant:
    """The thesis' first method: the sensors' currents summed into one; the actuators are ganged by the layout."""
    return replace(
        plant,
        C=plant.C.sum(axis=0, keepdims=True),
        D=plant.D.sum(axis=0, keepdims=True),
        sensor_noise=np.array([[np.trace(plant.sensor_noise)]]),
        sensor_full_scale=np.array([plant.sensor_full_scale.sum()]),
    )


@lru_cache(maxsize=64)
def plant_of(config: BladeConfig) -> Plant:
    """The plant of a blade, with one loop where its actuators are ganged."""
    plant = build_plant(config)
    return one_loop(plant) if config.patches.only("actuators").ganged else plant


def weighed(model: Model, plant: Plant, effort_weight: float = EFFORT_WEIGHT) -> Plant:
    """The plant with the input weight of the model: ours, or that of Eq. 5.9 in proportion to ``effort_weight``."""
    if INPUT_WEIGHT not in model.reading:
        return plant
    share = effort_weight / EFFORT_WEIGHT
    return replace(plant, input_weight=share * printed_factor(model) * printed_weight(plant))


def printed_weight(plant: Plant) -> Array:
    """FᵀΨᵀKΨF (m, m) of Eq. 5.9, F in modal coordinates: stiff modes weigh more, where FᵀK⁻¹F has them weigh less."""
    omega = plant.natural_frequencies
    force = omega[:, None] * plant.B[-len(omega) :]
    return force.T @ force


@lru_cache(maxsize=8)
def printed_factor(model: Model) -> float:
    """η of Eq. 5.9, which the thesis does not print: the one by which tr R of θ = 30° is that of our own rule."""
    plant = plant_of(blade(model, model.blade(30.0)))
    return float(np.trace(plant.input_weight) / np.trace(printed_weight(plant)))


@dataclass(frozen=True, slots=True, eq=False)
class Response:
    """A controlled response."""

    times: Array
    """(K,), s."""
    tip: Array
    """(K,), m."""
    voltages: Array
    """(K, m), V."""
    final: float
    """m: where the tip comes to rest."""
    asked: Array
    """(m,), V: the peak voltages that the law would ask for, were there no limit."""

    @property
    def peak(self) -> float:
        """m: largest displacement of the tip."""
        return float(np.abs(self.tip).max())

    @property
    def settling(self) -> float:
        """s: until the tip stays within 5 % of its largest excursion from rest."""
        return settling_time(self.times, self.tip, self.final)


def simulate(
    plant: Plant,
    controller: LinearController,
    load: float,
    duration: float = DURATION,
    pulse: float | None = None,
    direction: str = "flap",
) -> Response:
    """The response to a uniform load (N/m) that sets in at once, for good or for ``pulse`` s; noise-free, voltages limited."""
    column, held = DIRECTIONS.index(direction), sample(plant)
    steps = round(duration / plant.control_interval)
    until = steps if pulse is None else round(pulse / plant.control_interval)
    loads = np.zeros((steps, 2))
    loads[:until, column] = load
    states, voltages = linear_response(held, controller, loads)
    tip = states @ plant.tip_displacement[column]
    final = 0.0 if pulse else float(tip[-steps // 10 :].mean())
    times = np.linspace(0.0, steps * plant.control_interval, steps + 1)
    return Response(times, tip, np.vstack([voltages, voltages[-1:]]), final, np.abs(voltages).max(axis=0))


def controlled(
    model: Model,
    blades: Mapping[str, BladeConfig],
    pulse: float | None = None,
    direction: str = "flap",
    loaded: Callable[[Plant, BladeConfig], Plant] = lambda plant, config: plant,
) -> dict[str, Response]:
    """LQG-controlled responses to the model's load, by label; the law is that of uniform loads, however the blade is ``loaded``."""
    responses = {}
    for label, config in blades.items():
        plant = weighed(model, plant_of(config))
        law = lqg(plant)
        plant = loaded(plant, config)
        found = simulate(plant, law, model.load, pulse=pulse, direction=direction)
        asked = simulate(*without_limits(plant, law), model.load, SHOWN, pulse, direction).asked
        responses[label] = replace(found, asked=asked)
    return responses


@lru_cache(maxsize=16)
def pressure_of(config: BladeConfig) -> Array:
    """(2r,): what a load in flap that falls with the chord, 1 N/m at the root, does to the plant of a blade."""
    whole = Blade(config)
    force = ForcedBlade(whole.beam, config.speed, "flap", config.damping_ratio, pressure=True).force
    return acting_on_velocities(whole.modal.mode_shapes.T @ force[:, None])[:, 0]


def under_pressure(plant: Plant, config: BladeConfig) -> Plant:
    """The plant of a blade whose load in flap falls with the chord."""
    return replace(plant, disturbance_input=np.column_stack([plant.disturbance_input[:, 0], pressure_of(config)]))


def without_limits(plant: Plant, law: LinearController) -> tuple[Plant, LinearController]:
    """Behind a drive whose limits no voltage reaches."""
    free = replace(plant, voltage_limits=np.outer((-UNLIMITED, UNLIMITED), np.ones(len(plant.input_weight))))
    return free, replace(law, instruments=Instruments.of(free))


def response_panels(responses: Mapping[str, Response], direction: str = "flap") -> list[Panel]:
    """Tip displacement, then the voltage of each actuator."""
    first = next(iter(responses.values()))
    shown = first.times <= SHOWN
    actuators = first.voltages.shape[1]
    names = ["voltage on all actuators"] if actuators == 1 else [f"voltage on actuator {k + 1}" for k in range(actuators)]
    tip = [Curve(r.times[shown], 1e3 * r.tip[shown], label) for label, r in responses.items()]
    panels = [Panel(f"tip displacement in {direction}", "time (s)", "displacement (mm)", tip)]
    for k, name in enumerate(names):
        curves = [Curve(r.times[shown], r.voltages[shown, k], label) for label, r in responses.items()]
        panels.append(Panel(name, "time (s)", "voltage (V)", curves))
    return panels


def peaks(responses: Mapping[str, Response]) -> Array:
    """(labels,), m."""
    return np.array([response.peak for response in responses.values()])


def peak_voltages(responses: Mapping[str, Response]) -> Array:
    """(labels, actuators), V: asked for, were there no limit."""
    return np.array([response.asked for response in responses.values()])


def voltage_energy(response: Response, plant: Plant) -> float:
    """∫uᵀRu dt, J s: what the voltages put into the actuators, as the index weighs it."""
    per_step = np.einsum("ki,ij,kj->k", response.voltages, plant.input_weight, response.voltages)
    return float(plant.control_interval * per_step[:-1].sum())


def settling_times(responses: Mapping[str, Response]) -> Array:
    """(labels,), s."""
    return np.array([response.settling for response in responses.values()])
