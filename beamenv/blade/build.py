"""What is built from a configuration: the blade, its plant, and where its stations move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import MATERIALS, BladeConfig
from beamenv.configuration import Refused
from beamenv.plant.plant import Plant
from beamenv.plant.reduction import FullModel, ModalModel, full_model, reduced_plant, truncate
from beamenv.structure import RotatingBeam
from beamenv.structure.beam import OUT_OF_SCALE

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Blade:
    """A configuration and what is built of it: each part once, when it is first asked for, and kept as long as the blade is.

    Blades are equal if their configurations are. Parts raise ``ValueError`` for a blade that cannot be.
    """

    config: BladeConfig

    @property
    def as_beam(self) -> Blade:
        """The blade that the configuration describes: this one, unless it moves as a plant file says."""
        return self

    @cached_property
    def beam(self) -> RotatingBeam:
        """The blade with its patches' passive effect."""
        return build_beam(self.config)

    @cached_property
    def modal(self) -> ModalModel:
        """Its retained modes."""
        return truncate(self.beam, self.config.speed, self.config.modes, self.config.gyroscopic)

    @cached_property
    def full(self) -> FullModel:
        """What acts on it and what is seen of it."""
        return full_model(self.beam, self.config.patches, self.config.speed)

    @cached_property
    def plant(self) -> Plant:
        """Its reduced plant."""
        modal, config = self.modal, self.config
        try:
            plant = reduced_plant(
                modal,
                self.full,
                damping_ratio=config.damping_ratio,
                effort_weight=config.effort_weight,
                white_load=config.white_load,
                sensor_noise_fraction=config.sensor_noise_fraction,
                sensor_full_scale=config.sensor_full_scale,
                voltage_limits=config.voltage_limits,
                control_interval=config.control_interval,
            )
        except OverflowError:
            raise ValueError(f"blade cannot be computed: {OUT_OF_SCALE}") from None
        if not all(np.isfinite(getattr(plant, each.name)).all() for each in fields(plant)):
            raise ValueError(f"blade cannot be computed: {OUT_OF_SCALE}")
        return plant

    @property
    def true_modal(self) -> ModalModel:
        """The modes of its true plant."""
        return self.modal

    @property
    def truth(self) -> Plant:
        """Its true plant, that moves."""
        return self.plant

    def changed(self, config: BladeConfig) -> Blade:
        """The blade of another configuration, with the parts of this one that do not depend on the difference."""
        other = Blade(config)
        for part, depends_on in _MADE_OF.items():
            if all(getattr(config, name) == getattr(self.config, name) for name in depends_on):
                vars(other)[part] = getattr(self, part)
        return other

    def with_fixed_range(self) -> Blade:
        """The blade behind the data acquisition that fits it now: another blade made of its configuration keeps it."""
        return self.changed(replace(self.config, sensor_full_scale=float(self.plant.sensor_full_scale[0])))

    def displacement_operator(self, stations: Sequence[float] | Array) -> Array:
        """(3, k, n): lag, flap (m) and twist (rad) at k stations (m from the root) per unit of each state of the plant."""
        rows = self.beam.displacements(np.asarray(stations, dtype=float))
        displaced = np.stack([rows["u"], rows["v"], rows["phi"]]) @ (
            self.true_modal.mode_shapes / self.true_modal.natural_frequencies
        )
        return np.concatenate([displaced, np.zeros_like(displaced)], axis=-1)


_BEAM = ("beam", "patches", "model")
_MADE_OF = {"beam": _BEAM, "modal": (*_BEAM, "speed", "modes", "gyroscopic"), "full": (*_BEAM, "speed")}
"""The fields of a configuration that each part depends on."""


def build_beam(config: BladeConfig) -> RotatingBeam:
    """The blade with its patches' passive effect."""
    return config.beam.build(config.patches, config.model)


def build_plant(config: BladeConfig) -> Plant:
    """The reduced plant of a configuration, built anew, in some hundredths of a second; ``ValueError`` as the parts raise it."""
    return Blade(config).plant


def plant_of(config: BladeConfig, beam: RotatingBeam) -> Plant:
    """The plant of a beam that ``config.beam`` does not describe, of any section, say; it carries the inlays of passive patches.

    Raises ``ValueError`` for a beam of another model than the configuration's.
    """
    if beam.model != config.model:
        raise Refused("beam.model", beam.model, f"the blade's, {config.model!r}")
    blade = Blade(config)
    vars(blade)["beam"] = beam
    return blade.plant


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


def displacement_operator(config: BladeConfig, stations: Sequence[float] | Array) -> Array:
    """(3, k, n): lag, flap (m) and twist (rad) at k stations (m from the root) per unit of each state of the plant."""
    return Blade(config).displacement_operator(stations)
