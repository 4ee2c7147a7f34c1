"""The plant: matrices and nothing else, in continuous time and exactly sampled.

State ``x = [ω η; η̇]`` in energy coordinates: η are the coordinates of mass-normalised modes, so that
½ xᵀx is the vibration energy in joules. The dynamics are

    ẋ = A x + B u + E d,        y = C x + D u + v

with u the actuator voltages (V), d the uniform line loads in lag and flap (N/m) and y the sensed currents (A).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from hashlib import sha256
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

if TYPE_CHECKING:
    import control

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Plant:
    """Reduced-order blade with patches: n = 2r states, m voltages, p sensors, d = 2 line loads.

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
    """Q (n, n): ½ I, the vibration energy in joules."""
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

    def to_control(self) -> control.StateSpace:
        """The plant from [voltages, line loads] to [currents, tip displacements] as a ``control.StateSpace``."""
        import control

        inputs = np.hstack([self.B, self.disturbance_input])
        outputs = np.vstack([self.C, self.tip_displacement])
        feedthrough = np.zeros((len(outputs), inputs.shape[1]))
        feedthrough[: len(self.C), : self.B.shape[1]] = self.D
        return control.ss(
            self.A,
            inputs,
            outputs,
            feedthrough,
            inputs=[f"voltage{i}" for i in range(self.B.shape[1])] + ["load_lag", "load_flap"],
            outputs=[f"current{i}" for i in range(len(self.C))] + ["tip_lag", "tip_flap"],
        )


@dataclass(frozen=True, slots=True, eq=False)
class SampledPlant:
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


def sample(plant: Plant, interval: float | None = None) -> SampledPlant:
    """Discretise exactly under zero-order hold, cost included (Van Loan, IEEE Trans. Automatic Control 23, 1978).

    ``interval`` in s defaults to the plant's own control interval.
    """
    interval = plant.control_interval if interval is None else interval
    n, m = plant.B.shape
    drive = np.abs(plant.voltage_limits).max(axis=0)  # voltages in units of their limit keep the exponential well scaled
    scale = np.concatenate([np.ones(n), drive, np.ones(plant.disturbance_input.shape[1])])
    size = len(scale)
    dynamics = np.zeros((size, size))
    dynamics[:n] = np.hstack([plant.A, plant.B, plant.disturbance_input]) * scale
    weight = np.zeros((size, size))
    weight[:n, :n] = plant.state_weight
    weight[n : n + m, n : n + m] = plant.input_weight * np.outer(drive, drive)
    exponential = expm(np.block([[-dynamics.T, weight], [np.zeros((size, size)), dynamics]]) * interval)
    transition = exponential[size:, size:]
    cost = transition.T @ exponential[:size, size:] / np.outer(scale, scale)
    held = transition[:n] / scale
    return SampledPlant(
        A=held[:, :n],
        B=held[:, n : n + m],
        C=plant.C,
        D=plant.D,
        disturbance_input=held[:, n + m :],
        cost=0.5 * (cost + cost.T),
        process_noise=plant.process_noise / interval,
        sensor_noise=plant.sensor_noise / interval,
        interval=interval,
    )


def normalised(plant: Plant) -> Plant:
    """The plant as a controller meets it: voltages in units of the drive limit, currents in units of sensor full scale."""
    drive, full_scale = drive_limit(plant), plant.sensor_full_scale
    return replace(
        plant,
        B=plant.B * drive,
        C=plant.C / full_scale[:, None],
        D=plant.D * drive / full_scale[:, None],
        input_weight=plant.input_weight * np.outer(drive, drive),
        sensor_noise=plant.sensor_noise / np.outer(full_scale, full_scale),
        voltage_limits=plant.voltage_limits / drive,
        sensor_full_scale=np.ones_like(full_scale),
    )


def drive_limit(plant: Plant) -> Array:
    """(m,) V: the voltage an action of 1 stands for, the larger magnitude of the two limits."""
    return np.abs(plant.voltage_limits).max(axis=0)


def fingerprint(plant: Plant) -> str:
    """SHA-256, in hexadecimal, of what a controller meets: how the plant answers, its cost, noises, limits and clock.

    The answers are the transfer matrices from voltages and loads to currents and tip displacements at s = each natural
    frequency, on the real axis, where none is close to a pole. They do not depend on the signs of mode shapes, and all numbers
    are rounded to a millionth of the largest in their matrix, so that machines whose last digits differ agree.
    """
    digest = sha256()
    for matrix in _met(plant):
        largest = float(np.abs(matrix).max(initial=0.0))
        rounded = np.rint(matrix * (1e6 / largest if largest else 0.0)).astype("<i8")
        digest.update(f"{matrix.shape} {largest:.5e} ".encode() + rounded.tobytes())
    return digest.hexdigest()


def _met(plant: Plant) -> Iterator[Array]:
    yield plant.natural_frequencies
    identity = np.eye(len(plant.A))
    for inputs in (plant.B, plant.disturbance_input):
        states = [np.linalg.solve(s * identity - plant.A, inputs) for s in plant.natural_frequencies]
        yield from (outputs @ state for state in states for outputs in (plant.C, plant.tip_displacement))
    yield from (plant.D, plant.input_weight, plant.process_noise, plant.sensor_noise)
    yield from (plant.voltage_limits, plant.sensor_full_scale, np.array([plant.control_interval]))
