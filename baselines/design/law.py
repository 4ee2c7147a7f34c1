"""What the classical laws have in common: instruments, a memory for each blade, and SB3's ``predict`` around one decision."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from baselines.design.controller import Array, Observes
from baselines.design.instruments import Instruments, checked_instruments
from baselines.design.predicting import observed, remembered
from beamenv.configuration import Text, checked

if TYPE_CHECKING:
    import control
    from typing_extensions import Self


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Law(ABC):
    """Base class of controllers: sampled, with a memory of ``order`` numbers, zero at an episode's start, for one blade or a batch.

    A subclass says how it decides. Batches, the reset of the memory, checks of the input and units are the same for all, and are
    handled here.
    """

    name: str
    """What tables and figures call it."""
    instruments: Instruments
    """What it reads and drives; its matrices are in A and V whatever units they use."""

    def __post_init__(self) -> None:
        """``ValueError`` for a name that is no text of one line and for instruments that are none."""
        checked("name", self.name, Text(line=True))
        checked_instruments(self.instruments)

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
        """Action (m,) or (N, m) in units of the drive limit, and the next memory (None for a controller without memory).

        ``observation`` (p,) or (N, p) is what the controller ``observes``, normalised as the environment gives it; in rows where
        ``episode_start`` is true the memory is reset. Raises ValueError for an observation of another length or not finite, and
        for a ``state`` or ``episode_start`` that does not fit this controller and this batch.
        """
        seen, order = observed(observation, self.name, self.observes, self.instruments.measurement_scale.size), self.order
        action, following = self.decide(seen, remembered(state, episode_start, seen.shape[:-1], order))
        return action, following if order else None

    @property
    def observes(self) -> Observes:
        """Whether ``predict`` wants the sensors' observation, with the rotor speed behind it, or the true state."""
        return self.instruments.observes

    def in_physical_units(self) -> Self:
        """The same controller, taking amperes and giving volts, for an environment made with ``physical_units=True``."""
        return replace(self, instruments=self.instruments.in_physical_units())

    def to_control(self) -> control.StateSpace:
        """A linear controller as a ``control.StateSpace``; ValueError for any other."""
        kind = f"{self.name} ({type(self).__name__})"
        raise ValueError(f"law = {kind} is not linear, so it is no control.StateSpace: allowed is a LinearController.")

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r}: order {self.order}; {self.instruments.sizes})"
