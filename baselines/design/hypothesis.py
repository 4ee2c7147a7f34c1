"""What may be the case with a blade: its plant, and what is wrong between the controller and it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from operator import add
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import block_diag, solve_discrete_lyapunov

from baselines.design.controller import Array
from baselines.design.feedthrough import with_feedthrough
from baselines.design.instruments import checked_plant
from baselines.design.load_model import Load, LoadModel, checked_loads, model_of, with_load
from baselines.design.matrix import one_or_each
from beamenv.configuration import Count, Flag, Number, Refused, checked
from beamenv.configuration.read_only import ReadOnly, sealed
from beamenv.plant.plant import Plant, SampledPlant, sample
from beamenv.scenarios.load_cases import static_deflection
from beamenv.scenarios.tables import STRONGEST

BIAS_LASTS = 10.0
"""s: correlation time of a sensor's bias. A blade's episodes are much shorter, and the filter's equation has a solution."""


@dataclass(frozen=True, slots=True, eq=False)
class Hypothesis(ReadOnly):
    """One of the cases that a multiple-model controller considers, taken to hold throughout an episode.

    Voltages u asked for act ``delay`` control intervals later, as g u; readings are s C x + b + v. Raises ``ValueError`` of one
    sentence for what is out of range or of another number than the plant's voltages or sensors.
    """

    plant: Plant
    """The blade's, as it would be without faults."""
    delay: int = 0
    """Control intervals by which voltages come late."""
    actuator_gain: Any = 1.0
    """g, a number or (m,), from 0 to 1: 0 for an actuator that does nothing and stores nothing."""
    sensor_gain: Any = 1.0
    """s, a number or (p,), from 0 to 1: 0 for a sensor that shows noise alone."""
    sensor_bias: Any = 0.0
    """b, a number or (p,): root mean square of the bias that each sensor may have, of its full scale."""
    load: Load | Sequence[Load] | None = None
    """Loads that can be foreseen, such as ``PersistentLoad()``."""
    deflection: float = 0.0
    """N/m: root mean square, in lag and in flap each, of the static line load that the blade is released from at the start."""
    holds_lost_readings: bool = False
    """Whether a lost reading shows as the one before once more."""
    prior: float = 1.0
    """How likely it is beforehand, relative to the others."""

    def __post_init__(self) -> None:
        plant = checked_plant(self.plant)
        m, p = plant.B.shape[1], len(plant.C)
        keep = {
            "delay": checked("delay", self.delay, Count(0, 100)),
            "actuator_gain": _each("actuator_gain", self.actuator_gain, m, "voltage"),
            "sensor_gain": _each("sensor_gain", self.sensor_gain, p, "sensor"),
            "sensor_bias": _each("sensor_bias", self.sensor_bias, p, "sensor"),
            "load": checked_loads("load", self.load),
            "deflection": checked("deflection", self.deflection, Number(ge=0.0, le=STRONGEST, unit="N/m")),
            "holds_lost_readings": checked("holds_lost_readings", self.holds_lost_readings, Flag()),
            "prior": checked("prior", self.prior, Number(gt=0.0)),
        }
        for name, value in keep.items():
            object.__setattr__(self, name, value)
        ReadOnly.__post_init__(self)

    @property
    def loads(self) -> tuple[Load, ...]:
        """Each of them."""
        return checked_loads("load", self.load)

    @property
    def faulty_plant(self) -> Plant:
        """The plant from voltages as they come to readings without bias; what an actuator does not do costs nothing.

        A voltage that does nothing keeps a price, so that there is a best one: none.
        """
        g, s, R = self.actuator_gain, self.sensor_gain, self.plant.input_weight
        return replace(
            self.plant,
            B=sealed(self.plant.B * g),
            C=sealed(s[:, None] * self.plant.C),
            D=sealed(s[:, None] * self.plant.D * g),
            cross_weight=sealed(np.asarray(self.plant.cross_weight) * g),
            input_weight=sealed(R * np.outer(g, g) + np.diag(np.diag(R) * (1.0 - g**2))),
        )

    @property
    def foreseen(self) -> LoadModel | None:
        """All the loads in one; None without any."""
        models = [model_of(load, self.plant) for load in self.loads]
        return reduce(add, models) if models else None

    def sampled(self, biased: bool) -> SampledPlant:
        """What a filter believes in: the faulty plant with states [x; ξ; b] of loads and, if ``biased``, of p sensors' biases."""
        held, load = with_feedthrough(sample(self.faulty_plant), self.plant.D.any(axis=1)), self.foreseen
        held = held if load is None else with_load(held, load)
        return _with_bias(held, self._bias) if biased else held

    def covariance_at_start(self, biased: bool) -> Array:
        """Of [x; ξ; b] before the first reading: deflected and at rest, loads and biases as they are at any time."""
        bent, load = np.zeros_like(self.plant.disturbance_input.T), self.foreseen
        if self.deflection > 0.0:
            bent = self.deflection * static_deflection(self.plant, np.diag(self.plant.load_scale))
        parts = [bent.T @ bent]
        if felt := int(self.plant.D.any(axis=1).sum()):
            parts.append(np.zeros((felt, felt)))  # no voltage is on before the start
        if load is not None:
            parts.append(solve_discrete_lyapunov(load.transition, load.noise))
        if biased:
            parts.append(np.diag(self._bias**2))
        return np.asarray(block_diag(*parts))

    @property
    def _bias(self) -> Array:
        return np.asarray(self.sensor_bias * self.plant.sensor_full_scale)


def _each(name: str, value: Any, count: int, of: str) -> Array:
    """One number for each, from 0 to 1, read-only."""
    numbers = one_or_each(name, value, count, of)
    if numbers.min() < 0.0 or numbers.max() > 1.0:
        raise Refused(name, numbers.tolist(), f"a number from 0 to 1, or {count} of them, one for each {of}")
    return sealed(numbers.copy())


def _with_bias(held: SampledPlant, bias: ArrayLike) -> SampledPlant:
    """The plant with state [x; b], b (p,) in A what each sensor shows too much, all but constant, of root mean square ``bias``."""
    (n, m), k, p = held.B.shape, held.disturbance_input.shape[1], len(held.C)
    decay, forgotten = np.exp(-held.interval / BIAS_LASTS), -np.expm1(-2.0 * held.interval / BIAS_LASTS)
    own = np.concatenate([np.arange(n), np.arange(n + p, n + p + m + k)])
    cost = np.zeros((n + 2 * p + m + k,) * 2)
    cost[np.ix_(own, own)] = held.cost
    return replace(
        held,
        A=block_diag(held.A, decay * np.eye(p)),
        B=np.vstack([held.B, np.zeros((p, m))]),
        C=np.hstack([held.C, np.eye(p)]),
        disturbance_input=block_diag(held.disturbance_input, np.eye(p)),
        cost=cost,
        process_noise=block_diag(held.process_noise, forgotten * np.diag(np.square(bias))),
    )


def with_voltages_before(held: SampledPlant, delay: int, depth: int) -> SampledPlant:
    """The plant with state [x; u₋₁; …; u₋d], the last ``depth`` voltages asked for, which act ``delay`` intervals late."""
    if depth == 0:
        return held
    (n, m), k = held.B.shape, held.disturbance_input.shape[1]
    rest = depth * m
    acting = np.eye(m, rest + m, k=(delay - 1) * m if delay else rest)  # of [u₋₁; …; u]
    shift = np.vstack([np.zeros((m, rest)), np.eye(rest - m, rest)])
    kept = block_diag(np.eye(n), acting, np.eye(k))  # [x; acting; d] of [x; u₋₁; …; u; d]
    return replace(
        held,
        A=np.block([[held.A, held.B @ acting[:, :rest]], [np.zeros((rest, n)), shift]]),
        B=np.vstack([held.B @ acting[:, rest:], np.eye(rest, m)]),
        C=np.hstack([held.C, np.zeros((len(held.C), rest))]),
        disturbance_input=np.vstack([held.disturbance_input, np.zeros((rest, k))]),
        cost=kept.T @ held.cost @ kept,
    )
