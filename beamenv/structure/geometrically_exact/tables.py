"""Tables of the functions along the span at stations: of a blade's displacements and rotations."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.geometrically_exact.kinematics import INCREMENT
from beamenv.structure.span_space import FIELDS, SpanSpace

Array = NDArray[np.float64]

FIELD_COUNT = len(FIELDS)


def increment_rows(space: SpanSpace, z: Array) -> Array:
    """(S, 12, N): [u, c, u′, c′] at stations z (m), per coefficient."""
    if space.rigid:
        tables = space.evaluate(z)
        return np.stack([tables[name, derivative] for derivative in (0, 1) for name in FIELDS], axis=1)
    rows = np.zeros((len(z), INCREMENT, space.size))
    for order, table in enumerate(field_tables(space, z)):
        for k, block in enumerate(space.blocks().values()):
            rows[:, FIELD_COUNT * order + k, block] = table
    return rows


def field_tables(space: SpanSpace, z: Array) -> tuple[Array, Array]:
    """Values and slopes (S, terms) of the functions that every field has where sections shear."""
    value, slope, _ = space.table(z, space.kind("u"))
    return value, slope
