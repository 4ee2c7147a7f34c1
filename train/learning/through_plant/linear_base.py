"""The linear controllers that a residual policy may add to, as matrices of normalised readings and voltages."""

from __future__ import annotations

from typing import NamedTuple

from baselines import LinearController, PersistentLoad, RotorHarmonics, lqg, rotor_lqg
from baselines.design.controller import Array
from baselines.laws.lqg import sampled_design
from beamenv.configuration import Refused
from beamenv.task import Task

BASES = ("lqg", "lqg-load", "lqg-rotor")


class LinearBase(NamedTuple):
    """[ξ, y'] @ fused = [ξ⁺ before feedback, voltages]; ξ⁺ gains voltages @ feedback.

    y' = y + (C ξ − clip(C ξ)): with it the innovation is y − clip(C ξ), that of a filter which knows that readings clip.
    """

    fused: Array
    """(s + p, s + m)"""
    feedback: Array
    """(m, s)"""
    readout: Array
    """(s, p): ξ to the readings it predicts."""


def linear_base(kind: str, task: Task) -> LinearBase:
    """LQG of a task's design plant: "lqg", "lqg-load" (with load estimate) or "lqg-rotor" (with the rotor's harmonics)."""
    plant = task.design_plant
    load, harmonics = PersistentLoad(), RotorHarmonics(task.design_config.speed) if task.design_config.speed else None
    if kind == "lqg":
        return _based(lqg(plant), sampled_design(plant)[0].C, plant.sensor_full_scale)
    if kind == "lqg-load":
        return _based(lqg(plant, persistent_load=load), sampled_design(plant, load)[0].C, plant.sensor_full_scale)
    if kind == "lqg-rotor" and harmonics is not None:
        return _based(rotor_lqg(plant, harmonics), sampled_design(plant, harmonics)[0].C, plant.sensor_full_scale)
    raise Refused("base", kind, "one of lqg, lqg-load and, on a rotor that turns, lqg-rotor")


def _based(law: LinearController, output: Array, full_scale: Array) -> LinearBase:
    return LinearBase(*law.matrices, output.T / full_scale)
