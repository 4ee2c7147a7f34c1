"""Riccati equations of control and filtering, continuous and sampled: algorithms on matrices.

SciPy's solution stands where it satisfies its equation to ``RESIDUAL``; elsewhere, as where modes are decoupled or out of reach, it
is improved by Newton's method (Kleinman, IEEE Trans. Automatic Control 13, 1968), a sampled one from the doubling algorithm's.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.linalg import LinAlgError
from numpy.typing import NDArray
from scipy.linalg import solve, solve_continuous_are, solve_continuous_lyapunov, solve_discrete_are

from baselines.design.lyapunov import accumulated

Array = NDArray[np.float64]

RESIDUAL = 1e-9
"""How far an equation may be from being satisfied, relative to its terms."""

_NEWTON = 6
"""Steps, each of which squares the relative error."""

_DOUBLINGS = 45
"""2⁴⁵ intervals: a loop that needs longer has no stabilising solution that floating-point numbers know."""


class Unsolved(ValueError):
    """An equation for which no stabilising solution is found."""


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """What solves a Riccati equation, and how well: ``P, K = solution``."""

    matrix: Array
    """P or S (n, n)."""
    gain: Array
    """K (m, n) or L (n, p)."""
    residual: float
    """‖what the equation leaves‖ over the size of its terms, Frobenius norms."""

    def __iter__(self) -> Iterator[Array]:
        return iter((self.matrix, self.gain))


class Equation(Protocol):
    """A Riccati equation in P."""

    def left(self, P: Array) -> Array:
        """What it leaves, zero at a solution."""
        ...

    def size(self, P: Array) -> float:
        """Of its terms."""
        ...

    def correction(self, P: Array) -> Array | None:
        """One of Newton's steps; None where P does not stabilise."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class SampledEquation:
    """P = AᵀPA + Q − (AᵀPB + N) K, K = (R + BᵀPB)⁻¹ (BᵀPA + Nᵀ); R (m, m) may have either sign, as in a game."""

    A: Array
    B: Array
    Q: Array
    R: Array
    N: Array

    def gain(self, P: Array) -> Array:
        """K (m, n)."""
        return np.asarray(np.linalg.solve(self.R + self.B.T @ P @ self.B, self.B.T @ P @ self.A + self.N.T))

    def closed(self, P: Array) -> Array:
        """A − BK (n, n)."""
        return np.asarray(self.A - self.B @ self.gain(P))

    def left(self, P: Array) -> Array:
        """What the right side has more than P."""
        return np.asarray(self.A.T @ P @ self.A + self.Q - (self.A.T @ P @ self.B + self.N) @ self.gain(P) - P)

    def size(self, P: Array) -> float:
        """That of P, which is larger than what an interval adds to it."""
        return float(np.linalg.norm(P))

    def correction(self, P: Array) -> Array | None:
        """Of P: (A − BK)ᵀ Δ (A − BK) − Δ is minus what is left."""
        return accumulated(self.closed(P).T, self.left(P))


@dataclass(frozen=True, slots=True, eq=False)
class ContinuousEquation:
    """PA + AᵀP + Q − PBR⁻¹BᵀP = 0."""

    A: Array
    B: Array
    Q: Array
    R: Array

    def left(self, P: Array) -> Array:
        """The left side."""
        both = P @ self.A
        return np.asarray(both + both.T + self.Q - P @ self.B @ np.linalg.solve(self.R, self.B.T @ P))

    def size(self, P: Array) -> float:
        """That of its first three terms."""
        return float(2.0 * np.linalg.norm(P @ self.A) + np.linalg.norm(self.Q))

    def correction(self, P: Array) -> Array | None:
        """Of P, by the Lyapunov equation of the closed loop."""
        closed = self.A - self.B @ np.linalg.solve(self.R, self.B.T @ P)
        if np.linalg.eigvals(closed).real.max() >= 0.0:
            return None
        return np.asarray(solve_continuous_lyapunov(closed.T, -self.left(P)))


def regulator(A: Array, B: Array, state_weight: Array, input_weight: Array, cross_weight: Array | None = None) -> Solution:
    """Continuous regulator: P (n, n) and gain K (m, n) of u = −K x (thesis Eqs. 5.10, 5.11).

    PA + AᵀP + Q − PBR⁻¹BᵀP = 0, K = R⁻¹BᵀP. A weight N (n, m) of 2 xᵀNu is taken out by u = v − R⁻¹Nᵀx first. Raises ``Unsolved``
    without a stabilising solution.
    """
    if cross_weight is not None and cross_weight.any():
        out = solve(input_weight, cross_weight.T, assume_a="pos")
        without = regulator(A - B @ out, B, symmetric(state_weight - cross_weight @ out), input_weight)
        return Solution(without.matrix, without.gain + out, without.residual)
    unit = _unit_diagonal(input_weight)  # J/V² is tiny: with each input's own weight as unit the pencil is well scaled
    equation = ContinuousEquation(A, B * unit, state_weight, input_weight * np.outer(unit, unit))
    try:
        P, residual = improved(equation, solve_continuous_are(A, equation.B, state_weight, equation.R))
        gain = unit[:, None] * solve(equation.R, equation.B.T @ P, assume_a="pos")
    except (LinAlgError, ValueError) as error:
        raise Unsolved(f"Riccati equation has no stabilising solution: {error}") from None
    return Solution(P, gain, residual)


def kalman_filter(A: Array, C: Array, process_noise: Array, sensor_noise: Array) -> Solution:
    """Continuous filter: error covariance S (n, n) and gain L (n, p) of x̂̇ = A x̂ + B u + L (y − C x̂).

    AS + SAᵀ + W − SCᵀV⁻¹CS = 0, L = SCᵀV⁻¹ (thesis Eqs. 5.20, 5.21 with the transpose that 5.21 lacks): the regulator's dual.
    """
    dual = regulator(A.T, C.T, process_noise, sensor_noise)
    return Solution(dual.matrix, dual.gain.T, dual.residual)


def sampled_regulator(A: Array, B: Array, state_weight: Array, input_weight: Array, cross_weight: Array | None = None) -> Solution:
    """Sampled regulator: P (n, n) and gain K (m, n) of u = −K x, least Σ xᵀQx + 2xᵀNu + uᵀRu.

    P = AᵀPA + Q − (AᵀPB + N) K, K = (R + BᵀPB)⁻¹ (BᵀPA + Nᵀ). Raises ``Unsolved`` without a stabilising solution.
    """
    unit = _unit_diagonal(input_weight)
    N_unit = np.zeros_like(B) if cross_weight is None else cross_weight * unit
    equation = SampledEquation(A, B * unit, state_weight, input_weight * np.outer(unit, unit), N_unit)
    try:
        P, residual = _solved(equation)
        inner = equation.R + equation.B.T @ P @ equation.B
        gain = unit[:, None] * solve(inner, equation.B.T @ P @ A + N_unit.T, assume_a="pos")
    except (LinAlgError, ValueError) as error:
        raise Unsolved(f"Riccati equation has no stabilising solution: {error}") from None
    return Solution(P, gain, residual)


def sampled_kalman_filter(A: Array, C: Array, process_noise: Array, sensor_noise: Array) -> Solution:
    """Sampled filter: covariance S (n, n) of the *predicted* state and the *filter* gain L (n, p), x̂ ← x̂ + L (y − C x̂).

    S = A (S − L C S) Aᵀ + W, L = SCᵀ(CSCᵀ + V)⁻¹. The predictor's gain, which ``control.dlqe`` returns, is A L.
    """
    dual = sampled_regulator(A.T, C.T, process_noise, sensor_noise)  # its gain is (A L)ᵀ: dividing A out would cost digits
    S, unit = dual.matrix, _unit_diagonal(sensor_noise)
    C_unit = C * unit[:, None]
    innovation = C_unit @ S @ C_unit.T + sensor_noise * np.outer(unit, unit)
    return Solution(S, solve(innovation, C_unit @ S, assume_a="pos").T * unit, dual.residual)


def _solved(equation: SampledEquation) -> tuple[Array, float]:
    try:
        with np.errstate(all="ignore"):  # the residual says what came of it
            P: Array | None = solve_discrete_are(equation.A, equation.B, equation.Q, equation.R, s=equation.N)
    except (LinAlgError, ValueError):
        P = None
    if P is not None and (residual := relative_residual(equation, P)) <= RESIDUAL:
        return P, residual
    return improved(equation, doubled(equation))


@np.errstate(all="ignore")
def doubled(equation: SampledEquation) -> Array:
    """The stabilising solution by the structure-preserving doubling algorithm; ``LinAlgError`` where it does not converge.

    A, G = BR⁻¹Bᵀ and H = Q, once N is taken out, become those of twice the interval: W = I + GH, A ← AW⁻¹A, G ← G + AW⁻¹GAᵀ,
    H ← H + AᵀHW⁻¹A, and H tends to P (Chu, Fan, Lin and Wang, Int. J. Control 77, 2004).
    """
    n = len(equation.A)
    taken = np.linalg.solve(equation.R, np.hstack([equation.N.T, equation.B.T]))
    A = equation.A - equation.B @ taken[:, :n]
    G, H = symmetric(equation.B @ taken[:, n:]), symmetric(equation.Q - equation.N @ taken[:, :n])
    for _ in range(_DOUBLINGS):
        inner = np.linalg.solve(np.eye(n) + G @ H, np.hstack([A, G]))
        more = symmetric(A.T @ H @ inner[:, :n])
        A, G, H = A @ inner[:, :n], G + symmetric(A @ inner[:, n:] @ A.T), H + more
        added, whole = np.linalg.norm(more), np.linalg.norm(H)
        if not np.isfinite(whole):
            break
        if added <= 1e-15 * whole:
            return np.asarray(H)
    raise LinAlgError("doubling the interval does not converge")


@np.errstate(all="ignore")
def improved(equation: Equation, P: Array) -> tuple[Array, float]:
    """The solution that Newton's steps lead to from P (n, n), none where it is good already, and its relative residual."""
    residual = relative_residual(equation, P)
    for _ in range(_NEWTON):
        correction = None if residual <= RESIDUAL else equation.correction(P)
        if correction is None or not (new := relative_residual(equation, P + correction)) < residual:
            break
        P, residual = P + correction, new
    return P, residual


def relative_residual(equation: Equation, P: Array) -> float:
    """‖what the equation leaves‖ over the size of its terms; infinite where it is no number."""
    with np.errstate(over="ignore", invalid="ignore"):
        left, size = float(np.linalg.norm(equation.left(P))), equation.size(P)
    return 0.0 if left == 0.0 else left / size if np.isfinite(left) and size > 0.0 else np.inf


def symmetric(matrix: Array) -> Array:
    """Its symmetric part."""
    return np.asarray(0.5 * (matrix + matrix.T))


def _unit_diagonal(weight: Array) -> Array:
    """Units (m,) in which a positive weight has a unit diagonal."""
    return np.asarray(1.0 / np.sqrt(np.diag(weight)))
