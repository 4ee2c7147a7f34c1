"""Models of line loads that can be foreseen, as part of the plant: a filter can estimate them and a regulator answer them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any, Protocol

import numpy as np
from scipy.linalg import block_diag

from baselines.design.riccati import Array
from beamenv.configuration import Number, Refused
from beamenv.plant.plant import Plant, SampledPlant

MAGNITUDE = Number(ge=1e-6, le=1e6, unit="N/m")
"""Root mean square of a load: far beyond what a blade stands, and far from where squares leave the numbers."""

DURATION = Number(ge=1e-6, le=1e3, unit="s")
"""Time in which a load forgets itself."""


@dataclass(frozen=True, slots=True, eq=False)
class LoadModel:
    """Line loads d = output ξ whose q states move by themselves, ξ⁺ = transition ξ + w, from one control interval to the next."""

    transition: Array
    """(q, q): its eigenvalues must lie within the unit circle, for no voltage can stop a load."""
    output: Array
    """(k, q), N/m per unit of ξ: lag, flap, or whatever disturbances the plant has."""
    noise: Array
    """(q, q): covariance of w in one interval."""

    def __add__(self, other: LoadModel) -> LoadModel:
        """Both loads at once, independent of each other."""
        return LoadModel(
            transition=block_diag(self.transition, other.transition),
            output=np.hstack([self.output, other.output]),
            noise=block_diag(self.noise, other.noise),
        )


class Load(Protocol):
    """What the load is, apart from the clock it is sampled by."""

    def model(self, interval: float, disturbances: int = 2) -> LoadModel:
        """The load from one control interval (s) to the next, of so many disturbances; those of a blade are two line loads."""
        ...


def model_of(load: Load, plant: Plant) -> LoadModel:
    """A load as a plant meets it: where load cases are made of other disturbances than two line loads, of as many, and scaled as
    those of scenarios are (``Plant.load_scale``, ``Plant.time_scale``). ``ValueError`` for a model of another number of them.
    """
    scale, loads = plant.load_scale, plant.loads
    interval = plant.scenario_interval
    model = load.model(interval) if loads == 2 else load.model(interval, loads)
    if len(model.output) != loads:
        raise Refused("load", load, f"one whose model has {loads} outputs, as many as the plant has disturbances that are loads")
    if loads == len(scale) and np.all(scale == 1.0):
        return model
    return replace(model, output=np.eye(len(scale), loads) @ (scale[:loads, None] * model.output))


def checked_loads(name: str, load: Any) -> tuple[Load, ...]:
    """The loads, of one or of a list of them, none for None; ``ValueError`` for what has no model."""
    loads = () if load is None else tuple(load) if isinstance(load, (list, tuple)) else (load,)
    if not all(callable(getattr(each, "model", None)) and not isinstance(each, type) for each in loads):
        raise Refused(name, load, "None, a load that can be foreseen, such as PersistentLoad(), or a list of them")
    if any(each == other for each, other in combinations(loads, 2)):
        raise Refused(name, load, "a list of loads that differ from each other: no reading tells two equal ones apart")
    return loads


def with_load(held: SampledPlant, load: LoadModel) -> SampledPlant:
    """The plant with state [x; ξ], ξ (q,) that of the load, and with disturbances [white load; w].

    The cost stays the plant's own: the load bends the blade, and that energy counts.
    """
    (n, m), k, q = held.B.shape, held.disturbance_input.shape[1], len(load.transition)
    total = np.zeros((n + m + k, n + q + m + k + q))  # [x, u, white + d] from [x, ξ, u, white, w]
    total[:n, :n] = np.eye(n)
    total[n : n + m, n + q : n + q + m] = np.eye(m)
    total[n + m :, n : n + q] = load.output
    total[n + m :, n + q + m : n + q + m + k] = np.eye(k)
    return replace(
        held,
        A=np.block([[held.A, held.disturbance_input @ load.output], [np.zeros((q, n)), load.transition]]),
        B=np.vstack([held.B, np.zeros((q, m))]),
        C=np.hstack([held.C, np.zeros((len(held.C), q))]),
        disturbance_input=block_diag(held.disturbance_input, np.eye(q)),
        cost=total.T @ held.cost @ total,
        process_noise=block_diag(held.process_noise, load.noise),
    )
