"""What a recurrent agent remembers along episodes, what it was shown last, and what was the case in them."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

import beamenv
from baselines.evaluation.loop import attribute, instants
from beamenv.configuration import Refused
from beamenv.knowledge import on_validation_bank
from beamenv.scenarios.scenario import SCENARIOS
from train.controllers.policies import Policy, RecurrentPolicy

Array = NDArray[np.float64]

EVERY = 4
"""Instants from one that is kept to the next."""


@dataclass(frozen=True, slots=True, eq=False)
class Recorded:
    """Of E episodes at T instants."""

    time: Array
    """(T,), s."""
    hidden: Array
    """(E, T, k): hidden units."""
    window: Array
    """(E, T, k): the latest readings and voltages, as many numbers as hidden units."""
    truth: Array
    """(E,): what was the case."""


@dataclass(frozen=True, slots=True)
class Question:
    """Something that is drawn for each episode of a scenario and that no sensor shows."""

    name: str
    scenario: str
    classes: bool
    """Whether it is one of several kinds, and not a number."""

    def answer(self, env: Any) -> Array:
        """(E,) what is the case: the rotor's speed, rad/s; the delay, intervals; which actuator is dead."""
        inner, m = env.unwrapped, env.unwrapped.plant.B.shape[1]
        if self.name == "speed":
            return np.ravel(inner.rotor_speed).astype(np.float64)
        told = np.asarray(inner.episode_truth, dtype=np.float64)
        return told[:, 1] if self.name == "delay" else told[:, 2 : 2 + m].argmin(axis=1).astype(np.float64)


QUESTIONS = (
    Question("speed", "off-speed", classes=False),
    Question("delay", "delay", classes=True),
    Question("dead actuator", "failure", classes=True),
)


class _Watched:
    """A policy that keeps what it remembers and what it was shown last."""

    def __init__(self, policy: Policy, units: int) -> None:
        self._policy, self._units, self._instant = policy, units, 0
        self.observes = "observation"
        self.hidden: list[Array] = []
        self.window: list[Array] = []
        self._last: list[Array] = []

    def predict(
        self, observation: Any, state: Any = None, episode_start: Any = None, deterministic: bool = True
    ) -> tuple[Any, Any]:
        """The policy's own."""
        action, memory = self._policy.predict(observation, state, episode_start, deterministic)
        self._last = [np.hstack([observation, action]), *self._last][: -(-self._units // (observation.shape[1] + action.shape[1]))]
        self._instant += 1
        if self._instant % EVERY == 0:
            self.hidden.append(memory[:, : self._units].astype(np.float64))
            window = np.hstack(self._last)[:, : self._units]
            self.window.append(np.pad(window, ((0, 0), (0, self._units - window.shape[1]))))
        return action, memory


def recorded(policy: Policy, question: Question, seeds: Sequence[int]) -> Recorded:
    """One episode for each seed, on the validation bank; ``ValueError`` for a policy without a recurrent unit."""
    if "weight_hh" not in policy.weights:
        raise Refused("policy", policy.name, f"one with a recurrent unit, such as {RecurrentPolicy.kind!r}")
    units = int(policy.weights["weight_hh"].shape[1])
    scenario = on_validation_bank(SCENARIOS[question.scenario])
    with closing(gym.make_vec(beamenv.ENV_ID, num_envs=len(seeds), scenario=scenario, dtype="float64")) as env:
        watched, truth = _Watched(policy, units), None
        for _ in instants(watched, env, seeds):
            truth = question.answer(env) if truth is None else truth
        interval = attribute(env, "plant")[0].control_interval
    time = interval * EVERY * np.arange(1, len(watched.hidden) + 1)
    return Recorded(time, np.stack(watched.hidden, axis=1), np.stack(watched.window, axis=1), np.asarray(truth))
