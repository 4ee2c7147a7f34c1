"""Tables of the trial functions at stations: of a blade's displacements and rotations, and of its shapes' amplitudes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.geometrically_exact.kinematics import INCREMENT
from beamenv.structure.trial_functions import FIELDS, TrialSpace, clamped_table

Array = NDArray[np.float64]

FIELD_COUNT = len(FIELDS)


def increment_rows(space: TrialSpace, z: Array) -> Array:
    """(S, 12, N): [u, c, u′, c′] at stations z (m), per coefficient."""
    if space.rigid:
        tables = space.evaluate(z)
        return np.stack([tables[name, derivative] for derivative in (0, 1) for name in FIELDS], axis=1)
    rows = np.zeros((len(z), INCREMENT, space.size))
    for order, table in enumerate(field_tables(space, z)):
        for k in range(FIELD_COUNT):
            rows[:, FIELD_COUNT * order + k, space.each * k : space.each * (k + 1)] = table
    return rows


def field_tables(space: TrialSpace, z: Array) -> tuple[Array, Array]:
    """Values and slopes (S, each) of the trial functions that every field has."""
    value, slope, _ = space.table(z, 1)
    return value, slope


def shape_tables(space: TrialSpace, z: Array) -> tuple[Array, Array]:
    """Values and slopes (S, terms) of the amplitudes' trial functions."""
    return clamped_table(z / space.length, space.terms, space.length, space.clamp_reach)
