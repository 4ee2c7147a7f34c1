"""The blades of a setting, made once for all controllers that are measured on them one after another."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

import beamenv
from baselines import Episodes, roll_out
from baselines.evaluation.metrics import cost_without_control, settling_band
from beamenv.knowledge import on_validation_bank
from beamenv.scenarios.scenario import Scenario
from beamenv.task import Task
from train.controllers.named import named
from train.shared.held_out import held_out, validation

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Setting:
    """The episodes that every controller is put through."""

    name: str
    """Of the scenario."""
    scenario: Scenario
    seeds: int
    arguments: str = "{}"
    """Of the environment besides, as JSON."""
    validation: bool = False
    """Whether the seeds and the bank of plants are those that choose."""

    @property
    def episodes(self) -> range:
        """Their seeds."""
        return validation(self.seeds) if self.validation else held_out(self.seeds)

    @property
    def played(self) -> Scenario:
        """The scenario with its bank of plants."""
        return on_validation_bank(self.scenario) if self.validation else self.scenario


@dataclass(frozen=True, slots=True, eq=False)
class Blades:
    """The blades of a setting, and what they do without control."""

    envs: Any
    task: Task
    """What controllers are built for: they are told of the scenario alike, whichever of its banks moves."""
    reference: Episodes
    uncontrolled: Array
    """(N,), J s: J₀."""
    band: Array
    """(N,), m, within which a tip counts as settled."""


class Bench:
    """Has the blades of one setting at a time; whoever measures has a bench of its own, and closes it."""

    def __init__(self) -> None:
        self._setting: Setting | None = None
        self._blades: Blades | None = None
        self._envs: dict[int, Any] = {}

    def blades(self, setting: Setting) -> Blades:
        """Those of a setting, the last ones again where it is the same."""
        if self._blades is None or self._setting != setting:
            self.close()
            self._setting, self._blades = setting, _made(setting)
        return self._blades

    def envs(self, setting: Setting, times: int) -> Any:
        """A batch of so many blades for each seed of a setting."""
        self.blades(setting)
        if times not in self._envs:
            self._envs[times] = _envs(setting, times)
        return self._envs[times]

    def close(self) -> None:
        """Let go of the blades."""
        for each in (*self._envs.values(), *([] if self._blades is None else [self._blades.envs])):
            each.close()
        self._setting = self._blades = None
        self._envs = {}


def _envs(setting: Setting, times: int = 1) -> Any:
    arguments = {"dtype": "float64", **json.loads(setting.arguments)}
    return gym.make_vec(beamenv.ENV_ID, num_envs=times * setting.seeds, scenario=setting.played, **arguments)


def _made(setting: Setting) -> Blades:
    envs = _envs(setting)
    task = replace(envs.unwrapped.task, told_scenario=setting.scenario) if setting.validation else envs.unwrapped.task
    reference = roll_out(named("none").build_for(task), envs, setting.episodes)
    return Blades(envs, task, reference, cost_without_control(reference), settling_band(reference))
