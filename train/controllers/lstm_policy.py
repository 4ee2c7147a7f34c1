"""A trained LSTM as arrays and formulae."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.controllers.policies import Policy

Array = NDArray[np.floating[Any]]


class LSTMPolicy(Policy):
    """A long short-term memory (Hochreiter and Schmidhuber 1997, as torch's ``LSTM`` has it) and one linear layer.

    Every few instants it is asked for voltages, and then reads the window of the last ones, laid out as
    ``beamenv.envs.history.RollingHistory`` does. Its memory is [window | intervals the voltages have been held | h | c | voltages].
    """

    __slots__ = ()
    kind = "lstm"

    @property
    def memory_size(self) -> int:
        """The window, a count, hidden units and cells, and the last voltages."""
        gates, width = self.weights["weight_ih"].shape
        return int(width) + 1 + int(gates) // 2 + len(self.lowest)

    def act(self, readings: Array, memory: Array) -> tuple[Array, Array]:
        """Shift the window; where it is time, one step of the cells to new voltages."""
        m, (gates, width) = len(self.lowest), self.weights["weight_ih"].shape
        if width % (readings.shape[1] + m):
            raise ValueError(f"instants of {readings.shape[1] + m} numbers do not fill the window.")
        window, age, hidden, cell, voltages = np.split(memory, np.cumsum([width, 1, gates // 4, gates // 4]), axis=1)
        window = np.hstack([window[:, readings.shape[1] + m :], readings, voltages])
        due = age == 0.0
        following, kept = self._step(window, hidden, cell)
        action = np.where(due, following @ self.weights["weight_out"].T + self.weights["bias_out"], voltages)
        hidden, cell = np.where(due, following, hidden), np.where(due, kept, cell)
        age = (age + 1.0) % self.settings["held"]
        return action, np.hstack([window, age, hidden, cell, voltages]).astype(np.float32)

    def _step(self, window: Array, hidden: Array, cell: Array) -> tuple[Array, Array]:
        inputs = window * np.float32(self.settings["input_gain"])
        gates = inputs @ self.weights["weight_ih"].T + self.weights["bias_ih"]
        gates = gates + hidden @ self.weights["weight_hh"].T + self.weights["bias_hh"]
        taken, kept, candidate, shown = np.split(gates, 4, axis=1)
        cell = _sigmoid(kept) * cell + _sigmoid(taken) * np.tanh(candidate)
        return _sigmoid(shown) * np.tanh(cell), cell


def _sigmoid(values: Array) -> Array:
    return np.asarray(0.5 * (1.0 + np.tanh(0.5 * values)))
