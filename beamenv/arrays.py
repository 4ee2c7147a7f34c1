"""Arrays of NumPy and of torch: one simulation takes both."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import Any, Literal

import numpy as np

Precision = Literal["float32", "float64"]


def namespace(values: Any) -> Any:
    """The module whose functions take the array: NumPy, or torch for its tensors."""
    return np if isinstance(values, (np.ndarray, np.generic)) else sys.modules["torch"]


def integers(values: Any) -> Any:
    """The same numbers, whole already, as 64-bit integers."""
    return values.astype(np.int64) if isinstance(values, np.ndarray) else values.long()


def counting(count: int, other: Any) -> Any:
    """0, 1, … as an array of the other's kind, made where that is."""
    return np.arange(count) if isinstance(other, np.ndarray) else sys.modules["torch"].arange(count, device=other.device)


def copied(values: Any) -> Any:
    """A copy: of an array or of what NumPy makes an array of, or of a tensor without its graph."""
    return values.detach().clone() if hasattr(values, "detach") else np.array(values)


def on_host(values: Any) -> Any:
    """A tensor's numbers as an array of NumPy's; a device is waited for. All else as it is."""
    return values.detach().cpu().numpy() if hasattr(values, "detach") else values


@dataclass(frozen=True, slots=True)
class Arrays:
    """What arrays a simulation is made of: NumPy's, or torch's on a device.

    NumPy with 64 bits is the reference that the others agree with.
    """

    precision: Precision = "float64"
    device: str | None = None
    """Torch's name of where they are, as ``"cuda"``; None: they are NumPy's."""
    recorded: bool = False
    """Whether every step must do the same whatever the numbers are, for it is recorded once and run again."""
    compiled: bool = False
    """Whether what is recorded is compiled."""

    @property
    def of_numpy(self) -> bool:
        """Whether they are NumPy's, and changed in place."""
        return self.device is None

    @property
    def on_host(self) -> bool:
        """Whether they are on the processor."""
        return self.device is None or self.device.startswith("cpu")

    @property
    def looks(self) -> bool:
        """Whether a step may look at a number: on the processor that costs nothing, a device would have to be waited for."""
        return self.on_host and not self.recorded

    @property
    def kernels(self) -> Any:
        """The kernels of a GPU; None on the processor, or without Triton."""
        return None if self.on_host else _kernels()

    def floats(self, values: Any) -> Any:
        """The numbers in this precision: NumPy's own array where it has it already, but a copy in torch."""
        if self.device is None:
            return np.asarray(values, dtype=self.precision)
        return self._tensor(values, self.precision)

    def exact(self, values: Any) -> Any:
        """The numbers with 64 bits, or whole numbers as such: what is drawn is to be the same in either precision."""
        return values if self.device is None else self._tensor(values, None)

    def _tensor(self, values: Any, precision: str | None) -> Any:
        import torch

        dtype = None if precision is None else getattr(torch, precision)
        if isinstance(values, torch.Tensor):
            return values.to(self.device, dtype or values.dtype)
        return torch.tensor(np.ascontiguousarray(values), dtype=dtype, device=self.device)  # a copy: plants are read-only

    def zeros(self, *shape: int) -> Any:
        """Zeros of this precision."""
        return self.floats(np.zeros(shape))


@cache
def _kernels() -> Any:
    try:
        return import_module("beamenv.simulation.on_gpu")
    except ImportError:
        return None


REFERENCE = Arrays()
"""NumPy's, of 64 bits."""


class SomeRows:
    """Blades of a batch, by their rows; ``at`` is the index of these in arrays that lie as the batch does in memory."""

    __slots__ = ("at", "rows")

    def __init__(self, rows: Any, at: tuple[Any, ...]) -> None:
        self.rows, self.at = rows, at

    def take(self, values: Any) -> Any:
        """Their part (k, …) of values (N, …)."""
        return values[self.rows]

    def put(self, values: Any, own: Any) -> Any:
        """A copy of values (N, …) with their part exchanged."""
        if isinstance(values, np.ndarray):
            values = values.copy()
            values[self.rows] = own
            return values
        return values.index_put((self.rows,), own if hasattr(own, "shape") else values.new_tensor(own))

    def lay(self, values: Any, own: Any) -> Any:
        """Values of the batch's own shape (…, k) with their part exchanged: NumPy's in place."""
        if isinstance(values, np.ndarray):
            values[self.at] = own
            return values
        return values.index_put((self.rows,), own)


class Masked:
    """Blades of a batch of tensors, by a mask (N,): no device need be asked how many. Their part is then what all would have."""

    __slots__ = ("mask", "rows")

    def __init__(self, mask: Any) -> None:
        self.mask, self.rows = mask, slice(None)

    def take(self, values: Any) -> Any:
        """All of them (N, …)."""
        return values

    def put(self, values: Any, own: Any) -> Any:
        """Values (N, …) with their part exchanged."""
        mask = self.mask.reshape(-1, *[1] * (values.ndim - 1))
        return sys.modules["torch"].where(mask, own, values)

    lay = put


Those = SomeRows | Masked
