"""PPO of an LSTM by sb3-contrib: a memory that is learnt in place of a window of a set length."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Annotated, Any

import numpy as np
from sb3_contrib import RecurrentPPO
from torch import nn

from beamenv.configuration import Positive, Refused, configuration
from beamenv.plant.plant import normalised
from beamenv.task import Task
from train.controllers.lstm_policy import LSTMPolicy
from train.controllers.policies import Policy
from train.learning.ranges import BLADES, INSTANTS, SAMPLES, UNITS
from train.learning.sb3.asymmetric import AsymmetricRecurrentPolicy
from train.learning.sb3.ppo import OnPolicyTraining, PPOSettings


@configuration("settings")
class RecurrentPPOSettings(PPOSettings):
    """One experiment: PPO's settings with other values to begin with."""

    blades: Annotated[int, BLADES] = 256
    """Environments stepped together."""
    history: Annotated[int, INSTANTS] = 4
    """Instants the cells read at a time: all since the last action."""
    rollout: Annotated[int, INSTANTS] = 32
    """Actions of every blade between updates, and back-propagated through: 64 ms."""
    batch: Annotated[int, SAMPLES] = 4096
    """Samples in a gradient step."""
    units: Annotated[int, UNITS] = 48
    """Cells of the LSTM, and units of the critic's two tanh layers."""
    input_gain: Positive = 4.0
    """Readings are a few per cent of full scale most of the time."""

    def __post_init__(self) -> None:
        for name, only in (("sees", "history"), ("actor", "tanh"), ("critic", "network"), ("approach", 1.0)):
            if getattr(self, name) != only:
                raise Refused(name, getattr(self, name), f"{only!r}: cells know nothing else")
        PPOSettings.__post_init__(self)


class RecurrentPPOTraining(OnPolicyTraining):
    """Of an LSTM and a linear layer."""

    algorithm, networks = RecurrentPPO, AsymmetricRecurrentPolicy

    def __init__(self, tasks: Sequence[Task], settings: RecurrentPPOSettings, seed: int, teacher: Policy | None = None) -> None:
        if teacher is not None:
            raise ValueError("agent = 'recurrent-ppo' must start from scratch: only ppo, sac and tqc start from a teacher.")
        super().__init__(tasks, settings, seed)

    def _held_back(self) -> list[nn.Parameter]:
        policy = self.model.policy
        return [*policy.lstm_actor.parameters(), *policy.action_net.parameters()]

    def state_dict(self) -> dict[str, Any]:
        """With what the cells hold of the episodes under way."""
        return {**super().state_dict(), "cells": [tensor.clone() for part in self.model._last_lstm_states for tensor in part]}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Resume within the episodes."""
        super().load_state_dict(state)
        parts = iter(state["cells"])
        kind = type(self.model._last_lstm_states)
        self.model._last_lstm_states = kind(*((next(parts).clone(), next(parts).clone()) for _ in kind._fields))

    def policy(self) -> LSTMPolicy:
        """The actor's mean as arrays."""
        cells, head = self.model.policy.lstm_actor, self.model.policy.action_net
        names = ("weight_ih", "weight_hh", "bias_ih", "bias_hh")
        tensors = {name: getattr(cells, f"{name}_l0") for name in names} | {"weight_out": head.weight, "bias_out": head.bias}
        weights = {name: tensor.detach().numpy().copy() for name, tensor in tensors.items()}
        lowest, highest = normalised(self._task.design_plant).voltage_limits.astype(np.float32)
        return LSTMPolicy("recurrent PPO", weights, asdict(self.settings), lowest, highest)
