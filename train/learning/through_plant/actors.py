"""Policies in torch, to be trained through the plant; each becomes the same in NumPy (``train.controllers.policies``)."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any

import numpy as np
import torch
from torch import Tensor, nn

from baselines.design.controller import Array
from beamenv.configuration import Number, Positive, configuration
from beamenv.plant.plant import Plant, normalised
from train.controllers.policies import Policy, RecurrentPolicy, ResidualPolicy, StateSpacePolicy
from train.learning.ranges import UNITS
from train.learning.through_plant.linear_base import LinearBase
from train.learning.through_plant.windows import Memory


@configuration("settings.actor_settings")
class ActorSettings:
    """What an actor is made of."""

    units: Annotated[int, UNITS] = 48
    """Hidden units of a GRU: twice the plant's states, about."""
    input_gain: Positive = 4.0
    """Readings are a few per cent of full scale most of the time."""
    output_gain: Annotated[float, Number(ge=0.0)] = 0.1
    """Of the initial output layer: the untrained policy does next to nothing."""


class Actor(nn.Module):
    """Several runs of one kind of policy, trained side by side: every weight has a leading axis of ``runs``.

    Rows of a batch belong to the runs in equal parts, one after the other. Runs share nothing but their time: each has weights,
    episodes and gradients of its own. (Networks are so small that five runs cost little more than one.)
    """

    limits: Tensor
    """(2, m): what the drive lets through, in units of the larger limit."""

    def __init__(self, plant: Plant, settings: ActorSettings, runs: int) -> None:
        super().__init__()
        limits = normalised(plant).voltage_limits
        self.sensors, self.voltages = len(plant.C), limits.shape[1]
        self.settings, self.runs = settings, runs
        self.register_buffer("limits", torch.tensor(limits, dtype=torch.float32))

    def start(self, count: int) -> Memory:
        """Nothing remembered."""
        return tuple(torch.zeros(count, size, device=self.limits.device) for size in (*self.sizes, self.voltages))

    @property
    def sizes(self) -> tuple[int, ...]:
        """Widths of the memory's parts, before the voltages."""
        raise NotImplementedError

    def policy(self, run: int) -> Policy:
        """What a run has learnt, as arrays."""
        raise NotImplementedError

    def _within(self, voltages: Tensor) -> Tensor:
        return torch.clamp(voltages, self.limits[0], self.limits[1])

    def _bounds(self) -> tuple[Any, Any]:
        lowest, highest = self.limits.numpy(force=True).copy()
        return lowest, highest


class Layer(nn.Module):
    """A linear layer for each run, as torch's ``Linear`` draws it, its weights times ``gain``."""

    def __init__(self, runs: int, inputs: int, outputs: int, bound: float, gain: float = 1.0, bias: bool = True) -> None:
        super().__init__()
        self.weight = nn.Parameter(gain * bound * (2.0 * torch.rand(runs, inputs, outputs) - 1.0))
        self.bias = nn.Parameter(gain * bound * (2.0 * torch.rand(runs, 1, outputs) - 1.0) * float(bias), requires_grad=bias)

    def forward(self, rows: Tensor) -> Tensor:
        """Rows (rows, outputs)."""
        runs = len(self.weight)
        return torch.baddbmm(self.bias, rows.view(runs, -1, rows.shape[1]), self.weight).view(len(rows), -1)

    def arrays(self, run: int, suffix: str) -> dict[str, Any]:
        """Weight (outputs, inputs) and bias (outputs,) of a run."""
        weight, bias = self.weight[run].T, self.bias[run, 0]
        return {f"weight{suffix}": _array(weight), f"bias{suffix}": _array(bias)}


class GatedUnit(nn.Module):
    """A gated recurrent unit (Cho et al. 2014, as torch's ``GRUCell`` has it) with a tanh output layer."""

    def __init__(self, runs: int, inputs: int, outputs: int, settings: ActorSettings) -> None:
        super().__init__()
        bound = settings.units**-0.5
        self.ih = Layer(runs, inputs, 3 * settings.units, bound)
        self.hh = Layer(runs, settings.units, 3 * settings.units, bound)
        self.out = Layer(runs, settings.units, outputs, bound, settings.output_gain)

    def forward(self, inputs: Tensor, hidden: Tensor) -> tuple[Tensor, Tensor]:
        """Hidden units and outputs."""
        units = hidden.shape[1]
        from_input, from_hidden = self.ih(inputs), self.hh(hidden)
        reset, update = torch.sigmoid(from_input[:, : 2 * units] + from_hidden[:, : 2 * units]).chunk(2, dim=1)
        candidate = torch.tanh(from_input[:, 2 * units :] + reset * from_hidden[:, 2 * units :])
        hidden = torch.lerp(candidate, hidden, update)
        return hidden, torch.tanh(self.out(hidden))

    def arrays(self, run: int) -> dict[str, Any]:
        """The weights of a run."""
        return self.ih.arrays(run, "_ih") | self.hh.arrays(run, "_hh") | self.out.arrays(run, "_out")


class RecurrentActor(Actor):
    """A gated recurrent unit with a tanh output."""

    def __init__(self, plant: Plant, settings: ActorSettings, runs: int) -> None:
        super().__init__(plant, settings, runs)
        self.unit = GatedUnit(runs, self.sensors + self.voltages, self.voltages, settings)

    @property
    def sizes(self) -> tuple[int, ...]:
        """Hidden units."""
        return (self.settings.units,)

    def forward(self, readings: Tensor, memory: Memory) -> tuple[Tensor, Memory]:
        """Voltages and memory."""
        hidden, voltages = memory
        hidden, output = self.unit(torch.cat([self.settings.input_gain * readings, voltages], dim=1), hidden)
        voltages = self._within(output)
        return voltages, (hidden, voltages)

    def policy(self, run: int) -> Policy:
        """What a run has learnt, as arrays."""
        return RecurrentPolicy("gradient (GRU)", self.unit.arrays(run), asdict(self.settings), *self._bounds())


class ResidualActor(Actor):
    """Adds to a linear controller, and weighs it: u = clip((1 + g) ∘ u_lin + r), g and r from a gated recurrent unit.

    1 + g starts at one and may go to zero: where the controller's own loop is unstable it must be held back.
    """

    fused: Tensor
    feedback: Tensor
    readout: Tensor

    def __init__(self, plant: Plant, settings: ActorSettings, runs: int, base: LinearBase) -> None:
        super().__init__(plant, settings, runs)
        for name, matrix in base._asdict().items():
            self.register_buffer(name, torch.tensor(matrix, dtype=torch.float32))
        self.unit = GatedUnit(runs, self.sensors + 2 * self.voltages, 2 * self.voltages, settings)

    @property
    def sizes(self) -> tuple[int, ...]:
        """Hidden units and the controller's memory."""
        return self.settings.units, self.feedback.shape[1]

    def forward(self, readings: Tensor, memory: Memory) -> tuple[Tensor, Memory]:
        """Voltages and memory."""
        hidden, linear, voltages = memory
        predicted = linear @ self.readout
        given = readings + predicted - torch.clamp(predicted, -1.0, 1.0)
        product = torch.cat([linear, given], dim=1) @ self.fused
        order = linear.shape[1]
        asked = self._within(product[:, order:])
        hidden, output = self.unit(torch.cat([self.settings.input_gain * readings, voltages, asked], dim=1), hidden)
        weight, added = output.chunk(2, dim=1)
        voltages = self._within((1.0 + weight) * asked + added)
        return voltages, (hidden, product[:, :order] + voltages @ self.feedback, voltages)

    def policy(self, run: int) -> Policy:
        """What a run has learnt, as arrays."""
        weights = self.unit.arrays(run) | {name: _array(getattr(self, name)) for name in LinearBase._fields}
        return ResidualPolicy("residual (LQG + GRU)", weights, asdict(self.settings), *self._bounds())


class StateSpaceActor(Actor):
    """A linear law with a memory, started at a law of the design plant, or, ``idle``, at no voltages; all its matrices are free."""

    readout: Tensor

    def __init__(self, plant: Plant, settings: ActorSettings, runs: int, base: LinearBase, idle: bool) -> None:
        super().__init__(plant, settings, runs)
        order, fused = base.feedback.shape[1], base.fused.copy()
        fused[:, order:] *= float(not idle)
        self.fused, self.feedback = (nn.Parameter(_for_each(runs, matrix)) for matrix in (fused, base.feedback))
        self.register_buffer("readout", torch.tensor(base.readout, dtype=torch.float32))

    @property
    def sizes(self) -> tuple[int, ...]:
        """The law's memory."""
        return (self.feedback.shape[2],)

    def forward(self, readings: Tensor, memory: Memory) -> tuple[Tensor, Memory]:
        """Voltages and memory."""
        linear, _ = memory
        predicted = linear @ self.readout
        given = readings + predicted - torch.clamp(predicted, -1.0, 1.0)
        product = _run_by_run(torch.cat([linear, given], dim=1), self.fused)
        order = linear.shape[1]
        voltages = self._within(product[:, order:])
        return voltages, (product[:, :order] + _run_by_run(voltages, self.feedback), voltages)

    def policy(self, run: int) -> Policy:
        """What a run has learnt, as arrays."""
        weights = {"fused": _array(self.fused[run]), "feedback": _array(self.feedback[run]), "readout": _array(self.readout)}
        return StateSpacePolicy("optimised linear", weights, {}, *self._bounds())


class BeliefActor(Actor):
    """A gain from the belief of a law's filter, which stays as it is: its memory ξ and the innovations y − clip(C ξ)."""

    onward: Tensor
    feedback: Tensor
    readout: Tensor

    def __init__(self, plant: Plant, settings: ActorSettings, runs: int, base: LinearBase, idle: bool) -> None:
        super().__init__(plant, settings, runs)
        order = base.feedback.shape[1]
        asked = base.fused[:, order:]
        gain = np.vstack([asked[:order] + base.readout @ asked[order:], asked[order:]])
        self.gain = nn.Parameter(_for_each(runs, gain * float(not idle)))
        for name, matrix in {"onward": base.fused[:, :order], "feedback": base.feedback, "readout": base.readout}.items():
            self.register_buffer(name, torch.tensor(matrix, dtype=torch.float32))

    @property
    def sizes(self) -> tuple[int, ...]:
        """The filter's memory."""
        return (self.feedback.shape[1],)

    def forward(self, readings: Tensor, memory: Memory) -> tuple[Tensor, Memory]:
        """Voltages and memory."""
        belief, _ = memory
        predicted = belief @ self.readout
        innovation = readings - torch.clamp(predicted, -1.0, 1.0)
        voltages = self._within(_run_by_run(torch.cat([belief, innovation], dim=1), self.gain))
        onward = torch.cat([belief, predicted + innovation], dim=1) @ self.onward
        return voltages, (onward + voltages @ self.feedback, voltages)

    def policy(self, run: int) -> Policy:
        """What a run has learnt, as arrays: the same law of readings."""
        order = self.feedback.shape[1]
        from_belief, from_reading = self.gain[run, :order], self.gain[run, order:]
        asked = torch.cat([from_belief - self.readout @ from_reading, from_reading])
        weights = {"fused": torch.cat([self.onward, asked], dim=1), "feedback": self.feedback, "readout": self.readout}
        return StateSpacePolicy("linear on the belief", {n: _array(w) for n, w in weights.items()}, {}, *self._bounds())


def _run_by_run(rows: Tensor, matrices: Tensor) -> Tensor:
    """Rows (rows, k), in equal parts of the runs, times each run's own matrix (runs, k, l)."""
    runs = len(matrices)
    return torch.bmm(rows.view(runs, -1, rows.shape[1]), matrices).view(len(rows), -1)


def _for_each(runs: int, matrix: Array) -> Tensor:
    return torch.tensor(matrix, dtype=torch.float32).repeat(runs, 1, 1)


def _array(matrix: Tensor) -> Any:
    return matrix.numpy(force=True).copy()
