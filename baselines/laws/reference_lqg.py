"""The reference: LQG of all that is known of the blade, with a price on quick changes of the voltage, and of low order.

An LQG of the thesis' eleven modes does not know the twelfth, and on a blade that has it, behind amplifiers and filters, it is
unstable. This one is designed on the whole of the design blade's plant, every mode up to the Nyquist frequency and the electronics,
and then reduced: what is left out is memory of the law, in the closed loop, not modes of the plant.
"""

from __future__ import annotations

from collections.abc import Sequence

from baselines.analysis.stationary import stationary_cost
from baselines.design.instruments import checked_plant
from baselines.design.linear import LinearController
from baselines.design.load_model import Load, checked_loads
from baselines.design.verification import verified
from baselines.laws.lqg import compensator, sampled_design, sampled_with_loads
from baselines.laws.reduction import reduced, truncations
from beamenv.configuration import Text, checked
from beamenv.plant.plant import Plant, SampledPlant

RATE_WEIGHT = 1.0
"""Of changes of the voltage over that of the voltage itself: on the thesis' blade it costs 0.23 % in white noise and keeps the law
in place where the blade is another than its design."""

ALLOWANCE = 0.005
"""Share of the mean cost that reducing the law may add."""


def full_order_lqg(
    plant: Plant,
    rate_weight: float = RATE_WEIGHT,
    *,
    load: Load | Sequence[Load] | None = None,
    name: str = "LQG",
    verify: bool = True,
) -> LinearController:
    """The sampled LQG for the plant's cost plus, in each interval, ``rate_weight`` (u − u₋)ᵀ diag(R) (u − u₋).

    The added term is a price on quick changes: u₋ is the voltage of the interval before. ``load`` adds the states of one or
    several loads that can be foreseen, such as ``PersistentLoad`` or ``RotorHarmonics``. The loop is ``verified`` on ``plant``
    unless ``verify=False``. Raises ``ValueError`` for a negative weight, for what is no load, and as ``lqg`` does.
    """
    loads = checked_loads("load", load)
    held, regulated, filtered = sampled_design(checked_plant(plant), *loads, rate_weight=rate_weight)
    law = compensator(plant, checked("name", name, Text(line=True)), held, regulated.gain, filtered.gain)
    return verified(law, plant, regulated, filtered, instead="another rate_weight", verify=verify)


def reference_lqg(
    plant: Plant,
    rate_weight: float = RATE_WEIGHT,
    order: int | None = None,
    *,
    load: Load | Sequence[Load] | None = None,
    name: str = "LQG",
    verify: bool = True,
) -> LinearController:
    """The LQG of ``full_order_lqg``, reduced in the closed loop to ``order`` states.

    By default ``order`` is the least even number with which the mean cost, under the plant's own noise and the ``load``, rises by
    no more than 0.5 %. ``plant`` is all that is known of the blade, such as ``Design.full_plant``; the reduced controller is
    ``verified`` on it unless ``verify=False``. Raises ``ValueError`` as ``full_order_lqg`` does, and for a full-order loop that
    is not stable, which cannot be reduced.
    """
    whole = full_order_lqg(plant, rate_weight, load=load, name=name)
    loaded = sampled_with_loads(plant, *checked_loads("load", load))
    if order is not None:
        return reduced(loaded, whole, order, verify=verify)
    return verified(_least(loaded, whole), plant, verify=verify)


def _least(loaded: SampledPlant, whole: LinearController) -> LinearController:
    """Of the least even order within the allowance."""
    allowed, of = (1.0 + ALLOWANCE) * stationary_cost(loaded, whole), truncations(loaded, whole)
    shortest, low, high = whole, 1, whole.order // 2
    while low < high:  # the cost falls with the order, but for rounding
        middle = (low + high) // 2
        candidate = of(2 * middle)
        if stationary_cost(loaded, candidate) <= allowed:
            shortest, high = candidate, middle
        else:
            low = middle + 1
    return shortest
