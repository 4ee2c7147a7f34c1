"""Collocated negative velocity feedback: each actuator opposes the strain rate that its own sensor feels."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from baselines.analysis.stationary import stationary_cost
from baselines.design.controller import Array
from baselines.design.instruments import checked_plant
from baselines.design.linear import LinearController, static_law
from baselines.design.loop import sampled
from baselines.design.matrix import one_or_each
from baselines.design.objects import optional_instance
from baselines.design.verification import verified
from baselines.laws.gain_search import least_cost_gains
from beamenv.plant.plant import Plant

_DECADES = np.linspace(-6.0, 1.0, 36)
"""Exponents of the common gains tried, in units of the gain that damps at about the first mode's own rate."""


def velocity_feedback(
    plant: Plant, gain: ArrayLike | None = None, *, tuned_on: Plant | None = None, verify: bool = True
) -> LinearController:
    """Collocated velocity feedback: u_j = −g_j y_j, where y_j is the current of the sensor under actuator j.

    With ganged drive (m = 1) the one voltage answers the mean of the sensors. ``gain`` in V/A is one number, or one for each
    actuator. By default the gains are those with the least stationary cost under the
    white loads and sensor noise of the plant, or of ``tuned_on``, such as ``Design.full_plant``, among those that keep that sampled
    loop stable. The thesis' sensors lie across the section from their actuators and so feel bending alike but extension with the
    opposite sign: with one gain for all pairs the extension mode soon goes unstable, with one each the pairs keep it damped between
    them. The loop is ``verified`` on the plant, or on ``tuned_on``, unless ``verify=False``. Raises ValueError if sensors and
    actuators cannot be paired, if the plant has filters between blade and readings (they hide what a pair feels), if ``gain`` has
    another shape, and if the loop is unstable with the given gain or with every gain that was tried.
    """
    pairs = pairing(checked_plant(plant), "velocity feedback")
    meant_for = optional_instance("tuned_on", tuned_on, Plant, "a beamenv.Plant, such as design.full_plant") or plant
    felt = np.diag(pairs @ plant.C @ plant.B)
    if not felt.any():
        raise ValueError(
            "plant shows nowhere the velocity that its voltages change: allowed are sensors of currents or velocities, unfiltered "
            "(those of the design plant, with tuned_on= for this one)."
        )
    pairs = pairs * np.sign(felt)[:, None]  # so that −(the current) takes energy out
    given = None if gain is None else one_or_each("gain", gain, len(pairs), "actuator")
    gains = _least_cost_gains(plant, meant_for, pairs) if given is None else given
    return verified(_law(plant, "velocity feedback", pairs, gains), meant_for, instead="a smaller gain", verify=verify)


def _law(plant: Plant, name: str, pairs: Array, gains: Array) -> LinearController:
    return static_law(plant, name, -np.broadcast_to(gains, len(pairs))[:, None] * pairs)


def pairing(plant: Plant, name: str) -> Array:
    """(m, p): which sensor each actuator answers.

    Raises ValueError, with the ``name`` of the controller, for a plant whose sensors and actuators do not make pairs.
    """
    m, p = plant.B.shape[1], len(plant.C)
    if m not in (1, p):
        raise ValueError(
            f"plant has {m} actuators and {p} sensors, which {name} cannot pair: "
            "it needs one sensor to each actuator, or one ganged actuator."
        )
    return np.eye(p) if m == p else np.full((1, p), 1.0 / p)


def _least_cost_gains(plant: Plant, tuned_on: Plant, pairs: Array) -> Array:
    """(m,): first the best common gain, by decades, then each for itself from there (Nelder and Mead's simplex)."""
    collocated = np.abs(np.diag(pairs @ plant.C @ plant.B)).max()
    unit = float(plant.natural_frequencies[0] / collocated)  # damps at about the first mode's own rate
    held = sampled(tuned_on)

    def cost(gains: Array) -> float:
        return stationary_cost(held, _law(plant, "trial", pairs, unit * gains))

    return unit * least_cost_gains(cost, 10.0**_DECADES, len(pairs), "velocity feedback", maxiter=800)
