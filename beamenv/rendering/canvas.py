"""What is drawn on: a pygame surface finer than the picture, so that lines and edges come out smooth."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.rendering.palette import LIGHT, Theme

Colour = str | Sequence[int]
Points = NDArray[np.float64] | Sequence[Sequence[float]]

WIDTH, HEIGHT = 960, 540
FINENESS = 2
"""Pixels of the canvas for one of the picture, in each direction."""
SIZES = {"title": 10.5, "label": 8.5, "note": 8.0, "tick": 7.5, "number": 6.5}
"""Of letters, in points of the picture at 100 dots an inch."""
NEGATIVE = re.compile(r"(?<![\w-])-(?=[\d.])")
"""A hyphen that is a sign."""


@dataclass(frozen=True, slots=True)
class Frame:
    """A rectangle of the picture, in pixels; y runs down."""

    left: float
    top: float
    width: float
    height: float


class Canvas:
    """Draws in pixels of the picture, y downwards: first a background, then again and again what moves in some frames of it.

    It writes in the DejaVu Sans that matplotlib brings along: the same letters on every machine.
    """

    def __init__(self, theme: Theme = LIGHT, size: tuple[int, int] = (WIDTH, HEIGHT)) -> None:
        import pygame
        from matplotlib import get_data_path

        self.theme, self.size = theme, size
        width, height = size

        pygame.font.init()
        file = f"{get_data_path()}/fonts/ttf/DejaVuSans.ttf"
        self._draw, self._scale = pygame.draw, pygame.transform.smoothscale
        self._fonts = {name: pygame.font.Font(file, round(size * FINENESS * 100 / 72)) for name, size in SIZES.items()}
        self._fine = pygame.Surface((FINENESS * width, FINENESS * height), depth=32)
        self._background = self._fine.copy()
        self._picture = pygame.Surface(size, depth=32)
        self._array = np.empty((height, width, 3), dtype=np.uint8)
        self._array_surface = pygame.image.frombuffer(self._array.data, size, "RGB")

    @property
    def picture(self) -> Any:
        """The picture as a pygame surface."""
        return self._picture

    def pixels(self) -> NDArray[np.uint8]:
        """A copy (height, width, 3) of the picture."""
        self._array_surface.blit(self._picture, (0, 0))
        return self._array.copy()

    def clear(self) -> None:
        """An empty sheet."""
        self._fine.set_clip(None)
        self._fine.fill(self.theme.paper)

    def keep(self) -> None:
        """What has been drawn becomes the background."""
        self._background.blit(self._fine, (0, 0))
        self._scale(self._fine, self.size, self._picture)

    def open(self, frame: Frame) -> None:
        """The background alone in ``frame``; what is drawn next stays inside it."""
        rectangle = _fine(frame)
        self._fine.set_clip(rectangle)
        self._fine.blit(self._background, rectangle[:2], rectangle)

    def develop(self, frame: Frame) -> None:
        """Take what has been drawn in ``frame``, a whole number of pixels, into the picture."""
        size = (int(frame.width), int(frame.height))
        self._scale(self._fine.subsurface(_fine(frame)), size, self._picture.subsurface((int(frame.left), int(frame.top)), size))

    def polygon(self, corners: Points, colour: Colour) -> None:
        """A filled polygon (k, 2)."""
        self._draw.polygon(self._fine, colour, _finer(corners))

    def line(self, points: Points, colour: Colour, width: float = 1.0, closed: bool = False) -> None:
        """A line through points (k, 2), two or more of them."""
        self._draw.lines(self._fine, colour, closed, _finer(points), round(FINENESS * width))

    def write(self, text: str, x: float, y: float, colour: Colour, size: str, anchor: float = 0.0) -> float:
        """Text whose mid-height is at y and whose left (anchor 0), middle (½) or right end (1) is at x; its width."""
        written = self._fonts[size].render(_printed(text), True, colour)
        width, height = written.get_size()
        self._fine.blit(written, (FINENESS * x - anchor * width, FINENESS * y - 0.5 * height))
        return float(width / FINENESS)

    def width(self, text: str, size: str) -> float:
        """Of a text that would be written."""
        return float(self._fonts[size].size(_printed(text))[0] / FINENESS)

    def fitted(self, text: str, size: str, width: float) -> str:
        """The text, or as much of its beginning as is no wider, with … behind it."""
        if self.width(text, size) <= width:
            return text
        kept = next((k for k in range(len(text) - 1, 0, -1) if self.width(text[:k].rstrip() + "…", size) <= width), 0)
        return text[:kept].rstrip() + "…"

    def wrapped(self, text: str, size: str, width: float, lines: int) -> list[str]:
        """The text in so many lines at most, broken between words, each no wider; what is too much ends in …."""
        found, rest = [""], text.split()
        while rest:
            longer = f"{found[-1]} {rest[0]}".strip()
            if found[-1] and self.width(longer, size) > width:
                if len(found) == lines:
                    found[-1] = self.fitted(" ".join([found[-1], *rest]), size, width)
                    break
                found.append("")
                continue
            found[-1] = longer
            rest.pop(0)
        return [self.fitted(each, size, width) for each in found]


def _printed(text: str) -> str:
    """What has no sign, such as the end of a line, is left blank."""
    return NEGATIVE.sub("−", "".join(letter if letter.isprintable() else " " for letter in text))


def _fine(frame: Frame) -> tuple[int, int, int, int]:
    left, top, width, height = (round(FINENESS * side) for side in (frame.left, frame.top, frame.width, frame.height))
    return left, top, width, height


def _finer(points: Points) -> list[list[float]]:
    fine: list[list[float]] = (FINENESS * np.asarray(points)).tolist()
    return fine
