"""LQR: the sampled-data optimal regulator on the true state, an upper bound that no real blade can reach."""

from __future__ import annotations

from baselines.controller import LinearController, static_law
from baselines.riccati import sampled_regulator
from beamenv.plant import Plant, sample


def lqr(plant: Plant) -> LinearController:
    """Feedback u = −K x with the gain that is least in the environment's own cost, integrated exactly between samples.

    An upper bound: it ``observes`` the true state (n,), which ``evaluate`` hands it. With white loads and no saturation nothing
    that holds its voltages over the control interval costs less; a persistent load, which it is not told, can still be
    countered better by a law that estimates it.
    """
    held = sample(plant)
    _, gain = sampled_regulator(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight)
    return static_law(plant, "LQR (true state)", -gain, observes="state")
