"""The blade of a design: a configuration to build, save and control like any other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from baselines.design.riccati import kalman_filter, regulator
from baselines.placement.sizing.front import FrontPoint, SizedPatches
from baselines.placement.sizing.problem import SizingProblem
from baselines.placement.sizing.sheets import of_size
from baselines.placement.sizing.sized_contributions import drive_of
from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.configuration import Instance, checked
from beamenv.patches import PatchGroup
from beamenv.sensors.kinds import PatchCharge, PatchCurrent


def sized_blade(problem: SizingProblem, point: FrontPoint) -> BladeConfig:
    """The problem's blade with a point's patches, patches of one length in one group.

    Voltage limits go with the field, and the data acquisition keeps its noise: where larger sensors have larger currents, so is its
    range, of which the noise is then a smaller share. Raises ``ValueError`` for what is no problem, and no point of a front.
    """
    checked("problem", problem, Instance(SizingProblem))
    checked("point", point, Instance(FrontPoint))
    config = problem.config
    above, below = config.patches.pair()
    drive = drive_of(config, point.actuators.thickness)
    patches = replace(config.patches, actuators=groups_of(above, point.actuators), sensors=groups_of(below, point.sensors))
    low, high = (drive * limit for limit in config.voltage_limits)
    sized = replace(config, patches=patches, voltage_limits=(low, high), sensors=())
    if not config.sensors:
        return within_range(sized)
    listed = config.sensors[0]
    assert isinstance(listed, (PatchCurrent, PatchCharge))  # nothing else is read where patches are sized
    return replace(sized, sensors=tuple(replace(listed, group=k) for k in range(len(patches.groups("sensors")))))


def groups_of(group: PatchGroup, sized: SizedPatches) -> tuple[PatchGroup, ...]:
    """Groups like one, of patches of equal length, from the root to the tip by their first."""
    cut = of_size(group, sized.width, sized.thickness)
    lengths = dict.fromkeys(patch.length for patch in sized.patches)
    places = [(length, tuple(patch.start for patch in sized.patches if patch.length == length)) for length in lengths]
    return tuple(replace(cut, length=length, positions=positions) for length, positions in places)


def within_range(config: BladeConfig) -> BladeConfig:
    """The blade with a range that holds its currents, and the noise that it has."""
    held = config.sensor_full_scale
    needed = float(np.max(Blade(replace(config, sensor_full_scale=None)).plant.sensor_full_scale))
    if held is None or needed <= held:
        return config
    return replace(config, sensor_full_scale=needed, sensor_noise_fraction=config.sensor_noise_fraction * held / needed)


def cost_on_plant(problem: SizingProblem, point: FrontPoint) -> float:
    """J: what a point costs on the plant that is built of it, with the steady state and the section shapes of its own patches."""
    blade = sized_blade(problem, point)
    plant, drive = Blade(blade).plant, drive_of(problem.config, point.actuators.thickness)
    weight = problem.drive_weight / drive**2 * np.eye(plant.B.shape[1])
    P, K = regulator(plant.A, plant.B, plant.state_weight, weight)
    loads = plant.disturbance_input @ plant.process_noise @ plant.disturbance_input.T
    S, _ = kalman_filter(plant.A, plant.C, loads, plant.sensor_noise)
    return float(np.sum(P * loads) + np.sum(S * (K.T @ weight @ K)))
