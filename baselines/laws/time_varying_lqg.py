"""LQG whose gains follow the time: those of the plants, delays and faults that each blade has, over an episode."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines.design.controller import Array
from baselines.design.law import Law
from baselines.laws.time_varying_plan import Plan
from beamenv.knowledge import Prior, Truth
from beamenv.plant.plant import normalised
from beamenv.simulation.signals.electronics import hysteresis_of
from beamenv.simulation.signals.hysteresis import PLAYS, Hysteresis

Rows = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class TimeVaryingLQG(Law):
    """The optimum under white noise of the plant, delay and faults that each blade is taken to have, over the episode.

    It remembers the instant, what it believes of blade and loads, the voltages that are still to act, the last readings and the
    actuators' hysteresis. Its gains vary with time (``baselines.design.time_varying``): the filter's from the covariance with which
    episodes begin, the regulator's towards their end. It inverts hysteresis, takes a reading that repeats the last one for lost
    where readings are lost, and expects no more of a sensor than its full scale. Loads are not told: it estimates those that the
    scenario lets foresee (``foreseen_loads``).
    """

    known: Prior | Truth
    """The plants, the scenario and the length of episodes."""
    _plan: Plan = field(init=False)
    _hysteresis: Hysteresis | None = field(init=False)
    _limits: Array = field(init=False)
    _full_scale: Array = field(init=False)

    def __post_init__(self) -> None:
        Law.__post_init__(self)
        plant = self.known.bank.plant
        object.__setattr__(self, "_plan", Plan.of(self.known))
        object.__setattr__(self, "_hysteresis", hysteresis_of(plant, self.known.scenario.drive.hysteresis))
        object.__setattr__(self, "_limits", normalised(plant).voltage_limits)
        object.__setattr__(self, "_full_scale", plant.sensor_full_scale)

    @property
    def order(self) -> int:
        """Numbers in a blade's memory."""
        m, p = self._plan.sizes[1:]
        return 1 + self._plan.states + p + (PLAYS * m if self._hysteresis else 0)

    @abstractmethod
    def told(self, seen: Array) -> tuple[Array, Array]:
        """Readings (N, p) in A, and what each blade is taken to have (N, 2 + m + 2 p), as in ``Plan``, from what is seen (N, …)."""

    def decide(self, observation: Array, memory: Array) -> tuple[Array, Array]:
        """As a filter and a regulator, each with the gains of what the blade has and of its instant."""
        m, p = self._plan.sizes[1:]
        readings, told = self.told(self.instruments.read(np.atleast_2d(observation)))
        readings = readings / self._full_scale
        instant, belief, last, plays = np.split(np.atleast_2d(memory), np.cumsum([1, self._plan.states, p]), axis=1)
        plays = plays.reshape(len(readings), m, -1)
        now = Now.of(self._plan, told, instant[:, 0].astype(np.int64))
        belief = now.corrected(belief, readings, last if self.known.scenario.acquisition.dropout else None)
        voltage = effective = np.clip(now.wanted(belief), *self._limits)
        if self._hysteresis is not None:
            voltage = self._hysteresis.inverse(now.wanted(belief), plays, *self._limits)
            effective, plays = self._hysteresis.step(voltage, plays)
        following = np.hstack([instant + 1.0, now.following(belief, effective), readings, plays.reshape(len(readings), -1)])
        action = voltage * np.abs(self.instruments.voltage_limits).max(axis=0) / self.instruments.voltage_scale
        return action.reshape(*observation.shape[:-1], m), following.reshape(*observation.shape[:-1], -1)


@dataclass(frozen=True, slots=True, eq=False)
class Now:
    """N blades at their instants, each with the matrices of its truth: one of each where all have the same."""

    plan: Plan
    plant: Any
    """(N,) places in the bank, or one."""
    told: Array
    instant: Rows
    feedback: Array
    """(N, m, s) or (m, s)."""
    gain: Array
    """(N, s, p) or (s, p)."""

    @classmethod
    def of(cls, plan: Plan, told: Array, instant: Rows) -> Now:
        """Beyond the episode's end, with the last gains."""
        met, when = plan.met(told), np.minimum(instant, plan.known.steps - 1)
        plant = when if plan.known.bank.runs else told[:, 0].astype(np.int64)
        alike = (met == met[0]).all() and (when == when[0]).all()
        feedback, gain = ([each[k][t] for k, t in zip(met, when, strict=True)] for each in (plan.regulator, plan.filter))
        if alike:
            return cls(plan, plant[0], told, instant, feedback[0], gain[0])
        return cls(plan, plant[0] if (plant == plant[0]).all() else plant, told, instant, np.stack(feedback), np.stack(gain))

    def corrected(self, belief: Array, readings: Array, last: Array | None) -> Array:
        """The belief (N, s) after readings (N, p), of which those that repeat the ``last`` ones tell nothing."""
        n, m, p = self.plan.sizes
        start = self.plan.known.bank.start
        if start is not None:
            belief = belief + np.pad(start, ((0, 0), (0, belief.shape[1] - start.shape[1]))) * (self.instant == 0)[:, None]
        sensing, bias = self.told[:, 2 + m : 2 + m + p], self.told[:, 2 + m + p :]
        expected = _each(self.plan.plants.C[self.plant], belief[:, :n]) * sensing + bias
        news = readings - np.clip(expected, -1.0, 1.0)
        if last is not None:
            news = np.where((readings == last) & (self.instant > 0)[:, None], 0.0, news)
        return belief + _each(self.gain, news)

    def wanted(self, belief: Array) -> Array:
        """(N, m): the voltages that are to act."""
        return -_each(self.feedback, belief)

    def following(self, belief: Array, voltage: Array) -> Array:
        """The belief (N, s) of the next instant, from effective voltages (N, m) that are on their way from now on."""
        n, m, _ = self.plan.sizes
        plants, q = self.plan.plants, belief.shape[1] - n - m * self.plan.slots
        state, load, coming = np.split(belief, [n, n + q], axis=1)
        coming = np.hstack([voltage, coming])
        delay = self.told[:, 1].astype(np.int64)
        acting = coming.reshape(len(belief), -1, m)[np.arange(len(belief)), delay] * self.told[:, 2 : 2 + m]
        model = self.plan.loads[int(np.ravel(self.plant)[0])]
        turned, forces = load @ model.transition.T, load @ model.output.T
        if np.ndim(self.plant) and q:
            models = [self.plan.loads[each] for each in self.plant]
            turned = _each(np.stack([each.transition for each in models]), load)
            forces = _each(np.stack([each.output for each in models]), load)
        moved = (_each(each[self.plant], part) for each, part in ((plants.A, state), (plants.B, acting), (plants.E, forces)))
        return np.hstack([sum(moved), turned, coming[:, : m * self.plan.slots]])


def _each(matrices: Array, rows: Array) -> Array:
    """Rows (N, k) times one matrix (l, k), or each times its own (N, l, k)."""
    return rows @ matrices.T if matrices.ndim == 2 else (matrices @ rows[..., None])[..., 0]
