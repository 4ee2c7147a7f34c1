"""A linear law behind the inverse of its actuators' hysteresis: what acts is what it asks for."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from baselines.design.controller import Array
from baselines.design.law import Law
from baselines.design.linear import LinearController
from baselines.design.objects import instance
from beamenv.configuration import Number, checked
from beamenv.simulation.signals.hysteresis import PLAYS, Hysteresis, prandtl_ishlinskii

LOOP = Number(ge=0.0, le=0.5)
"""As ``scenario.drive.hysteresis``."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class InverseHysteresis(Law):
    """The voltages that act as ``law`` asks, as near as the drive's limits let them, for one blade or a batch.

    With the operator H of the actuators, whose plays it follows, and the controller's memory ξ,

        w = M ξ + T y,        u = H⁻¹[w] within the limits,        ξ⁺ = F ξ + G y + H_v H[u],

    so the controller's memory is driven by the voltage that acts, as without hysteresis, and not by the one asked for.
    """

    law: LinearController
    """What asks for voltages; it stands behind the same instruments."""
    loop: float
    """Width of the free-strain loop over its stroke, as ``scenario.drive.hysteresis``."""
    _hysteresis: Hysteresis = field(init=False)
    _drive: Array = field(init=False)
    _limits: Array = field(init=False)

    def __post_init__(self) -> None:
        """``ValueError`` for what is no linear law or no loop."""
        Law.__post_init__(self)
        instance("law", self.law, LinearController, "a LinearController, such as lqg(plant)")
        limits = self.instruments.voltage_limits
        drive = np.abs(limits).max(axis=0)
        limits = limits / drive
        loop = checked("loop", self.loop, LOOP)
        object.__setattr__(self, "_hysteresis", prandtl_ishlinskii(loop, float(limits[0].min()), float(limits[1].max())))
        object.__setattr__(self, "_drive", drive)
        object.__setattr__(self, "_limits", limits)

    @property
    def order(self) -> int:
        """Numbers in a blade's memory: the controller's, and each play of each actuator."""
        return self.law.order + PLAYS * len(self._drive)

    @property
    def operator(self) -> Hysteresis:
        """That of the actuators, of voltages over the larger drive limit."""
        return self._hysteresis

    def decide(self, observation: Array, memory: Array) -> tuple[Array, Array]:
        """Ask, invert, remember what acts."""
        law, m = self.law, len(self._drive)
        reading, (own, plays) = self.instruments.read(observation), np.split(memory, [law.order], axis=-1)
        plays = plays.reshape(*plays.shape[:-1], m, PLAYS)
        wanted = own @ law.state_gain.T + reading @ law.measurement_gain.T
        if self.loop:
            voltage = self._hysteresis.inverse(wanted / self._drive, plays, *self._limits)
            acting, plays = self._hysteresis.step(voltage, plays)
        else:
            voltage = acting = np.clip(wanted / self._drive, *self._limits)
        own = own @ law.transition.T + reading @ law.measurement_input.T + (acting * self._drive) @ law.voltage_input.T
        following = np.concatenate([own, plays.reshape(*plays.shape[:-2], m * PLAYS)], axis=-1)
        return self.instruments.drive(voltage * self._drive), following


def inverse_hysteresis(law: LinearController, loop: Any) -> InverseHysteresis:
    """A controller behind the inverse of the Prandtl–Ishlinskii operator with this ``loop``
    (``beamenv.simulation.signals.hysteresis``).

    Inverse control in the sense of Kuhnen (European J. Control 9, 2003), by bisection to 1e-12 of the range. Within the drive
    limits the blade moves as it would under ``law`` without hysteresis, so that the loop verified for ``law`` remains valid. A
    ``loop`` of 0 means no hysteresis. Raises ``ValueError`` for what is no ``LinearController``, and for a loop outside 0 to 0.5.
    """
    law = instance("law", law, LinearController, "a LinearController, such as lqg(plant)")
    return InverseHysteresis(f"{law.name}, hysteresis inverted", law.instruments, law, loop)
