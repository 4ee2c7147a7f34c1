"""Policies trained by back-propagation through the plant.

The plant is known and differentiable: the very kernel that the environment steps runs here on torch tensors, so that the
gradient of J itself is descended, through drawn plants, delays, hysteresis, failures and saturation. Windows of episodes are
unrolled; the energy left at a window's end, times the time it would take to decay, stands for the cost still to come.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Annotated, Any

import numpy as np
import torch

from beamenv.configuration import Choice, Count, Number, Positive, Refused, Text, configuration
from beamenv.task import Task
from train.controllers.general_bank import general_law
from train.controllers.policies import Policy
from train.learning.ranges import BLADES, INSTANTS, PASSES, RATE
from train.learning.session import Budget, follow
from train.learning.through_plant.actors import (
    Actor,
    ActorSettings,
    BeliefActor,
    RecurrentActor,
    ResidualActor,
    StateSpaceActor,
)
from train.learning.through_plant.compositions import compositions
from train.learning.through_plant.linear_base import BASES, linear_base
from train.learning.through_plant.models_actor import ModelsActor
from train.learning.through_plant.windows import Windows
from train.learning.training import Report, on_training_bank, uncontrolled_cost

COMPOSED = 13
"""Seed of the scenarios that generalists meet besides those with a name."""


@configuration("settings")
class GradientSettings:
    """One experiment."""

    actor: Annotated[str, Choice(("recurrent", "residual", "state-space", "belief", "multiple-model-residual"))] = "recurrent"
    """"recurrent", "residual", "state-space" (all matrices of a linear law), "belief" (its gain alone, its filter as it is) or
    "multiple-model-residual" (weighs the law of one bank for every scenario)."""
    base: Annotated[str, Choice(BASES)] = "lqg"
    """What a residual actor adds to and a linear one starts from: see ``train.learning.through_plant.linear_base``."""
    start: Annotated[str, Choice(("base", "idle"))] = "base"
    """Whether a linear actor starts as its base, or without voltages: of the base it then has the filter alone."""
    actor_settings: ActorSettings = field(default_factory=ActorSettings)
    runs: Annotated[int, PASSES] = 1
    """Independent trainings side by side."""
    episodes: Annotated[int, BLADES] = 128
    """Blades of each run unrolled together."""
    window: Annotated[int, INSTANTS] = 125
    """Steps back-propagated through, 62 ms: two periods of the slowest mode."""
    last_window: Annotated[int, Count(0, 10_000)] = 0
    """Steps of the longer windows at the training's end, which lean less on ``energy_horizon``; 0 for windows of one length."""
    last_share: Annotated[float, Number(ge=0.0, le=1.0)] = 0.4
    """Share of the training, at its end, that has ``last_window``."""
    last_rate: Annotated[float, RATE] = 1.0
    """Share of the learning rate in it."""
    learning_rate: Annotated[float, RATE] = 5e-3
    """Adam's, falling linearly to zero over the training."""
    energy_horizon: Annotated[float, Number(ge=0.0, unit="s")] = 0.05
    """s: the cost of a joule left at a window's end."""
    gradient_norm: Positive = 1.0
    """Gradients are clipped to it."""
    calm: Positive = 10.0
    """Times no control: what a blade's window costs beyond that counts by its logarithm, so that unstable episodes neither drown
    the others nor go unheard."""
    compositions: Annotated[int, Count(0, 1000)] = 0
    """Scenarios composed at random (``compositions``) that a training of several scenarios meets besides."""
    device: Annotated[str, Text()] = "cpu"
    """Where it is trained, as torch names it: "cpu", or "cuda" where there is such a GPU. Episodes are drawn on the processor."""

    def __post_init__(self) -> None:
        if 0 < self.last_window < self.window:
            raise Refused("last_window", self.last_window, f"0, or at least the window, {self.window}")


def new_actor(task: Task, settings: GradientSettings) -> Actor:
    """An untrained actor for the design plant of a task."""
    plant, own, runs = task.design_plant, settings.actor_settings, settings.runs
    if settings.actor == "recurrent":
        return RecurrentActor(plant, own, runs)
    if settings.actor == "state-space":
        return StateSpaceActor(plant, own, runs, linear_base(settings.base, task), settings.start == "idle")
    if settings.actor == "belief":
        return BeliefActor(plant, own, runs, linear_base(settings.base, task), settings.start == "idle")
    if settings.actor == "multiple-model-residual":
        return ModelsActor(plant, own, runs, general_law(task.prior.blade))
    return ResidualActor(plant, own, runs, linear_base(settings.base, task))


def device_of(settings: GradientSettings) -> torch.device:
    """The device of a training; ``ValueError`` for one that torch does not have here."""
    refused = Refused("settings.device", settings.device, "cpu, or a device that torch has here, such as cuda")
    try:
        device = torch.device(settings.device)
        torch.zeros(1, device=device).cpu()  # meta, which holds nothing, is a device to torch
    except (RuntimeError, AssertionError, NotImplementedError, ImportError):  # torch has one for each way not to have it
        raise refused from None
    if device.type == "cpu" and settings.device != "cpu":  # to torch there are 128 of it, and as many more below zero
        raise refused
    return device


def calmed(cost: torch.Tensor, calm: float) -> torch.Tensor:
    """The costs where they are below ``calm``, and beyond it calm (1 + log(cost / calm)): as steep there, then flatter."""
    return torch.where(cost > calm, calm * (1.0 + torch.log(cost.clamp(min=calm) / calm)), cost)


class GradientTraining:
    """A ``train.learning.training.Training`` on one task or several, in turns. It resumes bit for bit.

    Its plants come from a bank of their own, not from that of the evaluation. ValueError for a ``teacher``: it learns from
    scratch.
    """

    def __init__(self, tasks: Sequence[Task], settings: GradientSettings, seed: int, teacher: Policy | None = None) -> None:
        if teacher is not None:
            raise ValueError("agent = 'gradient' must start from scratch: only ppo, sac and tqc start from a teacher.")
        device = device_of(settings)
        torch.manual_seed(seed)
        self.settings, self._generator = settings, np.random.default_rng(seed)
        self.actor = new_actor(tasks[0], settings).to(device)
        self._parameters = [weights for weights in self.actor.parameters() if weights.requires_grad]
        self._optimiser = torch.optim.Adam(self._parameters, lr=settings.learning_rate)
        further = compositions(tasks[0], settings.compositions, COMPOSED) if len(tasks) > 1 else []
        self._tasks, self._device = [on_training_bank(task) for task in [*tasks, *further]], device
        self._begin(last=False)
        self._references = [uncontrolled_cost(task, 512 if len(self._tasks) == 1 else 128) for task in self._tasks]
        self._order: list[int] = []
        self.steps = 0
        """Control intervals so far."""
        self.updates = 0
        self.cost = np.full(settings.runs, np.nan)
        """(runs,): J relative to no control, a running mean over the tasks."""
        self.validated = float("nan")
        """It acts as it is trained, without exploration."""
        self.losses: dict[str, float] = {}

    def _begin(self, last: bool) -> None:
        """New episodes of every task, in windows of the last length or of the first."""
        window = self.settings.last_window if last else self.settings.window
        blades = self.settings.runs * self.settings.episodes
        self._windows = [Windows(task, blades, window, self._generator, self._device) for task in self._tasks]
        self._last = last

    def update(self, remaining: float) -> None:
        """One step of Adam, at the share ``remaining`` of its learning rate."""
        if not self._last and self.settings.last_window > self.settings.window and remaining <= self.settings.last_share:
            self._begin(last=True)
        rate = self.settings.learning_rate * (self.settings.last_rate if self._last else 1.0)
        for group in self._optimiser.param_groups:
            group["lr"] = rate * max(remaining, 1e-3)
        self._order = self._order or self._generator.permutation(len(self._windows)).tolist()
        turn = self._order.pop()
        windows, reference = self._windows[turn], self._references[turn]
        cost, left = windows.unroll(self.actor)
        scale = windows.count / reference
        self._optimiser.zero_grad()
        loss = calmed(scale * (cost + self.settings.energy_horizon * left), self.settings.calm)
        loss = loss.view(self.settings.runs, -1).mean(dim=1).sum()
        torch.autograd.backward(loss)
        self._clip_gradients()
        self._optimiser.step()
        self.updates += 1
        self.steps += self.settings.episodes * windows.length
        latest = (cost.detach().view(self.settings.runs, -1).mean(dim=1).numpy(force=True) * scale).clip(max=100.0)
        weight = 0.05 / len(self._windows) if self.updates > len(self._windows) else 1.0 / self.updates
        self.cost = latest if self.updates == 1 else self.cost + weight * (latest - self.cost)

    def _clip_gradients(self) -> None:
        """To the norm of the settings, run by run; a run whose gradient is not finite leaves its weights for this time."""
        squares = torch.stack([(weights.grad**2).sum(dim=(1, 2)) for weights in self._parameters if weights.grad is not None])
        norm = squares.sum(dim=0).sqrt()
        scale = (self.settings.gradient_norm / (norm + 1e-6)).clamp(max=1.0)
        for weights in self._parameters:
            if weights.grad is not None:
                weights.grad = torch.nan_to_num(weights.grad * scale[:, None, None], nan=0.0, posinf=0.0, neginf=0.0)

    def policies(self) -> list[Policy]:
        """What each run has learnt so far."""
        return [self.actor.policy(run) for run in range(self.settings.runs)]

    def state_dict(self) -> dict[str, Any]:
        """Weights, optimiser, generator, counters, whether the last windows have begun, and the episodes under way."""
        return {
            "actor": self.actor.state_dict(),
            "optimiser": self._optimiser.state_dict(),
            "generator": self._generator.bit_generator.state,
            "last": self._last,
            "windows": [windows.state_dict() for windows in self._windows],
            "counters": {"order": list(self._order), "steps": self.steps, "updates": self.updates, "cost": self.cost.copy()},
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Resume from the ``state_dict`` of an equally made training, with its tensors and arrays or as a checkpoint has them."""
        self.actor.load_state_dict(state["actor"])
        self._optimiser.load_state_dict(state["optimiser"])
        if state["last"] != self._last:
            self._begin(state["last"])
        self._generator.bit_generator.state = state["generator"]  # after what new windows draw
        for windows, saved in zip(self._windows, state["windows"], strict=True):
            windows.load_state_dict(saved)
        counters = state["counters"]
        self._order, self.steps, self.updates = list(counters["order"]), counters["steps"], counters["updates"]
        self.cost = np.asarray(counters["cost"]).copy()

    def close(self) -> None:
        """Nothing is open."""


def train_gradient(
    tasks: Task | Sequence[Task],
    seed: int,
    report: Report,
    settings: GradientSettings | None = None,
    *,
    seconds: float = np.inf,
    updates: float = np.inf,
) -> list[Policy]:
    """Train until ``seconds`` or ``updates`` are over, whichever is first; one policy of each run. Ctrl-C ends it early.

    ``report`` is called after every update. The learning rate falls to zero over the training. ValueError unless ``seconds`` or
    ``updates`` is given.
    """
    budget = Budget(updates, seconds)
    training = GradientTraining([tasks] if isinstance(tasks, Task) else tasks, settings or GradientSettings(), seed)
    return follow(training, budget, report)
