"""Gain-scheduled LQG: a family of LQG controllers over the rotor speed, which is measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import block_diag

from baselines.design.controller import Array
from baselines.design.instruments import Instruments
from baselines.design.law import Law
from baselines.design.linear import LinearController, linear
from baselines.design.matrix import keep_matrices
from baselines.design.objects import instance
from baselines.design.persistent_load import PersistentLoad, checked_persistent_load
from baselines.design.verification import verified
from baselines.laws.lqg import compensator, sampled_design
from beamenv.blade.config import BladeConfig
from beamenv.configuration import Flag, Number, Refused, checked
from beamenv.plant.plant import Plant
from beamenv.simulation.plants.speed_family import SpeedFamily, speed_family

_MATRICES = ("transition", "measurement_input", "voltage_input", "state_gain", "measurement_gain")
_GRID = np.linspace(0.8, 1.2, 9)
"""Speeds of the default family over the configuration's own: between neighbours the blade's frequencies change by some 5 %."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ScheduledLQG(Law):
    """A linear controller whose matrices are interpolated between those of the nearest speeds, for one blade or a batch.

    All controllers remember in the same coordinates, so that the estimate goes on as the speed changes. Beyond the first and the
    last speed these controllers are used as they are. What is scheduled is each frozen speed's optimum; a speed that changes as
    fast as the blade vibrates is outside the theory (Shamma and Athans, IEEE Trans. Automatic Control 35, 1990).
    """

    speeds: Array
    """(k,), rad/s, ascending."""
    laws: tuple[LinearController, ...]
    """One for each speed."""

    def __post_init__(self) -> None:
        """``ValueError`` for speeds that do not ascend, or laws that are not one for each, linear and of one order."""
        Law.__post_init__(self)
        laws = instance("laws", self.laws, tuple, "a tuple of LinearController, one for each speed")
        keep_matrices(self, {"speeds": (len(laws),)})
        if np.any(np.diff(self.speeds) <= 0.0):
            raise Refused("speeds", self.speeds.tolist(), "numbers in rad/s, each greater than the one before")
        if len({linear(law).order for law in laws}) != 1:
            raise Refused("laws", self.laws, "one or more LinearController of one order")

    @property
    def order(self) -> int:
        """Numbers in a blade's memory, s."""
        return self.laws[0].order

    def decide(self, observation: Array, memory: Array) -> tuple[Array, Array]:
        """As a linear controller, every product a mixture; ValueError for a speed that is no number."""
        weights = self._weights(observation[..., -1])
        fused, feedback = zip(*(each.matrices for each in self.laws), strict=True)
        product = _mixed(weights, np.concatenate([memory, observation[..., :-1]], axis=-1), fused)
        lowest, highest = self.instruments.drive(self.instruments.voltage_limits)
        action = np.clip(product[..., self.order :], lowest, highest)
        return action, product[..., : self.order] + _mixed(weights, action, feedback)

    def at(self, speed: float) -> LinearController:
        """The linear controller that this one is at a constant speed in rad/s; ``ValueError`` for what is no such number."""
        speed = checked("speed", speed, Number(unit="rad/s"))
        weights = self._weights(np.asarray(speed))
        mixed: dict[str, Any] = {
            name: np.tensordot(weights, np.stack([getattr(law, name) for law in self.laws]), axes=1) for name in _MATRICES
        }
        return replace(self.laws[0], name=f"{self.name} at {speed:g} rad/s", **mixed)

    def in_physical_units(self) -> ScheduledLQG:
        """The same controller taking amperes and giving volts, for an environment made with ``physical_units=True``."""
        laws = tuple(law.in_physical_units() for law in self.laws)
        return replace(self, instruments=self.instruments.in_physical_units(), laws=laws)

    def _weights(self, speed: Array) -> Array:
        """(…, k): share of each law, all of it at its own speed, falling linearly to none at its neighbours'."""
        if not np.isfinite(speed).all():
            raise ValueError(
                f"observation has the rotor speed {speed[~np.isfinite(speed)][0]}, but {self.name} needs a number in rad/s."
            )
        return np.stack([np.interp(speed, self.speeds, share) for share in np.eye(len(self.speeds))], axis=-1)


def _mixed(weights: Array, rows: Array, matrices: Sequence[Array]) -> Array:
    """Σ_j weights_j (rows @ matrices_j), leaving out what has no weight anywhere."""
    used = [j for j in range(len(matrices)) if weights[..., j].any()]
    return np.asarray(sum(weights[..., j, None] * (rows @ matrices[j]) for j in used))


def scheduled_lqg(
    family: SpeedFamily, persistent_load: PersistentLoad | None = None, *, rate_weight: float = 0.0, verify: bool = True
) -> ScheduledLQG:
    """The sampled LQG of each plant of a family, all in its common coordinates; ``persistent_load`` as in ``lqg``, and
    ``rate_weight`` a price on quick changes as in ``full_order_lqg``.

    Each controller is ``verified`` on the plant of its own speed unless ``verify=False``; nothing is promised for speeds between
    them, or for a speed that changes. Raises ValueError for plants that differ in sensor range, drive limits or control interval,
    and as ``lqg`` does.
    """
    load = checked_persistent_load(persistent_load)
    first = instance("family", family, SpeedFamily, "a SpeedFamily, such as speed_family(config, speeds)").plants[0]
    for plant in family.plants:
        for name in ("sensor_full_scale", "voltage_limits", "control_interval"):
            if not np.array_equal(getattr(plant, name), getattr(first, name)):
                raise ValueError(f"family has plants that differ in {name}, but one controller has one set of instruments.")
    laws = (_law(*each, load, rate_weight, verify) for each in zip(family.plants, family.from_common, strict=True))
    name = "LQG, scheduled with speed" if load is None else "LQG with load estimate, scheduled with speed"
    return ScheduledLQG(name, Instruments.of(first, "observation and speed"), family.speeds, tuple(laws))


def scheduled_lqg_for(
    config: BladeConfig,
    speeds: ArrayLike | None = None,
    persistent_load: PersistentLoad | None = None,
    *,
    full: bool = False,
    rate_weight: float = 0.0,
    verify: bool = True,
) -> ScheduledLQG:
    """The scheduled LQG of a blade over ``speeds`` (rad/s), by default nine within 20 % of the configuration's own.

    With ``full`` it is designed on all that is known of the blade, as in ``speed_family``, instead of on the design plant.

    Raises ValueError for speeds that ``speed_family`` refuses, for a blade that does not turn, and as ``scheduled_lqg`` does.
    """
    config = instance("config", config, BladeConfig, 'a BladeConfig, such as blade_config("thesis")')
    checked_persistent_load(persistent_load)
    if speeds is None:
        if config.speed == 0.0:
            raise ValueError("speeds is None, but must be given for a blade at rest: there is no speed to choose them around.")
        speeds = config.speed * _GRID
    family = speed_family(config, speeds, full=checked("full", full, Flag()))
    return scheduled_lqg(family, persistent_load, rate_weight=rate_weight, verify=verify)


def _law(plant: Plant, from_common: Array, load: PersistentLoad | None, rate_weight: float, verify: bool) -> LinearController:
    """The LQG of a plant with its memory, x and then any lasting load and voltages before, in the common coordinates."""
    held, regulated, filtered = sampled_design(plant, load, rate_weight=rate_weight)
    law = compensator(plant, "LQG", held, regulated.gain, filtered.gain)
    verified(law, plant, regulated, filtered, instead="another rate_weight or other speeds", verify=verify)
    there = block_diag(from_common, np.eye(len(law.transition) - len(from_common)))
    back = np.linalg.inv(there)
    return replace(
        law,
        transition=back @ law.transition @ there,
        measurement_input=back @ law.measurement_input,
        voltage_input=back @ law.voltage_input,
        state_gain=law.state_gain @ there,
    )
