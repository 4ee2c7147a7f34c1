"""Whether walls leave room for the corners between them: there they are cut along the mitre, which takes a share of each piece."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.structure.walls.chain import Chain

Array = NDArray[np.float64]

LEAST_ANGLE = 10.0
"""Degrees between two pieces that meet: the mitre of a sharper corner is a spike of more than eleven half thicknesses."""


def check_corners(chains: Sequence[Chain], drawn_by: str, scale: float = 1.0, path: str = "") -> None:
    """``ValueError`` for corners too sharp, and for walls too thick for a piece of theirs in a section of ``scale`` times the size.

    ``drawn_by`` is the field that says where corners are; ``path`` comes before the fields' names.
    """
    for chain in chains:
        before, after = reaches(chain)
        turn = np.degrees(turns(chain))
        if np.any(turn > 180.0 - LEAST_ANGLE):
            raise _too_sharp(chain, int(turn.argmax()), f"{path}{drawn_by}")
        taken, length = before + after, scale * chain.lengths
        if np.any(taken >= length):
            raise _too_short(chain, int((taken / length).argmax()), taken, turn, scale, path)


def turns(chain: Chain) -> Array:
    """(K,), rad: by how much the mid-line turns where each piece begins; 0 at a loose end."""
    tangent = (chain.ends - chain.starts) / chain.lengths[:, None]
    turn = np.arccos(np.clip((np.roll(tangent, 1, axis=0) * tangent).sum(axis=1), -1.0, 1.0))
    if not chain.closed:
        turn[0] = 0.0
    return np.asarray(turn)


def reaches(chain: Chain) -> tuple[Array, Array]:
    """(K,) each, m: how much of a piece the mitres take where it begins and where it ends.

    From where the mid-lines meet to where their faces do: h tan(φ/2) of walls of equal half thickness h, which turn by φ;
    |h₀ − h cos φ|/sin φ of one beside another of h₀.
    """
    turn, half = turns(chain), 0.5 * np.array(chain.thickness)
    other = np.roll(half, 1)
    sine, cosine = np.maximum(np.sin(turn), 1e-300), np.cos(turn)
    equal = (np.abs(half - other) <= 1e-12 * half) | (sine < 1e-6)
    alike = 0.5 * (half + other) * np.tan(0.5 * turn)
    begins = np.where(equal, alike, np.abs(other - half * cosine) / sine)
    ends = np.where(equal, alike, np.abs(half - other * cosine) / sine)
    return begins, np.roll(ends, -1)


def _too_sharp(chain: Chain, k: int, field: str) -> Refused:
    corner = chain.starts[k - 1], chain.starts[k], chain.ends[k]
    angle = 180.0 - float(np.degrees(turns(chain)[k]))
    allowed = f"points whose walls meet at {LEAST_ANGLE:g}° or more: those of wall {chain.walls[k]!r} meet at {angle:.3g}° here"
    return Refused(field, [point.tolist() for point in corner], allowed)


def _too_short(chain: Chain, k: int, taken: Array, turn: Array, scale: float, path: str) -> Refused:
    thickness, length, wall = chain.thickness[k], scale * float(chain.lengths[k]), chain.walls[k]
    number = 1 + [j for j, name in enumerate(chain.walls) if name == wall].index(k)
    angles = [180.0 - angle for angle in (turn[k], turn[(k + 1) % len(turn)]) if angle > 0.0]
    corners = " and ".join(f"a corner of {angle:.3g}°" for angle in angles)
    where = "" if scale == 1.0 else " at its narrow end"
    allowed = (
        f"below {thickness * length / taken[k]:.4g} m{where}: piece {number} of wall {wall!r} is {length:.4g} m long, beside "
        f"{corners}"
    )
    return Refused(f"{path}thickness", thickness, allowed)
