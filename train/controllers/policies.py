"""Trained policies as arrays and formulae: NumPy alone runs them, and loading one executes no code."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from baselines.design.predicting import observed, remembered
from beamenv.configuration import Refused

_LARGEST = 1e30
"""Of a reading: beyond it single precision, in which policies are, runs over."""
Array = NDArray[np.floating[Any]]


@dataclass(frozen=True, slots=True, eq=False)
class Policy:
    """An agent with Stable-Baselines3's ``predict`` that reads the sensors and its own voltages, both normalised.

    Its memory (N, k) ends in the voltages it asked for last, as the drive limits let them through.
    """

    kind: ClassVar[str]
    physical_units: ClassVar[bool] = False
    """Of the environment that it can act in: what it reads and drives is normalised."""
    name: str
    """What tables and figures call it."""
    weights: Mapping[str, Array]
    settings: Mapping[str, Any]
    """Whatever ``weights`` do not tell; JSON can hold it."""
    lowest: Array
    highest: Array
    """(m,) drive limits in units of the larger one."""

    def predict(
        self,
        observation: ArrayLike,
        state: Array | None = None,
        episode_start: ArrayLike | None = None,
        deterministic: bool = True,
    ) -> tuple[Array, Array]:
        """Action (m,) or (N, m) and the next memory; ``observation`` (p,) or (N, p) as the environment gives it.

        Raises ValueError as a ``Law`` does.
        """
        readings = observed(observation, self.name)
        if np.abs(readings).max(initial=0.0) > _LARGEST:
            raise Refused("observation", observation, f"no larger than {_LARGEST:.0e}, with which single precision can reckon")
        readings = readings.astype(np.float32)
        single = readings.ndim == 1
        rows = np.atleast_2d(readings)
        memory: Array = remembered(state, episode_start, (len(rows),), self.memory_size)
        memory = memory.astype(np.float32) if state is None else memory
        try:
            action, following = self.act(rows, memory)
        except ValueError:
            raise ValueError(
                f"observation has shape {readings.shape}, which is not what {self.name} was trained to read."
            ) from None
        action = np.clip(action, self.lowest, self.highest)
        following[:, -action.shape[1] :] = action
        return (action[0] if single else action), following

    def knowing(self, memory: Array, voltages: Array) -> Array:
        """The memory (N, k) after its last action was overruled: (N, m) ``voltages`` were held in its place."""
        return np.hstack([memory[:, : -voltages.shape[1]], voltages])

    @property
    def memory_size(self) -> int:
        """Numbers in a blade's memory, k."""
        raise NotImplementedError

    def act(self, readings: Array, memory: Array) -> tuple[Array, Array]:
        """Action (N, m) before saturation, and the next memory, whose voltages the caller fills in."""
        raise NotImplementedError


class HistoryPolicy(Policy):
    """A network on the last instants, laid out as ``beamenv.envs.history.RollingHistory`` does, asked every few instants.

    Its settings are ``input_gain``, ``held`` and, if they are not "tanh", false and 1, ``activation`` ("tanh" or "relu") of the
    hidden layers, ``squashed``: whether the output is a tanh, too, and ``approach``: the share of the way from the voltages held
    before to those that the network asks for.

    Its memory is [window | intervals the voltages have been held | voltages].
    """

    __slots__ = ()
    kind = "history"

    @property
    def memory_size(self) -> int:
        """The window, a count and the last voltages."""
        return int(self.weights["weight0"].shape[1]) + 1 + len(self.lowest)

    def act(self, readings: Array, memory: Array) -> tuple[Array, Array]:
        """Shift the window; where it is time, layer by layer to new voltages."""
        m = len(self.lowest)
        instant = readings.shape[1] + m
        if self.weights["weight0"].shape[1] % instant:
            raise ValueError(f"instants of {instant} numbers do not fill the window.")
        age, voltages = memory[:, -m - 1 : -m], memory[:, -m:]
        window = np.hstack([memory[:, instant : -m - 1], readings, voltages])
        asked = network(self.weights, self.settings, window)
        action = np.where(age == 0.0, towards(asked, voltages, self.settings), voltages)
        return action, np.hstack([window, (age + 1.0) % self.settings["held"], voltages]).astype(np.float32)


def network(weights: Mapping[str, Array], settings: Mapping[str, Any], inputs: Array) -> Array:
    """(N, m): what the layers ``weight0``, ``bias0``, … make of inputs (N, k)."""
    hidden, depth = inputs * np.float32(settings["input_gain"]), sum(name.startswith("bias") for name in weights)
    activation = _rectified if settings.get("activation") == "relu" else np.tanh
    for layer in range(depth):
        hidden = hidden @ weights[f"weight{layer}"].T + weights[f"bias{layer}"]
        hidden = activation(hidden) if layer < depth - 1 else hidden
    return np.tanh(hidden) if settings.get("squashed") else hidden


def towards(asked: Array, voltages: Array, settings: Mapping[str, Any]) -> Array:
    """Voltages (N, m) a share ``approach`` of the way from those held before to those asked for, within the unit box."""
    share = settings.get("approach", 1.0)
    if share == 1.0:
        return asked
    return np.asarray(voltages + np.float32(share) * (np.clip(asked, -1.0, 1.0) - voltages))


def _rectified(values: Array) -> Array:
    return np.maximum(values, np.float32(0.0))


class RecurrentPolicy(Policy):
    """A gated recurrent unit with a tanh output (Cho et al. 2014, as torch's ``GRUCell`` has it)."""

    __slots__ = ()
    kind = "recurrent"

    @property
    def memory_size(self) -> int:
        """Hidden units, and the last voltages."""
        return int(self.weights["weight_hh"].shape[1]) + len(self.lowest)

    def act(self, readings: Array, memory: Array) -> tuple[Array, Array]:
        """One step of the unit, then the output layer."""
        units = self.weights["weight_hh"].shape[1]
        hidden, voltages = memory[:, :units], memory[:, units:]
        inputs = np.hstack([readings * np.float32(self.settings["input_gain"]), voltages])
        hidden, action = gated_unit(self.weights, inputs, hidden)
        return action, np.hstack([hidden, np.zeros_like(action)])


class StateSpacePolicy(Policy):
    """A linear law whose memory is that of a filter: [ξ, y'] @ fused = [ξ⁺ before feedback, u], and ξ⁺ gains clip(u) @ feedback.

    y' = y + (C ξ − clip(C ξ)) with C ξ = ξ @ readout, the readings that are expected: with it the innovation y' − C ξ is
    y − clip(C ξ), that of a filter which knows that readings clip. Its memory is [ξ | voltages].
    """

    __slots__ = ()
    kind = "state-space"

    @property
    def memory_size(self) -> int:
        """The filter's memory, and the last voltages."""
        return int(self.weights["feedback"].shape[1]) + len(self.lowest)

    def act(self, readings: Array, memory: Array) -> tuple[Array, Array]:
        """One product, and what the drive lets through of it."""
        asked, onward = linear_law(self.weights, readings, memory[:, : self.weights["feedback"].shape[1]])
        action = np.clip(asked, self.lowest, self.highest)
        return action, np.hstack([onward + action @ self.weights["feedback"], action])

    def knowing(self, memory: Array, voltages: Array) -> Array:
        """The filter, too, goes by the voltages that were held."""
        return np.hstack([_corrected(self.weights, memory, voltages), voltages])


class ResidualPolicy(Policy):
    """Adds to a linear law and weighs it: u = clip((1 + g) ∘ u_lin + r), [g, r] the tanh output of a gated recurrent unit.

    The law is that of a ``StateSpacePolicy``. Its memory is [hidden units | the law's | voltages].
    """

    __slots__ = ()
    kind = "residual"

    @property
    def memory_size(self) -> int:
        """Hidden units, the law's memory and the last voltages."""
        return int(self.weights["weight_hh"].shape[1]) + int(self.weights["feedback"].shape[1]) + len(self.lowest)

    def act(self, readings: Array, memory: Array) -> tuple[Array, Array]:
        """The law, the unit, and what both ask for."""
        units, order = self.weights["weight_hh"].shape[1], self.weights["feedback"].shape[1]
        hidden, linear, voltages = memory[:, :units], memory[:, units : units + order], memory[:, units + order :]
        asked, onward = linear_law(self.weights, readings, linear)
        asked = np.clip(asked, self.lowest, self.highest)
        inputs = np.hstack([readings * np.float32(self.settings["input_gain"]), voltages, asked])
        hidden, output = gated_unit(self.weights, inputs, hidden)
        weight, added = np.split(output, 2, axis=1)
        action = np.clip((1.0 + weight) * asked + added, self.lowest, self.highest)
        return action, np.hstack([hidden, onward + action @ self.weights["feedback"], action])

    def knowing(self, memory: Array, voltages: Array) -> Array:
        """The law's estimate, too, goes by the voltages that were held."""
        units = self.weights["weight_hh"].shape[1]
        return np.hstack([memory[:, :units], _corrected(self.weights, memory[:, units:], voltages), voltages])


def linear_law(weights: Mapping[str, Array], readings: Array, memory: Array) -> tuple[Array, Array]:
    """Voltages (N, m) that a law of these ``fused`` and ``readout`` asks for, and its next memory (N, s) before feedback."""
    predicted = memory @ weights["readout"]
    given = readings + predicted - np.clip(predicted, -1.0, 1.0)
    product = np.hstack([memory, given]) @ weights["fused"]
    return product[:, memory.shape[1] :], product[:, : memory.shape[1]]


def _corrected(weights: Mapping[str, Array], memory: Array, voltages: Array) -> Array:
    """The law's part (N, s) of a memory [ξ | voltages] once other ``voltages`` were held."""
    m = voltages.shape[1]
    return memory[:, :-m] + (voltages - memory[:, -m:]) @ weights["feedback"]


def gated_unit(weights: Mapping[str, Array], inputs: Array, hidden: Array) -> tuple[Array, Array]:
    """Hidden units (N, units) and tanh outputs of a gated recurrent unit, as torch's ``GRUCell`` and a linear layer have them."""
    from_input = np.split(inputs @ weights["weight_ih"].T + weights["bias_ih"], 3, axis=1)
    from_hidden = np.split(hidden @ weights["weight_hh"].T + weights["bias_hh"], 3, axis=1)
    reset, update = (_sigmoid(a + b) for a, b in zip(from_input[:2], from_hidden[:2], strict=True))
    candidate = np.tanh(from_input[2] + reset * from_hidden[2])
    hidden = (1.0 - update) * candidate + update * hidden
    return hidden, np.tanh(hidden @ weights["weight_out"].T + weights["bias_out"])


def _sigmoid(values: Array) -> Array:
    return np.asarray(0.5 * (1.0 + np.tanh(0.5 * values)))
