"""The sampled loop of a plant and a linear law, as matrices, and whether it dies away."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from baselines.design.controller import Array, Observes
from baselines.design.feedthrough import with_feedthrough
from baselines.design.instruments import checked_plant
from beamenv.plant.plant import Plant, SampledPlant, sample


class LinearLaw(Protocol):
    """What is asked here of a ``LinearController``, which says what its matrices are; it is built on this, not this on it."""

    @property
    def name(self) -> str:
        """What sentences call it."""
        ...

    @property
    def observes(self) -> Observes:
        """What it measures."""
        ...

    @property
    def transition(self) -> Array:
        """F (s, s)."""
        ...

    @property
    def measurement_input(self) -> Array:
        """G (s, p)."""
        ...

    @property
    def voltage_input(self) -> Array:
        """H (s, m)."""
        ...

    @property
    def state_gain(self) -> Array:
        """M (m, s)."""
        ...

    @property
    def measurement_gain(self) -> Array:
        """T (m, p)."""
        ...


def sampled(plant: Plant | SampledPlant, law: LinearLaw | None = None) -> SampledPlant:
    """The plant as it is, or sampled; ``ValueError`` for what is neither.

    What readings show of the voltages before is part of its state (``with_feedthrough``), but for a ``law`` that observes the state
    and reads no sensor.
    """
    held = plant if isinstance(plant, SampledPlant) else sample(checked_plant(plant))
    return held if law is not None and law.observes == "state" else with_feedthrough(held)


def spectral_radius(transition: Array) -> float:
    """Largest magnitude of a transition matrix's poles: below 1 all dies away."""
    return float(np.abs(np.linalg.eigvals(transition)).max(initial=0.0))


def closed_loop(held: SampledPlant, law: LinearLaw) -> tuple[Array, Array, Array, Array, Array]:
    """Φ, Γ, Z_x, Z_n of X⁺ = Φ X + Γ n, z = Z_x X + Z_n n and the covariance N of n = [d; v]; u = T C x + M ξ + T v.

    ``held`` is as ``sampled`` gives it for the law. Raises ValueError for a law that has other measurements or voltages than the
    plant.
    """
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
