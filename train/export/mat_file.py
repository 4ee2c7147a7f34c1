"""A controller as a MATLAB file: matrices of a linear law for Simulink's blocks, and every block of any controller's diagram."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.io import savemat

from baselines import LinearController
from beamenv.plant.plant import drive_limit
from train.export.blocks import Affine, Block, Blocks, Constant, Delay, Function, Input, Pair, Pick, Reduce
from train.export.diagram import Diagram, called
from train.export.exported import Exported


def mat_file(exported: Exported) -> bytes:
    """The file's bytes, for MATLAB 5 and later; ``ValueError`` for numbers that its precision cannot hold.

    Of a linear law there are ``A``, ``B``, ``C``, ``D``, u = C ξ + D y and ξ⁺ = A ξ + B y while no limit acts, and ``F``, ``G``,
    ``H``, ``M``, ``T``, ξ⁺ = F ξ + G y + H u, u = clip(M ξ + T y), y in the sensors' units and u in V. Of every controller there
    are ``blocks``, each behind its sources: a name, what it does, the names of its sources and its tables, indices from 1; and
    ``memory``: the name of what is remembered, how many numbers, zero at first, and the name of the signal that it is next.
    """
    exported.check_range()
    plant, kind = exported.plant, np.float64 if exported.precision == "double" else np.float32
    names = _names(exported.diagram)
    content: dict[str, Any] = {
        "about": {name.replace(" ", "_"): text for name, text in exported.facts.items() if "[" not in name},
        "dt": plant.control_interval,
        "sensor_names": _cells([each.name for each in plant.sensors]),
        "sensor_units": _cells([each.unit for each in plant.sensors]),
        "sensor_full_scale": plant.sensor_full_scale,
        "voltage_limits": plant.voltage_limits,
        "drive_limit": drive_limit(plant),
        "inputs": _cells([names[each] for each in exported.diagram.inputs]),
        "output": names[exported.diagram.output],
        **{name: matrix.astype(kind) for name, matrix in _matrices(exported.source).items()},
        "blocks": _structs([_block(each, names, kind) for each in exported.diagram.order if not isinstance(each, (Input, Delay))]),
        "memory": _structs(
            [{"name": names[each], "size": each.size, "next": names[by]} for each, by in exported.diagram.following.items()]
        ),
    }
    file = io.BytesIO()
    savemat(file, content, oned_as="row", long_field_names=True, do_compression=True)
    return file.getvalue()


def _matrices(law: Any) -> dict[str, NDArray[Any]]:
    """Of a linear law."""
    if not isinstance(law, LinearController):
        return {}
    F, G, H, M, T = law.transition, law.measurement_input, law.voltage_input, law.state_gain, law.measurement_gain
    return {"A": F + H @ M, "B": G + H @ T, "C": M, "D": T, "F": F, "G": G, "H": H, "M": M, "T": T}


def _names(diagram: Diagram) -> dict[Block, str]:
    """A name of its own for every signal."""
    found: dict[Block, str] = {}
    taken: dict[str, int] = {}
    for block in diagram.order:
        name = called(block)
        taken[name] = taken.get(name, 0) + 1
        found[block] = name if taken[name] == 1 else f"{name}_{taken[name]}"
    return found


def _block(block: Block, names: dict[Block, str], kind: Any) -> dict[str, Any]:
    """A block's fields: those that it does not have are empty."""
    empty: dict[str, Any] = dict.fromkeys(("matrix", "bias", "which", "indices", "value"), np.zeros((0, 0)))
    what = block.name if isinstance(block, (Function, Pair, Reduce)) else type(block).__name__.lower()
    parts = f"{what} of parts" if isinstance(block, Reduce) else what
    own = {"name": names[block], "does": parts, "of": _cells([names[each] for each in block.sources]), "size": block.size, **empty}
    return {**own, **_tables(block, kind)}


def _tables(block: Block, kind: Any) -> dict[str, Any]:
    if isinstance(block, Affine):
        return {"matrix": block.matrix.astype(kind), **({} if block.bias is None else {"bias": block.bias.astype(kind)})}
    if isinstance(block, Blocks):
        return {"matrix": block.matrices.transpose(2, 3, 1, 0).astype(kind), "which": block.which + 1.0}
    if isinstance(block, Pick):
        return {"indices": block.indices + 1.0}
    return {"value": block.value.astype(kind)} if isinstance(block, Constant) else {}


def _cells(texts: list[str]) -> NDArray[Any]:
    found = np.empty(len(texts), dtype=object)
    found[:] = texts
    return found


def _structs(rows: list[dict[str, Any]]) -> NDArray[Any]:
    """A structure array with the fields of the first row."""
    if not rows:
        return np.zeros((0, 0))
    found = np.empty(len(rows), dtype=[(name, object) for name in rows[0]])
    for k, row in enumerate(rows):
        found[k] = tuple(row.values())
    return found
