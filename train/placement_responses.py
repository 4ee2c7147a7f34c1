"""Figures 6.5 and 6.6: a blade struck by a pulse, its patches equally spaced and where they belong; and what that buys in J."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import gymnasium
import numpy as np
from numpy.typing import NDArray

import beamenv
from baselines import Controller, Evaluation, evaluate, lqg
from beamenv.configuration import BladeConfig, build_plant
from beamenv.plant import Plant

Array = NDArray[np.float64]

PULSE = {"case": "pulse", "magnitude": 30.0, "direction_deg": 90.0, "onset": 0.0, "duration": 0.02}
"""The thesis gives neither length nor height of its rectangular pulse in flap; 30 N/m is what ±1500 V can answer."""


@dataclass(frozen=True, slots=True, eq=False)
class Response:
    """One blade after the pulse, under its own LQG controller, without noise."""

    time: Array
    """(K,), s."""
    tip: Array
    """(K,), m, flap."""
    volts: Array
    """(K, m), V."""
    cost: float
    """J, J s."""
    effort: float
    """The actuators' share of it, J s."""

    @property
    def peak_volts(self) -> Array:
        """(m,), V: what each actuator needs at most."""
        return np.asarray(np.abs(self.volts).max(axis=0))

    def settling_time(self, band: float) -> float:
        """Time (s) after which the tip stays within ``band`` (m)."""
        outside = np.flatnonzero(np.abs(self.tip) > band)
        return float(self.time[outside[-1]]) if len(outside) else 0.0


def pulse_response(config: BladeConfig, design: str = "continuous", duration: float = 0.5) -> Response:
    """The response of a blade under LQG: "continuous" is the thesis' design, "sampled" the optimum."""
    env = gymnasium.make(beamenv.ENV_ID, blade=config, scenario="quiet", duration=duration)
    controller = lqg(build_plant(config), design)  # type: ignore[arg-type]
    observation, _ = env.reset(seed=0, options={"load": PULSE})
    memory, infos, over = None, [], False
    while not over:
        action, memory = controller.predict(observation, memory)
        observation, _, terminated, truncated, info = env.step(action)
        infos.append(info)
        over = terminated or truncated
    return Response(
        time=config.control_interval * np.arange(1, len(infos) + 1),
        tip=np.array([info["tip_displacement"][1] for info in infos]),
        volts=np.array([info["volts"] for info in infos]),
        cost=float(sum(info["cost_increment"] for info in infos)),
        effort=float(sum(info["effort"] for info in infos)),
    )


def compared(
    configs: Sequence[BladeConfig],
    seeds: Sequence[int],
    scenario: str = "default",
    controller: Callable[[Plant], Controller] = lqg,
) -> list[Evaluation]:
    """Each blade under a controller made from its own plant (LQG's sampled optimum), on the same load cases and noise for all."""
    evaluations = []
    for config in configs:
        envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=len(seeds), blade=config, scenario=scenario)
        evaluations.append(evaluate(controller(build_plant(config)), envs, seeds))
    return evaluations
