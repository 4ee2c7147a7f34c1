"""LQG that is told each episode's truth: its plant, its delay and what is broken. What no real blade offers, and so a reference."""

from __future__ import annotations

from dataclasses import dataclass

from baselines.design.controller import Array
from baselines.design.instruments import Instruments
from baselines.design.objects import instance
from baselines.laws.time_varying_lqg import TimeVaryingLQG
from beamenv.knowledge import Truth


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ClairvoyantLQG(TimeVaryingLQG):
    """The optimum under white noise of the plant, delay and faults that each episode has, over the episode.

    It ``observes`` the readings and the truth as it is now. Under white noise nothing costs less in the mean while no limit acts.
    Drawn loads are no white noise, and limits act: with them it is a reference and not a bound.
    """

    def told(self, seen: Array) -> tuple[Array, Array]:
        """The truth lies behind the readings."""
        p = self._plan.sizes[2]
        return seen[:, :p], seen[:, p:]


def clairvoyant_lqg(truth: Truth) -> ClairvoyantLQG:
    """LQG that is told each episode's plant, delay and faults, and knows the loads that can be foreseen.

    The episodes of a batch may differ in all of these. Gains are computed when a case is first met, for a whole batch together.
    Raises ``ValueError`` for what is no ``Truth``, for a bank of several blades, and for plants that change within an episode, as
    in `drift`, because its gains are for constant plants.
    """
    truth = instance("truth", truth, Truth, "a beamenv.knowledge.Truth, such as env.unwrapped.task.truth")
    return ClairvoyantLQG("clairvoyant LQG", Instruments.of(truth.plant, "observation and truth"), truth)
