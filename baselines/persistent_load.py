"""A persistent load as part of the plant, so that a filter can estimate it and a regulator can answer it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beamenv.plant import SampledPlant


@dataclass(frozen=True, slots=True)
class PersistentLoad:
    """Line loads in lag and flap that last: independent first-order Gauss–Markov processes.

    The rule for both numbers: root mean square and length of what may come. Of the environment's default load cases a quarter
    are steps of 30 N/m in any direction, 10 N/m root mean square over all episodes, and they stay for most of 0.5 s. Neither
    needs care: on the default blade from 5 to 20 N/m and from 0.2 to 0.5 s J moves by less than 2 %.
    """

    magnitude: float = 10.0
    """N/m, root mean square."""
    duration: float = 0.25
    """s, correlation time."""

    def __post_init__(self) -> None:
        for name in ("magnitude", "duration"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                raise ValueError(f"{name} = {value!r} of a persistent load is not allowed: it must be a positive number")


def with_persistent_load(held: SampledPlant, load: PersistentLoad) -> SampledPlant:
    """The plant with state [x; d] where d (2,) is the load that lasts, and with disturbances [white load; what changes d].

    The cost stays the plant's own: d bends the blade, and that energy counts.
    """
    n, m = held.B.shape
    k = held.disturbance_input.shape[1]
    decay = float(np.exp(-held.interval / load.duration))
    A = np.block([[held.A, held.disturbance_input], [np.zeros((k, n)), decay * np.eye(k)]])
    B = np.vstack([held.B, np.zeros((k, m))])
    disturbance_input = np.block([[held.disturbance_input, np.zeros((n, k))], [np.zeros((k, k)), np.eye(k)]])
    total = np.zeros((n + m + k, n + k + m + 2 * k))  # [x, u, white + d] from [x, d, u, white, change of d]
    total[:n, :n] = np.eye(n)
    total[n : n + m, n + k : n + k + m] = np.eye(m)
    total[n + m :, n : n + k] = total[n + m :, n + k + m : n + 2 * k + m] = np.eye(k)
    process_noise = np.zeros((2 * k, 2 * k))
    process_noise[:k, :k] = held.process_noise
    process_noise[k:, k:] = (1.0 - decay**2) * load.magnitude**2 * np.eye(k)
    return SampledPlant(
        A=A,
        B=B,
        C=np.hstack([held.C, np.zeros((len(held.C), k))]),
        D=held.D,
        disturbance_input=disturbance_input,
        cost=total.T @ held.cost @ total,
        process_noise=process_noise,
        sensor_noise=held.sensor_noise,
        interval=held.interval,
    )
