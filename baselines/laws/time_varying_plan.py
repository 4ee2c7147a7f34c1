"""The gains of a law that is told what each episode has, worked out when such a truth is first met."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import reduce
from operator import add

import numpy as np
from numpy.typing import NDArray

from baselines.design.controller import Array
from baselines.design.load_model import LoadModel, model_of
from baselines.design.lyapunov import accumulated
from baselines.design.time_varying import Stage, filter_gains, regulator_gains
from baselines.laws.foreseen_load import foreseen_loads, mean_square
from baselines.laws.lqg import known_sensor_noise
from beamenv.knowledge import Prior, Truth
from beamenv.plant.plant import normalised
from beamenv.simulation.plants.sampled_bank import SampledBank, sampled_bank

Rows = NDArray[np.int64]

FREE = 1e-9
"""Of the price of an actuator's voltage: what that of one that does nothing, or nothing yet, is taken to cost."""


@dataclass(slots=True, eq=False)
class Plan:
    """Gains by truth and instant; state [x; loads ξ; effective voltages of the last D intervals, the newest first].

    A truth is a row [place in the bank, delay, gains of actuators (m), gains of sensors (p), biases (p)]. Where plants follow one
    another, an instant has that of its own.
    """

    known: Prior | Truth
    plants: SampledBank
    loads: tuple[LoadModel, ...]
    """Of each plant's speed."""
    white: tuple[Array, Array]
    """Covariances of the white load, (N/m)², and of one sample's noise, normalised."""
    places: dict[bytes, int] = field(default_factory=dict)
    regulator: list[Array] = field(default_factory=list)
    """(T, m, s) of each truth that was met."""
    filter: list[Array] = field(default_factory=list)
    """(T, s, p)."""

    @classmethod
    def of(cls, known: Prior | Truth) -> Plan:
        """Without any gains yet; ``ValueError`` for a bank of several blades, or of plants that wander."""
        bank, scenario, plant = known.bank, known.scenario, normalised(known.bank.plant)
        if bank.groups > 1:
            raise ValueError(f"truth has a bank of {bank.groups} blades, but must have that of a single one.")
        if bank.walk is not None:
            raise ValueError("truth has plants that wander within an episode, but allowed are one an episode, and a spin-up's.")
        if not scenario.sensor_noise:
            plant = replace(plant, sensor_noise=np.zeros_like(plant.sensor_noise))
        models = {speed: _model(known, speed) for speed in dict.fromkeys(bank.speeds.tolist())}
        white = scenario.white_load * plant.process_noise, known_sensor_noise(plant)
        covariances = white[0] / plant.control_interval, white[1] / plant.control_interval
        return cls(known, sampled_bank(bank), tuple(models[speed] for speed in bank.speeds.tolist()), covariances)

    @property
    def sizes(self) -> tuple[int, int, int]:
        """n, m, p."""
        return len(self.plants.A[0]), self.plants.B.shape[2], self.plants.C.shape[1]

    @property
    def slots(self) -> int:
        """D: intervals by which a voltage may come late."""
        return self.known.scenario.drive.delay[1]

    @property
    def states(self) -> int:
        """How many numbers its state has, s."""
        n, m, _ = self.sizes
        return n + len(self.loads[0].transition) + m * self.slots

    def met(self, told: Array) -> Rows:
        """(N,): the place of each truth (N, 2 + m + 2 p), the gains of new ones worked out together."""
        kept = told.copy()
        kept[:, -self.sizes[2] :] = 0.0  # biases, which are told and taken off
        if self.known.bank.runs:
            kept[:, 0] = 0.0
        keys = [row.tobytes() for row in kept]
        new = {key: row for key, row in zip(keys, kept, strict=True) if key not in self.places}
        if new:
            self._work_out(np.array(list(new.values())))
            self.places.update({key: len(self.places) + k for k, key in enumerate(new)})
        return np.array([self.places[key] for key in keys], dtype=np.int64)

    def _work_out(self, told: Array) -> None:
        steps, runs = self.known.steps, self.known.bank.runs
        plants = [np.full(len(told), k) for k in range(steps)] if runs else [told[:, 0].astype(np.int64)] * steps
        always = None if runs else self.stage(plants[0], told)
        stages = (always or self.stage(each, told) for each in plants)
        gains, _ = filter_gains(stages, self.beginning(plants[0]))
        last_first = (always or self.stage(each, told) for each in plants[::-1])
        feedback, _ = regulator_gains(last_first, np.zeros((len(told), self.states, self.states)))
        self.filter += list(gains.swapaxes(0, 1))
        self.regulator += list(feedback.swapaxes(0, 1))

    def stage(self, plant: Rows, told: Array) -> Stage:
        """A control interval of G truths whose plants are these (G,) of the bank."""
        (n, m, p), s = self.sizes, self.states
        q, size = s - n - m * self.slots, len(plant)
        delay, working, sensing = told[:, 1].astype(np.int64), told[:, 2 : 2 + m], told[:, 2 + m : 2 + m + p]
        loads = [self.loads[each] for each in plant]
        driven = np.zeros((size, n + m + self.plants.E.shape[2], s + m))  # [x, what acts, d] from [x, ξ, voltages to come, u]
        driven[:, :n, :n] = np.eye(n)
        first = np.where(delay == 0, s, n + q + m * (delay - 1))
        rows, each = np.arange(size)[:, None], np.arange(m)
        driven[rows, n + each, first[:, None] + each] = working
        driven[:, n + m :, n : n + q] = [load.output for load in loads]
        moved = np.concatenate([self.plants.A[plant], self.plants.B[plant], self.plants.E[plant]], axis=2) @ driven
        onward = np.zeros((size, s, s + m))
        onward[:, :n] = moved
        onward[:, n : n + q, n : n + q] = [load.transition for load in loads]
        if self.slots:
            onward[:, n + q :, n + q : s - m] = np.eye(m * self.slots, m * (self.slots - 1), -m)
            onward[:, n + q : n + q + m, s:] = np.eye(m)
        return Stage(A=onward[..., :s], B=onward[..., s:], **self._weights(plant, driven), **self._noise(plant, loads, sensing))

    def _weights(self, plant: Rows, driven: Array) -> dict[str, Array]:
        (n, m, _), s = self.sizes, self.states
        whole = self.plants.cost[plant]
        cost = driven.swapaxes(-1, -2) @ whole @ driven
        price = FREE * np.diagonal(whole[:, n : n + m, n : n + m], axis1=-2, axis2=-1)
        return {"Q": cost[:, :s, :s], "N": cost[:, :s, s:], "R": cost[:, s:, s:] + price[..., None] * np.eye(m)}

    def _noise(self, plant: Rows, loads: list[LoadModel], sensing: Array) -> dict[str, Array]:
        (n, _, p), s = self.sizes, self.states
        q, E, C = len(loads[0].transition), self.plants.E[plant], np.zeros((len(plant), p, s))
        C[:, :, :n] = self.plants.C[plant] * sensing[..., None]
        W = np.zeros((len(plant), s, s))
        W[:, :n, :n] = E @ self.white[0] @ E.swapaxes(-1, -2)
        W[:, n : n + q, n : n + q] = [load.noise for load in loads]
        return {"C": C, "W": W, "V": self.white[1]}

    def beginning(self, plant: Rows) -> Array:
        """(G, s, s): covariance of the state at t = 0: of static deflections that are released, and of loads that may be on."""
        bank, scenario, n = self.known.bank, self.known.scenario, self.sizes[0]
        release, own = bank.release[plant] * bank.plant.load_scale[:, None], bank.release.shape[-1]
        begun = np.zeros((len(plant), self.states, self.states))
        released = scenario.deflection * mean_square(scenario.magnitude) / max(bank.plant.loads, 1)
        begun[:, :own, :own] = released * release.swapaxes(-1, -2) @ release
        for row, each in zip(begun, plant, strict=True):
            load = self.loads[each]
            q = len(load.transition)
            row[n : n + q, n : n + q] = accumulated(load.transition, load.noise) if q else 0.0
        return begun


def _model(known: Prior | Truth, speed: float) -> LoadModel:
    plant = known.bank.plant
    none = LoadModel(np.zeros((0, 0)), np.zeros((plant.disturbance_input.shape[1], 0)), np.zeros((0, 0)))
    return reduce(add, (model_of(load, plant) for load in foreseen_loads(known.scenario, speed, plant.loads)), none)
