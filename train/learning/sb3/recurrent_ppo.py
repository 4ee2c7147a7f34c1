"""PPO of an LSTM by sb3-contrib: a memory that is learnt in place of a window of a set length."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Annotated, Any

import numpy as np
import torch
from sb3_contrib import RecurrentPPO
from torch import nn

from beamenv.configuration import Natural, Number, Positive, Real, Share, Whole, configuration
from beamenv.plant.plant import normalised
from beamenv.task import Task
from train.controllers.lstm_policy import LSTMPolicy
from train.controllers.policies import Policy
from train.learning.sb3.asymmetric import AsymmetricRecurrentPolicy
from train.learning.sb3.sb3 import SB3Training, training_envs


@configuration("settings")
class RecurrentPPOSettings:
    """One experiment."""

    blades: Whole = 256
    """Environments stepped together."""
    history: Whole = 4
    """Instants the cells read at a time: all since the last action."""
    held: Whole = 4
    """Control intervals for which an action is held, 2 ms."""
    rollout: Whole = 32
    """Actions of every blade between updates, and back-propagated through: 64 ms."""
    batch: Whole = 4096
    """Samples in a gradient step."""
    epochs: Whole = 4
    """Passes over a rollout."""
    learning_rate: Positive = 1e-3
    """Adam's, falling linearly to zero over the training."""
    discount: Share = 0.95
    """γ: 20 actions, 40 ms."""
    trace: Share = 0.8
    """λ of the advantage estimate."""
    energy_horizon: Annotated[float, Number(ge=0.0, unit="s")] = 0.03
    """s: potential of a joule, see ``train.learning.sb3.vec_env``."""
    exploration: Real = -1.4
    """Logarithm of the standard deviation of the actions, constant."""
    units: Whole = 48
    """Cells of the LSTM, and units of the critic's two tanh layers."""
    clip: Positive = 0.2
    """Of the probability ratio."""
    gradient_norm: Positive = 1e3
    """Gradients are clipped to it: hardly ever."""
    input_gain: Real = 4.0
    """Readings are a few per cent of full scale most of the time."""
    critic_first: Natural = 0
    """Updates that train the critic alone."""
    smoothing: Share = 0.2
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
