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

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Count, Number, Texts, checked
from beamenv.configuration.read_only import ReadOnly
from beamenv.plant.parts import (
    check_clock,
    check_parts,
    checked_cross,
    checked_energy,
    checked_reference,
    counts,
    half_squares,
    span,
)
from beamenv.plant.signals import REFERENCE_LOAD, Signal, checked_signals, currents, usual_disturbances

if TYPE_CHECKING:
    import control

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PlantMatrices(ReadOnly):
    """What a ``Plant`` consists of: n states, m voltages, p sensors, k disturbances.

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
        check_clock(self, "control_interval")
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
        return f"{type(self).__name__}({self.sizes}{said})"

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
        return f"{counts(self.B, self.C)}; {span(first, last)}; {clock}; {low:.5g} … {high:.5g} V"

    def to_control(self) -> control.StateSpace:
        """The plant from [voltages, line loads] to [currents, tip displacements] as a ``control.StateSpace``."""
        from beamenv.plant.interchange import plant_to_control

        return plant_to_control(self)
