"""What a linear law makes of loads that are known, without noise: the closed loop as a recursion, drive limits included."""

from __future__ import annotations

import numpy as np

from baselines.design.controller import Array
from baselines.design.linear import LinearController, linear
from baselines.design.loop import closed_loop, sampled
from beamenv.plant.plant import SampledPlant


def linear_response(held: SampledPlant, controller: LinearController, loads: Array) -> tuple[Array, Array]:
    """States (K + 1, n) and voltages (K, m) in V from rest, under line loads (K, k) in N/m, each held over its interval. Exact.

    Where readings show voltages, what they show are the last states.

    X = [x; ξ] is blade and memory, u = clip(T C x + M ξ) and X⁺ = [A x; F ξ + G C x] + [B; H] u + [E d; 0]. Readings are neither
    noisy nor clipped. Raises ValueError for a law that is not linear.
    """
    law = linear(controller)
    held = sampled(held, law)
    n, m = held.B.shape
    gain = closed_loop(held, law)[2][n : n + m]
    measured = held.C if law.observes == "observation" else np.eye(n)
    s, (lowest, highest) = law.order, law.instruments.voltage_limits
    transition = np.block([[held.A, np.zeros((n, s))], [law.measurement_input @ measured, law.transition]])
    drive = np.vstack([held.B, law.voltage_input])
    pushes = np.hstack([loads @ held.disturbance_input.T, np.zeros((len(loads), s))])
    both, voltages = np.zeros((len(loads) + 1, n + s)), np.zeros((len(loads), m))
    for step, push in enumerate(pushes):
        voltages[step] = u = np.minimum(np.maximum(gain @ both[step], lowest), highest)
        both[step + 1] = transition @ both[step] + drive @ u + push
    return both[:, :n], voltages
