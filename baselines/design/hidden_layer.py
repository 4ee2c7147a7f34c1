"""A network of one hidden layer that learns while it is in use, one for each blade: outputs, steps and the balls they end in."""

from __future__ import annotations

from math import prod
from typing import NamedTuple

import numpy as np

from baselines.design.controller import Array


class Weights(NamedTuple):
    """Of N networks of q outputs: each output has k hidden units of its own, h = q k in all, which see its own two inputs."""

    outer: Array
    """W (N, h)."""
    inner: Array
    """V − V₀ (N, h, 2): departures from where all of them start."""
    bias: Array
    """b (N, p): what whitened innovations are in the mean, which no motion is."""


class Learning(NamedTuple):
    """How fast weights learn and forget, and how far they go."""

    outer_rate: float
    """γ_W, below 2."""
    inner_rate: float
    """γ_V, below 2."""
    bias_rate: float
    """γ_b, below 2."""
    forgetting: float
    """κ of the e-modification."""
    outer_bound: float
    """Largest norm of W."""
    inner_bound: float
    """Largest norm of V − V₀."""
    saturation: float
    """s, where hidden units end: σ(z) = s tanh(z/s)."""


class Filtered(NamedTuple):
    """What networks have been shown and made of it, as it is felt in p whitened innovations."""

    units: Array
    """ψ (N, h, p): of hidden units."""
    inputs: Array
    """(N, q, 2, p)."""


def first_inner_weights(outputs: int, each: int, seed: int) -> Array:
    """V₀ (h, 2): of each output's units directions of the plane evenly spread over half a turn, from an angle drawn by ``seed``."""
    first = np.random.default_rng(seed).uniform(0.0, np.pi, (outputs, 1))
    angles = (first + np.pi * np.arange(each) / each).ravel()
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def hidden_units(start: Array, weights: Weights, inputs: Array, saturation: float) -> Array:
    """σ(Vᵀ μ) (N, h) of inputs μ (N, q, 2)."""
    inner = start + weights.inner
    seen = np.repeat(inputs, inner.shape[1] // inputs.shape[1], axis=1)
    return np.asarray(saturation * np.tanh((seen * inner).sum(axis=-1) / saturation))


def outputs(weights: Weights, units: Array, count: int) -> Array:
    """Wᵀ σ (N, q), q = ``count``."""
    return (weights.outer * units).reshape(len(units), count, units.shape[1] // count).sum(axis=-1)


def prediction_error(weights: Weights, felt: Filtered, innovation: Array) -> Array:
    """E = ε − b − ψᵀ W (N, p) of whitened innovations ε (N, p) of the design: what the network does not explain.

    Monopoli's augmented error (IEEE Trans. Automatic Control 19, 1974): whatever the weights were before, it is
    ψᵀ (W* − W) and what is random, if a network W* is right.
    """
    return innovation - weights.bias - np.einsum("nh,nhp->np", weights.outer, felt.units)


def learned(weights: Weights, felt: Filtered, units: Array, error: Array, size: Array, learning: Learning) -> Weights:
    """The weights after a normalised step down the gradient of |e|², and back onto their balls.

        W ← W + γ_W ψ e / d − κ ‖E‖ W,    V ← V + γ_V (σ' ∘ W ∘ ψ_μ) e / d − κ ‖E‖ (V − V₀),    b ← b + γ_b e / d,

    d = 1 + p + |ψ|², ``size`` (N,) = ‖E‖: the filtered gradient of Calise, Hovakimyan and Idan (Automatica 37, 2001) for W and, to
    first order in V, of Hovakimyan, Nardi, Calise and Kim (IEEE Trans. Neural Networks 13, 2002), with Narendra and Annaswamy's
    e-modification. With V at rest and κ = 0 a network that is right, W* within the ball, comes nearer at every instant while no
    innovation is random, for any rates from 0 to 2: |W − W*|²/γ_W + |b|²/γ_b never rises, and falls wherever e is not zero.
    """
    squares = np.einsum("nhp,nhp->n", felt.units, felt.units)
    step = error / (1.0 + error.shape[1] + squares)[:, None]
    slope = weights.outer * (1.0 - (units / learning.saturation) ** 2)
    through = np.repeat(np.einsum("nqip,np->nqi", felt.inputs, step), units.shape[1] // felt.inputs.shape[1], axis=1)
    kept = np.maximum(1.0 - learning.forgetting * size, 0.0)[:, None]
    outer = kept * weights.outer + learning.outer_rate * np.einsum("nhp,np->nh", felt.units, step)
    inner = kept[..., None] * weights.inner + learning.inner_rate * slope[..., None] * through
    bias = weights.bias + learning.bias_rate * step
    return Weights(onto_ball(outer, learning.outer_bound), onto_ball(inner, learning.inner_bound), bias)


def onto_ball(numbers: Array, radius: float) -> Array:
    """The nearest arrays (N, …) of a norm of at most ``radius``."""
    shrink = radius / np.maximum(norms(numbers), radius)
    return np.asarray(numbers * shrink.reshape(-1, *[1] * (numbers.ndim - 1)))


def norms(numbers: Array) -> Array:
    """(N,) of arrays (N, …)."""
    flat = numbers.reshape(len(numbers), prod(numbers.shape[1:]))
    return np.asarray(np.sqrt(np.einsum("nk,nk->n", flat, flat)))
