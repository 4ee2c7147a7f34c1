"""Standard normals: of NumPy with 64 and with 32 bits, and of torch on its device."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import namespace

_ALL = np.iinfo(np.uint64).max
_TURN = np.float32(2.0 * np.pi)
_MANTISSA, _ONE = np.uint32(9), np.uint32(0x3F800000)
"""32 bits shifted by the one and with the other's bits are a number of 32 bits in [1, 2)."""


class Normals:
    """Draws as many as an array has numbers, from a generator of NumPy, into that array.

    With 64 bits they are the generator's own. With 32 bits two are made of two uniform numbers (Box and Muller 1958), √(−2 ln u)
    times the cosine and the sine of an angle, which NumPy does several at a time: none is beyond 5.7. Their bits are drawn 64 at
    a time, in half the time of uniform numbers of 32 bits.
    """

    def __init__(self, out: NDArray[Any]) -> None:
        self.out = out
        self._flat = out.reshape(-1)
        self._pairs = -(-out.size // 2) if out.dtype == np.float32 else None

    def draw(self, generator: np.random.Generator) -> None:
        """New ones."""
        if self._pairs is None:
            generator.standard_normal(out=self.out)
            return
        half, flat = self._pairs, self._flat
        bits = generator.integers(_ALL, size=half, dtype=np.uint64, endpoint=True).view(np.uint32)
        np.bitwise_or(np.right_shift(bits, _MANTISSA, out=bits), _ONE, out=bits)
        radius, angle = bits.view(np.float32).reshape(2, half)
        np.log2(np.subtract(2.0, radius, out=radius), out=radius)  # faster than ln
        np.sqrt(np.multiply(radius, -2.0 * math.log(2.0), out=radius), out=radius)
        np.multiply(angle, _TURN, out=angle)
        np.multiply(np.cos(angle, out=flat[:half]), radius, out=flat[:half])
        odd = len(flat) - half
        np.multiply(np.sin(angle, out=angle)[:odd], radius[:odd], out=flat[half:])


def normals_like(generator: Any, values: Any) -> Any:
    """As many standard normals as there are values in a tensor, from torch's generator, where it is."""
    torch = namespace(values)
    return torch.randn(values.shape, generator=generator, dtype=values.dtype, device=values.device)
