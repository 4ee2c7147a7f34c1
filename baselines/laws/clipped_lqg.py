"""LQG whose filter knows that the drive clips its voltages and that the data acquisition clips its readings."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from baselines.design.controller import Array, Observes, drive_scale, measurement, remembered
from baselines.design.persistent_load import PersistentLoad
from baselines.laws.lqg import sampled_design
from beamenv.plant.plant import Plant


@dataclass(frozen=True, slots=True, eq=False)
class ClippedLQG:
    """The sampled LQG with a reading predicted as it will be taken, for one blade or a batch.

    With the memory x̂, the state predicted from the interval before and zero at the start of an episode,

        x̂ ← x̂ + L (y − clip(C x̂)),        u = clip(−K x̂),        x̂⁺ = A x̂ + B u

    so a reading at full scale contradicts an estimate that is smaller, and none that is larger. Not linear, and not optimal: the
    gain L stays what it is while a reading is clipped.
    """

    name: str
    """What tables and figures call it."""
    transition: Array
    """A (s, s)."""
    voltage_input: Array
    """B (s, m), per V."""
    output: Array
    """C (p, s), A."""
    feedback_gain: Array
    """K (m, s), V."""
    kalman_gain: Array
    """L (s, p), per A."""
    full_scale: Array
    """(p,), A: the largest current that a reading can show."""
    measurement_scale: Array
    """(p,), A: the current that an observation of 1 stands for."""
    voltage_scale: Array
    """(m,), V: the voltage that an action of 1 stands for."""
    voltage_limits: Array
    """(2, m), V: lower and upper drive limit."""
    observes: Observes = "observation"

    def predict(
        self,
        observation: ArrayLike,
        state: Array | None = None,
        episode_start: ArrayLike | None = None,
        deterministic: bool = True,
    ) -> tuple[Array, Array]:
        """Action (m,) or (N, m) in units of the drive limit, and the next memory; as ``LinearController.predict``."""
        measured = measurement(self, observation)
        memory = remembered(state, episode_start, measured.shape[:-1], len(self.transition))
        expected = np.clip(memory @ self.output.T, -self.full_scale, self.full_scale)
        estimate = memory + (measured * self.measurement_scale - expected) @ self.kalman_gain.T
        voltage = np.clip(-estimate @ self.feedback_gain.T, *self.voltage_limits)
        return voltage / self.voltage_scale, estimate @ self.transition.T + voltage @ self.voltage_input.T

    def in_physical_units(self) -> ClippedLQG:
        """The same law taking amperes and giving volts, for an environment made with ``physical_units=True``."""
        return replace(self, measurement_scale=np.ones_like(self.measurement_scale), voltage_scale=np.ones_like(self.voltage_scale))


def clipped_lqg(plant: Plant, persistent_load: PersistentLoad | None = None) -> ClippedLQG:
    """The sampled LQG of a design plant, its filter told that readings end at full scale; equal to ``lqg`` while none does.

    ``persistent_load`` adds a load that lasts to the state, as in ``lqg``.
    """
    held, _, K, L = sampled_design(plant, persistent_load)
    return ClippedLQG(
        name="LQG, clipping known" if persistent_load is None else "LQG with load estimate, clipping known",
        transition=held.A,
        voltage_input=held.B,
        output=held.C,
        feedback_gain=K,
        kalman_gain=L,
        full_scale=plant.sensor_full_scale,
        measurement_scale=plant.sensor_full_scale,
        voltage_scale=drive_scale(plant),
        voltage_limits=plant.voltage_limits,
    )
