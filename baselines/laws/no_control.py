"""No control: what every other controller is measured against."""

from __future__ import annotations

import numpy as np

from baselines.design.instruments import checked_plant
from baselines.design.linear import LinearController, static_law
from beamenv.plant.plant import Plant


def no_control(plant: Plant) -> LinearController:
    """Zero volts always, whatever the sensors say. There is no loop to be verified: the blade stays as it is."""
    return static_law(plant, "no control", np.zeros((checked_plant(plant).B.shape[1], len(plant.C))))
