"""The documentation's pictures of an identification: 40 s of ``sound-blade`` under random voltages.

``python -m train.identification.pictures`` writes ``identification-stabilisation.png`` and ``identification-fit.png`` into
``docs/images``, or the folder that is its argument, each with another beside it for dark pages; in about a minute.
"""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

import beamenv
from baselines.identification.identified import Identified
from baselines.identification.identify import identify
from baselines.identification.measurement import Measurement
from train.figures.paper import save_themes
from train.identification.figures import fit_figure, stabilisation_figure

FOLDER = Path("docs/images")
SECONDS, DEVIATION, LIMIT = 40.0, 450.0, 1500.0
"""s of the record; V of the voltages, one standard deviation and at most."""
COLLOCATED = 5.0 / 3.0
"""A sensor's charge is collected over 0.3 mm where the actuator's field spans 0.5 mm."""


def measured(seconds: float = SECONDS, seed: int = 0) -> Measurement:
    """Voltages and currents of the blade in white loads."""
    env = gym.make(beamenv.ENV_ID, preset="sound-blade", scenario="white", duration=seconds, physical_units=True, dtype="float64")
    blade: Any = env.unwrapped
    interval, actuators = blade.design.config.control_interval, blade.plant.B.shape[1]
    volts = np.clip(np.random.default_rng(seed).normal(0.0, DEVIATION, (round(seconds / interval), actuators)), -LIMIT, LIMIT)
    reading, _ = env.reset(seed=seed)
    readings = []
    for row in volts:
        readings.append(reading)
        reading, *_ = env.step(row)
    return Measurement(volts, np.array(readings), interval=interval, reading_units=("A",) * len(readings[0]))


def write_pictures(found: Identified, folder: Path) -> None:
    """Both, each whole or not at all."""
    for name, figure in (("stabilisation", stabilisation_figure), ("fit", fit_figure)):
        save_themes(partial(figure, found), folder / f"identification-{name}.png")


if __name__ == "__main__":
    write_pictures(identify(measured(), collocated=COLLOCATED), Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
