"""Step responses of several bare blades in one panel: exact, and by Newmark's method as the thesis integrates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from train.figures.figure import Curve, Panel
from train.reproduce.thesis import Model
from train.reproduce.thesis.response import ForcedBlade, newmark_responses, settling_time

Array = NDArray[np.float64]

DURATION, SHOWN = 4.0, 0.4
"""s: long enough to settle, and what is integrated by Newmark's method too."""
EXACT_EVERY, NEWMARK_EVERY = 4, 60
"""Points that are drawn: one in so many."""


@dataclass(frozen=True, slots=True, eq=False)
class ForcedResponses:
    """Step responses, one for each blade in order."""

    panel: Panel
    peaks: Array
    """(blades,), m: largest tip displacement."""
    settling: Array
    """(blades,), s: until the tip stays within 5 % of its largest excursion from rest."""
    newmark_error: Array
    """(blades,): largest difference between Newmark and exact over the peak; empty where the thesis' own equations are tried,
    for it is the same."""


def forced_responses(model: Model, blades: Mapping[str, ForcedBlade], drawn: float = SHOWN) -> ForcedResponses:
    """The responses to the model's step load, by label, of which the first ``drawn`` s are drawn.

    All blades are loaded and observed in their own direction.
    """
    exact = [blade.step_response(model.load, DURATION) for blade in blades.values()]
    peaks = np.array([np.abs(tip).max() for _, tip in exact])
    finals = [blade.static_displacement(model.load) for blade in blades.values()]
    settling = np.array([settling_time(*response, final) for response, final in zip(exact, finals, strict=True)])
    direction = next(iter(blades.values())).direction
    if model.reading:
        return ForcedResponses(Panel(direction, "", "", []), peaks, settling, np.empty(0))
    shown, by_newmark = newmark_responses(list(blades.values()), model.load, SHOWN)
    last, curves, errors = np.searchsorted(shown, drawn, side="right"), [], []
    for label, (_, tip), integrated in zip(blades, exact, by_newmark, strict=True):
        errors.append(float(np.abs(integrated - tip[: len(shown)]).max()))
        curves.append(Curve(shown[:last:EXACT_EVERY], 1e3 * tip[:last:EXACT_EVERY], label))
        curves.append(Curve(shown[:last:NEWMARK_EVERY], 1e3 * integrated[:last:NEWMARK_EVERY], label, "points"))
    panel = Panel(f"step in {direction}", "time (s)", "tip displacement (mm)", curves)
    return ForcedResponses(panel, peaks, settling, np.array(errors) / peaks)
