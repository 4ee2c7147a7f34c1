"""A bank of discretised plants: what an episode's true plant is drawn from. Built once; a blade in a batch has an index into it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import BeamConfig, BladeConfig, build_beam, build_plant, changed_blade, plant_of
from beamenv.kernel import Operators
from beamenv.loads import static_deflection
from beamenv.plant import Plant, normalised
from beamenv.reduction import truncate
from beamenv.structure import RotatingBeam
from beamenv.troubles import PlantVariation

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Bank:
    """K plants of n states with the same drive and data acquisition; voltages and readings normalised to these.

    Every plant has energy coordinates of its own: ½ xᵀx is the energy, in joules, whichever it is.
    """

    plant: Plant
    """The one all others depart from."""
    operators: Operators
    """``fused`` (K, …), or of one plant."""
    readout: Array
    """(K, n, p): state to noise-free readings, in full scales."""
    tip: Array
    """(K, n, 2), m per √J."""
    strain: Array
    """(K, k, n) per √J."""
    release: Array
    """(K, 2, n): static deflection per N/m of line load, lag and flap."""
    speeds: Array
    """(K,), rad/s."""
    effort_weight: Array
    """(K, m, m), J s: uᵀRu Δt of normalised voltages."""
    to_design: Array | None
    """(K, n, d): state to the design plant's coordinates; None where the two blades' displacements cannot be compared."""
    start: Array | None = None
    """(n,): what a blade's state at the start of an episode is increased by."""
    runs: bool = False
    """Whether the plants follow one another, one each control interval, instead of being drawn."""

    def __len__(self) -> int:
        return len(self.speeds)

    @classmethod
    def single(cls, plant: Plant, speed: float = 0.0, to_design: Array | None = None) -> Bank:
        """The bank of one plant."""
        bank = cls.gather(plant, [plant], np.array([speed]), None if to_design is None else to_design[None])
        return replace(bank, operators=Operators.from_plant(normalised(plant)))

    @classmethod
    def gather(cls, plant: Plant, plants: Sequence[Plant], speeds: Array, to_design: Array | None) -> Bank:
        """The bank of several plants."""
        units = [normalised(each) for each in plants]
        parts = [Operators.from_plant(unit) for unit in units]
        return cls(
            plant=plant,
            operators=replace(parts[0], fused=np.stack([part.fused for part in parts])),
            readout=np.stack([unit.C.T for unit in units]),
            tip=np.stack([each.tip_displacement.T for each in plants]),
            strain=np.stack([each.strain for each in plants]),
            release=np.stack([static_deflection(each, np.eye(2)) for each in plants]),
            speeds=speeds,
            effort_weight=np.stack([unit.input_weight * unit.control_interval for unit in units]),
            to_design=to_design,
        )


def build_bank(config: BladeConfig, design: BladeConfig, variation: PlantVariation, steps: int) -> Bank:
    """The bank of a true blade, seen from a design blade, for episodes of ``steps`` control intervals; built once and cached."""
    if variation.spin_up is not None:
        from beamenv.spin_up import spin_up_bank

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


def seen_from(config: BladeConfig, beam: RotatingBeam, design: BladeConfig) -> Array | None:
    """(n, d): the state of a blade in a design blade's coordinates, by its displacements and velocities.

    With mode shapes Ψ on the same trial functions η_d = Ψ_dᵀ M_d Ψ η. None where the trial functions are not the same.
    """
    other = build_beam(design)
    if beam.space != other.space:
        return None
    true, modal = (truncate(blade, of.speed, of.modes, of.gyroscopic) for blade, of in ((beam, config), (other, design)))
    displacing = true.mode_shapes / true.natural_frequencies
    return coordinates(displacing, true.mode_shapes, other, modal.mode_shapes, modal.natural_frequencies)


def coordinates(displacing: Array, moving: Array, design: RotatingBeam, shapes: Array, frequencies: Array) -> Array:
    """(n, d) map of states whose halves move the trial functions' coefficients by ``displacing`` and ``moving`` (N, r)."""
    projection = shapes.T @ design.matrices.mass
    displaced, moved = frequencies[:, None] * (projection @ displacing), projection @ moving
    still = np.zeros_like(displaced)
    return np.asarray(np.block([[displaced, still], [still, moved]]).T)
