"""What blades are like as they turn and nothing vibrates: what resets tell of it, and what of it counts towards failure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, replace

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.plant.reduction import steady_and_strain
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.plants.spin_up import SpinUp
from beamenv.structure.steady_deformation import steady_deformation

Array = NDArray[np.float64]

NODES = 8
"""Squared speeds between whose steady states those of a spin-up are interpolated."""


def about_steady_states(bank: Bank, blades: Sequence[Blade]) -> Bank:
    """The bank of as many blades, with their steady states.

    ``ValueError`` for a blade whose steady state alone is beyond its strain limit.
    """
    for blade in blades:
        if blade.config.strain_limit == "total":
            check_strain(blade.full.steady.strain, blade.config.speed, blade.config.patches.failure_strain)
    steady = np.array([astuple(blade.full.steady) for blade in blades])
    standing = np.stack([blade.standing_strain for blade in blades])
    limits = np.array([blade.config.patches.failure_strain for blade in blades])
    return replace(bank, steady=steady, standing=standing, failure_strain=limits)


def about_moving_equilibrium(bank: Bank, blade: Blade, spin_up: SpinUp) -> Bank:
    """The bank of a spin-up, with the steady state of the first speed and what the moving equilibrium strains the blade.

    That is the strain of each speed's steady state, and that of what the equilibrium of the modes departs from their static one.
    ``ValueError`` where one of these steady states alone is beyond the blade's strain limit.
    """
    first = steady_deformation(blade.beam, spin_up.course.first)
    limits = np.full(len(bank), blade.config.patches.failure_strain)
    bank = replace(bank, steady=np.tile(astuple(first), (len(bank), 1)), failure_strain=limits)
    if blade.config.strain_limit == "vibration":
        return bank
    times = np.linspace(0.0, spin_up.course.duration, len(bank), endpoint=False)
    patches = spin_up.patches(times)
    assert patches is not None  # in the thesis' model the limit is on vibration
    moving = np.einsum("tkr,tr->tk", patches[2], spin_up.departure(times))
    return replace(bank, standing=standing_strains(blade, spin_up.course.speed(times)) + moving)


def check_strain(strain: float, speed: float, limit: float) -> None:
    """``ValueError`` for a strain, of a steady state at a speed in rad/s, that fails a blade which bears so much."""
    if not abs(strain) <= limit:
        raise ValueError(
            f"blade.strain_limit is 'total', but the blade's steady state at {speed:.4g} rad/s alone strains it by "
            f"{100.0 * abs(strain):.2g} %, beyond the {100.0 * limit:.3g} % at which it fails."
        )


def standing_strains(blade: Blade, speeds: Array) -> Array:
    """(K, k): strains of a blade's steady states at speeds (K,), rad/s, where those of vibration are watched.

    They are smooth in the square of the speed, and interpolated in it. ``ValueError`` where one is beyond the limit.
    """
    low, high = float(speeds.min()) ** 2, float(speeds.max()) ** 2
    places = chebyshev.chebpts2(NODES)
    nodes = np.sqrt(0.5 * (low + high) + 0.5 * (high - low) * places)
    states = [steady_and_strain(blade.beam, float(speed)) for speed in nodes]
    for speed, (state, _) in zip(nodes, states, strict=True):
        check_strain(state.strain, speed, blade.config.patches.failure_strain)
    coefficients = chebyshev.chebfit(places, np.stack([strain for _, strain in states]), NODES - 1)
    reached = (2.0 * speeds**2 - low - high) / max(high - low, np.finfo(np.float64).tiny)
    return np.asarray(chebyshev.chebval(reached, coefficients).T)
