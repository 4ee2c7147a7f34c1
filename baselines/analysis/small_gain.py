"""Whether a law holds other plants than its own by what is known of their differences alone: the small-gain theorem."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from baselines.analysis.frequency_response import Complex, frequency_response, resonant_angles
from baselines.design.controller import Array
from baselines.design.instruments import checked_plant
from baselines.design.linear import LinearController, linear
from baselines.design.loop import closed_loop, sampled, spectral_radius
from beamenv.configuration import Refused
from beamenv.plant.plant import Plant, SampledPlant


def small_gain(plant: Plant, controller: LinearController, others: Sequence[Plant]) -> float:
    """The small-gain test: if the result is below 1, the loop is stable on each of the ``others``.

    The result is the largest σ̄(K S) ℓ over all frequencies, with ℓ = max σ̄(G_i − G) over the ``others``, all sampled. Below 1
    the loop is stable on every stable plant that differs from ``plant`` by no more than ℓ. K S leads from a disturbance of the
    readings to the voltages, in the closed loop with ``plant``; voltages are in units of the drive limits, readings in units of
    full scale. The test is sufficient; it is necessary if nothing but ℓ is known of the differences (Doyle and Stein, IEEE Trans.
    Automatic Control 26, 1981). The result is infinite if the loop on ``plant`` is unstable, or one of the ``others`` by itself.
    Raises ValueError for a controller that is not linear, and for ``others`` that are not plants with as many voltages and
    sensors as ``plant``.
    """
    checked_plant(plant)
    law = linear(controller)
    held, those = sampled(plant, law), [sampled(each, law) for each in _checked(others, plant)]
    loop = closed_loop(held, law)[0]
    if max(spectral_radius(each) for each in (loop, held.A, *(other.A for other in those))) >= 1.0:
        return float("inf")
    angles = resonant_angles(loop, held.A, *(each.A for each in those))
    own = _answers(held, plant, angles)
    size = np.max([_norm(_answers(each, plant, angles) - own) for each in those], axis=0)
    return float((_norm(_disturbed(held, law, plant, loop, angles)) * size).max())


def _answers(held: SampledPlant, plant: Plant, angles: Array) -> Complex:
    """G (k, p, m) from voltages to readings."""
    drive, full_scale = np.abs(plant.voltage_limits).max(axis=0), plant.sensor_full_scale[:, None]
    return frequency_response(held.A, held.B * drive, held.C / full_scale, held.D * drive / full_scale, angles)


def _disturbed(held: SampledPlant, law: LinearController, plant: Plant, loop: Array, angles: Array) -> Complex:
    """K S (k, m, p) from what is added to readings to voltages."""
    drive, full_scale = np.abs(plant.voltage_limits).max(axis=0)[:, None], plant.sensor_full_scale
    added = np.vstack([held.B @ law.measurement_gain, law.measurement_input + law.voltage_input @ law.measurement_gain])
    voltage = np.hstack([law.measurement_gain @ held.C, law.state_gain])
    return frequency_response(loop, added * full_scale, voltage / drive, law.measurement_gain * full_scale / drive, angles)


def _norm(response: Complex) -> Array:
    return np.asarray(np.linalg.norm(response, ord=2, axis=(1, 2)))


def _checked(others: Any, plant: Plant) -> Sequence[Plant]:
    those = others if isinstance(others, (list, tuple)) else ()
    if not those or not all(isinstance(each, Plant) for each in those):
        raise Refused("others", others, "a list of one or more beamenv.Plant")
    for each in those:
        if each.B.shape[1] != plant.B.shape[1] or len(each.C) != len(plant.C) or each.control_interval != plant.control_interval:
            raise ValueError("others have other voltages, sensors or another clock than plant, but must have as many and the same.")
    return those
