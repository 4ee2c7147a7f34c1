"""Stable-Baselines3 driven update by update: what its agents have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import torch
from stable_baselines3.common.callbacks import BaseCallback
from torch import nn

from beamenv.blade.design import Design
from beamenv.configuration import Refused
from beamenv.plant.plant import normalised
from beamenv.task import Task
from train.controllers.belief_policy import BeliefPolicy
from train.controllers.policies import HistoryPolicy, Policy
from train.learning.sb3.belief import Belief, design_belief, oscillator_bank
from train.learning.sb3.fitted import two_sided_bank
from train.learning.sb3.side_by_side import SideBySide
from train.learning.sb3.vec_env import TrainingVecEnv
from train.learning.training import on_training_bank, uncontrolled_cost
from train.learning.validation import Validation

Envs = TrainingVecEnv | SideBySide

REFIT = 5
"""Updates between two fits of an estimate."""


def seen_by(settings: Any, design: Design) -> Belief | None:
    """What the settings of a trainer show, None for a history."""
    if settings.sees == "belief":
        return design_belief(design, settings.modes)
    if settings.sees == "estimate":
        return two_sided_bank(design.plant, settings.modes)
    return oscillator_bank(design.plant) if settings.sees == "oscillators" else None


def training_envs(tasks: Sequence[Task], settings: Any, seed: int, **seen: Any) -> Envs:
    """The batch that an agent trains on, its plants from the training bank; with several tasks the blades are divided among them.

    What it is shown is said by the ``settings`` of its trainer, and ``seen``: keyword arguments of ``TrainingVecEnv``.
    """
    blades = settings.blades
    seen |= {name: getattr(settings, name) for name in ("history", "energy_horizon", "discount", "held", "approach")}
    seen["belief"] = seen_by(settings, tasks[0].design)
    if settings.sees == "estimate":
        if len(tasks) > 1:
            raise Refused("settings.sees", settings.sees, "another where several scenarios are trained on")
        seen["fitted"] = settings.modes
    if blades < len(tasks):
        raise ValueError(f"blades = {blades} must be at least one for each of the {len(tasks)} scenarios.")
    if settings.held > min(task.steps for task in tasks):
        raise Refused("settings.held", settings.held, f"at most the {min(task.steps for task in tasks)} intervals of an episode")
    batches = []
    for index, task in enumerate(map(on_training_bank, tasks)):
        count = blades // len(tasks) + (index < blades % len(tasks))
        reference = uncontrolled_cost(task)
        batches.append(TrainingVecEnv(count, task, seed + index, reference=reference, shows_state=True, **seen))
    return batches[0] if len(batches) == 1 else SideBySide(batches)


class Meter(BaseCallback):
    """The running cost relative to no control."""

    def __init__(self, envs: Envs) -> None:
        super().__init__()
        self._envs, self._sum, self._count = envs, 0.0, 0

    def _on_step(self) -> bool:
        self._sum += self._envs.relative_cost
        self._count += 1
        return True

    def read(self) -> float:
        """The mean since it was last read."""
        mean = self._sum / max(self._count, 1)
        self._sum, self._count = 0.0, 0
        return mean


class SB3Training:
    """A training (``train.learning.training.Training``) of one of SB3's models.

    Its state holds networks, optimisers, generators, the episodes under way and what is remembered of others: by updates it
    resumes bit for bit.
    """

    def __init__(self, model: Any, envs: Envs, tasks: Sequence[Task], settings: Any, seed: int) -> None:
        self.model, self.envs, self.settings = model, envs, settings
        self.steps = self.updates = 0
        self.cost = float("nan")
        self.losses: dict[str, float] = {}
        """What SB3 logged in the last update, by its names."""
        self._seed, self._task = seed, tasks[0]
        self._meter, self._validation = Meter(envs), Validation(tasks)
        self.validated = float("nan")
        self._best: tuple[float, Policy] | None = None
        _, self._callback = model._setup_learn(2**62, [self._meter, *self._callbacks()])

    def update(self, remaining: float) -> None:
        """Gather experience and learn from it, at the share ``remaining`` of the learning rate."""
        before, self.validated = self.model.num_timesteps, float("nan")
        self.model._current_progress_remaining = remaining
        self._free(self.updates >= self.settings.critic_first)
        self._gather_and_learn()
        if self.settings.sees == "estimate" and (self.updates + 1) % REFIT == 0:
            assert isinstance(self.envs, TrainingVecEnv)
            self.envs.refit()
        self.losses = {name: float(value) for name, value in self.model.logger.name_to_value.items()}
        self.model.logger.name_to_value.clear()
        self.updates += 1
        self.steps += (self.model.num_timesteps - before) * self.envs.held
        latest = min(self._meter.read(), 100.0)
        weight = max(self.settings.smoothing, 1.0 / self.updates)
        self.cost = latest if np.isnan(self.cost) else self.cost + weight * (latest - self.cost)
        if self.settings.validation and self.updates % self.settings.validation == 0:
            self._validate()

    def _validate(self) -> None:
        """Look at the policy without exploration, and keep it if it is the best so far."""
        policy = self.policy()
        self.validated = self._validation.cost(policy)
        if self._best is None or self.validated < self._best[0]:
            self._best = self.validated, policy

    def _callbacks(self) -> list[BaseCallback]:
        """Of the algorithm, beside the meter."""
        return []

    def _free(self, free: bool) -> None:
        """Whether the actor is trained."""
        for parameter in self._held_back():
            parameter.requires_grad_(free)

    def _gather_and_learn(self) -> None:
        raise NotImplementedError

    def _held_back(self) -> list[nn.Parameter]:
        """Of the actor: what is not trained in the first ``critic_first`` updates."""
        raise NotImplementedError

    def _optimisers(self) -> dict[str, torch.optim.Optimizer]:
        raise NotImplementedError

    def _loose(self) -> dict[str, torch.Tensor]:
        """Tensors that are trained but belong to no module."""
        return {}

    def policy(self) -> Policy:
        """The actor as arrays."""
        raise NotImplementedError

    def _as_policy(self, name: str, weights: dict[str, np.ndarray[Any, Any]], settings: dict[str, Any]) -> Policy:
        """Layers on a history or on a belief, as the settings have it."""
        lowest, highest = normalised(self._task.design_plant).voltage_limits.astype(np.float32)
        belief = None if isinstance(self.envs, SideBySide) else self.envs.belief
        belief = seen_by(self.settings, self._task.design) if belief is None else belief
        if belief is None:
            return HistoryPolicy(name, weights, settings, lowest, highest)
        return BeliefPolicy(name, {**belief._asdict(), **weights}, settings, lowest, highest)

    def policies(self) -> list[Policy]:
        """``policy`` alone, or the best that validation has seen."""
        return [self.policy() if self._best is None else self._best[1]]

    def close(self) -> None:
        """Close the batch."""
        self.envs.close()

    def state_dict(self) -> dict[str, Any]:
        """Networks, optimisers, generators, counters, the episodes under way, and a ``memory`` of experience if there is one."""
        kind, keys, position, has_gauss, cached = np.random.get_state(legacy=True)  # noqa: NPY002 - SB3's own generator
        return {
            "policy": self.model.policy.state_dict(),
            "optimisers": {name: each.state_dict() for name, each in self._optimisers().items()},
            "loose": {name: each.detach().clone() for name, each in self._loose().items()},
            "torch": torch.get_rng_state(),
            "numpy": [str(kind), torch.as_tensor(np.asarray(keys, np.int64)), int(position), int(has_gauss), float(cached)],
            "counters": {"steps": self.steps, "updates": self.updates, "cost": self.cost, "timesteps": self.model.num_timesteps},
            "best": None if self._best is None else {"cost": self._best[0], "weights": dict(self._best[1].weights)},
            "episodes": self.envs.state_dict(),
            "shown": {"observations": self.model._last_obs.copy(), "starts": self.model._last_episode_starts.copy()},
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Resume from the ``state_dict`` of an equally made training, with its arrays or as a checkpoint has them."""
        self.model.policy.load_state_dict(state["policy"])
        for name, each in self._optimisers().items():
            each.load_state_dict(state["optimisers"][name])
        for name, tensor in self._loose().items():
            tensor.data.copy_(state["loose"][name])
        counters = state["counters"]
        self.steps, self.updates, self.cost = counters["steps"], counters["updates"], counters["cost"]
        self.model.num_timesteps = counters["timesteps"]
        best = state["best"]
        weights = {} if best is None else {name: np.asarray(weight) for name, weight in best["weights"].items()}
        self._best = None if best is None else (best["cost"], replace(self.policy(), weights=weights))
        self.envs.load_state_dict(state["episodes"])
        self.model._last_obs = np.asarray(state["shown"]["observations"]).copy()
        self.model._last_episode_starts = np.asarray(state["shown"]["starts"]).copy()
        torch.set_rng_state(state["torch"])
        kind, keys, position, has_gauss, cached = state["numpy"]
        np.random.set_state((kind, np.asarray(keys).astype(np.uint32), position, has_gauss, cached))  # noqa: NPY002


def layers_as_arrays(layers: Sequence[nn.Linear]) -> dict[str, np.ndarray[Any, Any]]:
    """Weights and biases as ``train.controllers.policies.HistoryPolicy`` names them."""
    arrays = {}
    for index, layer in enumerate(layers):
        arrays[f"weight{index}"] = layer.weight.detach().numpy().copy()
        arrays[f"bias{index}"] = layer.bias.detach().numpy().copy()
    return arrays


def linear_layers(network: nn.Module) -> list[nn.Linear]:
    """Its linear layers, in order."""
    return [layer for layer in network.modules() if isinstance(layer, nn.Linear)]
