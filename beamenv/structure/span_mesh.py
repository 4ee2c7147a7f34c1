"""Where finite elements end along the span: at every place where the blade changes, and close together beside the clamp."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FINEST = 0.5
"""Of the reach of the clamp: the element beside it. Further out elements grow with the distance from it."""

LEAST_SHARE = 1e-3
"""Of the length of elements elsewhere, at least: what a clamp does within less of a slender blade counts for nothing."""

GROWTH = 1.0
"""By how much an element is longer for each metre of distance from the clamp."""

NEAREST = 1e-4
"""Of the span: of ends of elements closer together one is left out."""


def even_mesh(length: float, edges: Sequence[float], elements: int, reach: float) -> tuple[float, ...]:
    """Nodes (m) on a span, at least so many elements long, with one at every edge.

    Elements are shorter beside the clamp, where sections are held over a ``reach`` (m).
    """
    size = length / elements
    ends = _joined([0.0, *edges, length], length)
    finest = min(size, max(FINEST * reach, LEAST_SHARE * size))
    counts = _elements_to(np.array(ends), size, finest)
    found = [0.0]
    for first, last, low, high in zip(ends[:-1], ends[1:], counts[:-1], counts[1:], strict=True):
        pieces = max(1, int(np.ceil(high - low - 1e-6)))
        inside = _place_of(np.linspace(low, high, pieces + 1)[1:-1], size, finest)
        found += [*np.clip(inside, first, last).tolist(), last]
    return tuple(found)


def given_mesh(length: float, edges: Sequence[float], shares: Sequence[float]) -> tuple[float, ...]:
    """Nodes (m) at shares of the span from 0 to 1, and at every edge: in its place where a share is next to it."""
    ends = _joined([0.0, *edges, length], length)
    free = [length * share for share in shares if min(abs(length * share - end) for end in ends) > NEAREST * length]
    return tuple(sorted([*ends, *free]))


def _joined(places: Sequence[float], length: float) -> list[float]:
    """Ascending, of those too close together the first; the tip always."""
    found: list[float] = []
    for place in sorted(min(max(place, 0.0), length) for place in places):
        if not found or place - found[-1] > NEAREST * length:
            found.append(place)
    if found[-1] != length:
        found[-1:] = [length]
    return found


def _elements_to(z: Array, size: float, finest: float) -> Array:
    """How many elements reach to z, not a whole number, where they are as long as finest + GROWTH z and at most ``size``."""
    full = (size - finest) / GROWTH
    growing = np.log1p(GROWTH * np.minimum(z, full) / finest) / GROWTH
    return np.asarray(growing + np.maximum(z - full, 0.0) / size)


def _place_of(count: Array, size: float, finest: float) -> Array:
    """Where so many elements reach to."""
    full = (size - finest) / GROWTH
    most = float(_elements_to(np.array([full]), size, finest)[0])
    growing = np.expm1(GROWTH * np.minimum(count, most)) * finest / GROWTH
    return np.asarray(growing + np.maximum(count - most, 0.0) * size)
