"""The plant: matrices that cannot be changed, in continuous time and exactly sampled.

The state of a blade is ``x = [ω η; η̇]`` in energy coordinates: η are the coordinates of mass-normalised modes, so that
½ xᵀx is the vibration energy in joules. States of filters and amplifiers may follow (``beamenv.plant.electronics``), which have
no energy. A model of another origin has coordinates of its own, and its ``energy`` is a matrix. The dynamics are

    ẋ = A x + B u + E d,        y = C x + D u + v

with u the actuator voltages (V), d the disturbances, of a blade the uniform line loads in lag and flap (N/m), and y what the
sensors show, of a blade the currents (A).

**When a sensor is read.** At t_k the reading is taken first, then the voltage u_k is put on: where D ≠ 0 the reading shows the
voltages that were held over the interval before, y_k = C x_k + D u_{k−1} + v_k, and none at the first instant.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.configuration import Count, Instance, Number, Texts, checked
from beamenv.configuration.read_only import ReadOnly, sealed
from beamenv.plant.hold import hold_all_with_cost, hold_with_cost
from beamenv.plant.parts import check_parts, checked_cross, checked_energy, checked_reference, half_squares
from beamenv.plant.poles import poles_of_sampled
from beamenv.plant.signals import REFERENCE_LOAD, Signal, checked_signals, currents, usual_disturbances

if TYPE_CHECKING:
    import control

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Plant(ReadOnly):
    """Reduced-order blade with patches, or a model of another origin: n states, m voltages, p sensors, k disturbances.

    ``ValueError`` of one sentence for a part that is no array of real numbers with as many dimensions.

    The cost it is judged by is J = ∫ (xᵀQx + 2xᵀNu + uᵀRu) dt (thesis Eqs. 5.7–5.9, corrected, with N = 0). Units are those of a
    blade: where the sensors or disturbances are others, read theirs for A and N/m.
    """

    A: Array
    """(n, n), 1/s."""
    B: Array
    """(n, m), √J/s per V."""
    C: Array
    """(p, n), A per √J."""
    D: Array
    """(p, m), A/V; zero for current sensing. See above for which voltages a reading shows."""
    disturbance_input: Array
    """E (n, k), √J/s per N/m of uniform line load: lag, flap."""
    tip_displacement: Array
    """(q, n), m per √J: lag, flap at z = L; of a model that does not tell, none."""
    strain: Array
    """(s, n), spanwise strain per √J at points of the outer face; none where it is not known, and nothing then fails by it."""
    natural_frequencies: Array
    """(r,), rad/s, of the retained undamped modes without gyroscopic coupling, ascending."""
    state_weight: Array
    """Q (n, n), symmetric, not negative. Of a blade ½ I, the vibration energy in joules; zero for the electronics."""
    input_weight: Array
    """R (m, m), J/V²: ρ Fᵀ K⁻¹ F, the energy the actuators can store."""
    process_noise: Array
    """W (k, k), (N/m)² s: intensity of the white line loads."""
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
    energy: Array | None = None
    """H (n, n), symmetric, not negative: xᵀHx is the energy in joules; zero says that it is not known. Left out, it is ½ the
    squares of all but the ``electronic_states``."""
    reference_load: Array | None = None
    """(k,) of each disturbance, in its unit: what the actuators can about hold, by which the loads of scenarios are scaled. The
    last may be 0: no load case has part in these, which are noise alone. None: 30 N/m of a line load, 1 of anything else."""
    disturbances: tuple[Signal, ...] = ()
    """(k,) of them; left out, they are the line loads in lag and flap, N/m, if there are two."""
    sensors: tuple[Signal, ...] = ()
    """(p,) of them; left out, they are currents, A."""
    cross_weight: Array | None = None
    """N (n, m): 2 xᵀNu is part of the cost too, where it is of outputs that feel the voltages; zero unless said otherwise."""
    time_scale: float = 1.0
    """What stands for 1 s of a scenario, whose load cases are made for a blade with a first period of 35 ms."""
    assumed: tuple[str, ...] = ()
    """In words, what nobody said of a model and was taken to be so."""

    def __post_init__(self) -> None:
        check_parts(self)
        _check_clock(self, "control_interval")
        (n, k), p = self.disturbance_input.shape, len(self.C)
        electronic = checked("plant.electronic_states", self.electronic_states, Count(0, n))
        kept = {
            "electronic_states": electronic,
            "reference_load": checked_reference(self.reference_load, self.disturbances, k),
            "disturbances": checked_signals("plant.disturbances", self.disturbances, k, usual_disturbances),
            "sensors": checked_signals("plant.sensors", self.sensors, p, currents),
            "assumed": checked("plant.assumed", self.assumed, Texts()),
            "energy": checked_energy(self.energy, n, electronic),
            "cross_weight": checked_cross(self.cross_weight, self.B.shape),
            "time_scale": checked("plant.time_scale", self.time_scale, Number(gt=0.0)),
        }
        for name, value in kept.items():
            object.__setattr__(self, name, value)
        ReadOnly.__post_init__(self)

    def __repr__(self) -> str:
        said = f"; assumed: {'; '.join(self.assumed)}" if self.assumed else ""
        return f"Plant({self.sizes}{said})"

    @property
    def blade_states(self) -> int:
        """How many of the n states, the first, are the blade's own; in energy coordinates ½ their squares are the energy."""
        return len(self.A) - self.electronic_states

    @property
    def energy_known(self) -> bool:
        """Whether any energy is known: what is not known counts as none."""
        return bool(np.any(self.energy))

    @property
    def in_energy_coordinates(self) -> bool:
        """Whether ½ the sum of the squares of all states but the electronic ones is the energy."""
        return np.array_equal(np.asarray(self.energy), half_squares(len(self.A), self.electronic_states))

    @property
    def scenario_interval(self) -> float:
        """Seconds of a scenario's time that a control interval stands for."""
        return self.control_interval / self.time_scale

    @property
    def load_scale(self) -> Array:
        """(k,): what stands for 1 N/m of a scenario, which is made for a blade that can about hold 30 N/m."""
        return np.asarray(self.reference_load) / REFERENCE_LOAD

    @property
    def loads(self) -> int:
        """How many of the disturbances, the first, load cases are made of; the others are noise alone."""
        return int(np.count_nonzero(self.load_scale))

    @property
    def sizes(self) -> str:
        """In one line: how many states, voltages and sensors; first and last frequency; clock and limits."""
        first, last = self.natural_frequencies[[0, -1]]
        low, high = self.voltage_limits[0].min(), self.voltage_limits[1].max()
        clock = f"{1e3 * self.control_interval:.4g} ms"
        return f"{_counts(self.B, self.C)}; {_range(first, last)}; {clock}; {low:.5g} … {high:.5g} V"

    def to_control(self) -> control.StateSpace:
        """The plant from [voltages, line loads] to [currents, tip displacements] as a ``control.StateSpace``."""
        from beamenv.plant.interchange import plant_to_control

        return plant_to_control(self)

    @classmethod
    def from_state_space(cls, A: ArrayLike, B: ArrayLike, C: ArrayLike, D: ArrayLike | None = None, **about: Any) -> Plant:
        """The plant of ẋ = A x + B u, y = C x + D u, or with ``dt`` (s) of x⁺ = A x + B u. What may be said ``about`` it, and what
        is taken to be so where it is not, tells ``beamenv.plant.state_space.plant_of_model``.
        """
        from beamenv.plant.state_space import plant_of_arguments

        return plant_of_arguments({"A": A, "B": B, "C": C, "D": D, **about})

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Plant:
        """The plant of a model in a file, .npz, .mat or .json, by the names that ``from_state_space`` has for its arguments."""
        from beamenv.plant.model_files import plant_from_file

        return plant_from_file(path)

    @classmethod
    def from_control(cls, system: control.StateSpace, like: Plant | None = None, **changes: Any) -> Plant:
        """The plant of a ``control.StateSpace``: as ``from_state_space`` makes it, ``changes`` being what is known besides; or with
        ``like``, and all else as that plant has it. See ``interchange``.
        """
        from beamenv.plant.interchange import plant_from_control, plant_of_system

        if like is None:
            return plant_of_system(system, changes)
        return plant_from_control(system, checked("like", like, Instance(cls)), **changes)


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

        return sampled_from_control(system, checked("like", like, Instance(cls)), **changes)


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
    cross = np.asarray(plant.cross_weight)
    weight[:n, n : n + m], weight[n : n + m, :n] = cross, cross.T
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
        cross_weight=sealed(np.asarray(plant.cross_weight) * drive),
        sensor_noise=sealed(plant.sensor_noise / np.outer(full_scale, full_scale)),
        voltage_limits=sealed(plant.voltage_limits / drive),
        sensor_full_scale=sealed(np.ones_like(full_scale)),
    )


def drive_limit(plant: Plant) -> Array:
    """(m,) V: the voltage an action of 1 stands for, the larger magnitude of the two limits."""
    return np.abs(plant.voltage_limits).max(axis=0)
