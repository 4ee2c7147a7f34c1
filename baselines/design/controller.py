"""What a controller is: SB3's ``predict``; and the linear one that every classical law here is an instance of."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.plant.plant import Plant

Array = NDArray[np.float64]
Observes = Literal["observation", "state", "observation and speed"]
"""What ``predict`` wants: the sensors' readings, the true state, or the readings (p,) with the rotor speed in rad/s behind them."""


@runtime_checkable
class Controller(Protocol):
    """Anything with Stable-Baselines3's ``predict``: the laws of this package and SB3's own models."""

    def predict(
        self, observation: Any, state: Any = None, episode_start: Any = None, deterministic: bool = True
    ) -> tuple[Any, Any]:
        """Action and next memory for one observation or a batch (leading axis); ``state=None`` starts afresh."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class LinearController:
    """A sampled linear law that knows the drive limits, for one blade or a batch in two matrix products.

    With y_k the measurement (A, or the state when ``observes == "state"``) and ξ_k the memory, zero at the start of an episode,

        u_k = clip(M ξ_k + T y_k),        ξ_{k+1} = F ξ_k + G y_k + H u_k

    so y_k acts on u_k without delay and the memory is driven by the voltage that was really applied.
    """

    name: str
    """What tables and figures call it."""
    transition: Array
    """F (s, s)."""
    measurement_input: Array
    """G (s, p), per A."""
    voltage_input: Array
    """H (s, m), per V."""
    state_gain: Array
    """M (m, s), V."""
    measurement_gain: Array
    """T (m, p), V/A."""
    measurement_scale: Array
    """(p,): the measurement that an observation of 1 stands for."""
    voltage_scale: Array
    """(m,), V: the voltage that an action of 1 stands for."""
    voltage_limits: Array
    """(2, m), V: lower and upper drive limit."""
    observes: Literal["observation", "state"] = "observation"
    """Whether ``predict`` wants the sensors' observation or the true state (n,), which no real blade offers."""
    _fused: Array = field(init=False, repr=False)
    _feedback: Array = field(init=False, repr=False)
    _limits: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Fuse the law into [ξ, observation] @ fused = [F ξ + G y, action]."""
        scale, drive = self.measurement_scale, self.voltage_scale[:, None]
        memory = np.hstack([self.transition, self.measurement_input * scale])
        action = np.hstack([self.state_gain, self.measurement_gain * scale]) / drive
        object.__setattr__(self, "_fused", np.ascontiguousarray(np.vstack([memory, action]).T))
        object.__setattr__(self, "_feedback", np.ascontiguousarray(drive * self.voltage_input.T))
        object.__setattr__(self, "_limits", self.voltage_limits / self.voltage_scale)

    def predict(
        self,
        observation: ArrayLike,
        state: Array | None = None,
        episode_start: ArrayLike | None = None,
        deterministic: bool = True,
    ) -> tuple[Array, Array | None]:
        """Action (m,) or (N, m) in units of the drive limit, and the next memory (None for a law without memory).

        ``observation`` (p,) or (N, p) is normalised as the environment gives it; rows where ``episode_start`` is true
        forget their memory. Raises ValueError for an observation of another length.
        """
        measured, order = measurement(self, observation), len(self.transition)
        memory = remembered(state, episode_start, measured.shape[:-1], order)
        product = np.concatenate([memory, measured], axis=-1) @ self._fused
        action = np.clip(product[..., order:], self._limits[0], self._limits[1])
        following = product[..., :order] + action @ self._feedback
        return action, following if order else None

    @property
    def matrices(self) -> tuple[Array, Array]:
        """[ξ, observation] @ fused (s + p, s + m) = [F ξ + G y, action], and feedback (m, s): ξ⁺ gains action @ feedback."""
        return self._fused, self._feedback

    def in_physical_units(self) -> LinearController:
        """The same law taking amperes and giving volts, for an environment made with ``physical_units=True``."""
        return replace(self, measurement_scale=np.ones_like(self.measurement_scale), voltage_scale=np.ones_like(self.voltage_scale))


class _Law(Protocol):
    @property
    def name(self) -> str: ...
    @property
    def observes(self) -> str: ...
    @property
    def measurement_scale(self) -> Array: ...


def measurement(law: _Law, observation: ArrayLike) -> Array:
    """The observation (p,) or (N, p) as float64. Raises ValueError unless it has the length that the law takes."""
    measured = np.asarray(observation, dtype=np.float64)
    if measured.ndim not in (1, 2) or measured.shape[-1] != law.measurement_scale.size:
        raise ValueError(
            f"observation has shape {measured.shape}, but {law.name} takes {law.observes} vectors of length "
            f"{law.measurement_scale.size}, alone or in rows"
        )
    return measured


def remembered(state: Array | None, episode_start: ArrayLike | None, batch: tuple[int, ...], order: int) -> Array:
    """The memory (*batch, order) that a decision starts from: zero without a state, and where an episode starts."""
    if state is None:
        return np.zeros((*batch, order))
    if episode_start is None:
        return state
    begins = np.asarray(episode_start, dtype=bool).reshape(batch)
    return np.where(begins[..., None], 0.0, state)


def static_law(plant: Plant, name: str, gain: Array, observes: Literal["observation", "state"] = "observation") -> LinearController:
    """The law u = gain @ y without memory: ``gain`` (m, p) in V/A, or (m, n) in V/√J when it observes the state."""
    m, p = gain.shape
    return LinearController(
        name=name,
        transition=np.zeros((0, 0)),
        measurement_input=np.zeros((0, p)),
        voltage_input=np.zeros((0, m)),
        state_gain=np.zeros((m, 0)),
        measurement_gain=gain,
        measurement_scale=plant.sensor_full_scale if observes == "observation" else np.ones(p),
        voltage_scale=drive_scale(plant),
        voltage_limits=plant.voltage_limits,
        observes=observes,
    )


def drive_scale(plant: Plant) -> Array:
    """Voltage (m,) in V that an action of 1 stands for: the larger of each actuator's two limits."""
    return np.asarray(np.abs(plant.voltage_limits).max(axis=0))
