"""A picture of the blade: its walls, patches and hub in perspective, as SVG, which follows the colours of the system."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterator, Mapping, Sequence
from html import escape

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import SIDES, Side
from beamenv.blade.shape import bodies, edges, patch, quadrilaterals, sides
from beamenv.patches.group import PatchGroup
from beamenv.rendering.camera import Camera, faces_camera
from beamenv.rendering.canvas import Frame
from beamenv.structure import RotatingBeam
from train.figures.palette import PATCH_COLOURS, PATCHES_OF_YOUR_OWN
from train.figures.themes import THEMES

Array = NDArray[np.float64]

WIDTH, HEIGHT, MARGIN = 640.0, 260.0, 14.0
STATIONS = 25
TOWARDS, DISTANCE = np.array([-0.80, 0.62, -0.45]), 1.6
"""Where the eye is from the middle of the blade, with positive pretwist: the direction (lag, flap, span) and how many spans."""
DROP = 0.16
"""Share of the span by which sensors are drawn below where they are, for most are on the side that is turned away."""
HUB = 1.3
"""Size of the block that holds the root, over the root's."""
LIGHT = np.array([0.3, 0.9, -0.3])
SHADES = 8
"""Of the walls, from the darkest to the brightest."""


def picture(config: BladeConfig, beam: RotatingBeam) -> str:
    """The picture as the address of an image that stands in itself."""
    return as_address(drawn(config, beam))


def as_address(drawing: str) -> str:
    """An SVG as the address of an image that stands in itself."""
    return "data:image/svg+xml;base64," + b64encode(drawing.encode()).decode()


def said(config: BladeConfig) -> str:
    """What the picture shows, in words."""
    beam, parts = config.beam, []
    for side in SIDES:
        for group in config.patches.groups(side):
            edges = ", ".join(f"{1e3 * edge:.0f}" for edge in group.at(side, beam.length))
            parts.append(f"{name_of(group)} {side} on the {group.wall} wall at {edges} mm from the root")
    shape = "box" if beam.section is None else beam.section.shape
    twist = "twisted along its span" if beam.twist_table is not None else f"pretwist {beam.pretwist_deg:g}°"
    return f"Blade with a section of the shape {shape}, {beam.length:g} m long, {twist}: {'; '.join(parts)}."


def drawn(config: BladeConfig, beam: RotatingBeam) -> str:
    """The SVG."""
    span = np.linspace(0.0, beam.length, STATIONS)
    walls = [skin.at_rest() for skin in bodies(beam, span)]
    actuators, sensors = (_patches(config, beam, side) for side in SIDES)
    middle = np.radians(beam.presetting_deg + 0.5 * config.beam.pretwist_deg)
    towards = TOWARDS * [-1.0 if np.sin(middle) < 0.0 else 1.0, 1.0, 1.0]
    hub = _hub(np.concatenate([each[0] for each in walls]))
    dropped = [(group, corners + [0.0, -DROP * beam.length, 0.0]) for group, corners in sensors]
    points = [*walls, *hub, *(corners for _, corners in dropped)]
    all_points = np.concatenate([each.reshape(-1, 3) for each in points])
    camera = Camera.facing(all_points, towards, DISTANCE * beam.length, Frame(0.0, 0.0, WIDTH, HEIGHT))
    hidden = [not _is_seen(camera, corners) for _, corners in sensors]
    drawn_below = [(below if away else there) for below, there, away in zip(dropped, sensors, hidden, strict=True)]
    parts = [
        *_leaders(camera, [(there[1], below[1]) for there, below in zip(sensors, drawn_below, strict=True) if below is not there]),
        *_faces(camera, [face for wall in walls for face in (*sides(wall), wall[-1])]),
        *_lines(camera, walls, beam),
        *_sheets(camera, actuators, "actuator"),
        *_faces(camera, hub, "hub"),
        *_sheets(camera, drawn_below, "sensor"),
    ]
    return _document(parts, camera.project(all_points)[0], escape(said(config)))


def _patches(config: BladeConfig, beam: RotatingBeam, side: Side) -> list[tuple[PatchGroup, Array]]:
    """Each patch's group and corners (4, 3), m, counter-clockwise from outside."""
    found = []
    for group in config.patches.groups(side):
        for inlay in group.inlays(side, beam.length):
            ends = np.array([inlay.start, inlay.start + inlay.length])
            found.append((group, quadrilaterals(patch(beam, inlay, ends).at_rest())))
    return found


def _hub(root: Array) -> list[Array]:
    """Faces (4, 3) of the block that holds the root (k, 3)."""
    low, high = root.min(axis=0), root.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * HUB * np.maximum(high - low, 0.2 * float(np.ptp(root[:, :2], axis=0).max()))
    corners = np.array([[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]]) * half[:2] + middle[:2]
    depth = float(np.ptp(corners, axis=0).min())
    block = np.stack([np.column_stack([corners, np.full(4, z)]) for z in (-depth, 0.0)])
    return [*sides(block), block[1], block[0, ::-1]]


def _faces(camera: Camera, faces: Sequence[Array], kind: str = "wall") -> Iterator[str]:
    """Faces that are turned to the eye, the farthest first."""
    seen = []
    for face in faces:
        corners, depth = camera.project(face)
        if faces_camera(corners[None])[0]:
            seen.append((float(depth.mean()), corners, _shade(face)))
    for _, corners, shade in sorted(seen, key=lambda each: -each[0]):
        yield f'<polygon class="{kind} s{shade}" points="{_points(corners)}"/>'


def _shade(face: Array) -> int:
    normal = np.cross(face, np.roll(face, -1, axis=0)).sum(axis=0)
    size = max(float(np.linalg.norm(normal)), float(np.finfo(np.float64).tiny))
    brightness = 0.5 + 0.5 * float(normal @ LIGHT) / size / float(np.linalg.norm(LIGHT))
    return min(int(SHADES * brightness), SHADES - 1)


def _lines(camera: Camera, walls: Sequence[Array], beam: RotatingBeam) -> Iterator[str]:
    """Sharp edges along the span, where they are seen or not, and the tip's outline."""
    for wall, sharp in zip(walls, edges(beam.section), strict=True):
        for corner in sharp:
            yield f'<polyline class="edge" points="{_points(camera.project(wall[:, corner])[0])}"/>'
        yield f'<polygon class="tip" points="{_points(camera.project(wall[-1])[0])}"/>'


def _leaders(camera: Camera, ends: Sequence[tuple[Array, Array]]) -> Iterator[str]:
    """From where patches are to where they are drawn."""
    for there, below in ends:
        middles = np.stack([there.mean(axis=0), below.mean(axis=0)])
        yield f'<polyline class="leader" points="{_points(camera.project(middles)[0])}"/>'


def _is_seen(camera: Camera, face: Array) -> bool:
    return bool(faces_camera(camera.project(face)[0][None])[0])


def _sheets(camera: Camera, patches: Sequence[tuple[PatchGroup, Array]], kind: str) -> Iterator[str]:
    """Patches with their numbers; dashed where an actuator is behind the wall that it lies in."""
    for number, (group, face) in enumerate(patches, start=1):
        corners, _ = camera.project(face)
        behind = " behind" if kind == "actuator" and not _is_seen(camera, face) else ""
        x, y = corners.mean(axis=0)
        yield f'<polygon class="{kind}{behind}" style="--own:{colour_of(group)}" points="{_points(corners)}"/>'
        yield f'<text class="{kind}{behind}" x="{x:.1f}" y="{y + 4.0:.1f}">{number}</text>'


def _points(corners: Array) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)


def name_of(group: PatchGroup) -> str:
    """Of its material."""
    return group.material if isinstance(group.material, str) else "own"


def colour_of(group: PatchGroup) -> str:
    """Of its material."""
    return PATCH_COLOURS.get(name_of(group), PATCHES_OF_YOUR_OWN)


def key(config: BladeConfig) -> Mapping[str, str]:
    """The colour of each kind of patch there is."""
    return {name_of(group): colour_of(group) for side in SIDES for group in config.patches.groups(side)}


def which(config: BladeConfig, name: str) -> str:
    """The numbers of the patches of a kind: actuators 1–4, sensors 1–4."""
    found = []
    for side in SIDES:
        groups = config.patches.groups(side)
        owners = [name_of(group) for group in groups for _ in range(group.count)]
        numbers = [k for k, owner in enumerate(owners, start=1) if owner == name]
        if numbers:
            found.append(f"{side} {_numbers(numbers)}")
    return ", ".join(found)


def _numbers(numbers: Sequence[int]) -> str:
    whole = len(numbers) > 2 and numbers[-1] - numbers[0] + 1 == len(numbers)
    return f"{numbers[0]}–{numbers[-1]}" if whole else ", ".join(map(str, numbers))


def _document(parts: Sequence[str], points: Array, title: str) -> str:
    left, top = points.min(axis=0) - MARGIN
    width, height = points.max(axis=0) + MARGIN - (left, top)
    box = f"{left:.0f} {top:.0f} {width:.0f} {height:.0f}"
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}"><title>{title}</title><style>{_style()}</style>'
    return f"{head}{''.join(parts)}</svg>"


def _style() -> str:
    light, dark = THEMES["light"], THEMES["dark"]
    shades = [_shaded(kind, darkest, shade) for kind, darkest in (("wall", 150), ("hub", 70)) for shade in range(SHADES)]
    return "".join(shades) + (
        f".edge,.tip{{fill:none;stroke:{light.faint};stroke-width:.7}}.leader{{stroke:{light.faint};stroke-width:.8;fill:none}}"
        f"polygon.actuator{{fill:var(--own);stroke:{light.ink}}}"
        "polygon.behind{fill:none;stroke:var(--own);stroke-dasharray:4 3}"
        "polygon.sensor{fill:var(--own);fill-opacity:.3;stroke:var(--own);stroke-width:1.5}"
        "text{font:600 12px system-ui,sans-serif;text-anchor:middle}"
        f"text.actuator{{fill:#fff}}text.behind{{fill:{light.ink}}}text.sensor{{fill:{light.ink}}}"
        f"@media (prefers-color-scheme:dark){{.leader{{stroke:{dark.faint}}}text.sensor{{fill:{dark.ink}}}}}"
    )


def _shaded(kind: str, darkest: int, shade: int) -> str:
    """Of faces, whose strokes close the gaps between them."""
    level = darkest + 80 * shade // SHADES
    grey = f"#{level:02x}{level + 8:02x}{level + 16:02x}"
    return f".{kind}.s{shade}{{fill:{grey};stroke:{grey}}}"
