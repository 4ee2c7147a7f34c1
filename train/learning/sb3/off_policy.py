"""Soft actor-critic (Haarnoja et al. 2018) by Stable-Baselines3, and truncated quantile critics (Kuznetsov et al. 2020) by
sb3-contrib: on a batch of blades, with the same actor, critics on the true state, and a replay buffer.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Annotated, Any, ClassVar

import numpy as np
import torch
from sb3_contrib import TQC
from stable_baselines3 import SAC
from stable_baselines3.common.type_aliases import TrainFreq, TrainFrequencyUnit
from torch import nn

from beamenv.configuration import Choice, Natural, Number, Positive, Refused, Share, configuration
from beamenv.task import Task
from train.controllers.policies import Policy
from train.learning.ranges import BLADES, INSTANTS, LOGARITHM, PASSES, RATE, SAMPLES, SEEN, UNITS
from train.learning.sb3.asymmetric import AsymmetricSACPolicy, AsymmetricTQCPolicy
from train.learning.sb3.cloning import Cloning, check_clonable, clone
from train.learning.sb3.least_squares import LeastSquaresPolicy, LeastSquaresSAC
from train.learning.sb3.sb3 import SB3Training, layers_as_arrays, linear_layers, training_envs

REMEMBERED = ("observations", "next_observations", "actions", "rewards", "dones", "timeouts")
"""Arrays of SB3's replay buffer, a row for each action of every blade."""

_ACTIVATIONS: dict[str, type[nn.Module]] = {"tanh": nn.Tanh, "relu": nn.ReLU}


@configuration("settings")
class OffPolicySettings:
    """One experiment."""

    blades: Annotated[int, BLADES] = 256
    """Environments stepped together."""
    sees: Annotated[str, Choice(SEEN)] = "history"
    """The last readings and voltages, or readings through oscillators, or an estimate from these that is fitted on the way, or the
    belief of the design's filter: see ``belief`` and ``fitted``."""
    modes: Annotated[int, UNITS] = 5
    """Of the estimate or the belief, the slowest ones, that are shown."""
    history: Annotated[int, INSTANTS] = 12
    """Instants the agent sees, 6 ms."""
    actor: Annotated[str, Choice(("layers", "linear"))] = "layers"
    """Two hidden layers and a linear one, or the latter alone, which begins without voltages; a tanh bounds either."""
    critic: Annotated[str, Choice(("network", "quadratic"))] = "network"
    """Two layers on the true state and the action, or, for SAC on one scenario, a quadratic of these and of the coming load, in
    closed form: see ``least_squares``."""
    held: Annotated[int, INSTANTS] = 4
    """Control intervals for which an action is held, 2 ms."""
    approach: Annotated[float, RATE] = 1.0
    """Share of the way from the last voltages to an action that they go: exploration that wanders in place of jumping."""
    rollout: Annotated[int, INSTANTS] = 4
    """Actions of every blade between updates."""
    critic_steps: Annotated[int, PASSES] = 12
    """Gradient steps of the critics alone, in an update."""
    gradient_steps: Annotated[int, PASSES] = 4
    """Gradient steps of critics and actor after them: an actor that is quicker than its critics saturates."""
    batch: Annotated[int, SAMPLES] = 256
    """Samples in a gradient step."""
    buffer: Annotated[int, SAMPLES] = 200_000
    """Actions remembered."""
    samples: Annotated[int, SAMPLES] = 8192
    """Of these, to which an update fits a quadratic critic."""
    critic_memory: Annotated[float, Number(ge=0.0, lt=1.0)] = 0.96
    """Share that earlier fits keep in a quadratic critic's sums."""
    first: Natural = 10_000
    """Actions remembered before learning begins."""
    learning_rate: Annotated[float, RATE] = 1e-3
    """Adam's, falling linearly to zero over the training."""
    damping: Annotated[float, RATE] = 1e-8
    """Adam's ε: gradients far below it, of what hardly moves, change weights in proportion and not by the whole rate."""
    discount: Annotated[float, RATE] = 0.95
    """γ: 20 actions, 40 ms."""
    energy_horizon: Annotated[float, Number(ge=0.0, unit="s")] = 0.03
    """s: potential of a joule, see ``train.learning.sb3.vec_env``."""
    reward_unit: Positive = 0.04
    """Reward of a control interval without control, about, with its sign changed: values must outgrow untrained critics' noise."""
    exploration: Annotated[float, LOGARITHM] = -1.4
    """Logarithm of a standard deviation of the actions: its entropy is what the temperature is steered to."""
    temperature: Positive = 0.003
    """Weight of the entropy to begin with, in rewards."""
    target_rate: Annotated[float, RATE] = 0.01
    """At which target critics follow."""
    units: Annotated[int, UNITS] = 64
    """Of each of two layers of the actor."""
    critic_units: Annotated[int, UNITS] = 128
    """Of each of two layers of the critics."""
    activation: Annotated[str, Choice(tuple(_ACTIVATIONS))] = "relu"
    """Of all layers: tanh or relu."""
    input_gain: Positive = 1.0
    """Readings are a few per cent of full scale most of the time."""
    critic_first: Natural = 50
    """Updates that train the critics alone: an actor must not follow critics that know nothing."""
    smoothing: Share = 0.02
    """Weight of the latest rollout in the running cost."""
    validation: Natural = 0
    """Updates between two looks at the policy without exploration, on validation seeds; the best is kept. 0: the last is."""

    def __post_init__(self) -> None:
        if self.buffer < self.blades:
            raise Refused("buffer", self.buffer, f"at least one action of each of the {self.blades} blades")
        if self.first > self.buffer // self.blades * self.blades:
            raise Refused("first", self.first, f"at most what the buffer of {self.buffer} holds, or learning never begins")


def _told(settings: OffPolicySettings, envs: Any) -> dict[str, int]:
    """What a quadratic critic is told beside the true state and the load: a belief and the voltages held, or these alone."""
    crossed = envs.seen if settings.sees == "belief" else int(np.prod(envs.action_space.shape or ()))
    return {"modes": envs.blades.plant.blade_states // 2, "crossed": crossed}


class OffPolicyTraining(SB3Training):
    """Of a squashed network on the history; with a ``teacher``, from its clone on."""

    algorithm: ClassVar[Any]
    networks: ClassVar[Any]
    name: ClassVar[str]

    def __init__(self, tasks: Sequence[Task], settings: OffPolicySettings, seed: int, teacher: Policy | None = None) -> None:
        quadratic = settings.critic == "quadratic"
        self._check(settings, tasks)
        envs = training_envs(tasks, settings, seed, reward_unit=settings.reward_unit, shows_loads=quadratic)
        voltages = int(np.prod(envs.action_space.shape or ()))
        kinds: tuple[Any, Any] = (LeastSquaresSAC, LeastSquaresPolicy) if quadratic else (self.algorithm, self.networks)
        model = kinds[0](
            kinds[1],
            envs,
            learning_rate=lambda remaining: settings.learning_rate * max(remaining, 1e-3),
            buffer_size=settings.buffer,
            learning_starts=0,
            batch_size=settings.batch,
            tau=settings.target_rate,
            gamma=settings.discount,
            ent_coef=f"auto_{settings.temperature}",
            target_entropy=voltages * (0.5 * math.log(2.0 * math.pi * math.e) + settings.exploration),
            policy_kwargs={
                "seen": envs.seen,
                "actor_gain": settings.input_gain,
                "net_arch": {"pi": [] if settings.actor == "linear" else [settings.units] * 2, "qf": [settings.critic_units] * 2},
                "activation_fn": _ACTIVATIONS[settings.activation],
                "optimizer_kwargs": {"eps": settings.damping},
                **(_told(settings, envs) if quadratic else {}),
            },
            seed=seed,
            device="cpu",
        )
        with torch.no_grad():  # it begins as PPO does: hardly any voltage but that of exploration
            small = 0.0 if settings.actor == "linear" else 0.01
            model.actor.mu.weight *= small
            model.actor.log_std.weight *= small
            if settings.actor == "linear":
                model.actor.mu.bias.zero_()
            model.actor.log_std.bias.fill_(settings.exploration)
        if teacher is not None:
            check_clonable(settings)
            clone(nn.Sequential(*self._actor(model), nn.Tanh()), envs, teacher, settings.input_gain, Cloning(), seed)
        super().__init__(model, envs, tasks, settings, seed)

    def _check(self, settings: OffPolicySettings, tasks: Sequence[Task]) -> None:
        if settings.critic == "quadratic" and (self.algorithm is not SAC or len(tasks) > 1):
            raise Refused("settings.critic", settings.critic, "'network' unless SAC is trained on one scenario")
        if settings.critic == "quadratic" and settings.held >= tasks[0].steps:  # there would be no action after any
            raise Refused("settings.held", settings.held, f"below the {tasks[0].steps} intervals of an episode for this critic")

    @staticmethod
    def _actor(model: Any) -> list[nn.Module]:
        return [model.actor.latent_pi, model.actor.mu]

    def _held_back(self) -> list[nn.Parameter]:
        return list(self.model.actor.parameters())

    def _optimisers(self) -> dict[str, torch.optim.Optimizer]:
        model = self.model
        return {"actor": model.actor.optimizer, "critic": model.critic.optimizer, "temperature": model.ent_coef_optimizer}

    def _loose(self) -> dict[str, torch.Tensor]:
        return {"temperature": self.model.log_ent_coef}

    def _gather_and_learn(self) -> None:
        frequency = TrainFreq(self.settings.rollout, TrainFrequencyUnit.STEP)
        memory = self.model.replay_buffer
        self.model.collect_rollouts(self.envs, self._callback, frequency, memory)
        if memory.size() * self.envs.num_envs >= self.settings.first:
            self._learn(actor=self.updates >= self.settings.critic_first)

    def _learn(self, actor: bool) -> None:
        """Critics first, and then, with them, the ``actor``."""
        settings = self.settings
        if settings.critic == "quadratic":
            self.model.fit(settings.samples, settings.critic_memory)
            if actor:
                self.model.train(settings.gradient_steps, settings.batch)
        else:
            self._free(False)
            self.model.train(settings.critic_steps, settings.batch)
            self._free(actor)
            self.model.train(settings.gradient_steps, settings.batch)

    def state_dict(self) -> dict[str, Any]:
        """With the actions remembered."""
        memory = self.model.replay_buffer
        rows = memory.size()
        remembered = {name: getattr(memory, name)[:rows].copy() for name in REMEMBERED}
        return {**super().state_dict(), "memory": {"place": memory.pos, "full": memory.full, **remembered}}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Resume, remembering what was; a training that is over has no memory left."""
        super().load_state_dict(state)
        if "memory" not in state:
            return
        memory, before = self.model.replay_buffer, state["memory"]
        memory.pos, memory.full = int(before["place"]), bool(before["full"])
        for name in REMEMBERED:
            getattr(memory, name)[: memory.size()] = np.asarray(before[name])

    def policy(self) -> Policy:
        """The actor's most likely action as arrays."""
        weights = layers_as_arrays([layer for part in self._actor(self.model) for layer in linear_layers(part)])
        return self._as_policy(self.name, weights, {**asdict(self.settings), "squashed": True})


class SACTraining(OffPolicyTraining):
    """Two critics of the mean."""

    algorithm, networks, name = SAC, AsymmetricSACPolicy, "SAC"


class TQCTraining(OffPolicyTraining):
    """Critics of quantiles, of which the highest are cut off."""

    algorithm, networks, name = TQC, AsymmetricTQCPolicy, "TQC"
