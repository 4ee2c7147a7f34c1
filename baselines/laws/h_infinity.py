"""H∞ control: the least cost under the worst noise, rather than under white noise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.linalg import LinAlgError
from numpy.typing import ArrayLike
from scipy.linalg import block_diag, solve

from baselines.analysis.frequency_response import h_infinity_norm, square_root
from baselines.design.controller import Array
from baselines.design.instruments import checked_plant
from baselines.design.linear import LinearController
from baselines.design.loop import sampled, spectral_radius
from baselines.design.riccati import RESIDUAL, SampledEquation, Solution, doubled, improved
from baselines.design.verification import DECAYS, verified
from baselines.design.weights import weighted
from baselines.laws.lqg import known_sensor_noise, observer, sampled_lqg
from beamenv.configuration import Number, checked
from beamenv.plant.plant import Plant

_BISECTION = 1e-5
"""Relative width of the bracket at which γ counts as found."""


def h_infinity(
    plant: Plant, back_off: float = 1.5, *, Q: ArrayLike | None = None, R: ArrayLike | None = None, verify: bool = True
) -> LinearController:
    """Output feedback whose ``h_infinity_norm`` is below γ, which is ``back_off`` times the least possible value.

    Cost and noise are those of the sampled LQG, but the noise n = [W^-½ d; V^-½ v] is the worst that its energy allows:

        Σ zᵀ cost z < γ² Σ |n|²,        z = [x; u; d],

    and the controller is the central solution, which becomes LQG as γ → ∞. It is solved in discrete time, so that sampling costs
    nothing:
    Whittle, Risk-sensitive Optimal Control (1990), and Başar and Bernhard, H∞-Optimal Control (1995), the discrete counterpart of
    Doyle, Glover, Khargonekar and Francis (IEEE Trans. Automatic Control 34, 1989). The rule for γ: half as much again as
    the least, near which gains grow without bound. ``Q`` and ``R`` replace the plant's weights, as in ``lqg``. That the loop on
    ``plant`` is stable and its norm below γ is ``verified`` unless ``verify=False``. Raises ValueError for a ``back_off`` of 1 or
    less, for a plant without white loads, and as ``lqg`` does.
    """
    back_off = checked("back_off", back_off, Number(gt=1.0))
    plant = weighted(plant, Q, R)
    return h_infinity_law(plant, back_off * least_attenuation(plant), verify=verify)


def least_attenuation(plant: Plant) -> float:
    """The γ, √(J s), that no controller's ``h_infinity_norm`` stays below: by bisection, downwards from LQG's own norm.

    A γ counts as possible where both Riccati equations have stabilising solutions, to 1e-9 of their terms. Raises ValueError for a
    plant without white loads, where doing nothing costs nothing.
    """
    if not checked_plant(plant).process_noise.any():
        raise ValueError(
            "plant has no white load (process_noise is zero), so an H∞ controller has nothing to hold its own against."
        )
    low, high = 0.0, h_infinity_norm(plant, sampled_lqg(plant))
    while high - low > _BISECTION * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _saddle_point(_game(plant, middle)) else (middle, high)
    return high


def h_infinity_law(plant: Plant, attenuation: float, *, verify: bool = True) -> LinearController:
    """The central controller of γ = ``attenuation``, √(J s), ``verified`` to keep below it; ValueError where none does.

    Its memory x̂ is the state that noise and cost up to now make the most of; ``h_infinity`` tells the rest.
    """
    attenuation = checked("attenuation", attenuation, Number(gt=0.0, unit="√(J s)"))
    game = _game(checked_plant(plant), attenuation)
    solution = _saddle_point(game)
    if solution is None:
        raise ValueError(f"attenuation = {attenuation!r} is too little: no controller keeps the gain from noise to cost below it.")
    p, unit, reading = len(game.C), game.voltage_unit[:, None], np.linalg.inv(game.reading_unit)
    K, L, predictor = solution.regulator, solution.filter, solution.predictor
    law = observer(
        plant,
        "H∞",
        game.A - predictor @ np.vstack([game.C, game.X]),
        predictor[:, :p] @ reading,
        (game.B - predictor[:, p:] @ game.U) / unit.T,
        -unit * (K - K @ L @ game.C),
        -unit * K @ L @ reading,
    )
    return verified(
        law, plant, *solution.equations, norm=h_infinity_norm, norm_below=attenuation, instead="a larger attenuation", verify=verify
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Game:
    """x⁺ = A x + B u + E d, y = C x + v, z = X x + U u + D d with γ, the sizes of d and v and the weight of each voltage all 1."""

    A: Array
    B: Array
    C: Array
    E: Array
    X: Array
    U: Array
    D: Array
    voltage_unit: Array
    """(m,), V."""
    reading_unit: Array
    """(p, p), A."""


@dataclass(frozen=True, slots=True, eq=False)
class _SaddlePoint:
    regulator: Array
    """(m, n): u = −regulator x̂, where x̂ has been corrected by the newest reading."""
    filter: Array
    """(n, p), of that correction."""
    predictor: Array
    """(n, p + z), from what readings y and cost z say of the state, one interval on."""
    equations: tuple[Solution, Solution]
    """Of what is to come and of what has been."""


def _game(plant: Plant, attenuation: float) -> _Game:
    held = sampled(plant)
    n, m = held.B.shape
    unit = attenuation / np.sqrt(np.diag(held.input_weight))
    load, reading = square_root(held.process_noise), square_root(known_sensor_noise(plant) / held.interval)
    in_units = block_diag(np.eye(n), np.diag(unit), load) / attenuation
    X, U, D = np.split(square_root(held.cost).T @ in_units, [n, n + m], axis=1)
    C: Array = solve(reading, held.C)
    return _Game(held.A, held.B * unit, C, held.disturbance_input @ load, X, U, D, unit, reading)


def _saddle_point(game: _Game) -> _SaddlePoint | None:
    """Of the cost Σ|z|² − |d|² − |v|², least over voltages and greatest over noise; None where noise can raise it for ever.

    What is to come is worth xᵀPx, what has been has left the state x̂ with "covariance" S: a Kalman filter's, that takes the cost
    for further readings of variance −1. Corrected by the newest reading, S becomes S_c and the worst state (I − S_c P)⁻¹ x̂.
    """
    A, B, C, E, X, U, D = game.A, game.B, game.C, game.E, game.X, game.U, game.D
    (n, m), p, k = B.shape, len(C), E.shape[1]
    inputs, costs = np.hstack([B, E]), np.hstack([U, D])
    weight = costs.T @ costs - block_diag(np.zeros((m, m)), np.eye(k))
    outputs, noise = np.vstack([C, X]), block_diag(np.eye(p), D @ D.T - np.eye(len(X)))
    correlation = np.hstack([np.zeros((n, p)), E @ D.T])
    to_come = _stabilising(SampledEquation(A, inputs, X.T @ X, weight, X.T @ costs))
    has_been = None if to_come is None else _stabilising(SampledEquation(A.T, outputs.T, E @ E.T, noise, correlation))
    if to_come is None or has_been is None:
        return None
    P, S = to_come.matrix, has_been.matrix
    try:
        L = solve(np.eye(p) + C @ S @ C.T, C @ S, assume_a="pos").T
    except LinAlgError:  # S is no covariance
        return None
    corrected = S - L @ C @ S
    seen = np.hstack([X, D]) @ block_diag(corrected, np.eye(k)) @ np.hstack([X, D]).T
    bounded = (
        _positive(np.eye(k) - D.T @ D - E.T @ P @ E)
        and _positive(np.eye(len(X)) - seen)
        and min(np.linalg.eigvalsh(P).min(), np.linalg.eigvalsh(S).min()) > -1e-9
        and np.abs(np.linalg.eigvals(S @ P)).max() < 1.0
    )
    if not bounded:
        return None
    K = to_come.gain[:m] @ np.linalg.inv(np.eye(n) - corrected @ P)
    return _SaddlePoint(K, L, has_been.gain.T, (to_come, has_been))


def _stabilising(equation: SampledEquation) -> Solution | None:
    """By doubling and Newton's steps; None where the residual stays above the allowed one or the closed loop does not decay."""
    try:
        P, residual = improved(equation, doubled(equation))
        gain = equation.gain(P)
    except LinAlgError:
        return None
    stable = residual <= RESIDUAL and spectral_radius(equation.A - equation.B @ gain) < DECAYS
    return Solution(P, gain, residual) if stable else None


def _positive(matrix: Array) -> bool:
    return bool(np.linalg.eigvalsh(matrix).min() > 0.0)
