"""What lies between a controller and the blade's patches, where a scenario makes it imperfect: delay, hysteresis, dead actuators
on the way in; dead and biased sensors, lost readings on the way out. Pure functions of a batch of N blades, NumPy and torch alike.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from beamenv.arrays import Those, copied, counting, integers, namespace
from beamenv.scenarios.drawing import whole_intervals
from beamenv.scenarios.load_cases import NEVER
from beamenv.scenarios.tables import Failures
from beamenv.simulation.signals.hysteresis import Hysteresis

DRAWS = 6
"""Uniform numbers that faults take: plant, delay, actuator, sensor, dead or biased, bias."""

ONSET_DRAWS = 3
"""Further ones where faults may set in within the episode: when actuators do, when sensors do, which of both."""


@dataclass(frozen=True, slots=True, eq=False)
class Faults:
    """What is wrong with each of N blades in this episode."""

    delay: Any
    """(N,) control intervals."""
    actuator_gain: Any
    """(N, m): 0 for a dead one, 1 for a sound one."""
    sensor_gain: Any
    """(N, p): 0 for a dead one."""
    sensor_bias: Any
    """(N, p), of full scale."""

    def replace(self, those: Those, others: Faults) -> Faults:
        """These faults with those of some blades exchanged for ``others``."""
        names = [each.name for each in fields(self)]
        return Faults(**{name: those.put(getattr(self, name), getattr(others, name)) for name in names})

    def of(self, those: Those) -> Faults:
        """The faults of some of the blades."""
        return self.convert(those.take)

    def convert(self, to_array: Callable[[Any], Any]) -> Faults:
        """The same faults with each array passed through ``to_array``."""
        return replace(self, **{each.name: to_array(getattr(self, each.name)) for each in fields(self)})

    def state_dict(self) -> dict[str, Any]:
        """A copy of each array by its name: ``Faults.from_state_dict`` makes equal faults of them."""
        return {each.name: copied(getattr(self, each.name)) for each in fields(self)}

    @classmethod
    def from_state_dict(cls, state: Mapping[str, ArrayLike]) -> Faults:
        """The faults of a ``state_dict``."""
        return cls(**{name: copied(values) for name, values in state.items()})


@dataclass(frozen=True, slots=True, eq=False)
class Onsets:
    """From which sampling instant on, a whole number of control intervals, each of N blades has its faults."""

    actuators: Any
    """(N,)"""
    sensors: Any
    """(N,)"""

    def replace(self, those: Those, others: Onsets) -> Onsets:
        """These with those of some blades exchanged for ``others``."""
        return Onsets(those.put(self.actuators, others.actuators), those.put(self.sensors, others.sensors))

    def set_in(self, faults: Faults, elapsed: Any) -> Faults:
        """Those of the faults that the blades have after ``elapsed`` (N,) control intervals."""
        array = namespace(elapsed)
        actuators, sensors = (self.actuators <= elapsed)[:, None], (self.sensors <= elapsed)[:, None]
        return replace(
            faults,
            actuator_gain=array.where(actuators, faults.actuator_gain, 1.0),
            sensor_gain=array.where(sensors, faults.sensor_gain, 1.0),
            sensor_bias=array.where(sensors, faults.sensor_bias, 0.0),
        )

    def begins(self, elapsed: Any) -> bool:
        """Whether a blade's fault sets in at this very instant."""
        return bool(((self.actuators == elapsed) | (self.sensors == elapsed)).any())


class SignalMemory(NamedTuple):
    """What the electronics remember of the past."""

    commands: Any
    """(N, D + 1, m): the last voltages asked for, newest first."""
    plays: Any
    """(N, m, J): outputs of the hysteresis operator's plays."""
    readings: Any
    """(N, p): the last readings shown."""


def draw_faults(failures: Failures, delay: tuple[int, int], uniforms: Any, actuators: int, sensors: int) -> Faults:
    """Faults of N blades from uniform numbers (N, ``DRAWS``), of NumPy or of torch, as they are."""
    array = namespace(uniforms)
    bias = failures.bias[0] + (failures.bias[1] - failures.bias[0]) * array.abs(2.0 * uniforms[:, 5] - 1.0)
    low, high = failures.remaining
    lost = 1.0 - low - (high - low) * (uniforms[:, 2] * actuators % 1.0)  # which one it is does not say what is left of it
    faulty = _drawn(uniforms[:, 3], failures.faulty_sensors, sensors)
    biased = (uniforms[:, 4] < failures.biased_share)[:, None]
    sound = array.ones_like(uniforms[:, :1])
    return Faults(
        delay=delay[0] + integers(array.floor(uniforms[:, 1] * (delay[1] - delay[0] + 1))),
        actuator_gain=1.0 - lost[:, None] * _drawn(uniforms[:, 2], failures.dead_actuators, actuators),
        sensor_gain=array.where(faulty & ~biased, 0.0, sound),
        sensor_bias=array.where(faulty & biased, (array.sign(uniforms[:, 5] - 0.5) * bias)[:, None], 0.0),
    )


def fault_draws(failures: Failures) -> int:
    """How many uniform numbers the faults of an episode take."""
    return DRAWS + (ONSET_DRAWS if failures.drawn_instants else 0)


def draw_onsets(failures: Failures, interval: float, uniforms: Any) -> Onsets:
    """When N blades break, from uniform numbers (N, ``ONSET_DRAWS``) and the control interval in s."""
    array, (low, high) = namespace(uniforms), failures.onset
    actuators, sensors = whole_intervals(low + (high - low) * uniforms[:, :2], interval).T
    if failures.either:
        actuator = uniforms[:, 2] < 0.5
        actuators, sensors = array.where(actuator, actuators, NEVER), array.where(actuator, NEVER, sensors)
    return Onsets(actuators, sensors)


def _drawn(uniform: Any, count: int, among: int) -> Any:
    """(N, among): ``count`` neighbours, in a ring, are drawn; each is as likely as any other."""
    first = integers(namespace(uniform).floor(uniform * among))
    return ((counting(among, uniform) - first[:, None]) % among) < min(count, among)


def drive(faults: Faults, hysteresis: Hysteresis | None, memory: SignalMemory, asked: Any) -> tuple[Any, SignalMemory]:
    """Voltages (N, m) that act on the blade, from those asked for, and the memory after them."""
    array = namespace(asked)
    commands = array.concatenate([asked[:, None], memory.commands[:, :-1]], axis=1)
    acting = commands[counting(len(asked), asked), faults.delay] if commands.shape[1] > 1 else asked
    plays = memory.plays
    if hysteresis is not None:
        acting, plays = hysteresis.step(acting, plays)
    return acting * faults.actuator_gain, memory._replace(commands=commands, plays=plays)


def acquire(faults: Faults, memory: SignalMemory, output: Any, noise: Any, lost: Any) -> tuple[Any, SignalMemory]:
    """Readings (N, p) in full scales, clipped, from the blade's noise-free output, noise and what is ``lost`` (N, p) or None."""
    array = namespace(output)
    readings = array.clip(output * faults.sensor_gain + faults.sensor_bias + noise, -1.0, 1.0)
    if lost is not None:
        readings = array.where(lost, memory.readings, readings)
    return readings, memory._replace(readings=readings)
