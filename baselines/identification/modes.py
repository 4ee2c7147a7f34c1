"""Frequencies and dampings of an identified model with their spread, and models drawn within it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines.identification.innovation_model import InnovationModel
from baselines.identification.order import certainties
from baselines.identification.prediction_error import Refined, moved
from baselines.identification.realisation import OVERDAMPED
from beamenv.configuration.read_only import ReadOnly

Array = NDArray[np.float64]

DRAWS = 100
"""How often a model is drawn before one that is unstable is taken half the way to the mean."""


@dataclass(frozen=True, slots=True, eq=False)
class Modes(ReadOnly):
    """Lightly damped modes by ascending frequency, each with one standard deviation, by Cramér and Rao's bound."""

    frequency: Array
    """(k,), rad/s: magnitude of the pole."""
    frequency_spread: Array
    """(k,), rad/s."""
    damping_ratio: Array
    """(k,)."""
    damping_spread: Array
    """(k,)."""
    certainty: Array
    """(k,): Wald's statistic that it is driven at all, over the count of its numbers; about 1 where it is not."""

    def __len__(self) -> int:
        return len(self.frequency)


def modes_of(found: Refined) -> Modes:
    """Those with a damping ratio below ``OVERDAMPED``."""
    model, parameters = found.model, found.parameters
    s = model.poles[: len(model.pairs)]
    size, ratio = np.abs(s), -s.real / np.abs(s)
    kept = [k for k in np.argsort(size) if ratio[k] < OVERDAMPED]
    spread = np.array([_spread(s[k], parameters[2 * k : 2 * k + 2, 2 * k : 2 * k + 2]) for k in kept]).reshape(-1, 2)
    return Modes(size[kept], spread[:, 0], ratio[kept], spread[:, 1], certainties(found)[kept])


def _spread(s: complex, covariance: Array) -> tuple[float, float]:
    """Standard deviations of |s| and of −Re s/|s| from the covariance (2, 2) of Re s and Im s."""
    size = abs(s)
    of_size = np.array([s.real, s.imag]) / size
    of_ratio = np.array([-(s.imag**2), s.real * s.imag]) / size**3
    return float(np.sqrt(of_size @ covariance @ of_size)), float(np.sqrt(of_ratio @ covariance @ of_ratio))


def drawn(model: InnovationModel, parameters: Array, count: int, seed: int) -> list[InnovationModel]:
    """Models drawn from the normal distribution that the parameters' covariance (k, k) gives them, all stable."""
    values, vectors = np.linalg.eigh(parameters)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    rng = np.random.default_rng(seed)
    return [_stable(model, root, rng) for _ in range(count)]


def _stable(model: InnovationModel, root: Array, rng: np.random.Generator) -> InnovationModel:
    for _ in range(DRAWS):
        step = root @ rng.standard_normal(len(root))
        if (tried := moved(model, step)).stable:
            return tried
    while not (tried := moved(model, step)).stable:
        step = 0.5 * step
    return tried
