"""What is built from a configuration: the blade, its plant, and where its stations move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import MATERIALS, BladeConfig
from beamenv.plant.plant import Plant
from beamenv.plant.reduction import reduced_plant, truncate
from beamenv.structure import RotatingBeam

Array = NDArray[np.float64]


@lru_cache(maxsize=64)
def build_beam(config: BladeConfig) -> RotatingBeam:
    """The blade with its patches' passive effect."""
    return config.beam.build(config.patches)


@lru_cache(maxsize=64)
def build_plant(config: BladeConfig) -> Plant:
    """The reduced plant of a configuration, built once and cached; ``ValueError`` as the parts raise it."""
    return plant_of(config, build_beam(config))


def changed_blade(
    config: BladeConfig, speed: float, ply_angle: float, modulus: float, mass: float, damping_ratio: float
) -> BladeConfig:
    """A blade whose speed, ply angles, moduli and density are those of another times a ratio, with a damping ratio of its own."""
    material = MATERIALS[config.beam.material] if isinstance(config.beam.material, str) else config.beam.material
    stiffer = {name: modulus * getattr(material, name) for name in ("E1", "E2", "G12", "G13", "G23")}
    beam = replace(
        config.beam,
        material=replace(material, density=mass * material.density, **stiffer),
        ply_angles_deg=tuple((wall, tuple(ply_angle * angle for angle in angles)) for wall, angles in config.beam.ply_angles_deg),
    )
    return replace(config, beam=beam, speed=speed * config.speed, damping_ratio=damping_ratio)


def plant_of(config: BladeConfig, beam: RotatingBeam) -> Plant:
    """The reduced plant of a configuration whose blade has been built."""
    return reduced_plant(
        beam,
        config.patches,
        speed=config.speed,
        modes=config.modes,
        damping_ratio=config.damping_ratio,
        gyroscopic=config.gyroscopic,
        effort_weight=config.effort_weight,
        white_load=config.white_load,
        sensor_noise_fraction=config.sensor_noise_fraction,
        sensor_full_scale=config.sensor_full_scale,
        voltage_limits=config.voltage_limits,
        control_interval=config.control_interval,
    )


def displacement_operator(config: BladeConfig, stations: Sequence[float] | Array) -> Array:
    """(3, k, n): lag, flap (m) and twist (rad) at k stations (m from the root) per unit of each state of the plant."""
    beam = build_beam(config)
    modal = truncate(beam, config.speed, config.modes, config.gyroscopic)
    rows = beam.displacements(np.asarray(stations, dtype=float))
    displaced = np.stack([rows["u"], rows["v"], rows["phi"]]) @ (modal.mode_shapes / modal.natural_frequencies)
    return np.concatenate([displaced, np.zeros_like(displaced)], axis=-1)
