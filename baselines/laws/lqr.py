"""LQR: the sampled-data optimal regulator on the full state, which no sensor of a real blade offers."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from baselines.design.controller import Array
from baselines.design.instruments import Instruments
from baselines.design.linear import LinearController, static_law
from baselines.design.load_model import model_of, with_load
from baselines.design.persistent_load import PersistentLoad, checked_persistent_load
from baselines.design.riccati import sampled_kalman_filter, sampled_regulator
from baselines.design.verification import solvable, verified
from baselines.design.weights import weighted
from beamenv.plant.plant import Plant, SampledPlant, sample

_SEEN_AT_ONCE = 1e-12
"""Of a lasting load's variance: white load this weak, or none, hides nothing of it."""


def lqr(
    plant: Plant,
    persistent_load: PersistentLoad | None = None,
    *,
    Q: ArrayLike | None = None,
    R: ArrayLike | None = None,
    verify: bool = True,
) -> LinearController:
    """State feedback u = −K x with the gain of least cost, in the environment's own cost integrated exactly between samples.

    The controller ``observes`` the true state (n,), which ``evaluate`` hands to it and no sensor offers: it is a reference, not a
    rival. With white loads and no saturation its cost is a lower bound for every controller that holds its voltages over the
    control interval. Under a sustained load it is no bound, because it takes the static deflection for motion. With
    ``persistent_load`` it is one again: the load of each past interval follows exactly from two true states, is filtered (it is
    the sum of the sustained load and the white one) and answered. ``Q`` and ``R`` replace the plant's weights, as in ``lqg``; the
    gain is then optimal for these. The loop is ``verified`` on ``plant`` unless ``verify=False``. Raises ValueError as ``lqg``.
    """
    held, load = sample(weighted(plant, Q, R)), checked_persistent_load(persistent_load)
    if load is not None:
        return _with_load(plant, held, load, verify)
    with solvable(plant):
        regulated = sampled_regulator(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight)
    return verified(static_law(plant, "LQR (full state)", -regulated.gain, observes="state"), plant, regulated, verify=verify)


def _with_load(plant: Plant, held: SampledPlant, load: PersistentLoad, verify: bool) -> LinearController:
    both = with_load(held, model_of(load, plant))
    n, k = held.disturbance_input.shape
    decay, change = both.A[n:, n:], both.process_noise[k:, k:]
    hidden = held.process_noise + np.diag(np.where(np.diag(held.process_noise) > 0.0, 0.0, _SEEN_AT_ONCE * np.diag(change)))
    with solvable(plant):
        regulated = sampled_regulator(both.A, both.B, both.state_weight, both.input_weight, both.cross_weight)
        filtered = sampled_kalman_filter(decay, np.eye(k), change, hidden)
    K, L = regulated.gain, filtered.gain
    felt: Array = decay @ L @ np.linalg.pinv(held.disturbance_input)  # (k, n): from x − (A x + B u of the interval before)
    estimate = np.hstack([-felt, decay @ (np.eye(k) - L)])
    law = LinearController(
        name="LQR with load estimate (full state)",
        instruments=Instruments.of(plant, "state"),
        transition=np.vstack([np.zeros((n, n + k)), estimate]),
        measurement_input=np.vstack([held.A, felt]),
        voltage_input=both.B,
        state_gain=-K[:, n:] @ estimate,
        measurement_gain=-K[:, :n] - K[:, n:] @ felt,
    )
    return verified(law, plant, regulated, filtered, verify=verify)
