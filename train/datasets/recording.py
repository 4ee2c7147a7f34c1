"""Record a controller: episodes on seeds and plants of their own, as a data set of Minari's that loads again."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import gymnasium as gym
from minari import MinariDataset

import beamenv
from baselines import Controller
from baselines.design.controller import ControllerArgument, as_controller, name_of
from baselines.evaluation.episodes import MOST_SEEDS, Progress, checked_progress
from baselines.evaluation.fit import check_fit
from beamenv.configuration import Count, Flag, Refused, checked, checked_table
from beamenv.knowledge import on_recording_bank
from beamenv.scenarios.named import UNSEEN
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.scenarios.scenario import scenario as as_scenario
from beamenv.task import Task, checked_dtype, resolve_task
from train.controllers.choice import chosen
from train.controllers.ids import found
from train.datasets.about import metadata, tier_of
from train.datasets.storage import DATA, add, begun, checked_place, put_in_place, root_of
from train.datasets.taped import Episode, episodes_of
from train.shared.files import as_path
from train.shared.held_models import held_models
from train.shared.held_out import RECORDED, recorded
from train.shared.interruption import Deferred, Interrupted

WIDTH = 64
"""Blades side by side, however many episodes there are: sums over more or fewer blades differ in their last bits."""

EPISODES = Count(1, MOST_SEEDS)

ARGUMENTS = ("preset", "speed", "blade", "design", "duration", "physical_units", "dtype", "plant", "spread")
"""Of the environment, besides the scenario."""


def record(
    controller: str | ControllerArgument,
    scenario: Any = "nominal",
    episodes: int = 100,
    seed: int = RECORDED,
    *,
    name: str | None = None,
    folder: str | Path | None = None,
    environment: Mapping[str, Any] | None = None,
    trained_seed: int | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> MinariDataset:
    """Record a controller's episodes as a data set of Minari, and return it as Minari loads it.

    - ``controller``: id of a controller, such as "lqg", or of a shipped agent, the folder of a trained agent, an object with
      Stable-Baselines3's ``predict``, or a function of the readings (N, p).
    - ``scenario``: a name, a file, a table or a ``Scenario``. Its plants are those of ``on_recording_bank``.
    - ``episodes``: their number. ``seed``: random seed of the first; each further episode has one more. On the same machine, the
      first episodes of a longer data set are those of a shorter one, bit for bit.
    - ``name``: name of the data set, by default "beamenv/CONTROLLER-SCENARIO-v0". ``folder``: folder of all data sets, by default
      Minari's own.
    - ``environment``: keyword arguments of the environment, ``preset``, ``plant``, ``duration`` and so on.
    - ``trained_seed``: training seed that selects a run of a shipped agent.
    - ``overwrite``: whether to replace a data set of this name.
    - ``progress``: called with the number of episodes done and their total.

    A data set of a scenario that is kept for judging says so. An interrupted recording leaves no data set behind, and leaves one
    that it would have replaced unchanged. Raises ``ValueError`` for a wrong argument, for seeds on which controllers are compared,
    tuned or chosen, and for a controller that does not fit the environment.
    """
    count, overwrite = checked("episodes", episodes, EPISODES), checked("overwrite", overwrite, Flag())
    seeds, progress = recorded(seed, count), checked_progress(progress)
    root = root_of(None if folder is None else as_path("folder", folder))
    called = (
        found(controller, _word(scenario), trained_seed).id if isinstance(controller, str) else name_of(as_controller(controller))
    )
    place = checked_place(root, _default_name(called, scenario) if name is None else name, overwrite)
    stage = Stage.of(controller, scenario, {} if environment is None else environment, trained_seed)
    with put_in_place(place) as hidden:
        storage, costs = begun(hidden, stage.env), []
        for first in range(0, count, WIDTH):
            each = stage.episodes(seeds[first : first + WIDTH])
            with Deferred() as interruption:  # in the midst of writing HDF5 may lose one
                add(storage, each)
            if interruption.asked:
                raise Interrupted(interruption.asked)
            costs += [math.nan if one.failed else one.cost for one in each]
            if progress is not None:
                progress(len(costs), count)
        storage.update_metadata(stage.metadata(place.relative_to(root).as_posix(), called, seeds, costs))
    return MinariDataset(place / DATA)


def _default_name(controller: str, scenario: Any) -> str:
    """Of a data set, with - for whatever Minari does not take."""
    where = Path(scenario).stem if isinstance(scenario, (str, Path)) else "own"
    return f"beamenv/{'-'.join(re.sub(r'[^-a-zA-Z0-9_]+', '-', each) for each in (controller, where))}-v0"


def _word(scenario: Any) -> str:
    return str(scenario) if isinstance(scenario, (str, Path)) else "one of the caller's own"


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """The controller and the blades it acts on."""

    law: Controller
    tier: int
    task: Task
    """What it was built for."""
    env: Any
    """One blade, as the data set recovers it."""
    envs: Any
    """``WIDTH`` of them."""
    scenario: str
    trained_seed: int | None
    eval_spec: str
    """Of the environment that controllers are compared in."""

    @classmethod
    def of(
        cls, controller: str | ControllerArgument, scenario: Any, environment: Mapping[str, Any], trained_seed: int | None
    ) -> Stage:
        """The environment of the arguments on plants of its own, and the controller as it is told of them."""
        given = checked_table("environment", environment, ARGUMENTS)
        checked_dtype(given.get("dtype", "float32"))
        known, arguments = as_scenario(scenario), held_models(given)
        blades = {name: value for name, value in arguments.items() if name != "dtype"}
        resolve_task(**blades, scenario=known)  # which says what is wrong in the arguments' own words
        played = {**arguments, "scenario": on_recording_bank(known)}
        envs: Any = gym.make_vec(beamenv.ENV_ID, num_envs=WIDTH, **played)
        task = replace(envs.unwrapped.task, told_scenario=known)
        word = _word(scenario)
        if isinstance(controller, str):
            law = chosen(controller, task, word, trained_seed)
        elif trained_seed is not None:
            raise Refused("trained_seed", trained_seed, "left out with an object")
        else:
            law = as_controller(controller)
        check_fit(law, envs)
        judged = gym.make(beamenv.ENV_ID, **arguments, scenario=known).spec
        assert judged is not None
        env = gym.make(beamenv.ENV_ID, **played)
        return cls(law, tier_of(controller, law), task, env, envs, word, trained_seed, judged.to_json())

    def episodes(self, seeds: range) -> list[Episode]:
        """One of each seed, ``WIDTH`` at most."""
        padded = [*seeds, *[seeds[-1]] * (WIDTH - len(seeds))]
        return episodes_of(self.law, self.envs, padded)[: len(seeds)]

    def metadata(self, name: str, controller: str, seeds: range, costs: list[float]) -> dict[str, Any]:
        """What the data set tells of itself."""
        judges = (self.task.told_scenario or self.task.scenario) in [SCENARIOS[each] for each in UNSEEN]
        return metadata(
            name, controller, self.law, self.tier, self.trained_seed, self.scenario, judges, self.eval_spec, seeds, costs
        )
