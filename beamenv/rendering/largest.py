"""How far a scenario moves a blade: what pictures of it are scaled to."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.plant.plant import Plant
from beamenv.scenarios.load_cases import static_deflection
from beamenv.simulation.blades import Blades
from beamenv.task import Task

Array = NDArray[np.float64]

EPISODES, STEPS = 32, 2000
"""What is looked at: some hundredths of a second of computing."""
OVERSHOOT = 2.0
"""Of a step of the load, without damping, over the deflection that it leaves."""


class Largest(NamedTuple):
    """What a blade that is left alone comes to in a scenario, at most."""

    deflection: float
    """m, of the tip."""
    load: float
    """N/m, of the line load."""


def largest_of(task: Task) -> Largest:
    """In ``EPISODES`` episodes without control, the same whenever they are asked for.

    Where nothing moves the blade, or its end cannot be told: that of a step of the reference load.
    """
    blades, count = Blades(task.bank, task.scenario, EPISODES), EPISODES
    generators = [np.random.default_rng(seed) for seed in range(count)]
    motion, idle = blades.begin(generators), np.zeros((count, task.plant.B.shape[1]))
    deflection, load = _finite(motion.tip_displacement), _finite(blades.coming_loads)
    for _ in range(min(task.steps, STEPS)):
        motion = blades.step(idle, generators)
        deflection, load = max(deflection, _finite(motion.tip_displacement)), max(load, _finite(blades.coming_loads))
    usual = usual_of(task.plant)
    return Largest(deflection or usual.deflection, load or usual.load)


def usual_of(plant: Plant) -> Largest:
    """A step of the reference load in lag or in flap, whichever moves the tip more."""
    return Largest(OVERSHOOT * reference_deflection(plant), float(np.asarray(plant.reference_load).max()) or 1.0)


def reference_deflection(plant: Plant) -> float:
    """Static tip deflection, m, under the reference load in lag or in flap, whichever is larger."""
    tip = plant.tip_displacement @ static_deflection(plant, np.diag(np.asarray(plant.reference_load))).T
    return float(np.linalg.norm(tip, axis=0).max())


def _finite(vectors: Array) -> float:
    """The longest of the vectors (N, k) that are finite; 0 of none."""
    sizes = np.linalg.norm(vectors, axis=-1)
    return float(sizes[np.isfinite(sizes)].max(initial=0.0))
