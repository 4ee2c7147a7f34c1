"""Pictures of a blade's section at one station, to scale: walls with their plies and patches, and each wall from face to face."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import SIDES
from beamenv.patches.group import PatchGroup
from beamenv.structure import RotatingBeam
from beamenv.structure.section.mesh import Mesh, mesh
from beamenv.structure.walls.inlay import Inlay
from beamenv.structure.walls.laminate import Laminate, Ply
from train.explore.picture import as_address, colour_of, name_of
from train.explore.units import nearest_round, signed, unit_of
from train.figures.section import piece
from train.figures.themes import THEMES

Array = NDArray[np.float64]

WIDTH, HIGHEST, MARGIN = 420.0, 270.0, 26.0
BAR_WIDTH, BAR_HEIGHT, BAR_ROW = 380.0, 30.0, 62.0
BESIDE = 13.0
"""Pixels from a wall to its name."""
LETTER = 7.8
"""Pixels, about, of a letter of a bar's labels."""
THINNEST_PLY = 1.2
"""Pixels: a wall whose plies are thinner is drawn as one."""
GREYS = ("#c3ced9", "#9fb0c1", "#dde5ec", "#8497ab", "#b1bfcd", "#6f849a")
"""Of plies by their angle, in its order."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """A patch that lies at the station."""

    name: str
    colour: str
    side: str
    inlay: Inlay


@dataclass(frozen=True, slots=True, eq=False)
class Cut:
    """A blade's section at one station."""

    elements: Mesh
    hosts: dict[str, Laminate]
    sheets: tuple[Sheet, ...]
    material: str

    @classmethod
    def at(cls, config: BladeConfig, beam: RotatingBeam, z: float) -> Cut:
        """That at z, m from the root."""
        sheets = tuple(_sheets(config, beam, z))
        strips = sorted({each.inlay.strip for each in sheets}, key=lambda strip: (strip.wall, strip.width, strip.offset))
        elements = mesh(beam.section.chains, beam.planform.scale(np.array([z])), strips)
        given = config.beam.material
        material = given if isinstance(given, str) else "your own material"
        return cls(elements, beam.section.hosts(config.beam.layup()), sheets, material)

    def under(self, k: int) -> tuple[Sheet, ...]:
        """The patches on an element."""
        return tuple(each for each in self.sheets if self.elements.edges[k].lies_under(each.inlay))

    def laminate(self, k: int) -> Laminate:
        """Of an element: its wall's, with the patches there."""
        laminate = self.hosts[self.elements.edges[k].wall]
        for sheet in self.under(k):
            laminate = sheet.inlay.let_into(laminate)
        return laminate

    def colour(self, ply: Ply) -> str:
        """Of a ply of the walls, by its angle."""
        angles = sorted({each.angle_deg for host in self.hosts.values() for each in host.plies})
        return GREYS[angles.index(ply.angle_deg) % len(GREYS)]

    @property
    def bars(self) -> list[Bar]:
        """One for all walls, or parts of them under patches, that are alike."""
        found: dict[tuple[Laminate, tuple[Sheet, ...]], list[str]] = {}
        for k, edge in enumerate(self.elements.edges):
            found.setdefault((self.laminate(k), self.under(k)), []).append(edge.wall)
        return [Bar(tuple(dict.fromkeys(walls)), *each) for each, walls in sorted(found.items(), key=lambda each: len(each[0][1]))]


@dataclass(frozen=True, slots=True)
class Bar:
    """Walls that are alike, from the inner face to the outer, with the patches on them."""

    walls: tuple[str, ...]
    laminate: Laminate
    sheets: tuple[Sheet, ...]

    @property
    def name(self) -> str:
        """The walls, and what lies on them."""
        on = f" with {' and '.join(sheet.name.partition(' ')[2] for sheet in self.sheets)}" if self.sheets else ""
        return f"{', '.join(self.walls)}{on}"


def sheet_of(laminate: Laminate, sheets: Sequence[Sheet], layer: int) -> Sheet | None:
    """The patch that is a layer of a wall: its first or its last, by the face that it lies on."""
    place = {0: "inner", len(laminate.plies) - 1: "outer"}.get(layer)
    return next((each for each in sheets if each.inlay.face == place and each.inlay.ply == laminate.plies[layer]), None)


def _sheets(config: BladeConfig, beam: RotatingBeam, z: float) -> Iterator[Sheet]:
    for side in SIDES:
        number_of = 0
        for group in config.patches.groups(side):
            for inlay in group.inlays(side, beam.length):
                number_of += 1
                if inlay.covers(np.array(z)):
                    yield Sheet(f"{name_of(group)} {side[:-1]} {number_of}", colour_of(group), side, inlay)


def first_patch(config: BladeConfig) -> float:
    """Where the first actuator is, m from the root: its middle, or that of the span where there is none."""
    groups: Sequence[PatchGroup] = config.patches.groups("actuators")
    length = config.beam.length
    return groups[0].at("actuators", length)[0] + 0.5 * groups[0].length if groups else 0.5 * length


def section_picture(cut: Cut) -> str:
    """The section as the address of an image."""
    elements = cut.elements
    layers = [layer for k in range(len(elements.edges)) for layer in _layers(cut, k)]
    corners = np.concatenate([points for points, *_ in layers])
    low, extent = corners.min(axis=0), np.ptp(corners, axis=0)
    scale = min((WIDTH - 2.0 * MARGIN) / extent[0], (HIGHEST - 2.0 * MARGIN) / max(extent[1], 1e-12))

    def placed(points: Array) -> Array:
        left = 0.5 * (WIDTH - scale * extent[0])
        return np.stack([left + scale * (points[:, 0] - low[0]), MARGIN + scale * (low[1] + extent[1] - points[:, 1])], axis=-1)

    parts = []
    for points, colour, kind, thickness in layers:
        corners = placed(points)
        parts.append(f'<polygon class="{kind}" fill="{colour}" stroke="{colour}" points="{_points(corners)}"/>')
        if kind == "ply" and scale * thickness > THINNEST_PLY:
            parts.append(f'<polyline class="between" points="{_points(corners[:2])}"/>')
    parts += _names(cut, placed)
    height = 2.0 * MARGIN + scale * extent[1] + 30.0
    parts += _scale_bar(scale, height - 14.0)
    return _document(f"0 0 {WIDTH:.0f} {height:.0f}", parts)


def _layers(cut: Cut, k: int) -> Iterator[tuple[Array, str, str, float]]:
    """Of an element: corners (4, 2), m, the colour, what it is, and its thickness, m."""
    laminate, sheets = cut.laminate(k), cut.under(k)
    for layer, (low, high) in enumerate(pairwise(laminate.interfaces)):
        sheet = sheet_of(laminate, sheets, layer)
        colour, kind = (cut.colour(laminate.plies[layer]), "ply") if sheet is None else (sheet.colour, sheet.side)
        yield piece(cut.elements, k, low, high), colour, kind, high - low


def _names(cut: Cut, placed: Callable[[Array], Array]) -> Iterator[str]:
    """Of walls, at the middle of each: of one that lies outside of it, of one that stands inside."""
    elements = cut.elements
    centre = 0.5 * (elements.points[0].min(axis=0) + elements.points[0].max(axis=0))
    for wall in cut.hosts:
        pieces = [k for k, edge in enumerate(elements.edges) if edge.wall == wall]
        lengths = np.array([float(np.hypot(*(elements.last_points[0, k] - elements.points[0, k]))) for k in pieces])
        k = pieces[int(np.searchsorted(np.cumsum(lengths), 0.5 * lengths.sum()))]
        middle = 0.5 * (elements.points[0, k] + elements.last_points[0, k])
        normal = elements.directions[0, k] / float(np.hypot(*elements.directions[0, k]))
        away = normal if normal @ (middle - centre) >= 0.0 else -normal
        side = away if abs(normal[1]) > 0.5 else -away
        x, y = placed((middle + 0.5 * float(elements.thickness[k]) * side)[None])[0] + BESIDE * side * [1.0, -1.0]
        anchor = "start" if side[0] > 0.7 else "end" if side[0] < -0.7 else "middle"
        yield f'<text x="{x:.1f}" y="{y + 5.0:.1f}" text-anchor="{anchor}">{escape(wall)}</text>'


def _scale_bar(scale: float, y: float) -> Iterator[str]:
    """A round length of about a quarter of the picture."""
    length = nearest_round(0.22 * WIDTH / scale)
    unit = unit_of(length, "m")
    end = MARGIN + scale * length
    yield f'<path class="bar" d="M{MARGIN} {y - 5:.1f}v10m0-5H{end:.1f}m0-5v10"/>'
    yield f'<text x="{end + 8:.1f}" y="{y + 5:.1f}" text-anchor="start">{unit.per * length:g} {unit.name}</text>'


def plies_picture(cut: Cut) -> str:
    """Each wall from its inner face to its outer, to one scale, as the address of an image."""
    parts, bars = [], cut.bars
    scale = BAR_WIDTH / max(bar.laminate.thickness for bar in bars)
    for k, bar in enumerate(bars):
        thickness = bar.laminate.thickness
        named = f"{unit_of(thickness, 'm')(thickness)}: {bar.name}"
        parts.append(f'<text x="0" y="{k * BAR_ROW + 14:.1f}" text-anchor="start">{escape(named)}</text>')
        parts += _drawn(cut, bar, scale, k * BAR_ROW + 21.0)
    return _document(f"-1 0 {BAR_WIDTH + 2:.0f} {len(bars) * BAR_ROW:.0f}", parts)


def _drawn(cut: Cut, bar: Bar, scale: float, y: float) -> Iterator[str]:
    """Plies, and over each as much of its name as has room."""
    laminate = bar.laminate
    for first, last, ply in _runs(laminate):
        levels = scale * (np.array(laminate.interfaces[first : last + 1]) - laminate.interfaces[0])
        sheet = sheet_of(laminate, bar.sheets, first)
        colour, name = (cut.colour(ply), _ply(ply)) if sheet is None else (sheet.colour, sheet.name.split()[0])
        for low, high in pairwise(levels):
            place = f'x="{low:.2f}" y="{y}" width="{high - low:.2f}" height="{BAR_HEIGHT}"'
            yield f'<rect class="ply" fill="{colour}" {place}/>'
        if LETTER * len(name) > np.diff(levels).min() and last - first > 1:
            name, levels = f"{last - first} × {name}", levels[[0, -1]]
        where = f'class="{"in" if sheet is None else "on"}" y="{y + 20:.1f}" text-anchor="middle"'
        for low, high in pairwise(levels):
            if LETTER * len(name) <= high - low:
                yield f'<text {where} x="{0.5 * (low + high):.1f}">{escape(name)}</text>'


def _runs(laminate: Laminate) -> Iterator[tuple[int, int, Ply]]:
    """From which ply to before which one they are the same, inner to outer."""
    plies, first = laminate.plies, 0
    for k in range(1, len(plies) + 1):
        if k == len(plies) or plies[k] != plies[first]:
            yield first, k, plies[first]
            first = k


def section_said(cut: Cut) -> list[str]:
    """What both pictures show, in words: the outer size, then a line for each kind of wall."""
    elements = cut.elements
    corners = np.concatenate([points for k in range(len(elements.edges)) for points, *_ in _layers(cut, k)])
    wide, high = np.ptp(corners, axis=0)
    lines = [f"{unit_of(wide, 'm')(wide)} × {unit_of(high, 'm')(high)} outside, drawn without its twist"]
    for bar in cut.bars:
        plies = ", ".join(_said(cut, bar, *run) for run in _runs(bar.laminate))
        lines.append(f"{bar.name}, inner to outer face: {plies}")
    return lines


def _said(cut: Cut, bar: Bar, first: int, last: int, ply: Ply) -> str:
    sheet, thickness = sheet_of(bar.laminate, bar.sheets, first), bar.laminate.interfaces[last] - bar.laminate.interfaces[first]
    times = f"{last - first} × " if last - first > 1 else ""
    name = f"{times}{_ply(ply)} {cut.material}" if sheet is None else f"{sheet.name} at {_ply(ply)}"
    return f"{name} ({unit_of(thickness, 'm')(thickness, 3)})"


def _ply(ply: Ply) -> str:
    return "graded" if ply.uniform is None else f"{signed(ply.angle_deg)}°"


def _points(corners: Array) -> str:
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in corners)


def _document(box: str, parts: Sequence[str]) -> str:
    return as_address(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}">{_style()}{"".join(parts)}</svg>')


def _style() -> str:
    light, dark = THEMES["light"], THEMES["dark"]
    return (
        f"<style>text{{font:14px system-ui,sans-serif;fill:{light.ink}}}text.in{{fill:#10161d}}text.on{{fill:#fff;font-weight:600}}"
        f"polygon{{stroke-width:.4}}.between{{stroke:#fff;stroke-width:.6;fill:none}}rect.ply{{stroke:#fff;stroke-width:.7}}"
        "polygon.actuators{stroke-width:1.2}polygon.sensors{fill-opacity:.45}"
        f".bar{{fill:none;stroke:{light.ink};stroke-width:1.5}}"
        f"@media (prefers-color-scheme:dark){{text{{fill:{dark.ink}}}.bar{{stroke:{dark.ink}}}"
        "text.in{fill:#10161d}text.on{fill:#fff}}"
        "</style>"
    )
