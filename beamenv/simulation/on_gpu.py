"""Kernels of a GPU's own, in Triton, which PyTorch for CUDA brings: the product of a step, and the look for strains.

A product of many rows and few columns libraries leave at a fifth of what the memory allows. To multiply the strains of all blades
takes three times as long as their step, and hardly ever has one energy enough to fail, but the host would have to wait for the
device to learn which: here each block of blades decides by itself.
"""

from typing import Any

import torch
import triton
import triton.language as tl

_BLADES, _POINTS = 64, 64
"""Blades that one program looks after, and places of a blade whose strains it works out at a time."""

_ROWS, _COLUMNS, _WARPS = 128, 32, 4
"""Rows of a product that one program makes, columns it makes at a time, and its warps of threads."""


@triton.jit  # type: ignore[untyped-decorator]
def _multiply(  # type: ignore[no-untyped-def]
    state, held, loads, matrix, out, count, states, voltages, further, width,
    ROWS: tl.constexpr, STATES: tl.constexpr, INPUTS: tl.constexpr, COLUMNS: tl.constexpr,
):  # fmt: skip
    rows = tl.program_id(0) * ROWS + tl.arange(0, ROWS)[:, None]
    there, of_state, of_input = rows < count, tl.arange(0, STATES), tl.arange(0, INPUTS)
    moving = tl.load(state + rows * states + of_state, mask=there & (of_state < states), other=0.0)
    asked, beyond = of_input < voltages, of_input - voltages
    driven = tl.load(held + rows * voltages + of_input, mask=there & asked, other=0.0)
    driven += tl.load(loads + rows * further + beyond, mask=there & (beyond >= 0) & (beyond < further), other=0.0)
    for first in range(0, width, COLUMNS):
        columns = first + tl.arange(0, COLUMNS)
        inside = columns < width
        own = tl.load(matrix + of_state[:, None] * width + columns, mask=(of_state < states)[:, None] & inside, other=0.0)
        rest = tl.load(
            matrix + (states + of_input)[:, None] * width + columns,
            mask=(of_input < voltages + further)[:, None] & inside,
            other=0.0,
        )
        total = tl.dot(driven, rest, tl.dot(moving, own, input_precision="tf32x3"), input_precision="tf32x3")
        tl.store(out + rows * width + columns, total, mask=there & inside)


@torch.library.custom_op("beamenv::joined_product", mutates_args=())
def joined_product(state: torch.Tensor, held: torch.Tensor, loads: torch.Tensor, matrix: torch.Tensor) -> torch.Tensor:
    """[state, held, loads] (N, n + m + k) times a matrix (n + m + k, w), all of 32 bits: on tensor cores, in three parts of fewer
    bits each, which together are as exact as a product of 32 bits.
    """
    (count, states), width = state.shape, matrix.shape[1]
    out = torch.empty(count, width, dtype=state.dtype, device=state.device)
    inputs = held.shape[1] + loads.shape[1]
    _multiply[(triton.cdiv(count, _ROWS),)](
        state.contiguous(), held.contiguous(), loads.contiguous(), matrix.contiguous(), out,
        count, states, held.shape[1], loads.shape[1], width,
        ROWS=_ROWS, STATES=max(16, triton.next_power_of_2(states)), INPUTS=max(16, triton.next_power_of_2(inputs)),
        COLUMNS=_COLUMNS, num_warps=_WARPS,
    )  # fmt: skip
    return out


@joined_product.register_fake
def _(state: torch.Tensor, held: torch.Tensor, loads: torch.Tensor, matrix: torch.Tensor) -> torch.Tensor:
    return state.new_empty(state.shape[0], matrix.shape[1])


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
