"""Where a controller comes from: a file of `named`, the folder of a trained agent, a model file, or an object the caller gives."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Protocol

from baselines import Controller
from beamenv.plant.fingerprint import fingerprint
from beamenv.task import Task
from train.controllers.general_bank import general_law
from train.controllers.models import fitted, load_model
from train.controllers.models_policy import ModelsPolicy
from train.controllers.named import NamedController
from train.controllers.policies import Policy
from train.controllers.policy_files import load_policy
from train.shared.digests import digest


class Source(Protocol):
    """What a controller is made from, in whichever process."""

    def build(self, task: Task) -> Controller:
        """The controller for a task; ``ValueError`` says why there is none."""
        ...

    def fingerprint(self) -> str:
        """Changes with what the controller is made from; empty if that cannot be known."""
        ...

    def files(self) -> Sequence[Path]:
        """What a machine must be sent on which it is to be made."""
        ...


@dataclass(frozen=True, slots=True)
class Classical:
    """A controller with a name, designed afresh."""

    controller: NamedController

    def build(self, task: Task) -> Controller:
        """From what its tier is told of the task; a fixed controller of the nominal plant alone once for all tasks of that
        design.
        """
        if (self.controller.tier, self.controller.kind) != (0, "fixed"):
            return self.controller.build_for(task)
        return _designed(self.controller, _Designed(task))

    def fingerprint(self) -> str:
        """Of its file."""
        return digest(inspect.getsource(inspect.getmodule(self.controller.build) or self.controller.build).encode())

    def files(self) -> Sequence[Path]:
        """None: what has a name is installed."""
        return ()


class _Designed:
    """A task as the designer of a fixed law sees it: equal to others of the same design and units."""

    def __init__(self, task: Task) -> None:
        self.task, self._seen = task, (task.design_config, fingerprint(task.design_plant), task.physical_units)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Designed) and self._seen == other._seen

    def __hash__(self) -> int:
        return hash(self._seen[1:])


@lru_cache(maxsize=64)
def _designed(controller: NamedController, design: _Designed) -> Controller:
    return controller.build_for(design.task)


@dataclass(frozen=True, slots=True)
class Trained:
    """The folder of a trained agent."""

    folder: Path

    def build(self, task: Task) -> Policy:
        """The agent, within this design's drive limits and beside the controller it adds to; refused if trained on other plants."""
        policy = load_policy(self.folder, task.design_plant)
        return policy.beside(general_law(task.prior.blade)) if isinstance(policy, ModelsPolicy) else policy

    def fingerprint(self) -> str:
        """Of its weights and what is said of them."""
        return digest(*(path.read_bytes() for path in self.files()))

    def files(self) -> Sequence[Path]:
        """Both."""
        return tuple(self.folder / name for name in ("agent.json", "weights.npz"))


@dataclass(frozen=True, slots=True)
class ModelFile:
    """A model of Stable-Baselines3 in a file that the caller trusts: loading it may run code."""

    path: Path

    def build(self, task: Task) -> Controller:
        """The model, shown what it was trained to see."""
        return fitted(load_model(self.path), task.design_plant)

    def fingerprint(self) -> str:
        """Of the file."""
        return digest(self.path.read_bytes()) if self.path.is_file() else ""

    def files(self) -> Sequence[Path]:
        """The file, if it is there."""
        return (self.path,) if self.path.is_file() else ()


@dataclass(frozen=True, slots=True)
class Given:
    """An object with ``predict``."""

    controller: Any

    def build(self, task: Task) -> Controller:
        """The object itself, or a model of Stable-Baselines3 shown what it was trained to see."""
        return fitted(self.controller, task.design_plant)

    def fingerprint(self) -> str:
        """Empty: what an object will do nobody knows beforehand, so its cells are measured anew."""
        return ""

    def files(self) -> Sequence[Path]:
        """None that anybody knows of."""
        return ()
