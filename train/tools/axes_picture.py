"""Sketches of axes and angles on the page of physics, as SVG: the blade on its hub, a section, a piece of wall laid flat.

``python -m train.tools.axes_picture`` writes them into ``docs/images/axes``. Colours are legible on white and on black.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.writing import write_whole
from train.figures.palette import NEUTRAL, PALETTE

Array = NDArray[np.float64]

FOLDER = Path("docs/images/axes")
BLUE, ORANGE, GREEN = PALETTE[:3]
LETTERS = NEUTRAL
LENGTH, HUB, CHORD, DEPTH = 350.0, 66.0, 84.0, 20.0
"""px, not to scale: sections are drawn larger than the span would have them."""
PRESETTING, PRETWIST = np.deg2rad(8.0), np.deg2rad(30.0)
ORIGIN = np.array([44.0, 172.0])
"""px: where the spin axis meets the pitch axis."""
INTO = np.array([0.52, -0.36])
"""px a px along x, which points into the picture."""


def pictures() -> dict[str, str]:
    """SVG by name."""
    return {
        "blade": framed(560, 276, _blade()),
        "section": framed(360, 230, _section(np.array([160.0, 138.0]))),
        "wall": framed(360, 270, _wall(np.array([34.0, 42.0]))),
    }


def framed(width: int, height: int, parts: list[str]) -> str:
    """A whole picture."""
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="16">'
    return "\n".join([head, _marker(), *parts, "</svg>"]) + "\n"


def projected(x: Array, y: Array, z: Array) -> Array:
    """(n, 2) px: z to the right, y up, x into the picture."""
    return ORIGIN + np.multiply.outer(z, [1.0, 0.0]) + np.multiply.outer(y, [0.0, -1.0]) + np.multiply.outer(x, INTO)


def angle(share: float) -> float:
    """B(z), rad."""
    return float(PRESETTING + PRETWIST * share)


def turned(x: Array, y: Array, by: float) -> tuple[Array, Array]:
    """Points of a section, turned from x towards y."""
    return x * np.cos(by) - y * np.sin(by), x * np.sin(by) + y * np.cos(by)


def corners(share: float) -> Array:
    """(4, 2) px: of the section at a share of the span; the first two are those of the top wall."""
    x, y = turned(0.5 * CHORD * np.array([-1, 1, 1, -1]), 0.5 * DEPTH * np.array([1, 1, -1, -1]), angle(share))
    return projected(x, y, np.full(4, HUB + share * LENGTH))


def _blade() -> list[str]:
    """The blade on its hub with patches in its top wall, and the axes."""
    rings = np.array([corners(share) for share in np.linspace(0.0, 1.0, 25)])
    walls = [_closed([*rings[:, a], *rings[::-1, b]], LETTERS, shade) for a, b, shade in ((2, 3, 0.07), (3, 0, 0.07), (1, 2, 0.07))]
    top = _closed([*rings[:, 0], *rings[::-1, 1]], LETTERS, 0.18)
    ends = [_closed(rings[k], LETTERS, 0.25) for k in (0, -1)]
    said = [
        _text(np.array([236.0, 50.0]), "patches: actuators in the top wall,", ORANGE),
        _text(np.array([299.0, 70.0]), "sensors in the bottom wall", ORANGE),
    ]
    return [*walls, top, *ends, *map(_patch, (0.03, 0.24, 0.45, 0.66)), *_axes(), *said]


def _patch(start: float) -> str:
    """In the top wall, from a share of the span on."""
    along = [corners(share) for share in np.linspace(start, start + 0.085, 4)]
    near, far = ([ring[0] + part * (ring[1] - ring[0]) for ring in along] for part in (0.3, 0.7))
    return _closed([*near, *far[::-1]], ORANGE, 0.85)


def _axes() -> list[str]:
    """Axes, rotation, radius of the hub and length."""
    tips = ((106, 0, 0), (0, 146, 0), (0, 0, HUB + LENGTH + 88))
    x, y, z = (projected(*(np.array([each]) for each in at))[0] for at in tips)
    turn = f"M{ORIGIN[0] - 26} {ORIGIN[1] - 88}a26 9 0 0 0 50 4"
    left, below = ORIGIN + [0, 62], ORIGIN[1] + 62
    return [
        _line(ORIGIN + [0, 90], y, LETTERS, arrow=True),
        _line(ORIGIN, x, LETTERS, arrow=True),
        _line(ORIGIN, z, LETTERS, arrow=True, dash=True),
        _text(x + [6, 2], "x: lag, u"),
        _text(y + [10, 6], "y: spin axis, flap, v"),
        _text(z + [-70, 24], "z: span"),
        f'<path d="{turn}" fill="none" stroke="{BLUE}" stroke-width="2" marker-end="url(#blue)"/>',
        _text(ORIGIN + [-42, -96], "Ω", BLUE),
        *_measured(left[0], left[0] + HUB, below, "R₀: hub"),
        *_measured(left[0] + HUB, left[0] + HUB + LENGTH, below, "L: length"),
    ]


def _section(middle: Array) -> list[str]:
    """A section, the root behind it: x to the right, y up, z towards the reader."""
    by, wide, deep = np.deg2rad(24.0), 210.0, 50.0
    x, y = turned(0.5 * wide * np.array([-1, 1, 1, -1]), 0.5 * deep * np.array([1, 1, -1, -1]), float(by))
    at = middle + np.stack([x, -y], axis=-1)
    along, across = np.array([np.cos(by), -np.sin(by)]), np.array([-np.sin(by), -np.cos(by)])
    tangent = middle - 34 * along + 0.5 * deep * across
    chord = middle + 160 * along
    return [
        _text(middle + [-152, -118], "a section, looking towards the root", LETTERS),
        _closed(at, LETTERS, 0.08, width=4.0),
        _line(middle, middle + [168, 0], LETTERS, arrow=True),
        _line(middle, middle + [0, -84], LETTERS, arrow=True),
        _line(middle, chord, LETTERS, dash=True),
        _text(middle + [160, 22], "x"),
        _text(middle + [8, -74], "y"),
        _arc(middle, 118.0, float(by)),
        _text(middle + [66, 46], "B = γ + β₀ z/L", BLUE),
        _line(tangent + 30 * along, tangent - 34 * along, GREEN, arrow=True, width=2.2),
        _line(tangent, tangent + 36 * across, GREEN, arrow=True, width=2.2),
        _text(tangent - 46 * along + 14 * across, "s", GREEN),
        _text(tangent + 44 * across + [4, 4], "n", GREEN),
    ]


def _wall(corner: Array) -> list[str]:
    """A piece of the top wall from outside, laid flat: fibres of a ply, and a patch."""
    wide, tall, theta = 240.0, 150.0, np.deg2rad(30.0)
    top = corner[1]
    foot = np.array([corner[0], top + tall])
    return [
        _text(corner + [40, -14], "a wall laid flat, from outside", LETTERS),
        f'<clipPath id="wall"><rect x="{corner[0]}" y="{top}" width="{wide}" height="{tall}"/></clipPath>',
        f'<rect x="{corner[0]}" y="{top}" width="{wide}" height="{tall}" fill="{LETTERS}" fill-opacity="0.08" stroke="{LETTERS}"/>',
        '<g clip-path="url(#wall)">',
        *(
            _line(foot + [shift, 0], foot + [shift, 0] + 420 * np.array([np.cos(theta), -np.sin(theta)]), LETTERS, width=0.7)
            for shift in range(-240, 241, 24)
        ),
        "</g>",
        _closed(corner + np.array([[150, 30], [206, 30], [206, 116], [150, 116]]), ORANGE, 0.85),
        *(_line(corner + [150 + k, 30], corner + [150 + k, 116], "#ffffff", width=0.8) for k in range(8, 56, 8)),
        _line(foot, foot + [wide + 40, 0], GREEN, arrow=True, width=2.2),
        _line(foot, foot - [0, tall + 30], LETTERS, arrow=True, width=2.2),
        _line(foot, foot + 120 * np.array([np.cos(theta), -np.sin(theta)]), BLUE, width=2.4),
        _arc(foot, 70.0, float(theta)),
        _text(foot + [78, -14], "θ", BLUE),
        _text(foot + [wide + 26, 20], "s", GREEN),
        _text(foot + [-20, -tall - 20], "z"),
        _text(foot + [0, 30], "θ = 0: hoop fibre; 90°: along the span", BLUE),
        _text(foot + [0, 54], "patch: its fibres run along the span", ORANGE),
    ]


def _arc(middle: Array, radius: float, angle: float) -> str:
    """From the right, upwards."""
    x, y = middle[0] + radius * np.cos(angle), middle[1] - radius * np.sin(angle)
    path = f"M{middle[0] + radius:.1f} {middle[1]:.1f}A{radius:g} {radius:g} 0 0 0 {x:.1f} {y:.1f}"
    return f'<path d="{path}" fill="none" stroke="{BLUE}" stroke-width="2" marker-end="url(#blue)"/>'


def _marker() -> str:
    heads = {"grey": LETTERS, "blue": BLUE, "green": GREEN}
    made = (
        f'<marker id="{name}" viewBox="0 0 10 10" refX="8" refY="5" markerWidth="7" markerHeight="7" orient="auto-start-reverse">'
        f'<path d="M0 0L10 5L0 10z" fill="{colour}"/></marker>'
        for name, colour in heads.items()
    )
    return f"<defs>{''.join(made)}</defs>"


def _line(start: Array, end: Array, colour: str, arrow: bool = False, dash: bool = False, width: float = 1.3) -> str:
    head = {LETTERS: "grey", BLUE: "blue", GREEN: "green"}.get(colour)
    more = (f' marker-end="url(#{head})"' if arrow else "") + (' stroke-dasharray="5 4"' if dash else "")
    x, y = zip(start, end, strict=True)
    return f'<path d="M{x[0]:.1f} {y[0]:.1f}L{x[1]:.1f} {y[1]:.1f}" fill="none" stroke="{colour}" stroke-width="{width}"{more}/>'


def _closed(points: list[Array] | Array, colour: str, fill: float, width: float = 1.0) -> str:
    path = "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
    return f'<path d="M{path}Z" fill="{colour}" fill-opacity="{fill}" stroke="{colour}" stroke-width="{width}"/>'


def _text(at: Array, words: str, colour: str = LETTERS) -> str:
    return f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" fill="{colour}">{words}</text>'


def _measured(left: float, right: float, y: float, words: str) -> list[str]:
    both = f'<path d="M{left + 2} {y}H{right - 2}" stroke="{LETTERS}" marker-start="url(#grey)" marker-end="url(#grey)"/>'
    return [both, f'<text x="{0.5 * (left + right)}" y="{y + 18}" fill="{LETTERS}" text-anchor="middle">{words}</text>']


if __name__ == "__main__":
    for name, picture in pictures().items():
        write_whole(FOLDER / f"{name}.svg", picture.encode())
