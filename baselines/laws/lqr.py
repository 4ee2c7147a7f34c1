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
    """Feedback u = −K x with the gain that is least in the environment's own cost, integrated exactly between samples.

    It ``observes`` the true state (n,), which ``evaluate`` hands it: a reference, no rival. It is a bound with white loads and no
    saturation: nothing that holds its voltages over the control interval costs less. Under a load that lasts it is none: it takes
    the static deflection for motion. ``persistent_load`` makes it one again: the load of each past interval is worked out exactly
    from two true states, filtered (it is the lasting load and the white one together; without white loads it is known as it is),
    and answered. ``Q`` and ``R`` are other weights than the plant's, as in ``lqg``; in them it is the optimum then. ``verified`` on
    ``plant`` unless ``verify=False``; raises ValueError as ``lqg`` does.
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
