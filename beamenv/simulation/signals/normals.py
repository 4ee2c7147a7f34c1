"""Standard normals: of NumPy with 64 and with 32 bits, and of torch on its device."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import namespace

_TURN = np.float32(2.0 * np.pi)


class Normals:
    """Draws as many as an array has numbers, from a generator of NumPy, into that array.

    With 64 bits they are the generator's own. With 32 bits two are made of two uniform numbers (Box and Muller 1958), √(−2 ln u)
    times the cosine and the sine of an angle, which NumPy does several at a time: none is beyond 5.8.
    """

    def __init__(self, out: NDArray[Any]) -> None:
        self.out = out
        self._flat = out.reshape(-1)
        self._uniform = np.empty((2, -(-out.size // 2)), np.float32) if out.dtype == np.float32 else None

    def draw(self, generator: np.random.Generator) -> None:
        """New ones."""
        if self._uniform is None:
            generator.standard_normal(out=self.out)
            return
        generator.random(out=self._uniform, dtype=np.float32)
        (radius, angle), flat, half = self._uniform, self._flat, self._uniform.shape[1]
        np.log(np.subtract(1.0, radius, out=radius), out=radius)
        np.sqrt(np.multiply(radius, -2.0, out=radius), out=radius)
        np.multiply(angle, _TURN, out=angle)
        np.multiply(np.cos(angle, out=flat[:half]), radius, out=flat[:half])
        odd = len(flat) - half
        np.multiply(np.sin(angle, out=angle)[:odd], radius[:odd], out=flat[half:])


def normals_like(generator: Any, values: Any) -> Any:
    """As many standard normals as there are values in a tensor, from torch's generator, where it is."""
    torch = namespace(values)
    return torch.randn(values.shape, generator=generator, dtype=values.dtype, device=values.device)
