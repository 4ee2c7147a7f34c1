"""No control: what every other controller is measured against."""

from __future__ import annotations

import numpy as np

from baselines.design.instruments import checked_plant
from baselines.design.linear import LinearController, static_law
from beamenv.plant.plant import Plant


def no_control(plant: Plant) -> LinearController:
    """The controller that always gives zero volts, whatever the sensors show. There is no loop to verify."""
    return static_law(plant, "no control", np.zeros((checked_plant(plant).B.shape[1], len(plant.C))))
