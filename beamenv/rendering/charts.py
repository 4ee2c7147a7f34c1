"""Charts of the last instants, and the scales of colours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from beamenv.rendering.canvas import Canvas, Frame
from beamenv.rendering.history import WINDOW
from beamenv.rendering.palette import colour_table, colours_of

Array = NDArray[np.float64]

QUARTERS = np.linspace(0.0, 1.0, 5)
BESIDE = 30.0
"""Pixels right of a chart, for the names of its curves, unless they are long."""
LINE = 11.0
"""Pixels from one such name to the next, at least."""


@dataclass(frozen=True, slots=True)
class Chart:
    """Curves over the last seconds: where they are and what values they span."""

    title: str
    place: Frame
    low: float
    high: float
    window: float = WINDOW
    """s."""
    room: float = BESIDE
    """Pixels for the names of its curves."""

    @property
    def right(self) -> float:
        """Pixels."""
        return self.place.left + self.place.width

    def moving(self, canvas: Canvas) -> Frame:
        """What is told of the curves above them, right of the title."""
        left = float(np.ceil(self.place.left + canvas.width(self.title, "label") + 10.0))
        return Frame(left, self.place.top - 20.0, self.right - left, 18.0)

    @property
    def beside(self) -> Frame:
        """Where the curves' names stand."""
        return Frame(self.right + 2.0, self.place.top - 8.0, self.room - 2.0, self.place.height + 16.0)

    def up_to(self, high: float) -> Chart:
        """The chart up to ``high``, and down to minus that if it shows negative values."""
        return replace(self, low=-high if self.low < 0.0 else 0.0, high=high)

    def reaching(self, value: float) -> Chart:
        """The chart up to 1, 2, 3 or 5 times a power of ten, at least ``value``; the same chart if it already reaches so far."""
        return self.up_to(round_above(value)) if self.high < value < np.inf else self

    def draw_axes(self, canvas: Canvas, dated: bool) -> None:
        """Title, grid and values; with ``dated`` the time axis too."""
        place, theme = self.place, canvas.theme
        right, bottom = self.right, place.top + place.height
        canvas.write(self.title, place.left, place.top - 11.0, theme.ink, "label")
        for share in QUARTERS.tolist():
            x, y = place.left + share * place.width, bottom - share * place.height
            canvas.line([(x, place.top), (x, bottom)], theme.faint, 0.5)
            canvas.line([(place.left, y), (right, y)], theme.faint, 0.5)
            canvas.write(f"{self.low + share * (self.high - self.low):g}", place.left - 6.0, y, theme.quiet, "tick", anchor=1.0)
            if dated:
                canvas.write(f"{1e3 * self.window * (share - 1.0):.4g}", x, bottom + 10.0, theme.quiet, "tick", anchor=0.5)
        if dated:
            canvas.write("time before now, ms", place.left + 0.5 * place.width, bottom + 25.0, theme.quiet, "note", anchor=0.5)
        zero = bottom + place.height * self.low / (self.high - self.low)
        canvas.line([(place.left, zero), (right, zero)], theme.quiet, 0.5)

    def draw(
        self,
        canvas: Canvas,
        ages: Array,
        values: Array,
        colours: Sequence[str],
        names: Sequence[str],
        told: Sequence[str] = (),
    ) -> None:
        """Curves of values (k, c) at ages (k,) (s, 0 or less), the newest first, each with its name at its newest end, and from the
        right what is ``told`` of them above, as far as there is room; all in their colours.
        """
        place = self.place
        canvas.open(place)
        x = place.left + place.width * (1.0 + ages / self.window)
        y = place.top + place.height * (self.high - values) / (self.high - self.low)
        for column, colour in zip(y.T, colours, strict=True):
            if len(x) > 1:
                canvas.line(np.stack([x, column], axis=-1), colour, 1.5)
        canvas.develop(place)
        self._name(canvas, np.nan_to_num(y[0], nan=np.inf), colours, names)
        moving = self.moving(canvas)
        canvas.open(moving)
        right = self.right
        for text, colour in zip(told[::-1], colours[::-1], strict=False):
            if right - canvas.width(text, "label") >= moving.left:
                right -= canvas.write(text, right, place.top - 11.0, colour, "label", anchor=1.0) + 10.0
        canvas.develop(moving)

    def _name(self, canvas: Canvas, ends: Array, colours: Sequence[str], names: Sequence[str]) -> None:
        """Names beside the ends (c,), px, of their curves; where there are too many, those that there is room for."""
        place = self.place
        room = int(place.height // LINE) + 1
        chosen = [round(each) for each in np.linspace(0, len(names) - 1, min(len(names), room)).tolist()]
        canvas.open(self.beside)
        heights = spread(ends[chosen], place.top, place.top + place.height, LINE) if chosen else np.empty(0)
        for index, height in zip(chosen, heights.tolist(), strict=True):
            canvas.write(names[index], self.right + 5.0, height, colours[index], "tick")
        canvas.develop(self.beside)


def spread(wanted: Array, low: float, high: float, least: float) -> Array:
    """Places (k,) near those ``wanted``, in their order, between ``low`` and ``high``, at least ``least`` apart.

    There must be room: (k − 1) ``least`` is at most ``high`` − ``low``.
    """
    order = np.argsort(wanted, kind="stable")
    steps = least * np.arange(len(wanted))
    placed = np.clip(wanted[order], low, high) - steps
    placed = np.maximum.accumulate(placed)
    placed = np.minimum(placed, high - steps[-1]) + steps
    found = np.empty_like(placed)
    found[order] = placed
    return found


def round_above(value: float) -> float:
    """The least of …, 1, 2, 3, 5, 10, … that is not below the positive ``value``."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(next(factor * power for factor in (1.0, 2.0, 3.0, 5.0, 10.0) if factor * power >= value))


def draw_scale(canvas: Canvas, place: Frame, scale: str, limit: float, title: str) -> None:
    """The colours of a scale from −``limit`` to ``limit``."""
    theme = canvas.theme
    canvas.write(title, place.left, place.top - 11.0, theme.ink, "label")
    bottom = place.top + place.height
    edges = place.left + place.width * np.linspace(0.0, 1.0, int(place.width) + 1)
    colours = colours_of(colour_table(scale), np.linspace(-1.0, 1.0, int(place.width)))
    for left, right, colour in zip(edges[:-1].tolist(), edges[1:].tolist(), colours, strict=True):
        canvas.polygon([(left, place.top), (right, place.top), (right, bottom), (left, bottom)], colour)
    ends = (place.left, place.left + place.width)
    outline = [(x, y) for y, x in ((place.top, ends[0]), (place.top, ends[1]), (bottom, ends[1]), (bottom, ends[0]))]
    canvas.line(outline, theme.quiet, 0.5, True)
    for share in QUARTERS.tolist():
        canvas.write(
            f"{limit * (2.0 * share - 1.0):g}", ends[0] + share * place.width, bottom + 10.0, theme.quiet, "tick", anchor=0.5
        )
