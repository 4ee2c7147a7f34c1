"""A network of one hidden layer that learns while it is in use, one for each blade: outputs, steps and the balls they end in."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from baselines.design.controller import Array


class Weights(NamedTuple):
    """Of N networks of f inputs, h hidden units and q outputs."""

    outer: Array
    """W (N, h, q)."""
    inner: Array
    """V − V₀ (N, f, h): departures from where all of them start."""


class Learning(NamedTuple):
    """How fast weights learn and forget, and how far they go."""

    outer_rate: float
    """γ_W, from 0 to 1."""
    inner_rate: float
    """γ_V, from 0 to 1."""
    forgetting: float
    """κ of the e-modification."""
    outer_bound: float
    """Largest Frobenius norm of W."""
    inner_bound: float
    """Largest Frobenius norm of V − V₀."""
    activity: float
    """|σ|² up to which steps are as long as at rest: there EᵀPE + (1 + activity) ‖W − W*‖²/γ_W is a Lyapunov function."""


def first_inner_weights(inputs: int, hidden: int, seed: int) -> Array:
    """V₀ (f, h): unit directions of the input space drawn by ``seed``, as unlike each other as they can be.

    In each group of f of them they are orthogonal, so that the hidden units see all inputs alike.
    """
    generator = np.random.default_rng(seed)
    groups = [np.linalg.qr(generator.normal(size=(inputs, inputs)))[0] for _ in range(-(-hidden // inputs))]
    return np.ascontiguousarray(np.hstack(groups)[:, :hidden])


def hidden_units(start: Array, weights: Weights, inputs: Array) -> Array:
    """σ(Vᵀ μ) (N, h) of inputs μ (N, f), σ = tanh."""
    return np.asarray(np.tanh(inputs @ start + (inputs[:, None] @ weights.inner)[:, 0]))


def outputs(weights: Weights, units: Array) -> Array:
    """Wᵀ σ (N, q)."""
    return np.asarray((units[:, None] @ weights.outer)[:, 0])


def learned(weights: Weights, inputs: Array, units: Array, direction: Array, error: Array, learning: Learning) -> Weights:
    """The weights after a step along ``direction`` (N, q), in which outputs lessen an error of size ``error`` (N,).

    W ← W + γ_W σ pᵀ / (1 + max(|σ|², a)) − κ ‖E‖ W,    V ← V + γ_V μ (σ' ∘ W p)ᵀ / (1 + |μ|²) − κ ‖E‖ (V − V₀),

    each back onto its ball: the law of Hovakimyan, Nardi, Calise and Kim (IEEE Trans. Neural Networks 13, 2002), with Narendra and
    Annaswamy's e-modification, in discrete time with normalised steps. Their σ − σ' Vᵀμ in place of σ would be nothing to first
    order here, where hidden units are next to linear.
    """
    outer_step = (learning.outer_rate / (1.0 + np.maximum(_squares(units), learning.activity)))[:, None] * units
    inner_step = (learning.inner_rate / (1.0 + _squares(inputs)))[:, None] * inputs
    back = (1.0 - units**2) * (weights.outer @ direction[:, :, None])[:, :, 0]
    kept = np.maximum(1.0 - learning.forgetting * error, 0.0)[:, None, None]
    outer = kept * weights.outer + outer_step[:, :, None] * direction[:, None]
    inner = kept * weights.inner + inner_step[:, :, None] * back[:, None]
    return Weights(onto_ball(outer, learning.outer_bound), onto_ball(inner, learning.inner_bound))


def onto_ball(matrices: Array, radius: float) -> Array:
    """The nearest matrices (N, …) of a Frobenius norm of at most ``radius``."""
    shrink = radius / np.maximum(norms(matrices), radius)
    return np.asarray(matrices * shrink[:, None, None])


def norms(matrices: Array) -> Array:
    """Frobenius norms (N,)."""
    return np.asarray(np.sqrt(_squares(matrices.reshape(len(matrices), -1))))


def _squares(rows: Array) -> Array:
    return np.einsum("nk,nk->n", rows, rows)
