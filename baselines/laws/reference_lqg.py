"""The reference: LQG of all that is known of the blade, with a price on quick changes of the voltage, and of low order.

An LQG of the thesis' eleven modes does not know the twelfth, and on a blade that has it, behind amplifiers and filters, it is
unstable. This one is designed on the whole of the design blade's plant, every mode up to the Nyquist frequency and the electronics,
and then reduced: what is left out is memory of the law, in the closed loop, not modes of the plant.
"""

from __future__ import annotations

from baselines.analysis.stationary import stationary_cost
from baselines.design.linear import LinearController
from baselines.design.rate_penalty import with_rate_penalty
from baselines.design.riccati import sampled_kalman_filter, sampled_regulator
from baselines.laws.lqg import compensator, known_sensor_noise
from baselines.laws.reduction import reduced
from beamenv.plant.plant import Plant, sample

RATE_WEIGHT = 1.0
"""Of changes of the voltage over that of the voltage itself: on the thesis' blade it costs 0.3 % and keeps the law in place where
the blade is another than its design."""

ALLOWANCE = 0.005
"""Share of the mean cost that reducing the law may add."""


def full_order_lqg(plant: Plant, rate_weight: float = RATE_WEIGHT) -> LinearController:
    """The sampled optimum for the plant's cost with ``rate_weight`` (u − u₋)ᵀ diag(R) (u − u₋) of each interval on top.

    Raises ``ValueError`` for a weight that is negative and for a loop that comes out unstable.
    """
    if not rate_weight >= 0.0:
        raise ValueError(f"rate_weight = {rate_weight!r} must be at least 0.")
    held = with_rate_penalty(sample(plant), rate_weight)
    E = held.disturbance_input
    _, K = sampled_regulator(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight)
    _, L = sampled_kalman_filter(held.A, held.C, E @ held.process_noise @ E.T, known_sensor_noise(plant) / held.interval)
    law = compensator(plant, "LQG", held, K, L)
    if not stationary_cost(plant, law) < float("inf"):
        raise ValueError(f"rate_weight = {rate_weight!r} leaves LQG unstable on its own plant.")
    return law


def reference_lqg(plant: Plant, rate_weight: float = RATE_WEIGHT, order: int | None = None) -> LinearController:
    """``full_order_lqg`` with ``order`` numbers in its memory; None: the least even number that adds no more than 0.5 % to the mean
    cost under the plant's own noise.

    ``plant`` is all that is known of the blade, such as ``Design.full_plant``. Raises ``ValueError`` as its parts do.
    """
    whole = full_order_lqg(plant, rate_weight)
    if order is not None:
        return reduced(plant, whole, order)
    allowed = (1.0 + ALLOWANCE) * stationary_cost(plant, whole)
    shortest, low, high = whole, 1, whole.order // 2
    while low < high:  # the cost falls with the order, but for rounding
        middle = (low + high) // 2
        candidate = _reduced_or_none(plant, whole, 2 * middle)
        if candidate is not None and stationary_cost(plant, candidate) <= allowed:
            shortest, high = candidate, middle
        else:
            low = middle + 1
    return shortest


def _reduced_or_none(plant: Plant, law: LinearController, order: int) -> LinearController | None:
    try:
        return reduced(plant, law, order)
    except ValueError:
        return None
