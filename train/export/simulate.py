"""A block diagram run by NumPy: what all that is written of it must do."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import singledispatch
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.export.blocks import Affine, Block, Blocks, Choose, Constant, Delay, Function, Join, Pair, Pick, Reduce
from train.export.diagram import Diagram

Array = NDArray[np.floating[Any]]

_FUNCTIONS: Mapping[str, Callable[[Array], Array]] = {
    "tanh": np.tanh,
    "sigmoid": lambda x: x.dtype.type(0.5) * (1 + np.tanh(x.dtype.type(0.5) * x)),
    "exp": np.exp,
    "log": np.log,
    "absolute": np.abs,
}

_REDUCTIONS: Mapping[str, Callable[..., Array]] = {"sum": np.sum, "maximum": np.max, "minimum": np.min}


def simulated(diagram: Diagram, *measured: Array, single: bool = False) -> Array:
    """Voltages (k, m) of k instants from the measurements (k, p) of each input, from the start on."""
    kind = np.float32 if single else np.float64
    order = diagram.order
    held: dict[Block, Array] = {delay: np.zeros(delay.size, kind) for delay in diagram.following}
    found = np.empty((len(measured[0]), diagram.output.size), kind)
    for k in range(len(found)):
        values = dict(held)
        values.update((each, rows[k].astype(kind)) for each, rows in zip(diagram.inputs, measured, strict=True))
        for block in order:
            if block not in values:
                values[block] = np.asarray(_value(block, values), dtype=kind)
        found[k] = values[diagram.output]
        held = {delay: values[following] for delay, following in diagram.following.items()}
    return found


@singledispatch
def _value(block: Block, values: Mapping[Block, Array]) -> Array:
    raise TypeError(f"{type(block).__name__} has no value of its own.")


@_value.register
def _(block: Delay, values: Mapping[Block, Array]) -> Array:
    raise TypeError("a delay holds what no block gives it.")


@_value.register
def _(block: Constant, values: Mapping[Block, Array]) -> Array:
    return block.value


@_value.register
def _(block: Affine, values: Mapping[Block, Array]) -> Array:
    x = values[block.of]
    product = block.matrix.astype(x.dtype) @ x
    return product if block.bias is None else product + block.bias.astype(x.dtype)


@_value.register
def _(block: Blocks, values: Mapping[Block, Array]) -> Array:
    x = values[block.of].reshape(len(block.which), block.matrices.shape[3], 1)
    k = 0 if block.step is None else min(int(values[block.step][0]), len(block.matrices) - 1)
    return (block.matrices[k, block.which].astype(x.dtype) @ x).ravel()


@_value.register
def _(block: Function, values: Mapping[Block, Array]) -> Array:
    return _FUNCTIONS[block.name](values[block.of])


@_value.register
def _(block: Pair, values: Mapping[Block, Array]) -> Array:
    return np.asarray(getattr(np, block.name)(values[block.left], values[block.right]))


@_value.register
def _(block: Choose, values: Mapping[Block, Array]) -> Array:
    return np.where(values[block.condition] > 0.0, values[block.where], values[block.otherwise])


@_value.register
def _(block: Pick, values: Mapping[Block, Array]) -> Array:
    return values[block.of][block.indices]


@_value.register
def _(block: Join, values: Mapping[Block, Array]) -> Array:
    return np.concatenate([values[part] for part in block.parts])


@_value.register
def _(block: Reduce, values: Mapping[Block, Array]) -> Array:
    return _REDUCTIONS[block.name](values[block.of].reshape(block.size, -1), axis=1)
