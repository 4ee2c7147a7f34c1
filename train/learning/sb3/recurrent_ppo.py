"""PPO of an LSTM by sb3-contrib: a memory that is learnt in place of a window of a set length."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import torch
from sb3_contrib import RecurrentPPO
from torch import nn

from beamenv.plant.plant import normalised
from beamenv.task import Task
from train.controllers.lstm_policy import LSTMPolicy
from train.controllers.policies import Policy
from train.learning.sb3.asymmetric import AsymmetricRecurrentPolicy
from train.learning.sb3.sb3 import SB3Training, training_envs


@dataclass(frozen=True, slots=True)
class RecurrentPPOSettings:
    """One experiment."""

    blades: int = 256
    """Environments stepped together."""
    history: int = 4
    """Instants the cells read at a time: all since the last action."""
    held: int = 4
    """Control intervals for which an action is held, 2 ms."""
    rollout: int = 32
    """Actions of every blade between updates, and back-propagated through: 64 ms."""
    batch: int = 4096
    """Samples in a gradient step."""
    epochs: int = 4
    """Passes over a rollout."""
    learning_rate: float = 1e-3
    """Adam's, falling linearly to zero over the training."""
    discount: float = 0.95
    """γ: 20 actions, 40 ms."""
    trace: float = 0.8
    """λ of the advantage estimate."""
    energy_horizon: float = 0.03
    """s: potential of a joule, see ``train.learning.sb3.vec_env``."""
    exploration: float = -1.4
    """Logarithm of the standard deviation of the actions, constant."""
    units: int = 48
    """Cells of the LSTM, and units of the critic's two tanh layers."""
    clip: float = 0.2
    """Of the probability ratio."""
    gradient_norm: float = 1e3
    """Gradients are clipped to it: hardly ever."""
    input_gain: float = 4.0
    """Readings are a few per cent of full scale most of the time."""
    critic_first: int = 0
    """Updates that train the critic alone."""
    smoothing: float = 0.2
    """Weight of the latest rollout in the running cost."""


class RecurrentPPOTraining(SB3Training):
    """Of an LSTM and a linear layer."""

    model: RecurrentPPO

    def __init__(self, tasks: Sequence[Task], settings: RecurrentPPOSettings, seed: int, teacher: Policy | None = None) -> None:
        if teacher is not None:
            raise ValueError("agent = 'recurrent-ppo' must start from scratch: only ppo, sac and tqc start from a teacher.")
        envs = training_envs(
            tasks,
            settings.blades,
            seed,
            history=settings.history,
            energy_horizon=settings.energy_horizon,
            discount=settings.discount,
            held=settings.held,
        )
        model = RecurrentPPO(
            AsymmetricRecurrentPolicy,
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
        model.policy.log_std.requires_grad_(False)
        super().__init__(model, envs, tasks, settings, seed)

    def _held_back(self) -> list[nn.Parameter]:
        policy: Any = self.model.policy
        return [*policy.lstm_actor.parameters(), *policy.action_net.parameters()]

    def _optimisers(self) -> dict[str, torch.optim.Optimizer]:
        return {"policy": self.model.policy.optimizer}

    def _gather_and_learn(self) -> None:
        self.model.collect_rollouts(self.envs, self._callback, self.model.rollout_buffer, self.model.n_steps)
        self.model.train()

    def policy(self) -> LSTMPolicy:
        """The actor's mean as arrays."""
        cells, head = self.model.policy.lstm_actor, self.model.policy.action_net
        names = ("weight_ih", "weight_hh", "bias_ih", "bias_hh")
        tensors = {name: getattr(cells, f"{name}_l0") for name in names} | {"weight_out": head.weight, "bias_out": head.bias}
        weights = {name: tensor.detach().numpy().copy() for name, tensor in tensors.items()}
        lowest, highest = normalised(self._design).voltage_limits.astype(np.float32)
        return LSTMPolicy("recurrent PPO", weights, asdict(self.settings), lowest, highest)
