"""The plant: matrices that cannot be changed, in continuous time and exactly sampled.

State ``x = [ω η; η̇]`` in energy coordinates: η are the coordinates of mass-normalised modes, so that
½ xᵀx is the vibration energy in joules. States of filters and amplifiers may follow (``beamenv.plant.electronics``), which have
no energy. The dynamics are

    ẋ = A x + B u + E d,        y = C x + D u + v

with u the actuator voltages (V), d the uniform line loads in lag and flap (N/m) and y the sensed currents (A).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Count, Instance, Number, checked
from beamenv.configuration.arrays import shaped_array
from beamenv.configuration.read_only import ReadOnly, sealed
from beamenv.plant.hold import hold_all_with_cost, hold_with_cost
from beamenv.plant.poles import poles_of_sampled

if TYPE_CHECKING:
    import control

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Plant(ReadOnly):
    """Reduced-order blade with patches: n = 2r states, m voltages, p sensors, d = 2 line loads.

    ``ValueError`` of one sentence for a part that is no array of real numbers with as many dimensions.

    The cost it is judged by is J = ∫ (xᵀ Q x + uᵀ R u) dt (thesis Eqs. 5.7–5.9, corrected).
    """

    A: Array
    """(n, n), 1/s."""
    B: Array
    """(n, m), √J/s per V."""
    C: Array
    """(p, n), A per √J."""
    D: Array
    """(p, m), A/V; zero for current sensing."""
    disturbance_input: Array
    """E (n, 2), √J/s per N/m of uniform line load: lag, flap."""
    tip_displacement: Array
    """(2, n), m per √J: lag, flap at z = L."""
    strain: Array
    """(k, n), spanwise strain per √J at points of the outer face."""
    natural_frequencies: Array
    """(r,), rad/s, of the retained undamped modes without gyroscopic coupling, ascending."""
    state_weight: Array
    """Q (n, n): ½ I, the vibration energy in joules; zero for the electronics."""
    input_weight: Array
    """R (m, m), J/V²: ρ Fᵀ K⁻¹ F, the energy the actuators can store."""
    process_noise: Array
    """W (2, 2), (N/m)² s: intensity of the white line loads."""
    sensor_noise: Array
    """V (p, p), A² s: intensity of the sensor noise."""
    voltage_limits: Array
    """(2, m), V: lower and upper drive limit of each voltage."""
    sensor_full_scale: Array
    """(p,), A: the current that a sensor reading of 1 stands for."""
    control_interval: float
    """s: sensors are sampled, voltages and loads are held over this interval."""
    electronic_states: int = 0
    """How many of the n states, the last, are those of filters and amplifiers."""

    def __post_init__(self) -> None:
        _check_parts(self)
        _check_clock(self, "control_interval")
        n, electronic = len(self.A), self.electronic_states
        object.__setattr__(self, "electronic_states", checked("plant.electronic_states", electronic, Count(0, n)))
        ReadOnly.__post_init__(self)

    def __repr__(self) -> str:
        return f"Plant({self.sizes})"

    @property
    def blade_states(self) -> int:
        """How many of the n states, the first, are the blade's: ½ the sum of their squares is the energy."""
        return len(self.A) - self.electronic_states

    @property
    def sizes(self) -> str:
        """In one line: how many states, voltages and sensors; first and last frequency; clock and limits."""
        first, last = self.natural_frequencies[[0, -1]]
        low, high = self.voltage_limits[0].min(), self.voltage_limits[1].max()
        return f"{_counts(self.B, self.C)}; {_range(first, last)}; {1e3 * self.control_interval:.4g} ms; {low:.5g} … {high:.5g} V"

    def to_control(self) -> control.StateSpace:
        """The plant from [voltages, line loads] to [currents, tip displacements] as a ``control.StateSpace``."""
        from beamenv.plant.interchange import plant_to_control

        return plant_to_control(self)

    @classmethod
    def from_control(cls, system: control.StateSpace, like: Plant, **changes: Any) -> Plant:
        """A plant with the dynamics of a ``control.StateSpace``, and all else as ``like`` has it; see ``interchange``."""
        from beamenv.plant.interchange import plant_from_control

        return plant_from_control(system, like, **changes)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SampledPlant(ReadOnly):
    """A plant whose voltages and loads are held over ``interval``: exact, with the exactly integrated cost.

    x⁺ = A x + B u + E d, y = C x + D u + v, and over one interval ∫(xᵀQx + uᵀRu)dt = zᵀ cost z with z = [x; u; d].
    White load and sensor noise are band-limited at the sampling rate: held loads of covariance W/Δt, samples of covariance V/Δt.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    disturbance_input: Array
    cost: Array
    """(n+m+2, n+m+2), J s."""
    process_noise: Array
    """(2, 2), (N/m)²: covariance of the held white load."""
    sensor_noise: Array
    """(p, p), A²: covariance of one sample's noise."""
    interval: float
    """s."""

    def __post_init__(self) -> None:
        _check_parts(self)
        _check_clock(self, "interval")
        ReadOnly.__post_init__(self)

    def __repr__(self) -> str:
        magnitudes = np.abs(poles_of_sampled(self.A, self.interval))
        return f"SampledPlant({_counts(self.B, self.C)}; {_range(magnitudes[0], magnitudes[-1])}; {1e3 * self.interval:.4g} ms)"

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

        return sampled_from_control(system, like, **changes)


_ROWS = ("natural_frequencies", "sensor_full_scale")
_ONES = ("control_interval", "interval", "electronic_states")


def _check_parts(plant: Any) -> None:
    """Each part as an array; ``ValueError`` for one that is none of real numbers, or of another number of dimensions."""
    for name in (each.name for each in fields(plant) if each.name not in _ONES):
        given = getattr(plant, name)
        wanted = 1 if name in _ROWS else 2
        there = shaped_array(f"plant.{name}", given, (None,) * wanted, "a row" if wanted == 1 else "rows and columns")
        if there is not given:
            object.__setattr__(plant, name, there)


def _check_clock(plant: Any, name: str) -> None:
    object.__setattr__(plant, name, checked(f"plant.{name}", getattr(plant, name), Number(gt=0.0, unit="s")))


def _counts(B: Array, C: Array) -> str:
    return f"{B.shape[0]} states, {B.shape[1]} voltages, {len(C)} sensors"


def _range(first: float, last: float) -> str:
    return f"{first:.4g} … {last:.4g} rad/s"


def sample(plant: Plant, interval: float | None = None) -> SampledPlant:
    """Discretise exactly under zero-order hold, cost included, over any interval (``beamenv.plant.hold``).

    ``interval`` in s defaults to the plant's own control interval. Raises ValueError for one that is not positive and finite, and
    where what is unstable in the plant, or no number, leaves no finite state at its end.
    """
    interval = _checked_interval(checked("plant", plant, Instance(Plant)), interval)
    with np.errstate(over="ignore", invalid="ignore"):  # said below
        return _sampled(plant, hold_with_cost(*_problem(plant), interval), interval)


def sample_all(plants: Sequence[Plant], interval: float | None = None) -> list[SampledPlant]:
    """As ``sample`` each plant, to the last bit, of plants of one size that have one control interval or are given one."""
    interval = _checked_interval(plants[0], interval)
    A, inputs, weight = (np.array(parts) for parts in zip(*map(_problem, plants), strict=True))
    with np.errstate(over="ignore", invalid="ignore"):
        held = hold_all_with_cost(A, inputs, weight, interval)
    return [_sampled(plant, each, interval) for plant, *each in zip(plants, *held, strict=True)]


def _checked_interval(plant: Plant, interval: float | None) -> float:
    return checked("interval", plant.control_interval if interval is None else interval, Number(gt=0.0, unit="s"))


def _problem(plant: Plant) -> tuple[Array, Array, Array]:
    """A, [B E] and the running cost as a form in [x; u; d]: what is to be held over an interval."""
    (n, m), inputs = plant.B.shape, np.hstack([plant.B, plant.disturbance_input])
    weight = np.zeros((n + inputs.shape[1],) * 2)
    weight[:n, :n], weight[n : n + m, n : n + m] = plant.state_weight, plant.input_weight
    return plant.A, inputs, weight


def _sampled(plant: Plant, held: Sequence[Array], interval: float) -> SampledPlant:
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


def normalised(plant: Plant) -> Plant:
    """The plant as a controller meets it: voltages in units of the drive limit, currents in units of sensor full scale."""
    drive, full_scale = drive_limit(plant), plant.sensor_full_scale
    return replace(
        plant,
        B=sealed(plant.B * drive),
        C=sealed(plant.C / full_scale[:, None]),
        D=sealed(plant.D * drive / full_scale[:, None]),
        input_weight=sealed(plant.input_weight * np.outer(drive, drive)),
        sensor_noise=sealed(plant.sensor_noise / np.outer(full_scale, full_scale)),
        voltage_limits=sealed(plant.voltage_limits / drive),
        sensor_full_scale=sealed(np.ones_like(full_scale)),
    )


def drive_limit(plant: Plant) -> Array:
    """(m,) V: the voltage an action of 1 stands for, the larger magnitude of the two limits."""
    return np.abs(plant.voltage_limits).max(axis=0)
