"""The model in continuous time: what, sampled with held voltages and loads, is exactly the model identified."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines.identification.innovation_model import InnovationModel
from baselines.identification.realisation import OVERDAMPED
from beamenv.configuration.read_only import ReadOnly

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class StateSpace(ReadOnly):
    """ẋ = A x + B u + E d, y = C x + v with held d of unit variance."""

    A: Array
    """(n, n), 1/s."""
    B: Array
    """(n, m), per V."""
    C: Array
    """(p, n), in the sensors' units."""
    load_input: Array
    """E (n, k)."""
    energy: Array | None
    """(n, n): xᵀ energy x is the vibration energy, J; None where it is not known."""


def continuous(model: InnovationModel, load_input: Array, collocated: float | None) -> StateSpace:
    """In real coordinates of the modes, real poles last. With ``collocated``, x of each mode is such that ½ |x|² is its energy.

    Sensors of current that lie where the actuators do feel each mode as these drive it: C_s Ψ = g (ΨᵀF)ᵀ up to sign. With q
    the modal velocity, q̇ = ΨᵀF u, i = C_s Ψ q, its energy in resonance is ½ (q² + what is in phase with the displacement). So the
    residue c bᵀ of a mode, whatever its coordinates, has |c| = g |b| in those of its energy.
    """
    s, r = model.poles, len(model.pairs)
    A = _blocks(s, r)
    held = model.A - np.eye(model.order)
    B, E = np.linalg.solve(held, A @ model.B), np.linalg.solve(held, A @ load_input)
    scale = _scales(B, model.C, r, 1.0 if collocated is None else collocated)
    light = np.repeat(-s[:r].real < OVERDAMPED * np.abs(s[:r]), 2)
    energy = None if collocated is None else np.diag(0.5 * np.concatenate([light, np.zeros(len(s) - r)]))
    return StateSpace(A, B * scale[:, None], model.C / scale, E * scale[:, None], energy)


def _blocks(s: NDArray[np.complex128], r: int) -> Array:
    whole, first = np.diag(np.concatenate([np.repeat(s[:r].real, 2), s[r:].real])), np.arange(0, 2 * r, 2)
    whole[first, first + 1], whole[first + 1, first] = s[:r].imag, -s[:r].imag
    return whole


def _scales(B: NDArray[Any], C: Array, r: int, ratio: float) -> Array:
    """(n,): by which each pole's states are to be multiplied for |c| = ratio |b|."""
    sizes = [np.linalg.norm(np.hstack([C[:, k], C[:, k + 1]])) / np.linalg.norm(B[k : k + 2]) for k in range(0, 2 * r, 2)]
    alone = [np.linalg.norm(C[:, k]) / np.linalg.norm(B[k]) for k in range(2 * r, len(B))]
    return np.asarray(np.sqrt(np.concatenate([np.repeat(sizes, 2), alone]) / ratio))
