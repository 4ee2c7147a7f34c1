"""Which order: poles are taken away, the least certain first, for as long as rows that nothing was learned from do not miss them.

Whether a pole is there at all is asked of what drives it: Wald's statistic of its rows of [B K], θᵀ Σ⁻¹ θ with Σ their covariance,
is what the likelihood would lose if they were zero and all else made good what it can. (The same in neural networks is the optimal
brain surgeon; Hassibi and Stork, 1993.) A pole that noise has split in two loses one of them that way without harm.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from baselines.identification.innovation_model import InnovationModel
from baselines.identification.measurement import Measurement
from baselines.identification.prediction_error import Refined, Spectra, moved, refined
from baselines.identification.realisation import Realisation
from beamenv.configuration.read_only import ReadOnly

Array = NDArray[np.float64]

MADE_GOOD = 300.0
"""Likelihood of all rows held back that a balanced model may lack to begin with: prediction error makes it good."""
DOUBTFUL = 3.0
"""Wald's statistic over the count of its numbers, 1 for a pole that is not there: all below this are taken away together."""
CERTAIN = 3.0
"""Standard errors by which rows held back must miss a pole for it to stay; of several poles at once, none may be missed at all."""
BLOCKS = 50
"""Into which those rows are cut for the standard error, long against what a row remembers."""
STEPS = 4
"""Of prediction error after a pole was taken away."""
LAST_STEPS, LAST_GAIN = 15, 0.002
"""Of prediction error once the order is chosen: ten times as far as while it is sought."""
REFUSALS = 6
"""How many poles in turn must be missed before the search ends."""


@dataclass(frozen=True, slots=True, eq=False)
class Tried(ReadOnly):
    """An order that was looked at."""

    order: int
    loss: float
    """Half the log determinant of what one-step errors vary by on the rows held back: what a row loses of its likelihood."""
    missed: float
    """How much worse a row is than with the pole still there, in standard errors; 0 for the first."""
    kept: bool


@dataclass(frozen=True, slots=True, eq=False)
class Choice:
    """The model of the order chosen, and what was tried on the way."""

    refined: Refined
    tried: tuple[Tried, ...]
    wanted: int | None
    """The order that was asked for, if one was."""

    @property
    def reason(self) -> str:
        """Why this order, in a sentence."""
        order = self.refined.model.order
        if self.wanted is not None:
            return f"{order} states: {self.wanted} were asked for."
        shorter = [each for each in self.tried if order - 2 <= each.order < order]
        if not shorter:
            return f"{order} states: there is no pole left to do without."
        nearest = min(shorter, key=lambda each: each.missed)
        return (
            f"{order} states: without one pole more, {nearest.order} states, rows held back are worse predicted by "
            f"{nearest.missed:.1f} standard errors."
        )


Told = Callable[[str, float], None]


def first_order(realisation: Realisation, everything: Measurement, learned: int, candidates: range) -> tuple[int, dict[int, float]]:
    """The least order of a balanced model that explains the rows after ``learned`` about as well as the best; the loss of each."""
    errors = {order: _held_back(realisation.model(order), everything, learned) for order in candidates}
    losses = {order: np.inf if each is None else _loss(each) for order, each in errors.items()}
    least = min(losses.values())
    if not np.isfinite(least):
        raise ValueError("the measurement is explained by no model that is stable: it is too short, or of nothing that is.")
    rows = len(everything) - learned
    return next(order for order, loss in losses.items() if rows * (loss - least) <= MADE_GOOD), losses


def _held_back(model: InnovationModel, everything: Measurement, learned: int) -> Array | None:
    """One-step errors of the rows after ``learned``; None where there are no finite ones."""
    if not model.stable:
        return None
    with np.errstate(all="ignore"):  # of a predictor that is nearly unstable
        errors = model.one_step_errors(everything.voltages, everything.readings)[learned:]
    return errors if np.isfinite(errors).all() else None


def _loss(errors: Array) -> float:
    return 0.5 * float(np.linalg.slogdet(errors.T @ errors / len(errors))[1])


def pruned(first: Refined, spectra: Spectra, everything: Measurement, learned: int, wanted: int | None, told: Told) -> Choice:
    """Poles taken away down to ``wanted`` states; None: for as long as the rows after ``learned`` do not miss them."""
    now, (losses, loss) = first, _losses(first.model, everything, learned)
    tried, passed = [Tried(first.model.order, loss, 0.0, True)], 0
    least, together = wanted or 2, first.model.order
    while now.model.order > least and passed < REFUSALS:
        poles = _next(now, least, passed, together)
        if not poles:
            break
        shorter = without(now, poles)
        after = refined(spectra, shorter.model, shorter.start, steps=STEPS)
        left, loss = _losses(after.model, everything, learned)
        missed = _in_standard_errors(left - losses)
        kept = wanted is not None or missed < (CERTAIN if len(poles) == 1 else 0.0)
        tried.append(Tried(after.model.order, loss, missed, kept))
        told(f"{after.model.order} states", 0.0)
        if kept:
            now, losses, passed = after, left, 0
        elif len(poles) > 1:
            together = len(poles) // 2
        else:
            passed += 1
    return Choice(now, tuple(tried), wanted)


def settled(choice: Choice, spectra: Spectra, everything: Measurement, learned: int) -> Choice:
    """The choice with its model refined further, unless rows held back are certainly predicted worse by that."""
    now = choice.refined
    further = refined(spectra, now.model, now.start, steps=LAST_STEPS, enough=LAST_GAIN)
    before, after = (_losses(each.model, everything, learned)[0] for each in (now, further))
    return replace(choice, refined=further) if _in_standard_errors(after - before) < CERTAIN else choice


def _next(found: Refined, least: int, passed: int, together: int) -> list[int]:
    """The poles to try without: those that are doubtful, of these ``together``, or the least certain one but ``passed``."""
    certain = certainties(found)
    ranked = [int(k) for k in np.argsort(certain)]
    doubtful = [k for k in ranked if certain[k] < DOUBTFUL]
    states = _states(found.model)
    while sum(len(states[k]) for k in doubtful) > found.model.order - least:
        doubtful.pop()
    if len(doubtful[:together]) > 1:
        return doubtful[:together]
    fitting = [k for k in ranked if found.model.order - len(states[k]) >= least]
    return fitting[passed : passed + 1]


def _losses(model: InnovationModel, everything: Measurement, learned: int) -> tuple[Array, float]:
    """Minus log likelihood (rows,) of each row after ``learned``, less a constant; and what ``Tried`` has."""
    errors = _held_back(model, everything, learned)
    if errors is None:
        return np.full(len(everything) - learned, np.inf), np.inf
    root = np.linalg.cholesky(model.covariance)
    return 0.5 * (np.linalg.solve(root, errors.T) ** 2).sum(axis=0) + np.log(np.diag(root)).sum(), _loss(errors)


def _in_standard_errors(difference: Array) -> float:
    if not np.isfinite(difference).all():
        return np.inf
    blocks = np.array([each.mean() for each in np.array_split(difference, min(BLOCKS, len(difference) // 2))])
    return float(blocks.mean() / (blocks.std(ddof=1) / np.sqrt(len(blocks)) + 1e-300))


def certainties(found: Refined) -> Array:
    """Wald's statistic (r + s,) over the count of its numbers: of each mode, then of each real pole, that it is driven at all."""
    return np.array([_wald(found, states) for states in _states(found.model)])


def _states(model: InnovationModel) -> list[list[int]]:
    r = len(model.pairs)
    return [[2 * k, 2 * k + 1] for k in range(r)] + [[2 * r + k] for k in range(len(model.reals))]


def _driving(model: InnovationModel, states: list[int]) -> tuple[NDArray[np.int64], Array]:
    """Where the rows of [B K] of some states stand among the parameters, and their values."""
    n, m, p = model.order, model.B.shape[1], len(model.C)
    columns = np.r_[0:m, m : m + p]
    where = (n + np.array(states)[:, None] * (m + p + 1) + columns).ravel()
    return where, np.hstack([model.B[states], model.K[states]]).ravel()


def _wald(found: Refined, states: list[int]) -> float:
    where, values = _driving(found.model, states)
    return float(values @ np.linalg.pinv(found.parameters[np.ix_(where, where)], rcond=1e-8, hermitian=True) @ values) / len(values)


def without(found: Refined, poles: list[int]) -> Refined:
    """The model without some of its poles, the others moved to make good for them as far as the curvature tells."""
    states = [state for pole in poles for state in _states(found.model)[pole]]
    where, values = _driving(found.model, states)
    inverse = np.linalg.pinv(found.parameters[np.ix_(where, where)], rcond=1e-8, hermitian=True)
    made_good = _dropped(moved(found.model, -found.parameters[:, where] @ inverse @ values), poles, states)
    model = made_good if made_good.stable else _dropped(found.model, poles, states).steadied()
    return replace(found, model=model, start=np.delete(found.start, states))


def _dropped(model: InnovationModel, poles: list[int], states: list[int]) -> InnovationModel:
    r = len(model.pairs)
    rows = {name: np.delete(getattr(model, name), states, axis=0) for name in ("B", "K")}
    return replace(
        model,
        pairs=np.delete(model.pairs, [k for k in poles if k < r]),
        reals=np.delete(model.reals, [k - r for k in poles if k >= r]),
        C=np.delete(model.C, states, axis=1),
        **rows,
    )
