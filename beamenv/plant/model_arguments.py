"""What is said of a model, as arrays of the shapes that it must have."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.configuration import Refused, Texts, checked
from beamenv.configuration.arrays import check_finite, checked_array, real_numbers
from beamenv.plant.limits import STRONGEST_DRIVE
from beamenv.plant.parts import not_negative
from beamenv.plant.signals import Signal

Array = NDArray[np.float64]

FASTEST, LARGEST = 1e9, 1e30
"""Largest entries of A, 1/s, and of any other matrix."""

USUAL_LIMIT = 10.0
"""V: of a laboratory's amplifiers before anything that makes more of it."""


def checked_matrices(A: ArrayLike, B: ArrayLike, C: ArrayLike, D: ArrayLike | None) -> tuple[Array, Array, Array, Array]:
    """(n, n), (n, m), (p, n), (p, m): a row of B is one of one actuator, and so on."""
    dynamics = real_numbers("A", A)
    dynamics = dynamics.reshape(1, 1) if dynamics.ndim == 0 else dynamics
    n = len(dynamics)
    square = checked_array("A", dynamics, (n, n), "a row and a column for each state")
    inputs, outputs = real_numbers("B", B), real_numbers("C", C)
    inputs = inputs.reshape(-1, 1) if inputs.ndim < 2 else inputs
    inputs = checked_array("B", inputs, (n, None), "a row for each state, a column for each voltage")
    outputs = checked_array("C", np.atleast_2d(outputs), (None, n), "a row for each sensor, a column for each state")
    p, m = len(outputs), inputs.shape[1]
    through = np.zeros((p, m)) if D is None else real_numbers("D", D)
    through = through.reshape(p, m) if through.ndim < 2 and through.size == p * m else through
    through = checked_array("D", through, (p, m), "a row for each sensor, a column for each voltage")
    matrices = square, inputs, outputs, through
    for name, matrix, most in zip("ABCD", matrices, (FASTEST, LARGEST, LARGEST, LARGEST), strict=True):
        within(name, matrix, most)
    return matrices


def within(name: str, values: Array, most: float = LARGEST) -> Array:
    """The numbers; ``ValueError`` for any beyond ``most``, whose squares would leave what a computer counts with."""
    largest = float(np.abs(values).max(initial=0.0))
    if not largest <= most:
        raise ValueError(f"{name} has an entry of {largest:.3g} in magnitude, but must have none beyond {most:g}.")
    return values


def checked_limits(given: ArrayLike | None, m: int, assumed: list[str]) -> Array:
    """(2, m): a number is ± for all, two are the lower and upper one of all."""
    if given is None:
        assumed.append(f"actuator_limits = ±{USUAL_LIMIT:g} V")
        given = USUAL_LIMIT
    limits = real_numbers("actuator_limits", given)
    if limits.ndim == 0:
        limits = np.array([-limits, limits])
    limits = np.repeat(limits[:, None], m, axis=1) if limits.shape == (2,) else limits
    limits = checked_array(
        "actuator_limits", limits, (2, m), "lower and upper limit (V) of each voltage, or of all, or ± one number"
    )
    low, high = limits
    if not (np.all(low <= 0.0) and np.all(high >= 0.0) and np.all(high > low) and np.abs(limits).max() <= STRONGEST_DRIVE):
        allowed = f"a lower limit from {-STRONGEST_DRIVE:g} to 0 V and an upper one from 0 to {STRONGEST_DRIVE:g} V, apart"
        raise Refused("actuator_limits", limits.tolist(), allowed)
    return limits


def checked_inputs(name: str, given: ArrayLike | None, states: int) -> Array | None:
    """(n, k), or None as it is."""
    if given is None:
        return None
    inputs = real_numbers(name, given)
    inputs = inputs.reshape(-1, 1) if inputs.ndim < 2 else inputs
    return within(name, checked_array(name, inputs, (states, None), "a row for each state, a column for each disturbance"))


def checked_rows(name: str, given: ArrayLike, states: int, further: int) -> Array:
    """(q, n + further), zero of further states."""
    given = np.atleast_2d(real_numbers(name, given))
    rows = within(name, checked_array(name, given, (None, states), "a row for each, a column for each state"))
    return np.hstack([rows, np.zeros((len(rows), further))])


def root_of(name: str, given: ArrayLike | None, states: int) -> Array:
    """(n, r) whose square is a covariance (n, n)."""
    if given is None:
        return np.zeros((states, 0))
    covariance = not_negative(name, checked_array(name, given, (states, states), "a row and a column for each state"))
    deviations = np.sqrt(np.diag(covariance))  # states in small units are not to count for none
    units = np.where(deviations > 0.0, deviations, 1.0)
    values, vectors = np.linalg.eigh(covariance / np.outer(units, units))
    there = values > 1e-14 * max(float(values[-1]), 0.0)
    return np.asarray(units[:, None] * vectors[:, there] * np.sqrt(values[there]))


def named_signals(kind: str, names: Sequence[str] | None, units: Sequence[str] | None, count: int) -> tuple[Signal, ...]:
    """So many, numbered where they have no names, and without a unit where none is known."""
    titles = tuple(f"{kind} {k}" for k in range(count)) if names is None else checked(f"{kind}_names", names, Texts())
    measures = ("",) * count if units is None else checked(f"{kind}_units", units, Texts())
    for what, those in (("names", titles), ("units", measures)):
        if len(those) != count:
            raise Refused(f"{kind}_{what}", list(those), f"{count}, one for each {kind}")
    if len(set(titles)) < count:
        raise Refused(f"{kind}_names", list(titles), f"a name of its own for each {kind}")
    return tuple(Signal(*each) for each in zip(titles, measures, strict=True))


def checked_weight(name: str, given: ArrayLike, size: int, of: str) -> Array:
    """(size, size), of a number for each or of a matrix; ``ValueError`` unless symmetric and not negative."""
    weight = real_numbers(name, given)
    weight = np.diag(np.broadcast_to(weight, (size,))) if weight.shape in ((), (size,)) else weight
    return not_negative(
        name, checked_array(name, weight, (size, size), f"a row and a column for each {of}, or one number for each")
    )


def checked_covariance(name: str, given: ArrayLike, size: int, of: str) -> Array:
    """(size, size), of standard deviations or as it is."""
    values = real_numbers(name, given)
    if values.shape in ((), (size,)):
        values = np.broadcast_to(values, (size,))
        check_finite(name, values)
        if np.any(values < 0.0):
            raise Refused(name, values.tolist(), "standard deviations of at least 0")
        return np.diag(values**2)
    return not_negative(
        name, checked_array(name, values, (size, size), f"a row and a column for each {of}, or a deviation for each")
    )


def positive(name: str, given: ArrayLike, count: int, of: str) -> Array:
    """(count,) positive numbers, of one for all or one for each; ``ValueError`` for any others."""
    values = real_numbers(name, given)
    values = np.full(count, values) if values.ndim == 0 else values
    if values.shape != (count,) or not (np.isfinite(values).all() and np.all(values > 0.0)):
        raise Refused(name, values.tolist(), f"positive numbers, one for each {of} ({count}), or one for all")
    return np.array(values)
