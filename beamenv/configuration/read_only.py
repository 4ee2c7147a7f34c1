"""Data whose arrays cannot be written to: what many share, nobody changes under the others' hands."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import cached_property, wraps
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T")


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
        return type(self), tuple(getattr(self, each.name) for each in fields(self) if each.init)  # type: ignore[arg-type]


class Sealed:
    """Base of frozen dataclasses whose maker keeps no view of their arrays to write to: made read-only in place, not copied."""

    __slots__ = ()

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:  # type: ignore[attr-defined]
            value = getattr(self, name)
            if isinstance(value, np.ndarray):
                value.setflags(write=False)


class sealed_property(cached_property[T]):  # noqa: N801 - a decorator, as its base
    """A property that is worked out once, whose arrays, also in tuples, cannot be written to."""

    def __init__(self, method: Callable[[Any], T]) -> None:
        @wraps(method)
        def once(instance: Any) -> T:
            value = method(instance)
            for each in value if isinstance(value, tuple) else (value,):
                if isinstance(each, np.ndarray):
                    each.setflags(write=False)
            return value

        super().__init__(once)
