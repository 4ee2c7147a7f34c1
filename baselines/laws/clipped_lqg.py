"""LQG whose filter knows that the drive clips its voltages and that the data acquisition clips its readings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from baselines.design.controller import Array
from baselines.design.instruments import Instruments
from baselines.design.law import Law
from baselines.design.matrix import keep_matrices, rows
from baselines.design.persistent_load import PersistentLoad, checked_persistent_load
from baselines.design.verification import verified
from baselines.design.weights import weighted
from baselines.laws.lqg import compensator, sampled_design
from beamenv.plant.plant import Plant


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ClippedLQG(Law):
    """The sampled LQG whose filter predicts readings clipped at full scale, for one blade or a batch.

    With the memory x̂, the state predicted from the interval before and zero at the start of an episode,

        x̂ ← x̂ + L (y − clip(C x̂)),        u = clip(−K x̂),        x̂⁺ = A x̂ + B u

    so a reading at full scale contradicts an estimate that is smaller, and none that is larger. Not linear, and not optimal: the
    gain L stays what it is while a reading is clipped.
    """

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

    def __post_init__(self) -> None:
        """``ValueError`` for matrices that do not fit."""
        Law.__post_init__(self)
        s, p, m = rows(self.transition), *self.instruments.counts
        shapes = {"transition": (s, s), "voltage_input": (s, m), "output": (p, s), "feedback_gain": (m, s), "kalman_gain": (s, p)}
        keep_matrices(self, {**shapes, "full_scale": (p,)})

    @property
    def order(self) -> int:
        """Numbers in a blade's memory, s."""
        return len(self.transition)

    def decide(self, observation: Array, memory: Array) -> tuple[Array, Array]:
        """Correct, drive, predict."""
        expected = np.clip(memory @ self.output.T, -self.full_scale, self.full_scale)
        estimate = memory + (self.instruments.read(observation) - expected) @ self.kalman_gain.T
        voltage = self.instruments.limit(-estimate @ self.feedback_gain.T)
        return self.instruments.drive(voltage), estimate @ self.transition.T + voltage @ self.voltage_input.T


def clipped_lqg(
    plant: Plant,
    persistent_load: PersistentLoad | None = None,
    *,
    rate_weight: float = 0.0,
    Q: ArrayLike | None = None,
    R: ArrayLike | None = None,
    verify: bool = True,
) -> ClippedLQG:
    """The sampled LQG of a design plant, whose filter takes into account that readings clip at full scale.

    While no reading clips it is the controller of ``lqg``. ``persistent_load`` adds a sustained load to the state, and ``Q`` and
    ``R`` replace the plant's weights, as in ``lqg``; ``rate_weight`` is a price on quick changes, as in ``full_order_lqg``. The
    loop without clipping is ``verified`` on ``plant`` unless ``verify=False``; while readings or voltages clip, nothing is
    promised. Raises ValueError as ``lqg`` does.
    """
    load = checked_persistent_load(persistent_load)
    name = "LQG, clipping known" if load is None else "LQG with load estimate, clipping known"
    held, regulated, filtered = sampled_design(weighted(plant, Q, R), load, rate_weight=rate_weight)
    K, L = regulated.gain, filtered.gain
    verified(compensator(plant, name, held, K, L), plant, regulated, filtered, verify=verify)
    return ClippedLQG(
        name=name,
        instruments=Instruments.of(plant),
        transition=held.A,
        voltage_input=held.B,
        output=held.C,
        feedback_gain=K,
        kalman_gain=L,
        full_scale=plant.sensor_full_scale,
    )
