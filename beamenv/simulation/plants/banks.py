"""Which bank a scenario asks for: plants that are drawn, or the plants of a run-up."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import build_beam, build_plant, changed_blade, plant_of
from beamenv.blade.config import BeamConfig, BladeConfig
from beamenv.scenarios.tables import PlantVariation
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.plants.coordinates import seen_from
from beamenv.simulation.plants.spin_up import spin_up_bank
from beamenv.structure import RotatingBeam

Array = NDArray[np.float64]


def build_bank(config: BladeConfig, design: BladeConfig, variation: PlantVariation, steps: int) -> Bank:
    """The bank of a true blade, seen from a design blade, for episodes of ``steps`` control intervals; built once and cached."""
    if variation.spin_up is not None:
        return spin_up_bank(config, design, variation.spin_up, steps)
    return drawn_bank(config, design, variation)


@lru_cache(maxsize=16)
def drawn_bank(config: BladeConfig, design: BladeConfig, variation: PlantVariation) -> Bank:
    """The bank that each episode draws its plant from; of one plant where nothing varies."""
    plant = build_plant(config)
    if not variation.varies:
        return Bank.single(plant, config.speed, seen_from(config, build_beam(config), design))
    ranged = replace(config, sensor_full_scale=float(plant.sensor_full_scale[0]))
    configs = [changed_blade(ranged, *row) for row in varied(variation, config)]
    built: dict[BeamConfig, RotatingBeam] = {}
    plants, views = [], []
    for each in configs:
        if each.beam not in built:
            built[each.beam] = each.beam.build(each.patches)
        plants.append(plant_of(each, built[each.beam]))
        views.append(seen_from(each, built[each.beam], design))
    to_design = None if any(view is None for view in views) else np.stack(views)  # type: ignore[arg-type]
    return Bank.gather(plant, plants, np.array([each.speed for each in configs]), to_design)


def varied(variation: PlantVariation, config: BladeConfig) -> Array:
    """(bank, 5): speed, ply angle, modulus and mass ratios, and damping ratio, by Latin hypercube (McKay et al. 1979)."""
    generator = np.random.default_rng(variation.seed)
    damping = variation.damping_ratio or (config.damping_ratio, config.damping_ratio)
    ranges = (variation.speed_ratio, variation.ply_angle_ratio, variation.modulus_ratio, variation.mass_ratio)
    strata = np.stack([generator.permutation(variation.bank) for _ in range(5)], axis=1)
    uniform = (strata + generator.random(strata.shape)) / variation.bank
    columns = [low + (high - low) * uniform[:, k] for k, (low, high) in enumerate(ranges)]
    columns.append(damping[0] * (damping[1] / max(damping[0], 1e-300)) ** uniform[:, 4])
    return np.stack(columns, axis=1)
