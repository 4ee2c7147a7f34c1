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

    hidden: Annotated[int, Count(1, 50)] = 2
    """Hidden units of each force."""
    forces: Annotated[int, Count(1, 100)] = 11
    """Modes, the first, whose forces it foresees; voltages instead where a plant has no modes of its own coordinates."""
    outer_rate: Annotated[float, Number(ge=0.0, lt=2.0)] = 0.3
    """γ_W."""
    inner_rate: Annotated[float, Number(ge=0.0, lt=2.0)] = 0.1
    """γ_V."""
    bias_rate: Annotated[float, Number(ge=0.0, lt=2.0)] = 0.1
    """γ_b."""
    forgetting: Annotated[float, Number(ge=0.0, le=0.1)] = 1e-3
    """κ of the e-modification."""
    outer_bound: Annotated[float, Number(gt=0.0, le=1e3)] = 4.0
    """Largest norm of W."""
    inner_bound: Annotated[float, Number(gt=0.0, le=1e3)] = 1.0
    """Largest norm of V − V₀."""
    saturation: Annotated[float, Number(gt=0.0, le=1e3)] = 3.0
    """Where hidden units end, in units of what is usual."""
    surprise: Annotated[float, Number(ge=0.0, le=1e3)] = 1.0
    """Root mean square of the forces that the error observer takes for noise."""
    authority: Annotated[float, Number(gt=0.0, le=2.0)] = 0.5
    """Largest adaptive voltage over the drive limit."""
    seed: Annotated[int, Count(0, 2**32 - 1)] = 0
    """Of the first inner weights."""


def adaptive_neural(
    plant: Plant, base: LinearController | None = None, settings: AdaptationSettings | None = None, *, verify: bool = True
) -> AdaptiveNeural:
    """A linear controller augmented by a network that learns within each episode; None: ``reference_lqg(plant)``.

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
    rates, bounds = (chosen.outer_rate, chosen.inner_rate, chosen.bias_rate), (chosen.outer_bound, chosen.inner_bound)
    learning = Learning(*rates, chosen.forgetting, *bounds, chosen.saturation)
    start = first_inner_weights(model.counts[1], chosen.hidden, chosen.seed)
    return AdaptiveNeural("adaptive neural LQG", law.instruments, law, model, start, learning, chosen.authority)


def _behind_instruments(base: LinearController, plant: Plant) -> LinearController:
    """The base; ``ValueError`` where it reads and drives other things than the plant has."""
    own, others = base.instruments, Instruments.of(plant)
    for name in ("observes", "counts", "interval", "voltage_limits", "measurement_scale", "voltage_scale"):
        if not np.array_equal(getattr(own, name), getattr(others, name)):
            raise ValueError(f"base has another {name} than the plant: both must stand behind the same instruments.")
    return base


def error_model(plant: Plant, law: LinearController, settings: AdaptationSettings) -> ErrorModel:
    """The design as the reference model of a controller, in units of what is usual under a load that lasts."""
    held = sampled(plant)
    filtered, K = optimal_filter(plant, held), optimal_regulator(plant, with_rate_penalty(held, RATE_WEIGHT)).gain
    A, C, L = held.A, held.C, filtered.gain
    innovations = C @ filtered.matrix @ C.T + known_sensor_noise(plant) / held.interval
    whitening = _inverse_root(innovations)
    felt, loop = whitening @ C, A - A @ L @ C
    lyapunov = solve_discrete_lyapunov(loop.T, felt.T @ felt, method="bilinear")
    force_input, shown = _forces(plant, held, _spread(plant, held, law), K[:, : len(A)], settings.forces)
    return ErrorModel(
        transition=A,
        voltage_input=held.B,
        output=C,
        force_input=force_input,
        feedback_gain=_of_modes(plant, K[:, : len(A)], settings.forces),
        kalman_gain=L,
        observer_gain=_observer_gain(plant, held, settings.surprise * force_input),
        whitening=whitening,
        lyapunov=0.5 * (lyapunov + lyapunov.T),
        shown=shown,
        full_scale=plant.sensor_full_scale,
        drive=drive_limit(plant),
    )


def _inverse_root(covariance: Array) -> Array:
    unit = 1.0 / np.sqrt(np.diagonal(covariance))
    values, vectors = np.linalg.eigh(covariance * np.outer(unit, unit))
    return np.asarray((vectors / np.sqrt(values)) @ vectors.T * unit)


def _has_modes(plant: Plant) -> bool:
    """Whether its first states are those of modes, [ω η; η̇]."""
    r = plant.blade_states // 2
    turned = np.diag(plant.natural_frequencies)
    return plant.in_energy_coordinates and turned.shape == (r, r) and np.array_equal(plant.A[:r, r : 2 * r], turned)


def _forces(plant: Plant, held: SampledPlant, spread: Array, gain: Array, forces: int) -> tuple[Array, Array]:
    """D (n, q) of forces in units of what is usual, and what is shown of a state (n, 2 q), by its covariance ``spread``.

    Forces on the first modes, each shown its own mode; where a plant has no modes of its own coordinates, voltages, each shown what
    the regulator would ask for, and how that changes.
    """
    if not _has_modes(plant):
        seen = np.stack([-gain, -gain @ (held.A - np.eye(len(held.A)))], axis=1).reshape(-1, len(held.A)).T
        return UNUSUAL * held.B * drive_limit(plant), seen / _sizes(seen.T @ spread @ seen)
    n, r = len(held.A), plant.blade_states // 2
    q = min(forces, r)
    seen = np.zeros((n, 2 * q))
    seen[np.arange(q), 2 * np.arange(q)] = seen[r + np.arange(q), 2 * np.arange(q) + 1] = 1.0
    usual = _sizes(seen.T @ spread @ seen)
    return UNUSUAL * plant.natural_frequencies[:q] * usual[::2] * _accelerated(plant, held, q), seen / usual


def _of_modes(plant: Plant, gain: Array, forces: int) -> Array:
    """The gain (m, n) on modes whose forces are foreseen: of the others' departures, which these excite too, less is known."""
    if not _has_modes(plant):
        return gain
    r = plant.blade_states // 2
    state = np.arange(gain.shape[1])
    return np.asarray(np.where((state >= 2 * r) | (state % r < forces), gain, 0.0))


def _accelerated(plant: Plant, held: SampledPlant, count: int) -> Array:
    """(n, q): what accelerations of the first modes do within an interval in which they last."""
    n, r = len(plant.A), plant.blade_states // 2
    whole = np.zeros((n + count, n + count))
    whole[:n, :n] = plant.A
    whole[r : r + count, n:] = np.eye(count)
    return np.vstack([expm(whole * held.interval)[:n, n:], np.zeros((len(held.A) - n, count))])


def _spread(plant: Plant, held: SampledPlant, law: LinearController) -> Array:
    """Covariance (n, n) of the plant's states under a load that lasts, noise and the law."""
    loaded = sampled_with_loads(plant, PersistentLoad())
    transition, noise_input, _, _, covariance = closed_loop(loaded, law)
    spread = solve_discrete_lyapunov(transition, noise_input @ covariance @ noise_input.T, method="bilinear")
    return np.asarray(spread[: len(held.A), : len(held.A)])


def _sizes(covariance: Array) -> Array:
    """Root mean squares; 1 of what does not move."""
    squares = np.diagonal(covariance)
    return np.sqrt(np.where(squares > 0.0, squares, 1.0))


def _observer_gain(plant: Plant, held: SampledPlant, surprise: Array) -> Array:
    """Λ (n, p): the Kalman filter's of the error itself, which unknown forces drive too."""
    E = held.disturbance_input
    with solvable(plant):
        noise = E @ held.process_noise @ E.T + surprise @ surprise.T
        return sampled_kalman_filter(held.A, held.C, noise, known_sensor_noise(plant) / held.interval).gain
