"""A plant under further loads, which are neither drawn as load cases nor noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import sealed
from beamenv.plant.plant import Plant
from beamenv.plant.signals import Signal

Array = NDArray[np.float64]


def with_further_loads(plant: Plant, inputs: Array, signals: tuple[Signal, ...]) -> Plant:
    """The plant with l disturbances after its own, that enter by ``inputs`` (n, l)."""
    k, more = plant.disturbance_input.shape[1], len(signals)
    noise = np.zeros((k + more, k + more))
    noise[:k, :k] = plant.process_noise
    return replace(
        plant,
        disturbance_input=sealed(np.hstack([plant.disturbance_input, inputs])),
        process_noise=sealed(noise),
        reference_load=sealed(np.append(np.asarray(plant.reference_load), np.zeros(more))),
        disturbances=(*plant.disturbances, *signals),
    )
