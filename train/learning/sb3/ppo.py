"""Proximal policy optimisation (Schulman et al. 2017) by Stable-Baselines3 on hundreds of blades at once.

What it gathers and how it learns is the same whatever network it trains: ``recurrent_ppo`` has another.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Annotated, Any, ClassVar

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from torch import nn

from beamenv.configuration import Choice, Flag, Natural, Number, Positive, Refused, Share, configuration
from beamenv.task import Task
from train.controllers.policies import Policy
from train.learning.ranges import BLADES, INSTANTS, LOGARITHM, PASSES, RATE, SAMPLES, SEEN, UNITS
from train.learning.sb3.asymmetric import AsymmetricPolicy
from train.learning.sb3.belief import design_belief, regulator_on
from train.learning.sb3.cloning import Cloning, check_clonable, clone
from train.learning.sb3.quadratic import FitCritic, QuadraticPolicy
from train.learning.sb3.sb3 import Envs, SB3Training, layers_as_arrays, linear_layers, training_envs
from train.learning.sb3.side_by_side import SideBySide


@configuration("settings")
class PPOSettings:
    """One experiment."""

    blades: Annotated[int, BLADES] = 1024
    """Environments stepped together."""
    sees: Annotated[str, Choice(SEEN)] = "history"
    """The last readings and voltages, or readings through oscillators, or an estimate from these that is fitted on the way, or the
    belief of the design's filter: see ``belief`` and ``fitted``."""
    modes: Annotated[int, UNITS] = 5
    """Of the estimate or the belief, the slowest ones, that are shown."""
    history: Annotated[int, INSTANTS] = 12
    """Instants the agent sees, 6 ms."""
    actor: Annotated[str, Choice(("tanh", "linear"))] = "tanh"
    """Two tanh layers and a linear one, or the latter alone, which begins without voltages."""
    start: Annotated[str, Choice(("idle", "lqg"))] = "idle"
    """Without voltages, or, for a linear actor on the belief, from the gains of LQG with load estimate."""
    critic: Annotated[str, Choice(("network", "quadratic"))] = "network"
    """Two tanh layers on the true state, or a quadratic of it and of the coming load in closed form, for one scenario."""
    twins: Annotated[bool, Flag()] = False
    """Blades in pairs that meet the same, one's advantages being taken from the other's: for a quadratic critic."""
    held: Annotated[int, INSTANTS] = 4
    """Control intervals for which an action is held, 2 ms: exploration that lasts tells more of the slow modes than white noise
    does, against the white load."""
    approach: Annotated[float, RATE] = 1.0
    """Share of the way from the last voltages to an action that they go: exploration that wanders in place of jumping."""
    rollout: Annotated[int, INSTANTS] = 16
    """Actions of every blade between updates."""
    batch: Annotated[int, SAMPLES] = 8192
    """Samples in a gradient step."""
    epochs: Annotated[int, PASSES] = 4
    """Passes over a rollout."""
    learning_rate: Annotated[float, RATE] = 1e-3
    """Adam's, falling linearly to zero over the training."""
    damping: Annotated[float, RATE] = 1e-5
    """Adam's ε: gradients far below it, of what hardly moves, change weights in proportion and not by the whole rate."""
    discount: Annotated[float, RATE] = 0.95
    """γ: 20 actions, 40 ms."""
    trace: Share = 0.8
    """λ of the advantage estimate."""
    energy_horizon: Annotated[float, Number(ge=0.0, unit="s")] = 0.03
    """s: potential of a joule, see ``train.learning.sb3.vec_env``."""
    exploration: Annotated[float, LOGARITHM] = -1.4
    """Logarithm of the standard deviation of the actions, constant."""
    units: Annotated[int, UNITS] = 64
    """Of each of two tanh layers, actor and critic alike."""
    clip: Annotated[float, RATE] = 0.2
    """Of the probability ratio."""
    gradient_norm: Positive = 1e3
    """Gradients are clipped to it: hardly ever."""
    input_gain: Positive = 1.0
    """Readings are a few per cent of full scale most of the time."""
    critic_first: Natural = 0
    """Updates that train the critic alone, for an actor that is good already."""
    smoothing: Share = 0.2
    """Weight of the latest rollout in the running cost."""
    validation: Natural = 0
    """Updates between two looks at the policy without exploration, on validation seeds; the best is kept. 0: the last is."""

    def __post_init__(self) -> None:
        if self.batch > self.blades * self.rollout:
            raise Refused("batch", self.batch, f"at most the {self.blades * self.rollout} samples of a rollout, blades · rollout")
        if self.start == "lqg" and not (self.sees == "belief" and self.actor == "linear"):
            raise Refused("start", self.start, "'idle' unless sees is 'belief' and actor 'linear'")
        if self.twins and not (self.critic == "quadratic" and self.blades % 2 == 0):
            raise Refused("twins", self.twins, "false unless critic is 'quadratic' and blades an even number")


def _layered(settings: PPOSettings, envs: Envs) -> dict[str, Any]:
    """What policies on a window or a belief are made of."""
    made: dict[str, Any] = {"linear": settings.actor == "linear", "optimizer_kwargs": {"eps": settings.damping}}
    if settings.critic == "quadratic":
        if isinstance(envs, SideBySide):
            raise Refused("settings.critic", settings.critic, "'network' where several scenarios are trained on")
        voltages = int(np.prod(envs.action_space.shape or ()))
        made |= {"modes": envs.blades.plant.blade_states // 2, "crossed": envs.seen if settings.sees == "belief" else voltages}
    return made


class OnPolicyTraining(SB3Training):
    """Of an ``algorithm`` and its ``networks``, whose exploration stays what it is."""

    algorithm: ClassVar[Any]
    networks: ClassVar[Any]

    def __init__(self, tasks: Sequence[Task], settings: PPOSettings, seed: int, teacher: Policy | None = None) -> None:
        quadratic = settings.critic == "quadratic"
        envs = training_envs(tasks, settings, seed, shows_loads=quadratic and len(tasks) == 1, twins=settings.twins)
        model = self.algorithm(
            QuadraticPolicy if quadratic else self.networks,
            envs,
            n_steps=settings.rollout,
            batch_size=settings.batch,
            n_epochs=settings.epochs,
            learning_rate=lambda remaining: settings.learning_rate * max(remaining, 1e-3),
            gamma=settings.discount,
            gae_lambda=settings.trace,
            clip_range=settings.clip,
            vf_coef=0.0 if quadratic else 0.5,
            max_grad_norm=settings.gradient_norm,
            policy_kwargs={
                "seen": envs.seen,
                "actor_gain": settings.input_gain,
                "units": settings.units,
                "log_std_init": settings.exploration,
                **self._made(settings, envs),
            },
            seed=seed,
            device="cpu",
        )
        model.policy.log_std.requires_grad_(False)  # exploration that fades would leave nothing to learn from under the white load
        if settings.start == "lqg":
            belief = design_belief(tasks[0].design, settings.modes)
            gain = regulator_on(belief, tasks[0].design, settings.approach) / settings.input_gain
            with torch.no_grad():
                model.policy.action_net.weight.copy_(torch.as_tensor(gain))
        if teacher is not None:
            self._start_from(teacher, model, envs, settings, seed)
        super().__init__(model, envs, tasks, settings, seed)

    def _start_from(self, teacher: Policy, model: Any, envs: Envs, settings: PPOSettings, seed: int) -> None:
        raise NotImplementedError

    @staticmethod
    def _made(settings: PPOSettings, envs: Envs) -> dict[str, Any]:
        """Further arguments of the networks."""
        return {}

    def _callbacks(self) -> list[BaseCallback]:
        return [FitCritic(self.settings.twins)] if self.settings.critic == "quadratic" else []

    def _optimisers(self) -> dict[str, torch.optim.Optimizer]:
        return {"policy": self.model.policy.optimizer}

    def _gather_and_learn(self) -> None:
        self.model.collect_rollouts(self.envs, self._callback, self.model.rollout_buffer, self.model.n_steps)
        if self.settings.critic == "network" or self.updates >= self.settings.critic_first:  # the quadratic has been fitted
            self.model.train()


class PPOTraining(OnPolicyTraining):
    """Of a tanh network on the history; with a ``teacher``, from its clone on."""

    algorithm, networks = PPO, AsymmetricPolicy

    _made = staticmethod(_layered)

    def _start_from(self, teacher: Policy, model: Any, envs: Envs, settings: PPOSettings, seed: int) -> None:
        check_clonable(settings)
        clone(nn.Sequential(*self._actor(model)), envs, teacher, settings.input_gain, Cloning(), seed)

    @staticmethod
    def _actor(model: Any) -> list[nn.Module]:
        policy = model.policy
        return [policy.mlp_extractor.policy_net, policy.action_net]

    def _held_back(self) -> list[nn.Parameter]:
        return [parameter for part in self._actor(self.model) for parameter in part.parameters()]

    def policy(self) -> Policy:
        """The actor's mean as arrays."""
        weights = layers_as_arrays([layer for part in self._actor(self.model) for layer in linear_layers(part)])
        return self._as_policy("PPO", weights, asdict(self.settings))
