"""Numbers that leave no digits, or no finite ones, to compute with."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from beamenv.configuration import Refused

OUT_OF_SCALE = "one of its numbers is too large or too small beside the others."


class Contradiction(ValueError):
    """What values that are allowed one by one cannot be together, in a sentence of its own."""


@contextmanager
def in_scale(what: str) -> Iterator[None]:
    """``ValueError`` in one sentence about a beam, say, where arithmetic fails; what has a sentence already is told as it is."""
    try:
        with np.errstate(all="ignore"):
            yield
    except (Refused, Contradiction):
        raise
    except (ValueError, OverflowError, np.linalg.LinAlgError):
        raise ValueError(f"{what} cannot be computed: {OUT_OF_SCALE}") from None
