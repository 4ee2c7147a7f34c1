"""The policy that adds to a law of many models, in torch: the law of ``baselines.design.weighing`` once more, differentiable."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from baselines import MultipleModel
from baselines.design.motion import DenseMotion
from beamenv.plant.plant import Plant
from train.controllers.models_policy import SHARPNESS, ModelsPolicy
from train.learning.through_plant.actors import Actor, ActorSettings, GatedUnit
from train.learning.through_plant.windows import Memory

Steps = list[tuple[int, Tensor]]
"""Instants, as far as gains differ, and the blades that are at them."""


class Remembered(NamedTuple):
    """Of N blades, as ``baselines.design.weighing.Memory`` has it, by rows of numbers."""

    hidden: Tensor
    predicted: Tensor
    evidence: Tensor
    squared: Tensor
    own: Tensor
    before: Tensor
    reading: Tensor
    instant: Tensor
    readings: Tensor
    astray: Tensor
    voltages: Tensor


class Law(NamedTuple):
    """What a multiple-model law is made of, in single precision."""

    moved: Tensor
    onward: Tensor
    inverse: Tensor
    log_determinant: Tensor
    left: Tensor
    """(2^p, H, p, p): inverses by the pattern of what is lost, once gains have settled."""
    log_left: Tensor
    voltage_input: Tensor
    voltage_gain: Tensor
    log_prior: Tensor
    full_scale: Tensor
    drive: Tensor
    limits: Tensor
    own_transition: Tensor
    own_reading: Tensor
    own_voltage: Tensor
    own_gain: Tensor
    own_feedthrough: Tensor


class ModelsActor(Actor):
    """A gated recurrent unit that weighs a multiple-model law and its fallback, and adds to them; see ``ModelsPolicy``.

    The law is followed step by step and differentiated through, but for the weights of its hypotheses, which count as given. A
    reading that is lost while gains have not settled is left out as once they have.
    """

    def __init__(self, plant: Plant, settings: ActorSettings, runs: int, law: MultipleModel) -> None:
        super().__init__(plant, settings, runs)
        law = law.in_single_precision()
        self.law, self._floor, self._window, self._misfit = law, law.floor, law.window, law.misfit
        self._law = _tensors(law)
        p, m = self.sensors, self.voltages
        self.unit = GatedUnit(runs, p + 3 * m + 1 + law.bank.counts[0], 3 * m, settings)

    def _apply(self, fn: Callable[[Tensor], Tensor], recurse: bool = True) -> ModelsActor:
        """The law, too, goes where the weights go."""
        self._law = Law(*map(fn, self._law))
        super()._apply(fn, recurse)  # type: ignore[no-untyped-call]
        return self

    @property
    def sizes(self) -> tuple[int, ...]:
        """As ``Remembered`` has it."""
        (H, s), (p, m), D = self.law.bank.counts, self.law.instruments.counts, self._law.voltage_gain.shape[-1] // self.voltages
        assert self.law.fallback is not None
        return (self.settings.units, H * s, H, H, self.law.fallback.order, D * m, p, 1, 1, 1)

    def forward(self, readings: Tensor, memory: Memory) -> tuple[Tensor, Memory]:
        """Voltages and memory."""
        old, law, p, m = Remembered(*memory), self._law, self.sensors, self.voltages
        H, s = self.law.bank.counts
        taken = readings * law.full_scale
        moved = torch.bmm(old.predicted.view(-1, H, s).transpose(0, 1), law.moved)
        expected, quiet, estimate = torch.split(moved, [p, m, s], dim=2)
        innovation = taken - torch.clamp(expected, -law.full_scale, law.full_scale)
        lost = (taken == old.reading) & (taken.abs() < law.full_scale) & (old.instant > 0.0)
        steps = self._steps(old.instant[:, 0])
        whitened, squared, density = self._corrected(innovation, lost, steps)
        weights, squares, count, astray, fit = self._judged(old, squared, density, lost)
        carried = self._carried(whitened, steps)
        asked = carried[..., :m] - quiet - torch.matmul(old.before, law.voltage_gain.transpose(1, 2))
        volts = (weights.T[..., None] * torch.clamp(asked, law.limits[0], law.limits[1])).sum(dim=0)
        own = old.own @ law.own_gain + taken @ law.own_feedthrough
        cautious = torch.clamp(own, law.limits[0], law.limits[1])
        volts = torch.where(astray > 0.0, cautious, volts)
        of_models, of_fallback = volts / law.drive, cautious / law.drive
        inputs = [self.settings.input_gain * readings, old.voltages, of_models, of_fallback, fit, weights]
        hidden, output = self.unit(torch.cat(inputs, dim=1), old.hidden)
        weight, share, added = torch.split(output, m, dim=1)
        voltages = self._within((1.0 + weight) * of_models + share * of_fallback + added)
        applied = torch.cat([voltages * law.drive, old.before], dim=1)
        driven = torch.matmul(applied, law.voltage_input)
        predicted = (estimate + carried[..., m:] + driven).transpose(0, 1).reshape(len(readings), -1)
        own = old.own @ law.own_transition + taken @ law.own_reading + applied[:, :m] @ law.own_voltage
        kept = Remembered(
            hidden,
            predicted,
            weights.log() - law.log_prior,
            squares,
            own,
            applied[:, : old.before.shape[1]],
            taken.detach(),
            old.instant + 1.0,
            count,
            astray,
            voltages,
        )
        return voltages, tuple(kept)

    @torch.no_grad()
    def _judged(self, old: Remembered, squared: Tensor, density: Tensor, lost: Tensor) -> tuple[Tensor, ...]:
        """Weights, fading squares and how many, whether none fits any more, and how well any does: all of it counts as given."""
        weights = torch.softmax(self._law.log_prior + (old.evidence + density.T), dim=1).clamp(min=self._floor)
        weights = weights / weights.sum(dim=1, keepdim=True)
        fading = 1.0 - 1.0 / self._window
        squares = fading * old.squared + squared.T
        count = fading * old.readings + (~lost).sum(dim=1, keepdim=True)
        misfit = (weights * squares).sum(dim=1, keepdim=True)
        astray = torch.maximum(old.astray, ((misfit > self._misfit * count) & (old.instant >= self._window)).float())
        return weights, squares, count, astray, torch.tanh(SHARPNESS * torch.log(misfit / count.clamp(min=1.0) + 1e-3))

    def _steps(self, instant: Tensor) -> Steps:
        """Which of the gains are whose: blades of one window share an instant."""
        step = instant.clamp(max=len(self._law.onward) - 1).long()
        return [(int(k), torch.nonzero(step == k)[:, 0]) for k in torch.unique(step)]

    def _corrected(self, innovation: Tensor, lost: Tensor, steps: Steps) -> tuple[Tensor, Tensor, Tensor]:
        law, whole = self._law, torch.empty_like(innovation)
        density = innovation.new_empty(innovation.shape[:2])
        for k, rows in steps:
            whole = whole.index_copy(1, rows, torch.bmm(innovation[:, rows], law.inverse[k]))
            density[:, rows] = law.log_determinant[k][:, None]
        if len(law.left) and bool(lost.any()):
            rows = torch.nonzero(lost.any(dim=1))[:, 0]
            codes = (lost[rows] * 2 ** torch.arange(lost.shape[1], device=lost.device)).sum(dim=1)
            part = torch.einsum("hnp,nhpq->hnq", innovation[:, rows], law.left[codes])
            whole = whole.index_copy(1, rows, part)
            density[:, rows] = law.log_left[codes].T
        squared = (innovation.detach() * whole.detach()).sum(dim=2)
        return whole, squared, -0.5 * (squared + density)

    def _carried(self, whitened: Tensor, steps: Steps) -> Tensor:
        carried = whitened.new_empty((*whitened.shape[:2], self._law.onward.shape[-1]))
        for k, rows in steps:
            carried = carried.index_copy(1, rows, torch.bmm(whitened[:, rows], self._law.onward[k]))
        return carried

    def policy(self, run: int) -> ModelsPolicy:
        """What a run has learnt, as arrays, beside its law."""
        settings = {"input_gain": self.settings.input_gain}
        return ModelsPolicy("multiple-model and unit", self.unit.arrays(run), settings, *self._bounds(), law=self.law)


def _tensors(law: MultipleModel) -> Law:
    bank, own, instruments = law.bank, law.fallback, law.instruments
    dense = DenseMotion.of(bank, law.state_gain)
    assert own is not None
    left = [each[0] for each in bank.left] or np.zeros((0, *bank.inverse.shape[1:]))
    log_left = [each[1] for each in bank.left] or np.zeros((0, bank.counts[0]))
    arrays = (
        dense.moved,
        dense.onward,
        bank.inverse,
        bank.log_determinant,
        np.array(left),
        np.array(log_left),
        bank.voltage_input.transpose(1, 0, 2),
        law.voltage_gain,
        np.log(law.prior),
        bank.full_scale,
        instruments.voltage_scale,
        instruments.voltage_limits,
        own.transition.T,
        own.measurement_input.T,
        own.voltage_input.T,
        own.state_gain.T,
        own.measurement_gain.T,
    )
    return Law(*(torch.tensor(np.ascontiguousarray(each), dtype=torch.float32) for each in arrays))
