"""What the classical laws have in common: instruments, a memory for each blade, and SB3's ``predict`` around one decision."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from baselines.design.controller import Array, Observes
from baselines.design.instruments import Instruments
from beamenv.configuration import Refused

if TYPE_CHECKING:
    from typing_extensions import Self


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Law(ABC):
    """A sampled law with a memory of ``order`` numbers, zero at the start of an episode, for one blade or a batch.

    A law says how it decides; batches, forgetting, bad input and units are the same for all and stand here.
    """

    name: str
    """What tables and figures call it."""
    instruments: Instruments
    """What it reads and drives; its matrices are in A and V whatever units they use."""

    @property
    @abstractmethod
    def order(self) -> int:
        """Numbers in a blade's memory."""

    @abstractmethod
    def decide(self, observation: Array, memory: Array) -> tuple[Array, Array]:
        """Action (…, m) and next memory (…, order) from an observation (…, p) and a memory that have been checked."""

    def predict(
        self,
        observation: ArrayLike,
        state: Array | None = None,
        episode_start: ArrayLike | None = None,
        deterministic: bool = True,
    ) -> tuple[Array, Array | None]:
        """Action (m,) or (N, m) in units of the drive limit, and the next memory (None for a law without memory).

        ``observation`` (p,) or (N, p) is normalised as the environment gives it, and what the law ``observes``; rows where
        ``episode_start`` is true forget their memory. Raises ValueError for an observation of another length, for a memory of
        another shape, and for what are no numbers.
        """
        seen, order = numbers("observation", observation), self.order
        if seen.ndim not in (1, 2) or seen.shape[-1] != self.instruments.measurement_scale.size:
            raise ValueError(
                f"observation has shape {seen.shape}, but {self.name} takes {self.observes} vectors of length "
                f"{self.instruments.measurement_scale.size}, alone or in rows."
            )
        action, following = self.decide(seen, remembered(state, episode_start, seen.shape[:-1], order))
        return action, following if order else None

    @property
    def observes(self) -> Observes:
        """Whether ``predict`` wants the sensors' observation, with the rotor speed behind it, or the true state."""
        return self.instruments.observes

    def in_physical_units(self) -> Self:
        """The same law taking amperes and giving volts, for an environment made with ``physical_units=True``."""
        return replace(self, instruments=self.instruments.in_physical_units())

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r}: order {self.order}; {self.instruments.sizes})"


def remembered(state: Any, episode_start: Any, batch: tuple[int, ...], order: int) -> Array:
    """The memory (*batch, order) that a decision starts from: zero without a state, and where an episode starts.

    Raises ValueError of one sentence for a state of another shape, and for what is not one flag for each blade.
    """
    if state is None:
        return np.zeros((*batch, order))
    memory = numbers("state", state)
    if memory.shape != (*batch, order):
        raise ValueError(f"state has shape {memory.shape}, but must have shape {(*batch, order)}, as the law gave it.")
    return memory if episode_start is None else np.where(_begins(episode_start, batch)[..., None], 0.0, memory)


def _begins(given: Any, batch: tuple[int, ...]) -> NDArray[np.bool_]:
    """(*batch,): one flag for each blade, or one for all; zeros and ones are such."""
    try:
        flags = np.asarray(given)
    except (TypeError, ValueError, RuntimeError):
        flags = np.array(None)
    if flags.dtype.kind not in "b" and not (flags.dtype.kind in "iuf" and np.isin(flags, (0, 1)).all()):
        raise Refused("episode_start", given, "true or false for each blade")
    if flags.size not in (1, math.prod(batch)):
        raise ValueError(f"episode_start has shape {flags.shape}, but must have one flag for each blade, {batch}.")
    return np.broadcast_to(flags.reshape(batch if flags.size == math.prod(batch) else ()), batch) != 0


def numbers(name: str, value: Any) -> Array:
    """The numbers as float64, finite or not, itself where it is such an array; ``ValueError`` of one sentence for anything else."""
    if type(value) is np.ndarray and value.dtype == np.float64:  # a blade alone has no time to look closer
        return value
    if isinstance(value, (bytes, bytearray, memoryview)):
        raise Refused(name, value, "an array of numbers")
    try:
        given = np.asarray(value)
        if given.dtype.kind not in "fiu":
            raise TypeError
        return np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError, RuntimeError, OverflowError):  # torch raises the third of a tensor that wants a gradient
        raise Refused(name, value, "an array of numbers") from None
