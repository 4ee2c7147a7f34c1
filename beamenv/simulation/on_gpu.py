"""A kernel of a GPU's own, in Triton, which PyTorch for CUDA brings: the look for strains.

To multiply the strains of all blades takes three times as long as their step, and hardly ever has one energy enough to fail; but
the host would have to wait for the device to learn which. Here each block of blades decides by itself.
"""

from typing import Any

import torch
import triton
import triton.language as tl

_BLADES, _POINTS = 64, 64
"""Blades that one program looks after, and places of a blade whose strains it works out at a time."""


@triton.jit  # type: ignore[untyped-decorator]
def _look(  # type: ignore[no-untyped-def]
    energy, states, strain, standing, limit, index, failed, safe, count, own_states, points,
    BLADES: tl.constexpr, STATES: tl.constexpr, POINTS: tl.constexpr,
):  # fmt: skip
    first = tl.program_id(0) * BLADES
    rows = first + tl.arange(0, BLADES)
    columns = tl.arange(0, STATES)
    told = tl.zeros((BLADES,), tl.int32)
    energies = tl.load(energy + rows, mask=rows < count, other=0.0)
    if tl.min((energies <= safe).to(tl.int32), 0) == 0:  # what is no number is not safe either
        for row in range(first, tl.minimum(first + BLADES, count)):
            if (tl.load(energy + row) <= safe) == 0:
                plant = tl.load(index + row)
                state = tl.load(states + row * own_states + columns, mask=columns < own_states, other=0.0)
                bad = 0
                for point in range(0, points, POINTS):
                    places = point + tl.arange(0, POINTS)
                    there = places < points
                    at = plant * points + places
                    slopes = tl.load(
                        strain + at[:, None] * own_states + columns, mask=there[:, None] & (columns < own_states), other=0.0
                    )
                    moved = tl.load(standing + at, mask=there, other=0.0) + tl.sum(slopes * state, 1)
                    beyond = (tl.abs(moved) <= tl.load(limit + plant)) == 0
                    bad = tl.maximum(bad, tl.max((beyond & there).to(tl.int32), 0))
                told = tl.where(rows == row, bad, told)
    tl.store(failed + rows, told != 0, mask=rows < count)


@torch.library.custom_op("beamenv::strained_too_much", mutates_args=())
def strained_too_much(
    energy: torch.Tensor,
    states: torch.Tensor,
    strain: torch.Tensor,
    standing: torch.Tensor,
    limit: torch.Tensor,
    index: torch.Tensor,
    safe: float,
) -> torch.Tensor:
    """(N,) bools: which states (N, n) strain their blades beyond what they bear.

    As ``strain_limit.strained_too_much``, of blades with energies (N,) J that have the plants ``index`` (N,) of tables (K, s, n),
    (K, s) and (K,), none of which fails below ``safe`` J.
    """
    count, own = states.shape
    failed = torch.empty(count, dtype=torch.bool, device=states.device)
    _look[(triton.cdiv(count, _BLADES),)](
        energy.contiguous(), states.contiguous(), strain, standing, limit, index, failed, safe, count, own, strain.shape[1],
        BLADES=_BLADES, STATES=triton.next_power_of_2(own), POINTS=_POINTS,
    )  # fmt: skip
    return failed


@strained_too_much.register_fake
def _(energy: torch.Tensor, *others: Any) -> torch.Tensor:
    return torch.empty_like(energy, dtype=torch.bool)
