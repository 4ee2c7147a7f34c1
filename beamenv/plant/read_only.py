"""Data whose arrays cannot be written to: what many share, nobody changes under the others' hands."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray


def read_only(value: Any) -> Any:
    """An array as one that cannot be written to: itself if it is such, else a copy; anything else as it is."""
    if not isinstance(value, np.ndarray) or not value.flags.writeable:
        return value
    copied = np.array(value)  # whoever made it may write to it still
    copied.setflags(write=False)
    return copied


def sealed(fresh: NDArray[Any]) -> NDArray[Any]:
    """An array made read-only in place; for its maker, who keeps no other view of it to write to."""
    fresh.setflags(write=False)
    return fresh


class ReadOnly:
    """Base of frozen dataclasses whose arrays are read-only, copies and unpickled ones included."""

    __slots__ = ()

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:  # type: ignore[attr-defined]
            value = getattr(self, name)
            if isinstance(value, np.ndarray) and value.flags.writeable:
                object.__setattr__(self, name, read_only(value))

    def __reduce__(self) -> tuple[Any, ...]:
        """Made anew: NumPy forgets on the way that an array was read-only."""
        return type(self), tuple(getattr(self, each.name) for each in fields(self))  # type: ignore[arg-type]
