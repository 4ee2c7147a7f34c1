"""A linear controller on a plant under white noise: closed-loop poles and the exact mean cost, without a simulation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from baselines.design.linear import LinearController, linear
from baselines.design.loop import closed_loop, sampled
from baselines.design.lyapunov import accumulated
from beamenv.plant.plant import Plant, SampledPlant


def stationary_cost(plant: Plant | SampledPlant, controller: LinearController) -> float:
    """The long-run mean of J per second (J), under the plant's white loads and sensor noise, without drive limits.

    A plant that is sampled already, such as one with the states of a sustained load, is taken as it is.

    With X = [x; ξ] and noise n = [d; v], X⁺ = Φ X + Γ n and z = [x; u; d] = Z_x X + Z_n n, so Σ = ΦΣΦᵀ + ΓNΓᵀ and the mean
    is tr(cost (Z_x Σ Z_xᵀ + Z_n N Z_nᵀ))/Δt. Infinite when the loop is unstable. Raises ValueError for a controller that is not
    linear.
    """
    law = linear(controller)
    held = sampled(plant, law)
    transition, noise_input, state_map, noise_map, covariance = closed_loop(held, law)
    spread = accumulated(transition, noise_input @ covariance @ noise_input.T)
    if spread is None:
        return float("inf")
    second_moment = state_map @ spread @ state_map.T + noise_map @ covariance @ noise_map.T
    return float(np.sum(held.cost * second_moment) / held.interval)


def closed_loop_poles(plant: Plant | SampledPlant, controller: LinearController) -> NDArray[np.complex128]:
    """Poles of plant and controller together, as the continuous equivalents log(z)/Δt in rad/s (complex), slowest first.

    Poles of the sampled loop at z = 0 have no continuous equivalent and are left out. Raises ValueError for a controller that is
    not linear.
    """
    law = linear(controller)
    held = sampled(plant, law)
    poles = np.linalg.eigvals(closed_loop(held, law)[0])
    poles = np.log(poles[np.abs(poles) > 1e-12].astype(complex)) / held.interval
    return np.asarray(poles[np.argsort(-poles.real)])
