"""The plant exactly sampled: what voltages and loads that are held over an interval make of it, and what it costs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Number, Refused, checked
from beamenv.configuration.read_only import ReadOnly, sealed
from beamenv.plant.hold import hold_all_with_cost, hold_with_cost
from beamenv.plant.matrices import PlantMatrices
from beamenv.plant.parts import check_clock, check_parts, counts, span
from beamenv.plant.poles import poles_of_sampled

if TYPE_CHECKING:
    import control

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SampledPlant(ReadOnly):
    """A plant whose voltages and loads are held over ``interval``: exact, with the exactly integrated cost.

    x⁺ = A x + B u + E d, y = C x + D u₋ + v with u₋ the voltages of the interval before, and over one interval
    ∫(xᵀQx + uᵀRu)dt = zᵀ cost z with z = [x; u; d].
    White load and sensor noise are band-limited at the sampling rate: held loads of covariance W/Δt, samples of covariance V/Δt.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    disturbance_input: Array
    cost: Array
    """(n+m+k, n+m+k), J s."""
    process_noise: Array
    """(k, k), (N/m)²: covariance of the held white load."""
    sensor_noise: Array
    """(p, p), A²: covariance of one sample's noise."""
    interval: float
    """s."""

    def __post_init__(self) -> None:
        check_parts(self)
        check_clock(self, "interval")
        ReadOnly.__post_init__(self)

    def __repr__(self) -> str:
        magnitudes = np.abs(poles_of_sampled(self.A, self.interval))
        return f"SampledPlant({counts(self.B, self.C)}; {span(magnitudes[0], magnitudes[-1])}; {1e3 * self.interval:.4g} ms)"

    @property
    def state_weight(self) -> Array:
        """Q (n, n) of one interval."""
        n = len(self.A)
        return self.cost[:n, :n]

    @property
    def input_weight(self) -> Array:
        """R (m, m) of one interval."""
        n, m = self.B.shape
        return self.cost[n : n + m, n : n + m]

    @property
    def cross_weight(self) -> Array:
        """N (n, m) of one interval: the cost is xᵀQx + 2xᵀNu + uᵀRu when no load acts."""
        n, m = self.B.shape
        return self.cost[:n, n : n + m]

    def to_control(self) -> control.StateSpace:
        """The sampled plant from [voltages, line loads] to currents, with ``dt`` = ``interval``, as a ``control.StateSpace``."""
        from beamenv.plant.interchange import sampled_to_control

        return sampled_to_control(self)

    @classmethod
    def from_control(cls, system: control.StateSpace, like: SampledPlant, **changes: Any) -> SampledPlant:
        """A sampled plant with the dynamics of a ``control.StateSpace``, and all else as ``like`` has it; see ``interchange``."""
        from beamenv.plant.interchange import sampled_from_control

        if not isinstance(like, cls):
            raise Refused("like", like, "a SampledPlant")
        return sampled_from_control(system, like, **changes)


def sample(plant: PlantMatrices, interval: float | None = None) -> SampledPlant:
    """Discretise exactly under zero-order hold, cost included, over any interval (``beamenv.plant.hold``).

    ``interval`` in s defaults to the plant's own control interval. Raises ValueError for one that is not positive and finite, and
    where what is unstable in the plant, or no number, leaves no finite state at its end.
    """
    if not isinstance(plant, PlantMatrices):
        raise Refused("plant", plant, "a Plant")
    interval = _checked_interval(plant, interval)
    with np.errstate(over="ignore", invalid="ignore"):  # said below
        return _sampled(plant, hold_with_cost(*_problem(plant), interval), interval)


def sample_all(plants: Sequence[PlantMatrices], interval: float | None = None) -> list[SampledPlant]:
    """As ``sample`` each plant, to the last bit, of plants of one size that have one control interval or are given one."""
    interval = _checked_interval(plants[0], interval)
    A, inputs, weight = (np.array(parts) for parts in zip(*map(_problem, plants), strict=True))
    with np.errstate(over="ignore", invalid="ignore"):
        held = hold_all_with_cost(A, inputs, weight, interval)
    return [_sampled(plant, each, interval) for plant, *each in zip(plants, *held, strict=True)]


def _checked_interval(plant: PlantMatrices, interval: float | None) -> float:
    return checked("interval", plant.control_interval if interval is None else interval, Number(gt=0.0, unit="s"))


def _problem(plant: PlantMatrices) -> tuple[Array, Array, Array]:
    """A, [B E] and the running cost as a form in [x; u; d]: what is to be held over an interval."""
    (n, m), inputs = plant.B.shape, np.hstack([plant.B, plant.disturbance_input])
    weight = np.zeros((n + inputs.shape[1],) * 2)
    weight[:n, :n], weight[n : n + m, n : n + m] = plant.state_weight, plant.input_weight
    cross = np.asarray(plant.cross_weight)
    weight[:n, n : n + m], weight[n : n + m, :n] = cross, cross.T
    return plant.A, inputs, weight


def _sampled(plant: PlantMatrices, held: Sequence[Array], interval: float) -> SampledPlant:
    A, B, cost = held
    m = plant.B.shape[1]
    if not all(np.isfinite(part).all() for part in held):
        raise ValueError(f"interval = {interval!r} s leaves the plant without a finite state: it is unstable, or holds no numbers.")
    return SampledPlant(
        A=A,
        B=B[:, :m],
        C=plant.C,
        D=plant.D,
        disturbance_input=B[:, m:],
        cost=cost,
        process_noise=sealed(plant.process_noise / interval),
        sensor_noise=sealed(plant.sensor_noise / interval),
        interval=interval,
    )
