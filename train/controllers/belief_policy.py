"""A network on what a Kalman filter of the design makes of all readings so far: the belief, as arrays and formulae."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.controllers.policies import Policy, network, towards

Array = NDArray[np.floating[Any]]

FILTER = ("transition", "input", "correction", "readout", "shown")
"""Weights of a belief that are the filter's and not learnt; those of the layers come beside them."""


class BeliefPolicy(Policy):
    """Asked every ``held`` instants: what the layers make of [x̂ @ shown | voltages held before], or ``approach`` of the way there.

    x̂ ← x̂ + (y − clip(x̂ @ readout)) @ correction, x̂⁺ = x̂ @ transition + u @ input: a filter that knows that readings clip and
    drives saturate. Its memory is [x̂ before the next reading | intervals the voltages have been held | voltages].
    """

    __slots__ = ()
    kind = "belief"

    @property
    def memory_size(self) -> int:
        """The estimate, a count and the last voltages."""
        return len(self.weights["transition"]) + 1 + len(self.lowest)

    def act(self, readings: Array, memory: Array) -> tuple[Array, Array]:
        """Correct the estimate; where it is time, layer by layer to new voltages; predict."""
        m = len(self.lowest)
        before, age, voltages = memory[:, : -m - 1], memory[:, -m - 1 : -m], memory[:, -m:]
        estimate = corrected(self.weights, before, readings)
        asked = self.asked(np.hstack([estimate @ self.weights["shown"], voltages]))
        action = np.where(age == 0.0, towards(asked, voltages, self.settings), voltages)
        action = np.clip(action, self.lowest, self.highest).astype(np.float32)
        onward = estimate @ self.weights["transition"] + action @ self.weights["input"]
        return action, np.hstack([onward, (age + 1.0) % self.settings["held"], voltages]).astype(np.float32)

    def asked(self, shown: Array) -> Array:
        """Voltages (N, m) that the layers ask for, of what they are shown (N, f + m)."""
        return network(self.weights, self.settings, shown)

    def knowing(self, memory: Array, voltages: Array) -> Array:
        """The filter, too, goes by the voltages that were held."""
        m = voltages.shape[1]
        before = memory[:, : -m - 1] + (voltages - memory[:, -m:]) @ self.weights["input"]
        return np.hstack([before, memory[:, -m - 1 : -m], voltages])


def corrected(filter_: Mapping[str, Array], before: Array, readings: Array) -> Array:
    """The estimate (N, n) after the readings (N, p), from that before them."""
    expected = np.clip(before @ filter_["readout"], -1.0, 1.0)
    return np.asarray(before + (readings - expected).astype(before.dtype) @ filter_["correction"])
