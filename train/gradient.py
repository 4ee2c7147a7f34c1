"""A recurrent policy trained by back-propagation through the plant.

The plant is known and differentiable: the very kernel that the environment steps runs here on torch tensors, so that the
gradient of J itself is descended. Windows of episodes are unrolled; the energy left at a window's end, times the time it
would take to decay, stands for the cost still to come.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from beamenv.disturbances import noise_factor
from beamenv.kernel import Operators, advance
from beamenv.loads import static_deflection
from beamenv.scenarios import Scenario, draw_load_cases
from beamenv.plant import Plant, normalised
from train.policies import RecurrentPolicy
from train.training import Progress, Report, uncontrolled_cost


@dataclass(frozen=True, slots=True)
class GradientSettings:
    """One experiment."""

    units: int = 48
    """Hidden units of the GRU: twice the plant's states, about."""
    episodes: int = 128
    """Blades unrolled together."""
    window: int = 125
    """Steps back-propagated through, 62 ms: two periods of the slowest mode."""
    learning_rate: float = 5e-3
    """Adam's, falling linearly to zero over the budget."""
    energy_horizon: float = 0.05
    """s: the cost of a joule left at a window's end."""
    gradient_norm: float = 1.0
    """Gradients are clipped to it."""
    input_gain: float = 4.0
    """Readings are a few per cent of full scale most of the time."""
    output_gain: float = 0.1
    """Of the initial output layer: the untrained policy does next to nothing."""


def train_gradient(
    plant: Plant, scenario: Scenario, steps: int, budget: float, seed: int, report: Report, settings: GradientSettings | None = None
) -> RecurrentPolicy:
    """Train for ``budget`` s on a plant, in episodes of ``steps`` drawn from a scenario; Ctrl-C ends it early."""
    settings = settings or GradientSettings()
    torch.manual_seed(seed)
    actor = Actor(plant, settings)
    optimiser = torch.optim.Adam(actor.parameters(), lr=settings.learning_rate)
    windows = Windows(plant, scenario, steps, settings, np.random.default_rng(seed))
    reference = uncontrolled_cost(plant, scenario, steps)
    begin, done, running = time.monotonic(), 0, float("nan")
    try:
        while (elapsed := time.monotonic() - begin) < budget:
            for group in optimiser.param_groups:
                group["lr"] = settings.learning_rate * max(1.0 - elapsed / budget, 1e-3)
            cost, left = windows.unroll(actor)
            loss = (cost + settings.energy_horizon * left) * (windows.count / reference)
            optimiser.zero_grad()
            loss.backward()  # type: ignore[no-untyped-call]
            nn.utils.clip_grad_norm_(actor.parameters(), settings.gradient_norm)
            optimiser.step()
            done += settings.episodes * windows.length
            latest = float(cost.detach()) * windows.count / reference
            running = latest if np.isnan(running) else running + 0.05 * (latest - running)
            report(Progress(time.monotonic() - begin, done, running))
    except KeyboardInterrupt:
        pass
    return actor.policy(settings)


class Actor(nn.Module):
    """The GRU in torch; `train.policies.RecurrentPolicy` is the same in NumPy."""

    def __init__(self, plant: Plant, settings: GradientSettings) -> None:
        super().__init__()
        limits = normalised(plant).voltage_limits
        self.voltages, self.gain = limits.shape[1], settings.input_gain
        self.register_buffer("limits", torch.as_tensor(limits, dtype=torch.float32))
        self.cell = nn.GRUCell(len(plant.C) + self.voltages, settings.units)
        self.head = nn.Linear(settings.units, self.voltages)
        with torch.no_grad():
            self.head.weight *= settings.output_gain
            self.head.bias.zero_()

    def forward(self, readings: Tensor, hidden: Tensor, voltages: Tensor) -> tuple[Tensor, Tensor]:
        """Voltages (B, m) as the drive lets them through, and hidden units, from readings (B, p) and the last voltages."""
        hidden = self.cell(torch.cat([self.gain * readings, voltages], dim=1), hidden)
        return torch.clamp(torch.tanh(self.head(hidden)), self.limits[0], self.limits[1]), hidden

    def policy(self, settings: GradientSettings) -> RecurrentPolicy:
        """What has been learnt, as arrays."""
        names = ("weight_ih", "weight_hh", "bias_ih", "bias_hh")
        weights = {name: getattr(self.cell, name) for name in names} | {"weight_out": self.head.weight, "bias_out": self.head.bias}
        arrays = {name: weight.detach().numpy().copy() for name, weight in weights.items()}
        lowest, highest = self.limits.numpy().copy()
        return RecurrentPolicy("gradient (GRU)", arrays, asdict(settings), lowest, highest)


class Windows:
    """A batch of episodes, cut into windows that are unrolled one after the other; blades are spread over the windows."""

    def __init__(
        self, plant: Plant, scenario: Scenario, steps: int, settings: GradientSettings, generator: np.random.Generator
    ) -> None:
        self.length = min(settings.window, steps)
        self.count = steps // self.length
        self._plant, self._scenario, self._generator = plant, scenario, generator
        unit = normalised(plant)
        self._operators = Operators.from_plant(unit).convert(_float)
        self._readout, self._noise = _float(unit.C.T), _float(noise_factor(unit, scenario))
        batch = settings.episodes
        self._phase: NDArray[np.int64] = np.arange(batch) % self.count
        self._loads = torch.zeros(self.count * self.length, batch, 2)
        self._state, self._readings = torch.zeros(batch, len(plant.A)), torch.zeros(batch, len(plant.C))
        self._hidden, self._voltages = torch.zeros(batch, settings.units), torch.zeros(batch, plant.B.shape[1])
        self._begin(np.arange(batch))

    def _begin(self, rows: NDArray[np.int64]) -> None:
        cases = draw_load_cases(self._scenario, self._plant, self._generator, len(rows))
        state = _float(static_deflection(self._plant, cases.deflection))
        self._loads[:, rows] = _float(cases.at(np.arange(len(self._loads))[:, None]))
        self._state[rows] = state
        tremor = (torch.randn(len(rows), len(self._noise)) @ self._noise)[:, 2:]
        self._readings[rows] = torch.clamp(state @ self._readout + tremor, -1.0, 1.0)
        self._hidden[rows], self._voltages[rows] = 0.0, 0.0

    def _disturbances(self) -> Iterator[tuple[Tensor, Tensor]]:
        """Line loads (B, 2) and sensor noise (B, p), step by step through this window."""
        batch = len(self._phase)
        step = torch.as_tensor(self._phase * self.length)[None] + torch.arange(self.length)[:, None]
        normals = torch.randn(self.length, batch, len(self._noise)) @ self._noise
        loads = self._loads[step, torch.arange(batch)] + normals[..., :2]
        return zip(loads, normals[..., 2:], strict=True)

    def unroll(self, actor: Actor) -> tuple[Tensor, Tensor]:
        """Mean cost (J s) of a window and mean energy (J) left at its end; differentiable in the actor's weights."""
        state, readings, hidden, voltages = self._state, self._readings, self._hidden, self._voltages
        cost = torch.zeros(len(state))
        for loads, noise in self._disturbances():
            voltages, hidden = actor(readings, hidden, voltages)
            state, output, _, increment = advance(self._operators, torch.cat([state, voltages, loads], dim=1))
            readings = torch.clamp(output + noise, -1.0, 1.0)
            cost = cost + increment
        self._state, self._readings, self._hidden, self._voltages = (
            x.detach().clone() for x in (state, readings, hidden, voltages)
        )
        self._phase = (self._phase + 1) % self.count
        self._begin(np.flatnonzero(self._phase == 0))
        return cost.mean(), 0.5 * (state**2).sum(dim=1).mean()


def _float(array: NDArray[np.float64]) -> Tensor:
    return torch.as_tensor(np.ascontiguousarray(array), dtype=torch.float32)
