"""The colours and signs of figures by their role; lines are legible on white and on both themes of a page."""

from __future__ import annotations

PALETTE = ("#2f7fc2", "#d9601a", "#23945a", "#9a63c9", "#b8860b", "#d6428f")
"""Contrast of at least 3 on both panels, as WCAG 2.1 (1.4.11) asks of lines."""
INK = "#1a1a1a"
"""What is shown, on paper."""
NEUTRAL = "#7d8793"
"""What is without control, and what is only for orientation."""
BEHIND = "#bfbfbf"
"""What is without control where it lies behind a black curve."""
PATCH_COLOURS = {"MFC": PALETTE[1], "PZT": PALETTE[0], "PIC255": PALETTE[2]}
"""Of patches by their material, the same wherever patches or what they do are drawn side by side."""
PATCHES_OF_YOUR_OWN = PALETTE[3]
LINES = ("solid", "dashed", "dotted", "dashdot")
"""The second sign besides colour."""
SIGNS = ("x-thin", "cross-thin", "square", "circle", "diamond", "triangle-up")
"""Of points, the second sign besides colour."""


def colour(index: int) -> str:
    """Of one curve among many."""
    return PALETTE[index % len(PALETTE)]


def contrast(one: str, other: str) -> float:
    """Ratio of the luminances of two colours "#rrggbb", 1 to 21 (WCAG 2.1)."""
    low, high = sorted(_luminance(colour) for colour in (one, other))
    return (high + 0.05) / (low + 0.05)


def ink_on(shade: str) -> str:
    """Black or white, whichever is read better on a shade "#rrggbb"."""
    return max(("#000000", "#ffffff"), key=lambda ink: contrast(ink, shade))


def _luminance(colour: str) -> float:
    channels = [int(colour[start : start + 2], 16) / 255.0 for start in (1, 3, 5)]
    linear = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in channels]
    return sum(weight * value for weight, value in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
