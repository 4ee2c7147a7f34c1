"""How large rewards are in each scenario: returns of whole episodes without control and under LQG, on validation seeds.

``python -m train.tools.scenario_returns`` writes ``docs/returns.csv`` in about a minute.
"""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import beamenv
from baselines import evaluate, no_control, reference_lqg
from beamenv.configuration.writing import write_whole
from beamenv.scenarios.named import NAMES
from beamenv.simulation.reward import reward_scale
from train.shared.held_out import validation

FILE = Path("docs/returns.csv")
EPISODES = 32
COLUMNS = ("scenario", "scale", "idle", "idle_low", "idle_high", "lqg")
"""The scale s, J s; the mean return without control, its 5th and 95th percentile over episodes; the mean return under LQG."""


def returns(scenario: str) -> dict[str, Any]:
    """A row of the file. A return is −J/s; it is infinite where a blade fails."""
    envs: Any = gymnasium.make_vec(beamenv.ENV_ID, num_envs=EPISODES, scenario=scenario)
    inner = envs.unwrapped
    idle = evaluate(no_control(inner.design.plant), envs, validation(EPISODES))
    held = evaluate(reference_lqg(inner.design.full_plant), envs, validation(EPISODES), reference=idle.reference)
    scale = reward_scale(inner.plant)
    envs.close()
    without = -idle.metrics.cost / scale
    low, high = np.percentile(without, [5.0, 95.0])
    numbers = (scale, without.mean(), low, high, (-held.metrics.cost / scale).mean())
    return dict(zip(COLUMNS, (scenario, *(f"{number:.4g}" for number in numbers)), strict=True))


def write_returns(file: Path = FILE) -> None:
    """Write the file, whole or not at all."""
    text = io.StringIO()
    table = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    table.writeheader()
    table.writerows(returns(scenario) for scenario in NAMES)
    write_whole(file, text.getvalue().encode())


if __name__ == "__main__":
    write_returns()
