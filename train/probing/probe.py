"""A linear probe: ridge regression from features to what is the case, judged on episodes that it was not fitted to.

Alain and Bengio, Understanding intermediate layers using linear classifier probes, 2016.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FOLDS = 8
"""Parts of the episodes, each of which is judged by what the others say."""
PENALTIES = 10.0 ** np.arange(-3.0, 5.0)
"""Of squared weights of standardised features, over one episode's; the best on the fitted episodes' own folds is taken."""
RESAMPLES = 400
CONFIDENCE = 0.95


@dataclass(frozen=True, slots=True)
class Score:
    """R² of a number, or balanced accuracy of a class, with an interval by resampling episodes."""

    value: float
    low: float
    high: float


def probed(features: Array, truth: Array, classes: bool, seed: int = 0) -> Score:
    """How well a linear probe tells ``truth`` (E,) of E episodes from ``features`` (E, S, k) at S instants of each.

    Folds are of whole episodes, so that no episode is both fitted and judged; what is said of an episode is the mean over its
    instants. ``classes``: the truth is one of several kinds, and the probe the least squares of their indicators.
    """
    said = _out_of_fold(features, _targets(truth, classes), np.random.default_rng(seed).permutation(len(truth)))
    return _score(said, truth, classes, seed)


def _targets(truth: Array, classes: bool) -> Array:
    return (truth[:, None] == np.unique(truth)).astype(np.float64) if classes else truth[:, None]


def _out_of_fold(features: Array, targets: Array, order: NDArray[np.int64]) -> Array:
    """(E, t): what probes that have not seen an episode say of it."""
    said = np.empty_like(targets)
    for held in np.array_split(order, FOLDS):
        fitted = np.setdiff1d(order, held)
        penalty = _best_penalty(features[fitted], targets[fitted])
        said[held] = _said(features[fitted], targets[fitted], features[held], [penalty])[0]
    return said


def _best_penalty(features: Array, targets: Array) -> float:
    """By the same game within."""
    missed = np.zeros(len(PENALTIES))
    for held in np.array_split(np.arange(len(targets)), FOLDS // 2):
        fitted = np.setdiff1d(np.arange(len(targets)), held)
        said = _said(features[fitted], targets[fitted], features[held], PENALTIES)
        missed += ((said - targets[held]) ** 2).sum(axis=(1, 2))
    return float(PENALTIES[np.argmin(missed)])


def _said(features: Array, targets: Array, asked: Array, penalties: Array | list[float]) -> Array:
    """(penalties, episodes asked, t): means over instants of what ridge regressions say."""
    rows, instants = features.reshape(-1, features.shape[-1]), features.shape[1]
    centre, spread = rows.mean(axis=0), rows.std(axis=0)
    scale = np.where(spread > 0.0, spread, 1.0)
    standard, mean = (rows - centre) / scale, targets.mean(axis=0)
    values, vectors = np.linalg.eigh(standard.T @ standard / instants)
    moment = vectors.T @ (standard.T @ np.repeat(targets - mean, instants, axis=0) / instants)
    shown = ((asked.mean(axis=1) - centre) / scale) @ vectors
    return np.stack([shown @ (moment / (np.maximum(values, 0.0) + penalty)[:, None]) + mean for penalty in penalties])


def _score(said: Array, truth: Array, classes: bool, seed: int) -> Score:
    draws = np.random.default_rng(seed).integers(len(truth), size=(RESAMPLES, len(truth)))
    guessed = np.unique(truth)[said.argmax(axis=1)] if classes else said[:, 0]
    judge = balanced_accuracy if classes else explained
    resampled = [judge(guessed[draw], truth[draw]) for draw in draws]
    low, high = np.quantile(resampled, [(1.0 - CONFIDENCE) / 2.0, (1.0 + CONFIDENCE) / 2.0])
    return Score(judge(guessed, truth), float(low), float(high))


def explained(said: Array, truth: Array) -> float:
    """R²: 1 where all is told, 0 for the mean, below it for worse."""
    return float(1.0 - ((said - truth) ** 2).sum() / max(((truth - truth.mean()) ** 2).sum(), np.finfo(float).tiny))


def balanced_accuracy(said: Array, truth: Array) -> float:
    """Mean over kinds of the share that is told rightly: one over their number for guesses."""
    return float(np.mean([(said[truth == kind] == kind).mean() for kind in np.unique(truth)]))
