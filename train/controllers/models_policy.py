"""The policy that adds to a law of many models, which it is given: its weights alone do not tell the law."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from baselines import MultipleModel
from beamenv.configuration import Refused
from train.controllers.policies import Array, Policy, gated_unit

SHARPNESS = 0.3
"""What the logarithm of the misfit is multiplied by: a model that is off by a factor of ten shows as 0.7."""


@dataclass(frozen=True, slots=True, eq=False)
class ModelsPolicy(Policy):
    """Weighs a multiple-model law and its fallback and adds to them: u = clip((1 + g) ∘ u_models + c ∘ u_fallback + r).

    [g, c, r] is the tanh output of a gated recurrent unit that sees the readings, the voltages held before, what both laws ask for,
    how well any model fits and how likely each is. Its memory is [hidden units | the law's | voltages].
    """

    kind = "multiple-model-residual"
    law: MultipleModel | None = None
    """With a fallback, in normalised units."""

    def beside(self, law: Any) -> ModelsPolicy:
        """The same policy with its law; ``ValueError`` for what is none, or acts in other units or on another drive."""
        if not isinstance(law, MultipleModel) or law.fallback is None:
            raise Refused("law", law, "a multiple-model law with a fallback")
        m = len(self.lowest)
        told = self.weights["weight_ih"].shape[1] - 3 * m - 1
        (p, voltages), models = law.instruments.counts, law.bank.counts[0]
        if (p + models, voltages) != (told, m) or not law.instruments.fit(physical_units=False):
            raise Refused("law", law, f"one of {m} voltages and, together, {told} readings and models, in normalised units")
        return replace(self, law=law.in_single_precision())

    @property
    def memory_size(self) -> int:
        """Hidden units, the law's memory and the last voltages."""
        return int(self.weights["weight_hh"].shape[1]) + self._law.order + len(self.lowest)

    @property
    def _law(self) -> MultipleModel:
        if self.law is None:
            raise ValueError(f"{self.name} adds to a law that it must be given: build it for a task, or beside(law).")
        return self.law

    def act(self, readings: Array, memory: Array) -> tuple[Array, Array]:
        """What both laws ask for, and the unit, which revises it; the law then goes by what is held."""
        units, m = self.weights["weight_hh"].shape[1], len(self.lowest)
        hidden, own, voltages = memory[:, :units], memory[:, units:-m], memory[:, -m:]
        following = np.empty(memory.shape, np.float32)

        def weighed(some: slice, asked: Array, cautious: Array, misfit: Array, likely: Array) -> Array:
            fit = np.tanh(SHARPNESS * np.log(misfit + 1e-3))[:, None]
            seen = readings[some] * np.float32(self.settings["input_gain"])
            inputs = np.hstack([seen, voltages[some], asked, cautious, fit, likely])
            following[some, :units], output = gated_unit(self.weights, inputs.astype(np.float32), hidden[some].astype(np.float32))
            weight, share, added = np.split(output, 3, axis=1)
            return np.clip((1.0 + weight) * asked + share * cautious + added, self.lowest, self.highest)

        action = self._law.revised(np.asarray(readings, dtype=np.float64), own, weighed, following[:, units:-m])
        return action, following

    def knowing(self, memory: Array, voltages: Array) -> Array:
        """The law, too, goes by the voltages that were held."""
        units, m = self.weights["weight_hh"].shape[1], voltages.shape[1]
        own = self._law.overruled(memory[:, units:-m], voltages - memory[:, -m:])
        return np.hstack([memory[:, :units], own, voltages])
