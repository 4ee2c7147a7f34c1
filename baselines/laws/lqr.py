"""LQR: the sampled-data optimal regulator on the true state, an upper bound that no real blade can reach."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from baselines.design.instruments import Instruments
from baselines.design.linear import LinearController, static_law
from baselines.design.persistent_load import PersistentLoad, with_persistent_load
from baselines.design.riccati import sampled_kalman_filter, sampled_regulator
from baselines.design.weights import weighted
from beamenv.plant.plant import Plant, sample


def lqr(
    plant: Plant, persistent_load: PersistentLoad | None = None, *, Q: ArrayLike | None = None, R: ArrayLike | None = None
) -> LinearController:
    """Feedback u = −K x with the gain that is least in the environment's own cost, integrated exactly between samples.

    An upper bound on performance: it ``observes`` the true state (n,), which ``evaluate`` hands it. With white loads and no
    saturation nothing that holds its voltages over the control interval costs less. Under a load that lasts it is none: it takes
    the static deflection for motion. ``persistent_load`` makes it one again: the load of each past interval is worked out exactly
    from two true states, filtered (it is the lasting load and the white one together), and answered. ``Q`` and ``R`` are other
    weights than the plant's, as in ``lqg``; in them it is the optimum then.
    """
    held = sample(weighted(plant, Q, R))
    if persistent_load is None:
        _, gain = sampled_regulator(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight)
        return static_law(plant, "LQR (true state)", -gain, observes="state")
    both = with_persistent_load(held, persistent_load)
    n, k = held.disturbance_input.shape
    _, K = sampled_regulator(both.A, both.B, both.state_weight, both.input_weight, both.cross_weight)
    decay, change = both.A[n:, n:], both.process_noise[k:, k:]
    _, L = sampled_kalman_filter(decay, np.eye(k), change, held.process_noise)
    felt = decay @ L @ np.linalg.pinv(held.disturbance_input)  # (k, n): from x − (A x + B u of the interval before) to the estimate
    estimate = np.hstack([-felt, decay @ (np.eye(k) - L)])
    return LinearController(
        name="LQR with load estimate (true state)",
        instruments=Instruments.of(plant, "state"),
        transition=np.vstack([np.zeros((n, n + k)), estimate]),
        measurement_input=np.vstack([held.A, felt]),
        voltage_input=both.B,
        state_gain=-K[:, n:] @ estimate,
        measurement_gain=-K[:, :n] - K[:, n:] @ felt,
    )
