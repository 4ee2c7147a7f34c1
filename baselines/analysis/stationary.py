"""A linear controller on a plant under white noise: closed-loop poles and the exact mean cost, without a simulation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from baselines.design.controller import Array
from baselines.design.linear import LinearController, linear
from beamenv.plant.plant import Plant, SampledPlant, sample

_FORGOTTEN = 1e-20
"""Of what was there at the start, when all of it counts as gone; the inverse says that it grows."""

_DOUBLINGS = 50
"""2⁵⁰ intervals: a loop that needs longer counts as unstable."""


def stationary_cost(plant: Plant | SampledPlant, controller: LinearController) -> float:
    """Mean of J per second (J) in the long run, under the plant's white loads and sensor noise, voltages unlimited.

    A plant that is sampled already, such as one with states of loads that last, is taken as it is.

    With X = [x; ξ] and noise n = [d; v], X⁺ = Φ X + Γ n and z = [x; u; d] = Z_x X + Z_n n, so Σ = ΦΣΦᵀ + ΓNΓᵀ and the mean
    is tr(cost (Z_x Σ Z_xᵀ + Z_n N Z_nᵀ))/Δt. Infinite when the loop is unstable. Raises ValueError for a law that is not linear.
    """
    held = plant if isinstance(plant, SampledPlant) else sample(plant)
    transition, noise_input, state_map, noise_map, covariance = closed_loop(held, controller)
    spread = _spread(transition, noise_input @ covariance @ noise_input.T)
    if spread is None:
        return float("inf")
    second_moment = state_map @ spread @ state_map.T + noise_map @ covariance @ noise_map.T
    return float(np.sum(held.cost * second_moment) / held.interval)


def _spread(transition: Array, added: Array) -> Array | None:
    """Σ = Φ Σ Φᵀ + N as the sum of Φᵏ N Φᵏᵀ, twice as many terms at every step; None if it has no end.

    Smith, SIAM J. Applied Mathematics 16, 1968: no eigenvalues are needed to see that a loop is unstable.
    """
    power, spread = transition, added
    for _ in range(_DOUBLINGS):
        spread = spread + power @ spread @ power.T
        power = power @ power
        size = float(np.abs(power).max(initial=0.0))
        if size < _FORGOTTEN:
            return np.asarray(0.5 * (spread + spread.T))
        if not size < 1.0 / _FORGOTTEN:
            return None
    return None


def closed_loop_poles(plant: Plant, controller: LinearController) -> NDArray[np.complex128]:
    """Poles of plant and controller together, as the continuous equivalents log(z)/Δt in rad/s (complex), slowest first.

    Poles of the sampled loop at z = 0 have no continuous equivalent and are left out. Raises ValueError for a law that is not
    linear.
    """
    held = sample(plant)
    poles = np.linalg.eigvals(closed_loop(held, controller)[0])
    poles = np.log(poles[np.abs(poles) > 1e-12].astype(complex)) / held.interval
    return np.asarray(poles[np.argsort(-poles.real)])


def closed_loop(held: SampledPlant, law: LinearController) -> tuple[Array, Array, Array, Array, Array]:
    """Φ, Γ, Z_x, Z_n of X⁺ = Φ X + Γ n, z = Z_x X + Z_n n and the covariance N of n = [d; v]; u = T C x + M ξ + T v.

    Raises ValueError for a law that is not linear, or has other measurements or voltages than the plant.
    """
    law = linear(law)
    (n, m), s, k = held.B.shape, len(law.transition), held.disturbance_input.shape[1]
    C, V = (held.C, held.sensor_noise) if law.observes == "observation" else (np.eye(n), np.zeros((n, n)))
    p = len(C)
    if law.measurement_gain.shape != (m, p):
        raise ValueError(
            f"controller = {law.name} takes {law.measurement_gain.shape[1]} measurements and gives {len(law.measurement_gain)} "
            f"voltages, but the plant has {p} and {m}"
        )
    voltage = np.hstack([law.measurement_gain @ C, law.state_gain])
    transition = np.block([[held.A, np.zeros((n, s))], [law.measurement_input @ C, law.transition]])
    transition += np.vstack([held.B, law.voltage_input]) @ voltage
    noise_input = np.block([[held.disturbance_input, np.zeros((n, p))], [np.zeros((s, k)), law.measurement_input]])
    noise_input[:, k:] += np.vstack([held.B, law.voltage_input]) @ law.measurement_gain
    state_map = np.vstack([np.eye(n, n + s), voltage, np.zeros((k, n + s))])
    noise_map = np.zeros((n + m + k, k + p))
    noise_map[n : n + m, k:] = law.measurement_gain
    noise_map[n + m :, :k] = np.eye(k)
    covariance = np.block([[held.process_noise, np.zeros((k, p))], [np.zeros((p, k)), V]])
    return transition, noise_input, state_map, noise_map, covariance
