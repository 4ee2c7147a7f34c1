"""Charts of the last instants, and the scales of colours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from beamenv.rendering.canvas import Canvas, Frame
from beamenv.rendering.history import WINDOW
from beamenv.rendering.palette import FAINT, INK, QUIET, colour_table, colours_of

Array = NDArray[np.float64]

QUARTERS = np.linspace(0.0, 1.0, 5)


@dataclass(frozen=True, slots=True)
class Chart:
    """Curves over the last seconds: where they are and what values they span."""

    title: str
    place: Frame
    low: float
    high: float
    window: float = WINDOW
    """s."""

    @property
    def moving(self) -> Frame:
        """What changes from picture to picture: the curves, and their labels above them."""
        return Frame(self.place.left + 100.0, self.place.top - 20.0, self.place.width - 98.0, 18.0)

    def up_to(self, high: float) -> Chart:
        """The chart up to ``high``, and down to minus that if it shows negative values."""
        return replace(self, low=-high if self.low < 0.0 else 0.0, high=high)

    def reaching(self, value: float) -> Chart:
        """The chart up to 1, 2, 3 or 5 times a power of ten, at least ``value``; the same chart if it already reaches so far."""
        return self.up_to(round_above(value)) if self.high < value < np.inf else self

    def draw_axes(self, canvas: Canvas, dated: bool) -> None:
        """Title, grid and values; with ``dated`` the time axis too."""
        place = self.place
        right, bottom = place.left + place.width, place.top + place.height
        canvas.write(self.title, place.left, place.top - 11.0, INK, "label")
        for share in QUARTERS.tolist():
            x, y = place.left + share * place.width, bottom - share * place.height
            canvas.line([(x, place.top), (x, bottom)], FAINT, 0.5)
            canvas.line([(place.left, y), (right, y)], FAINT, 0.5)
            canvas.write(f"{self.low + share * (self.high - self.low):g}", place.left - 6.0, y, QUIET, "tick", anchor=1.0)
            if dated:
                canvas.write(f"{1e3 * self.window * (share - 1.0):.4g}", x, bottom + 10.0, QUIET, "tick", anchor=0.5)
        if dated:
            canvas.write("time before now, ms", place.left + 0.5 * place.width, bottom + 25.0, QUIET, "note", anchor=0.5)
        zero = bottom + place.height * self.low / (self.high - self.low)
        canvas.line([(place.left, zero), (right, zero)], QUIET, 0.5)

    def draw(self, canvas: Canvas, ages: Array, values: Array, colours: Sequence[str], labels: Sequence[str]) -> None:
        """Curves of values (k, c) at ages (k,) (s, 0 or less), and from the right a label of each in its colour."""
        place = self.place
        canvas.open(place)
        x = place.left + place.width * (1.0 + ages / self.window)
        y = place.top + place.height * (self.high - values) / (self.high - self.low)
        for column, colour in zip(y.T, colours, strict=True):
            if len(x) > 1:
                canvas.line(np.stack([x, column], axis=-1), colour, 1.5)
        canvas.develop(place)
        canvas.open(self.moving)
        right = place.left + place.width
        for label, colour in zip(labels[::-1], colours[::-1], strict=True):
            right -= canvas.write(label, right, place.top - 11.0, colour, "label", anchor=1.0) + 10.0
        canvas.develop(self.moving)


def round_above(value: float) -> float:
    """The least of …, 1, 2, 3, 5, 10, … that is not below the positive ``value``."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(next(factor * power for factor in (1.0, 2.0, 3.0, 5.0, 10.0) if factor * power >= value))


def draw_scale(canvas: Canvas, place: Frame, scale: str, limit: float, title: str) -> None:
    """The colours of a scale from −``limit`` to ``limit``."""
    canvas.write(title, place.left, place.top - 11.0, INK, "label")
    bottom = place.top + place.height
    edges = place.left + place.width * np.linspace(0.0, 1.0, int(place.width) + 1)
    colours = colours_of(colour_table(scale), np.linspace(-1.0, 1.0, int(place.width)))
    for left, right, colour in zip(edges[:-1].tolist(), edges[1:].tolist(), colours, strict=True):
        canvas.polygon([(left, place.top), (right, place.top), (right, bottom), (left, bottom)], colour)
    ends = (place.left, place.left + place.width)
    canvas.line(
        [(x, y) for y, x in ((place.top, ends[0]), (place.top, ends[1]), (bottom, ends[1]), (bottom, ends[0]))], QUIET, 0.5, True
    )
    for share in QUARTERS.tolist():
        canvas.write(f"{limit * (2.0 * share - 1.0):g}", ends[0] + share * place.width, bottom + 10.0, QUIET, "tick", anchor=0.5)
