"""A blade beside another: faster, stiffer, heavier, warmer, with other plies and another damping."""

from __future__ import annotations

from dataclasses import replace

from beamenv.blade.config import BladeConfig
from beamenv.structure.walls.named import MATERIALS


def changed_blade(
    config: BladeConfig,
    speed: float,
    ply_angle: float,
    modulus: float,
    mass: float,
    damping_ratio: float,
    temperature: float | None = None,
) -> BladeConfig:
    """A blade whose speed, ply angles, moduli and density are those of another times a ratio, with a damping ratio of its own, and
    at a temperature (K) of its own where one is said.
    """
    material = MATERIALS[config.beam.material] if isinstance(config.beam.material, str) else config.beam.material
    beam = replace(
        config.beam,
        material=material.scaled(modulus, mass),
        ply_angles_deg=tuple((wall, tuple(ply_angle * angle for angle in angles)) for wall, angles in config.beam.ply_angles_deg),
    )
    if temperature is not None:
        beam = replace(beam, temperature=temperature, temperature_table=None)
    return replace(config, beam=beam, speed=speed * config.speed, damping_ratio=damping_ratio)
