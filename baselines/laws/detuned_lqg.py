"""LQG whose design is told other than the plant's own numbers: a delay, dearer voltages, noisier sensors, dearer changes."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from baselines.design.delay import MOST_LATE, with_delay
from baselines.design.instruments import checked_plant
from baselines.design.linear import LinearController
from baselines.design.load_model import Load, checked_loads
from baselines.design.loop import sampled
from baselines.design.objects import instance
from baselines.design.riccati import Solution
from baselines.design.verification import verified
from baselines.laws.lqg import compensator, sampled_design
from beamenv.configuration import Count, Flag, Number, Text, checked, configuration
from beamenv.plant.plant import Plant, SampledPlant


@configuration("detuning")
class Detuning:
    """The fictitious delay, weights and noise of an LQG's design; by default the reference's price on quick changes alone."""

    delay: Annotated[int, Count(0, MOST_LATE)] = 0
    """d, control intervals by which voltages come late."""
    effort: Annotated[float, Number(gt=0.0, le=1e6)] = 1.0
    """r, over the plant's own price of voltages."""
    noise: Annotated[float, Number(gt=0.0, le=1e6)] = 1.0
    """v, over the root mean square of the plant's own sensor noise."""
    rate: Annotated[float, Number(ge=0.0, le=1e6)] = 1.0
    """s, of changes of the voltage over the price of the voltage itself."""
    foresees: Annotated[bool, Flag()] = False
    """Whether the loads that can be foreseen are part of the state."""


CAUTIOUS = Detuning(delay=1, rate=27.0)
"""What holds where nothing is known of what is wrong: of fourteen detunings, and of those that cost at most 3 % more than the
reference in `nominal`, the best in the mean of `delay` and `unknown-everything`. J over no control's of the reference and of this
one, 24 validation seeds from 3 000 000 on: nominal 0.577 and 0.591, delay 3.67 and 0.602, unknown-everything 0.725 and 0.581."""


def detuned_lqg(plant: Plant, detuning: Detuning, *loads: Load, name: str = "detuned LQG") -> LinearController:
    """The sampled LQG of a plant with the delay, weights and noise of ``detuning``; the loop is ``verified`` on that plant.

    ``loads`` are the loads that may be part of its state, if ``detuning.foresees`` says so.

    Robustness by fictitious noise and weights is loop transfer recovery's idea (Doyle and Stein, IEEE Trans. Automatic Control 24,
    1979; Anderson and Moore, Optimal Control, 1990, ch. 8). Raises ``ValueError`` as ``lqg`` does.
    """
    held, regulated, filtered = detuned_design(plant, detuning, *loads)
    law = compensator(plant, checked("name", name, Text()), held, regulated.gain, filtered.gain)
    return verified(law, with_delay(sampled(plant), detuning.delay), regulated, filtered, instead="another detuning")


def detuned_design(plant: Plant, detuning: Detuning, *loads: Load) -> tuple[SampledPlant, Solution, Solution]:
    """The sampled plant that the design is told of, its regulator and its filter; ``ValueError`` as ``sampled_design``."""
    detuning = instance("detuning", detuning, Detuning, "a Detuning, such as Detuning(delay=2)")
    loads = checked_loads("loads", list(loads))
    told = replace(checked_plant(plant), sensor_noise=detuning.noise**2 * plant.sensor_noise)
    told = replace(told, input_weight=detuning.effort * plant.input_weight)
    return sampled_design(told, *(loads if detuning.foresees else ()), rate_weight=detuning.rate, delay=detuning.delay)
