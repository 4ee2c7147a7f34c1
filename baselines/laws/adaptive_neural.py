"""Adaptive output feedback by a neural network that augments an LQG (Calise, Hovakimyan and Idan, Automatica 37, 2001)."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from scipy.linalg import expm, solve_discrete_lyapunov

from baselines.design.adapting import AdaptiveNeural
from baselines.design.controller import Array
from baselines.design.error_model import ErrorModel
from baselines.design.hidden_layer import Learning, first_inner_weights
from baselines.design.instruments import Instruments, checked_plant
from baselines.design.linear import LinearController
from baselines.design.loop import closed_loop, sampled
from baselines.design.objects import optional_instance
from baselines.design.persistent_load import PersistentLoad
from baselines.design.rate_penalty import with_rate_penalty
from baselines.design.riccati import sampled_kalman_filter
from baselines.design.verification import solvable
from baselines.laws.lqg import known_sensor_noise, optimal_filter, optimal_regulator, sampled_with_loads
from baselines.laws.reference_lqg import RATE_WEIGHT, reference_lqg
from beamenv.configuration import Count, Number, configuration
from beamenv.plant.plant import Plant, SampledPlant, drive_limit

UNUSUAL = 0.1
"""A force of 1: this part of a mode's own elastic force at its usual deflection."""


@configuration("adaptation")
class AdaptationSettings:
    """What the network is, and how it learns."""

    hidden: Annotated[int, Count(1, 200)] = 24
    """Hidden units."""
    forces: Annotated[int, Count(1, 100)] = 11
    """Modes, the first, whose forces it foresees; voltages instead where a plant has no modes of its own coordinates."""
    lags: Annotated[int, Count(0, 8)] = 3
    """Latest voltages that it is shown."""
    outer_rate: Annotated[float, Number(ge=0.0, le=1.0)] = 1.0
    """γ_W."""
    inner_rate: Annotated[float, Number(ge=0.0, le=1.0)] = 0.1
    """γ_V."""
    forgetting: Annotated[float, Number(ge=0.0, le=0.1)] = 1e-3
    """κ of the e-modification."""
    outer_bound: Annotated[float, Number(gt=0.0, le=1e3)] = 4.0
    """Largest norm of W."""
    inner_bound: Annotated[float, Number(gt=0.0, le=1e3)] = 1.0
    """Largest norm of V − V₀."""
    caution: Annotated[float, Number(gt=0.0, le=1e6)] = 0.1
    """λ: steps are shorter the less is to be seen of a force in the readings, halved where that is λ in innovations squared."""
    surprise: Annotated[float, Number(ge=0.0, le=1e3)] = 0.0
    """Root mean square of the forces that the error observer takes for noise."""
    authority: Annotated[float, Number(gt=0.0, le=2.0)] = 0.5
    """Largest adaptive voltage over the drive limit."""
    gain: Annotated[float, Number(gt=0.0, le=1.0)] = 0.3
    """Length of each hidden unit's first weights: below 1 all are next to linear at usual vibration."""
    seed: Annotated[int, Count(0, 2**32 - 1)] = 0
    """Of the first inner weights."""


def adaptive_neural(
    plant: Plant, base: LinearController | None = None, settings: AdaptationSettings | None = None, *, verify: bool = True
) -> AdaptiveNeural:
    """A linear law augmented by a network that learns within each episode; None: ``reference_lqg(plant)``.

    ``plant`` is all that is known of the blade, such as ``Design.full_plant``. The filter and the regulator that the network's
    forces go through are those of ``full_order_lqg``. The base is ``verified`` on ``plant`` unless ``verify=False``; with what the
    network adds, nothing is promised but that it is bounded. Raises ``ValueError`` for a base that is not linear or stands behind
    other instruments, for settings that are none, and as ``reference_lqg`` does.
    """
    checked_plant(plant)
    given = optional_instance("settings", settings, AdaptationSettings, "an AdaptationSettings, such as AdaptationSettings()")
    chosen = AdaptationSettings() if given is None else given
    own = optional_instance("base", base, LinearController, "a LinearController, such as reference_lqg(plant)")
    law = reference_lqg(plant, verify=verify) if own is None else _behind_instruments(own, plant)
    model = error_model(plant, law, chosen)
    rates, bounds = (chosen.outer_rate, chosen.inner_rate), (chosen.outer_bound, chosen.inner_bound)
    learning = Learning(*rates, chosen.forgetting, *bounds, activity=chosen.hidden * chosen.gain**2)
    start = chosen.gain * first_inner_weights(model.inputs, chosen.hidden, chosen.seed)
    return AdaptiveNeural("adaptive neural LQG", law.instruments, law, model, start, learning, chosen.authority)


def _behind_instruments(base: LinearController, plant: Plant) -> LinearController:
    """The base; ``ValueError`` where it reads and drives other things than the plant has."""
    own, others = base.instruments, Instruments.of(plant)
    for name in ("observes", "counts", "interval", "voltage_limits", "measurement_scale", "voltage_scale"):
        if not np.array_equal(getattr(own, name), getattr(others, name)):
            raise ValueError(f"base has another {name} than the plant: both must stand behind the same instruments.")
    return base


def error_model(plant: Plant, law: LinearController, settings: AdaptationSettings) -> ErrorModel:
    """The design as the reference model of a law, in units of what is usual under a load that lasts."""
    held = sampled(plant)
    filtered, rated = optimal_filter(plant, held), with_rate_penalty(held, RATE_WEIGHT)
    A, C, L = held.A, held.C, filtered.gain
    usual, force_input = _usual(plant, held, law), _force_input(plant, held, settings.forces)
    force_input = force_input * _usual_forces(plant, usual, settings.forces)
    noise = known_sensor_noise(plant) / held.interval
    seen = C.T @ np.linalg.solve(C @ filtered.matrix @ C.T + noise, C)
    loop = A - A @ L @ C
    lyapunov = solve_discrete_lyapunov(loop.T, 0.5 * (seen + seen.T), method="bilinear")
    lyapunov = 0.5 * (lyapunov + lyapunov.T)
    curvature = np.einsum("nq,nq->q", force_input, lyapunov @ force_input)
    return ErrorModel(
        transition=A,
        voltage_input=held.B,
        output=C,
        force_input=force_input,
        feedback_gain=optimal_regulator(plant, rated).gain[:, : len(A)],
        kalman_gain=L,
        observer_gain=_observer_gain(plant, held, settings.surprise * force_input),
        lyapunov=lyapunov,
        direction=lyapunov @ force_input / (settings.caution + curvature),
        full_scale=plant.sensor_full_scale,
        drive=drive_limit(plant),
        usual=usual,
        lags=settings.lags,
    )


def _has_modes(plant: Plant) -> bool:
    """Whether its first states are those of modes, [ω η; η̇]."""
    r = plant.blade_states // 2
    turned = np.diag(plant.natural_frequencies)
    return plant.in_energy_coordinates and turned.shape == (r, r) and np.array_equal(plant.A[:r, r : 2 * r], turned)


def _force_input(plant: Plant, held: SampledPlant, forces: int) -> Array:
    """D (n, q) of modal accelerations held over an interval; or of voltages."""
    if not _has_modes(plant):
        return held.B
    n, r = len(plant.A), plant.blade_states // 2
    q = min(forces, r)
    accelerated = np.zeros((n + q, n + q))
    accelerated[:n, :n] = plant.A
    accelerated[r : r + q, n:] = np.eye(q)
    held_over = expm(accelerated * held.interval)[:n, n:]
    return np.vstack([held_over, np.zeros((len(held.A) - n, q))])


def _usual(plant: Plant, held: SampledPlant, law: LinearController) -> Array:
    """(n,) root mean square of the blade's states under a load that lasts, noise and the law."""
    loaded = sampled_with_loads(plant, PersistentLoad())
    transition, noise_input, _, _, covariance = closed_loop(loaded, law)
    spread = solve_discrete_lyapunov(transition, noise_input @ covariance @ noise_input.T, method="bilinear")
    size = np.sqrt(np.maximum(np.diagonal(spread)[: len(held.A)], 0.0))
    return np.where(np.arange(len(size)) < plant.blade_states, size, 0.0)


def _usual_forces(plant: Plant, usual: Array, forces: int) -> Array:
    """(q,) that a force of 1 stands for."""
    if not _has_modes(plant):
        return UNUSUAL * drive_limit(plant)
    q = min(forces, plant.blade_states // 2)
    return UNUSUAL * plant.natural_frequencies[:q] * usual[:q]


def _observer_gain(plant: Plant, held: SampledPlant, surprise: Array) -> Array:
    """Λ (n, p): the Kalman filter's of the error itself, which unknown forces drive too."""
    E = held.disturbance_input
    with solvable(plant):
        noise = E @ held.process_noise @ E.T + surprise @ surprise.T
        return sampled_kalman_filter(held.A, held.C, noise, known_sensor_noise(plant) / held.interval).gain
