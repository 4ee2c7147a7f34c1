"""What a trained policy is made of, checked: weights of shapes that fit, finite, and settings by which it can act."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Choice, Count, Flag, Number, Numbers, Refused, Table, checked
from beamenv.configuration.kinds import Kind

Array = NDArray[np.floating[Any]]
Shapes = dict[str, tuple[int, ...]]

NEEDED: Mapping[str, Mapping[str, Kind]] = {
    "history": {"input_gain": Number(), "held": Count()},
    "belief": {"input_gain": Number(), "held": Count()},
    "recurrent": {"input_gain": Number()},
    "state-space": {},
    "residual": {"input_gain": Number()},
    "multiple-model-residual": {"input_gain": Number()},
    "lstm": {"input_gain": Number(), "held": Count()},
}
"""Settings that a kind of policy acts by."""

ACTIVATIONS = ("tanh", "relu")

_LAYERED = {"activation": Choice(ACTIVATIONS), "squashed": Flag(), "approach": Number(gt=0.0, le=1.0)}

OPTIONAL: Mapping[str, Mapping[str, Kind]] = {"history": _LAYERED, "belief": _LAYERED}


def limits(lowest: Any, highest: Any) -> tuple[Array, Array]:
    """(m,) drive limits in units of the larger one; ``ValueError`` unless each is a list of numbers and the highest are higher."""
    given = (("lowest", lowest), ("highest", highest))
    low, high = (np.array(checked(name, values, Numbers(least=1)), dtype=np.float32) for name, values in given)
    if low.shape != high.shape or not (low < high).all():
        raise Refused("highest", highest, f"a list of {len(low)} numbers, each above that of lowest")
    return low, high


def checked_settings(kind: str, settings: Any) -> dict[str, Any]:
    """Settings as a policy of this kind can act by them; those of its training may be among them. ``ValueError`` if not."""
    table: dict[str, Any] = checked("settings", settings, Table())
    for name, allowed in NEEDED[kind].items():
        table[name] = checked(f"settings.{name}", table.get(name), allowed)
    for name, allowed in OPTIONAL.get(kind, {}).items():
        if name in table:
            table[name] = checked(f"settings.{name}", table[name], allowed)
    return table


def checked_weights(kind: str, weights: Mapping[str, Any], voltages: int, readings: int | None) -> dict[str, Array]:
    """The weights of a policy of ``voltages`` outputs, of these ``readings`` if they are known.

    Raises ``ValueError`` of one sentence for one that is missing, of another shape than the others ask for, or not finite.
    """
    shapes = EXPECTED[kind](_Sizes(kind, weights), voltages, readings)
    for name in (*shapes, *weights):
        if name not in weights or name not in shapes:
            what = "are missing" if name not in weights else "are no part of it"
            raise ValueError(f"weights {name!r} {what}: a policy of kind {kind!r} has {', '.join(shapes)}.")
    for name, shape in shapes.items():
        if weights[name].shape != shape:
            raise ValueError(f"weights {name!r} are of shape {weights[name].shape}, but must be of {shape} to fit the others.")
        if weights[name].dtype.kind != "f" or not np.isfinite(weights[name]).all():
            raise ValueError(f"weights {name!r} must be finite floating-point numbers.")
    return dict(weights)


class _Sizes:
    """Sizes of weights, each a matrix."""

    def __init__(self, kind: str, weights: Mapping[str, Any]) -> None:
        self.kind, self.weights = kind, weights

    def of(self, name: str) -> tuple[int, int]:
        """Rows and columns; ``ValueError`` if the weights are missing or no matrix."""
        if name not in self.weights:
            raise ValueError(f"weights {name!r} are missing: a policy of kind {self.kind!r} needs them.")
        shape = self.weights[name].shape
        if len(shape) != 2 or 0 in shape:
            raise ValueError(f"weights {name!r} are of shape {shape}, but must be a matrix.")
        rows, columns = shape
        return rows, columns


def _windowed(width: int, instant: int, readings: int | None) -> int:
    """The width of a window if it has whole instants, or, of readings unknown, could have; else the next that has."""
    if readings is None:
        return max(width, instant + 1)
    return max(width // (instant + readings), 1) * (instant + readings)


def _history(sizes: _Sizes, m: int, p: int | None) -> Shapes:
    return _layers(sizes, m, _windowed(sizes.of("weight0")[1], m, p))


def _belief(sizes: _Sizes, m: int, p: int | None) -> Shapes:
    order, shown = sizes.of("shown")
    p = sizes.of("readout")[1] if p is None else p
    parts = {"transition": (order, order), "input": (m, order), "correction": (p, order), "readout": (order, p)}
    return {**parts, "shown": (order, shown), **_layers(sizes, m, shown + m)}


def _layers(sizes: _Sizes, m: int, inputs: int) -> Shapes:
    """Of layers one upon the other, as many as there are biases, one at least."""
    depth = max(sum(name.startswith("bias") for name in sizes.weights), 1)
    widths = [inputs, *(sizes.of(f"weight{k}")[0] for k in range(depth - 1)), m]
    layers = enumerate(zip(widths[:-1], widths[1:], strict=True))
    return {name: shape for k, (a, b) in layers for name, shape in ((f"weight{k}", (b, a)), (f"bias{k}", (b,)))}


def _cells(sizes: _Sizes, gates: int, inputs: int, outputs: int) -> Shapes:
    units = sizes.of("weight_hh")[1]
    return {
        "weight_ih": (gates * units, inputs),
        "weight_hh": (gates * units, units),
        "bias_ih": (gates * units,),
        "bias_hh": (gates * units,),
        "weight_out": (outputs, units),
        "bias_out": (outputs,),
    }


def _recurrent(sizes: _Sizes, m: int, p: int | None) -> Shapes:
    p = max(sizes.of("weight_ih")[1] - m, 1) if p is None else p
    return _cells(sizes, 3, p + m, m)


def _state_space(sizes: _Sizes, m: int, p: int | None) -> Shapes:
    order = sizes.of("feedback")[1]
    p = sizes.of("readout")[1] if p is None else p
    return {"fused": (order + p, order + m), "feedback": (m, order), "readout": (order, p)}


def _residual(sizes: _Sizes, m: int, p: int | None) -> Shapes:
    p = max(sizes.of("weight_ih")[1] - 2 * m, 1) if p is None else p
    return {**_cells(sizes, 3, p + 2 * m, 2 * m), **_state_space(sizes, m, p)}


def _multiple_model(sizes: _Sizes, m: int, p: int | None) -> Shapes:
    """Beside readings and voltages it sees one number, and one of each model, of which it alone cannot say how many there are."""
    return _cells(sizes, 3, max(sizes.of("weight_ih")[1], (p or 1) + 3 * m + 2), 3 * m)


def _lstm(sizes: _Sizes, m: int, p: int | None) -> Shapes:
    return _cells(sizes, 4, _windowed(sizes.of("weight_ih")[1], m, p), m)


EXPECTED: Mapping[str, Callable[[_Sizes, int, int | None], Shapes]] = {
    "history": _history,
    "belief": _belief,
    "recurrent": _recurrent,
    "state-space": _state_space,
    "residual": _residual,
    "multiple-model-residual": _multiple_model,
    "lstm": _lstm,
}
"""Shapes of each kind's weights, from sizes that they must share."""
