"""States that a batch of blades or its wrapper takes back, looked at before anything is written."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from beamenv.configuration import Refused


def check_state(state: Any, now: Any, name: str = "state") -> None:
    """``ValueError`` unless a state has the names, the shapes and the precision of what its taker has ``now``."""
    if isinstance(now, Mapping):
        if not isinstance(state, Mapping) or set(state) != set(now):
            found = sorted(map(str, state)) if isinstance(state, Mapping) else state
            raise Refused(name, found, f"{', '.join(map(str, now))}, as of an equally made batch")
        for key, own in now.items():
            check_state(state[key], own, f"{name}[{key!r}]")
    elif (found := _form(state)) != (wanted := _form(now)) and not (found[1] is None and found[0] == wanted[0]):
        raise ValueError(f"{name} is {_said(found)}, but must be {_said(wanted)}, as of an equally made batch.")


Form = tuple[tuple[int, ...] | None, str | None]
"""A shape, and the type of floating-point numbers; None of what has none, such as a list."""


def _form(value: Any) -> Form:
    try:
        shape = None if value is None or isinstance(value, Mapping) else tuple(np.shape(value))
    except ValueError:
        shape = None
    kind = str(getattr(value, "dtype", "")).removeprefix("torch.")
    return shape, kind if kind.startswith("float") else None


def _said(form: Form) -> str:
    shape, kind = form
    return "no array" if shape is None else f"of shape {shape}" + (f" and {kind}" if kind else "")
