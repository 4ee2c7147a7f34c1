"""Which bank a scenario asks for: plants that are drawn, or the plants of a spin-up."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from beamenv.blade.build import Blade
from beamenv.blade.changed import changed_blade
from beamenv.blade.config import BeamConfig, BladeConfig
from beamenv.blade.model_blade import ModelBlade
from beamenv.configuration import Refused
from beamenv.scenarios.tables import PlantVariation
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.plants.coordinates import seen_from
from beamenv.simulation.plants.model_bank import model_bank
from beamenv.simulation.plants.pyroelectric import pyroelectric_readings
from beamenv.simulation.plants.spin_up import Cycloid
from beamenv.simulation.plants.spin_up_bank import spin_up_bank
from beamenv.simulation.plants.spin_ups import spin_up_of
from beamenv.simulation.plants.standing import about_moving_equilibrium, about_steady_states
from beamenv.simulation.plants.walks import Warming, stations_of, walk_of

Array = NDArray[np.float64]


def build_bank(blade: Blade, design: Blade, variation: PlantVariation, steps: int) -> Bank:
    """The bank of a true blade, seen from a design blade, for episodes of ``steps`` control intervals."""
    if variation.spin_up is not None:
        spin_up = spin_up_of(blade, Cycloid(*variation.spin_up, steps * blade.config.control_interval))
        return about_moving_equilibrium(spin_up_bank(blade, design, spin_up, steps), blade, spin_up)
    return drawn_bank(blade, design, variation)


def drawn_bank(blade: Blade, design: Blade, variation: PlantVariation) -> Bank:
    """The bank that each episode draws its plant from; of one plant where nothing varies."""
    if isinstance(blade, ModelBlade):
        return model_bank(blade, design, variation)
    if not variation.varies:
        return about_steady_states(Bank.single(blade.truth, blade.config.speed, seen_from(blade, design)), [blade])
    blades = list(varied_blades(blade, variation))
    views = [seen_from(each, design) for each in blades]
    to_design = None if any(view is None for view in views) else np.stack(views)  # type: ignore[arg-type]
    plants, speeds = [each.truth for each in blades], np.array([each.config.speed for each in blades])
    bank = Bank.gather(blade.truth, plants, speeds, to_design)
    walk = walk_of(variation, blade.config.control_interval)
    if walk is not None:  # no tachometer follows
        passage = passage_between(blades, blade)
        bank = replace(
            bank, speeds=np.full(len(blades), blade.config.speed), walk=walk, to_common=passage[0], from_common=passage[1]
        )
    if variation.pyroelectric and variation.temperature is not None:
        readings = pyroelectric_readings(blade, variation.temperature)
        bank = replace(bank, pyroelectric=np.tile(readings, (len(blades), 1, 1)))
    return about_steady_states(bank.in_cost_axes(), blades)


def passage_between(blades: Sequence[Blade], reference: Blade) -> tuple[Array, Array]:
    """(K, n, n) twice: from the states of each blade's true plant to those that all have in common, and back.

    Displacements and velocities go on: with modes ΨᵀMΨ = 1 of one blade and Ψ₀ of the reference, η = ΨᵀMΨ₀ η₀. States are rows.
    """
    forth, back = [], []
    for blade in blades:
        modal, electronics = blade.true_modal, np.eye(blade.truth.electronic_states)
        seen = modal.mode_shapes.T @ blade.beam.at(blade.config.speed).mass @ reference.true_modal.mode_shapes
        omega, inverse = modal.natural_frequencies, np.linalg.inv(seen).T
        forth.append(block_diag(inverse / omega[:, None], inverse, electronics))
        back.append(block_diag(seen.T * omega, seen.T, electronics))
    return np.stack(forth), np.stack(back)


def _on_the_way(stations: Array, config: BladeConfig) -> Array:
    """(K, 5) as ``varied`` has them, from ratios (K, 3) of speed, modulus and mass."""
    speed, modulus, mass = stations.T
    return np.stack([speed, np.ones(len(speed)), modulus, mass, np.full(len(speed), config.damping_ratio)], axis=1)


def varied_blades(blade: Blade, variation: PlantVariation) -> Iterator[Blade]:
    """The blades of a bank, behind the data acquisition of the one they depart from and with as many modes; those of one structure
    share it.
    """
    ranged = blade.with_fixed_range().with_fixed_order()
    built: dict[BeamConfig, Blade] = {}
    for row in varied(variation, blade.config):
        try:
            config = changed_blade(ranged.config, *row)
        except Refused as error:
            raise _of_scenario(error, variation, row[-1]) from None
        yield built.setdefault(config.beam, ranged.changed(config)).changed(config)


def _of_scenario(error: Refused, variation: PlantVariation, temperature: float) -> Refused:
    """What is said of a scenario where a blade refuses one of its temperatures (K)."""
    if variation.temperature is None or not error.name.startswith("blade.beam.temperature"):
        return error
    low, high = variation.temperature
    reached = "" if low <= temperature <= high else f"; with its change it reaches {temperature:g} K"
    allowed = error.allowed.replace("a number from", "two numbers from", 1)
    return Refused("scenario.plants.temperature", [low, high], allowed + reached)


def varied(variation: PlantVariation, config: BladeConfig) -> Array:
    """(bank, 5): speed, ply angle, modulus and mass ratios, and damping ratio, by Latin hypercube (McKay et al. 1979), or at the
    stations of what changes within an episode; (bank, 6) with temperatures (K), where they do.
    """
    walk = walk_of(variation, config.control_interval)
    if walk is not None:
        rows = _on_the_way(stations_of(walk, variation), config)
        return np.column_stack([rows, walk.stations()]) if isinstance(walk, Warming) else rows
    generator = np.random.default_rng(variation.seed)
    damping = variation.damping_ratio or (config.damping_ratio, config.damping_ratio)
    ranges = (variation.speed_ratio, variation.ply_angle_ratio, variation.modulus_ratio, variation.mass_ratio)
    strata = np.stack([generator.permutation(variation.bank) for _ in range(5)], axis=1)
    uniform = (strata + generator.random(strata.shape)) / variation.bank
    columns = [low + (high - low) * uniform[:, k] for k, (low, high) in enumerate(ranges)]
    columns.append(damping[0] * (damping[1] / max(damping[0], 1e-300)) ** uniform[:, 4])
    return np.stack(columns, axis=1)
