"""Plants like another one, within a spread of its modes' frequencies and dampings and of its patches' gains."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from beamenv.configuration import Number, configuration
from beamenv.configuration.read_only import sealed
from beamenv.plant.model_rules import turning_frequencies
from beamenv.plant.plant import Plant

Array = NDArray[np.float64]

Relative = Annotated[float, Number(ge=0.0, lt=1.0)]


@configuration("spread")
class Spread:
    """Relative half widths: what varies is drawn uniformly, each mode, actuator and sensor for itself."""

    frequency: Relative = 0.0
    """Of each mode's frequency."""
    damping: Relative = 0.0
    """Of each mode's damping ratio."""
    actuator: Relative = 0.0
    """Of each actuator's gain."""
    sensor: Relative = 0.0
    """Of each sensor's gain."""

    @property
    def anything(self) -> bool:
        """Whether it is of any width."""
        return any((self.frequency, self.damping, self.actuator, self.sensor))


def plants_within(plant: Plant, spread: Spread, count: int, seed: int) -> list[Plant]:
    """So many plants, of the same instruments and cost, a Latin hypercube of what varies (McKay et al. 1979)."""
    generator = np.random.default_rng(seed)
    poles, modes = modal_form(plant.A)
    r, (m, p) = len(poles), (plant.B.shape[1], len(plant.C))
    strata = np.stack([generator.permutation(count) for _ in range(2 * r + m + p)], axis=1)
    away = 2.0 * (strata + generator.random(strata.shape)) / count - 1.0
    parts = np.split(1.0 + away, np.cumsum([r, r, m]), axis=1)
    factors = [1.0 + half * (each - 1.0) for half, each in zip((spread.frequency, spread.damping), parts[:2], strict=True)]
    gains = [1.0 + half * (each - 1.0) for half, each in zip((spread.actuator, spread.sensor), parts[2:], strict=True)]
    return [_changed(plant, poles, modes, *each) for each in zip(*factors, *gains, strict=True)]


def modal_form(A: Array) -> tuple[NDArray[np.complex128], Array]:
    """Poles (r,), of pairs the one that turns forward, and real T (n, n) with A = T diag(blocks) T⁻¹, real poles last."""
    poles, vectors = np.linalg.eig(A)
    turning = np.flatnonzero(poles.imag > 0.0)
    alone = np.flatnonzero(poles.imag == 0.0)
    pairs = np.stack([vectors[:, turning].real, vectors[:, turning].imag], axis=-1).reshape(len(A), -1)
    return np.concatenate([poles[turning], poles[alone]]), np.hstack([pairs, vectors[:, alone].real])


def _changed(
    plant: Plant, poles: NDArray[np.complex128], modes: Array, frequency: Array, damping: Array, actuator: Array, sensor: Array
) -> Plant:
    blocks = [_block(pole, *each) for pole, *each in zip(poles, frequency, damping, strict=True)]
    A = np.linalg.solve(modes.T, (modes @ block_diag(*blocks)).T).T
    return replace(
        plant,
        A=sealed(A),
        B=sealed(plant.B * actuator),
        C=sealed(plant.C * sensor[:, None]),
        D=sealed(plant.D * np.outer(sensor, actuator)),
        natural_frequencies=turning_frequencies(A),
    )


def _block(pole: complex, frequency: float, damping: float) -> Array:
    """(2, 2) of a pair, (1, 1) of a pole alone, which has no damping ratio of its own."""
    if pole.imag == 0.0:
        return np.array([[pole.real * frequency]])
    omega, ratio = abs(pole) * frequency, min(-pole.real / abs(pole) * damping, 0.999)
    turn = omega * np.sqrt(1.0 - ratio**2)
    return np.array([[-ratio * omega, turn], [-turn, -ratio * omega]])
