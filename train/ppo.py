"""Proximal policy optimisation (Schulman et al. 2017) by Stable-Baselines3 on hundreds of blades at once."""

from __future__ import annotations

import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

from beamenv.plant import Plant, normalised
from train.asymmetric import AsymmetricPolicy
from train.policies import HistoryPolicy
from train.training import Progress, Report, uncontrolled_cost
from train.vec_env import BladeVecEnv


@dataclass(frozen=True, slots=True)
class PPOSettings:
    """One experiment."""

    blades: int = 1024
    """Environments stepped together."""
    history: int = 12
    """Instants the agent sees, 6 ms."""
    held: int = 4
    """Control intervals for which an action is held, 2 ms: exploration that lasts tells more of the slow modes than white noise
    does, against the white load."""
    rollout: int = 16
    """Actions of every blade between updates."""
    batch: int = 8192
    """Samples in a gradient step."""
    epochs: int = 4
    """Passes over a rollout."""
    learning_rate: float = 1e-3
    """Adam's, falling linearly to zero over the budget."""
    discount: float = 0.95
    """γ: 20 actions, 40 ms."""
    trace: float = 0.8
    """λ of the advantage estimate."""
    energy_horizon: float = 0.03
    """s: potential of a joule, see ``train.vec_env``."""
    exploration: float = -1.4
    """Logarithm of the standard deviation of the actions, constant."""
    units: int = 64
    """Of each of two tanh layers, actor and critic alike."""
    clip: float = 0.2
    """Of the probability ratio."""
    gradient_norm: float = 1e3
    """Gradients are clipped to it: hardly ever."""
    input_gain: float = 1.0
    """Readings are a few per cent of full scale most of the time."""


def train_ppo(
    environment: Mapping[str, Any], budget: float, seed: int, report: Report, settings: PPOSettings | None = None
) -> HistoryPolicy:
    """Train for ``budget`` s on batches made with ``environment``, keyword arguments of the environment; Ctrl-C ends it early."""
    settings = settings or PPOSettings()
    envs = BladeVecEnv(
        settings.blades,
        environment,
        seed,
        history=settings.history,
        energy_horizon=settings.energy_horizon,
        discount=settings.discount,
        held=settings.held,
        shows_state=True,
    )
    try:
        model = TimedPPO(
            AsymmetricPolicy,
            envs,
            n_steps=settings.rollout,
            batch_size=settings.batch,
            n_epochs=settings.epochs,
            learning_rate=lambda remaining: settings.learning_rate * max(remaining, 1e-3),
            gamma=settings.discount,
            gae_lambda=settings.trace,
            clip_range=settings.clip,
            max_grad_norm=settings.gradient_norm,
            policy_kwargs={
                "seen": envs.seen,
                "actor_gain": settings.input_gain,
                "units": settings.units,
                "log_std_init": settings.exploration,
            },
            seed=seed,
            device="cpu",
        )
        model.policy.log_std.requires_grad_(False)  # exploration that fades would leave nothing to learn from under the white load
        model.clock = Clock(envs, budget, report)
        with suppress(KeyboardInterrupt):
            model.learn(2**62, callback=model.clock)
        return distilled(model, envs.blades.plant, settings)
    finally:
        envs.close()


class Clock(BaseCallback):
    """Ends training when its time is over, anneals the learning rate by the clock and reports the running cost."""

    def __init__(self, envs: BladeVecEnv, budget: float, report: Report) -> None:
        super().__init__()
        task = envs.blades.task
        self._budget, self._report, self._steps = budget, report, task.steps
        self._reference = uncontrolled_cost(task)
        self._begin = self._cost = 0.0
        self._envs, self._held = envs, envs.held

    @property
    def remaining(self) -> float:
        """Share of the budget that is left."""
        return max(0.0, 1.0 - (time.monotonic() - self._begin) / self._budget)

    def _on_training_start(self) -> None:
        self._begin = time.monotonic()

    def _on_rollout_start(self) -> None:
        self._cost = 0.0

    def _on_step(self) -> bool:
        self._cost += self._envs.last_cost
        return time.monotonic() - self._begin < self._budget

    def _on_rollout_end(self) -> None:
        elapsed = time.monotonic() - self._begin
        relative = self._cost / self.model.n_steps * self._steps / self._reference
        self._report(Progress(elapsed, self.num_timesteps * self._held, relative))


class TimedPPO(PPO):
    """PPO whose schedules run with the clock, not with a number of steps nobody knows."""

    clock: Clock

    def _update_current_progress_remaining(self, num_timesteps: int, total_timesteps: int) -> None:
        self._current_progress_remaining = self.clock.remaining


def distilled(model: PPO, plant: Plant, settings: PPOSettings) -> HistoryPolicy:
    """The actor as arrays."""
    layers = [layer for layer in model.policy.mlp_extractor.policy_net if isinstance(layer, torch.nn.Linear)]
    weights = {}
    for index, layer in enumerate([*layers, model.policy.action_net]):
        weights[f"weight{index}"] = layer.weight.detach().numpy().copy()
        weights[f"bias{index}"] = layer.bias.detach().numpy().copy()
    lowest, highest = normalised(plant).voltage_limits.astype(np.float32)
    return HistoryPolicy("PPO", weights, asdict(settings), lowest, highest)
