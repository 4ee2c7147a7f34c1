"""From the settings to what the page shows of a blade while a control moves."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines.design.weights import weighted
from baselines.laws.lqg import sampled_design
from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.blade.presets import THESIS
from beamenv.configuration.read_only import sealed
from beamenv.structure import RotatingBeam
from beamenv.structure.sweep import frequency_sweep
from train.explore.loops import Damping, StepResponses, damping, step_responses
from train.explore.settings import Settings
from train.explore.units import nearest_round, one_digit

Array = NDArray[np.float64]

ABOVE_ITS_OWN, ABOVE_THE_LOWEST = 2.0, 4.0
"""How far the Campbell diagram goes at least: times the blade's own speed, and times its lowest frequency at rest."""
SPEEDS = 21
CAMPBELL_MODES = 6
STATIONS = 33
MOTIONS = ("lag u", "flap v", "extension s", "twist φ·c/2")
"""Twist as the displacement of the root chord's ends, so that all four are lengths."""
PERIODS = 14.0
"""Of the lowest mode, about: how long step responses are."""
MOST_SAMPLES = 20_000
"""Of a step response."""


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """A blade with r retained modes, at one speed; n is r, or the Campbell diagram's number of modes if that is more."""

    speed: float
    """rad/s."""
    critical_speed: float
    """rad/s."""
    speeds: Array
    """(k,), rad/s, of the Campbell diagram."""
    campbell: Array
    """(k, modes), rad/s, at ``speeds``."""
    natural_frequencies: Array
    """(n,), rad/s, with gyroscopic coupling and all trial functions."""
    families: tuple[str, ...]
    """(n,): lag, flap, extension or twist."""
    stations: Array
    """(k,), m from the root."""
    shapes: NDArray[np.complex128]
    """(modes, 4, k): ``MOTIONS`` of the Campbell diagram's modes over the largest; imaginary: a quarter of a period later."""
    damping: Damping
    response: StepResponses


def view(settings: Settings, base: BladeConfig = THESIS) -> View:
    """Everything the page shows; ``ValueError``, in one sentence, for a blade or patches that cannot be."""
    blade = blade_of(settings, base)
    config, beam, plant = blade.config, blade.beam, blade.plant
    modes = beam.modes(config.speed, max(config.modes, CAMPBELL_MODES))
    stations, shapes = mode_shapes(beam, modes.mode_shapes[:, :CAMPBELL_MODES], 0.5 * width(beam))
    held, (_, K), (_, L) = sampled_design(weighted(plant, *settings.weights(plant)))
    line_load = blade.reference_load * np.array([settings.load == "lag", settings.load == "flap"], dtype=float)
    return View(
        speed=config.speed,
        critical_speed=beam.critical_speed,
        speeds=campbell_speeds(base),
        campbell=campbell(beam, highest_speed(base)),
        natural_frequencies=modes.natural_frequencies,
        families=modes.families,
        stations=stations,
        shapes=shapes,
        damping=damping(plant, held, K, L),
        response=step_responses(plant, held, K, L, line_load, step_duration(base)),
    )


@lru_cache(maxsize=2)
def blade_of(settings: Settings, base: BladeConfig = THESIS) -> Blade:
    """The blade that the settings stand for; ``ValueError`` where they make none."""
    config = settings.config(base)
    return built(without_noise(replace(config, speed=base.speed), base)).changed(config)


def without_noise(config: BladeConfig, base: BladeConfig) -> BladeConfig:
    """The blade under its first noise, on which none of its matrices but those of the noise depend."""
    return replace(config, white_load=base.white_load, sensor_noise_fraction=base.sensor_noise_fraction)


@lru_cache(maxsize=16)
def built(config: BladeConfig) -> Blade:
    """The blade, whose matrices do for every speed."""
    return Blade(config)


def width(beam: RotatingBeam) -> float:
    """m: of the root section's contour."""
    return float(np.ptp(np.concatenate([chain.points for chain in beam.section.chains])[:, 0]))


@lru_cache(maxsize=16)
def highest_speed(base: BladeConfig) -> float:
    """rad/s: where the Campbell diagram and the slider of the speed end, a number of one digit."""
    at_rest = float(built(base).beam.natural_frequencies(0.0, 1)[0])
    return one_digit(max(ABOVE_ITS_OWN * base.speed, ABOVE_THE_LOWEST * at_rest))


def campbell_speeds(base: BladeConfig) -> Array:
    """(k,), rad/s, from rest."""
    return np.linspace(0.0, highest_speed(base), SPEEDS)


@lru_cache(maxsize=16)
def step_duration(base: BladeConfig) -> float:
    """s: some periods of the blade's lowest mode, 1, 2 or 5 times a power of ten."""
    lowest = float(built(base).beam.natural_frequencies(base.speed, 1)[0])
    return nearest_round(min(2.0 * np.pi * PERIODS / lowest, MOST_SAMPLES * base.control_interval))


@lru_cache(maxsize=16)
def campbell(beam: RotatingBeam, highest: float) -> Array:
    """Natural frequencies (speeds, modes), rad/s."""
    return sealed(frequency_sweep(beam, np.linspace(0.0, highest, SPEEDS), CAMPBELL_MODES))


def mode_shapes(beam: RotatingBeam, coefficients: NDArray[Any], half_chord: float) -> tuple[Array, NDArray[np.complex128]]:
    """Stations (k,) in m and ``MOTIONS`` (modes, 4, k) there, turned and scaled so that the largest of each mode is 1."""
    stations = np.linspace(0.0, beam.length, STATIONS)
    rows = beam.displacements(stations)
    moved = np.stack([rows["u"], rows["v"], rows["s"], half_chord * rows["phi"]]) @ coefficients.astype(complex)
    moved = np.moveaxis(moved, -1, 0)
    flat = moved.reshape(len(moved), -1)
    largest = flat[np.arange(len(flat)), np.abs(flat).argmax(axis=1)]
    return stations, moved / largest[:, None, None]
