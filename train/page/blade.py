"""The blade in three dimensions, frame by frame, its actuators coloured by their voltage."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from beamenv.blade.build import build_beam
from beamenv.blade.config import BladeConfig
from beamenv.blade.shape import Skin, bodies, edges, end_triangles, magnification, patch, side_triangles
from train.figures.palette import NEUTRAL
from train.figures.screen import plain
from train.page.recording import RecordedEpisode, Recording

Array = NDArray[np.float64]

STATIONS, PATCH_STATIONS = 33, 3
FRAME_INTERVAL = 4e-3
"""s between frames: some nine a period of the slowest mode."""
MOST_FRAMES = 500
SHOWN_DEFLECTION = 0.2
"""Share of the span that the largest deflection is drawn as, at most."""
ROUND = (1, 2, 5)
"""Digits of the magnification."""
RAISED = 0.06
"""Depths of the section that patches are drawn above the wall they lie in, so that they are seen."""
BODY = "#a9b4c0"
SPAN_SHOWN = 1.45
"""Length of the span axis in the units of plotly's cameras."""
EYE = np.array([1.25, 0.9, -0.5])
"""Where the camera stands, in (lag, flap, span), on the side that the top wall is turned to when that is +lag."""


@dataclass(frozen=True, slots=True)
class Motion:
    """A recording as it is drawn: F frames."""

    recording: Recording
    rows: NDArray[np.int64]
    """(F,): instants of the recording; a blade that failed stays as it was last."""
    displacement: Array
    """(F, 3, STATIONS), as drawn: lag and flap in m, twist in rad."""


def frame_times(episode: RecordedEpisode) -> Array:
    """(F,), s."""
    time = max((recording.time for recording in episode.pair), key=len)
    stride = max(round(FRAME_INTERVAL / (time[1] - time[0])), -(-len(time) // MOST_FRAMES))
    return np.asarray(time[::stride])


def motions(episode: RecordedEpisode) -> tuple[list[Motion], float]:
    """The pair with the displacements that are drawn, and their common magnification."""
    blade, times = episode.blade.config, frame_times(episode)
    operator = episode.blade.displacement_operator(_stations(blade))
    rows = [np.searchsorted(recording.time, times).clip(max=len(recording.time) - 1) for recording in episode.pair]
    true = [np.einsum("dkn,fn->fdk", operator, each.states[row]) for each, row in zip(episode.pair, rows, strict=True)]
    factor = magnification(
        max(float(np.linalg.norm(each[:, :2], axis=1).max()) for each in true), SHOWN_DEFLECTION * blade.beam.length, ROUND
    )
    return [Motion(*parts) for parts in zip(episode.pair, rows, [factor * each for each in true], strict=True)], factor


def blade_figures(episode: RecordedEpisode) -> tuple[go.Figure, go.Figure]:
    """The pair, each with one frame for each of ``frame_times``, named "0", "1", …; same axes, same magnification."""
    pair, _ = motions(episode)
    reach = max(float(np.abs(motion.displacement[:, :2]).max()) for motion in pair)
    limit = float(np.abs(episode.blade.config.voltage_limits).max())
    left, right = (_figure(episode.blade.config, motion, reach, limit) for motion in pair)
    return left, right


def _figure(blade: BladeConfig, motion: Motion, reach: float, limit: float) -> go.Figure:
    skins, patches = bodies(build_beam(blade), _stations(blade)), _patches(blade)
    walls, raised = _moved(skins, motion.displacement), _raised(blade, patches, motion.displacement)
    volts = motion.recording.volts[motion.rows]
    shades = np.broadcast_to(volts, (len(volts), len(patches)))  # ganged actuators share one voltage
    triangles = side_triangles(PATCH_STATIONS, 2, closed=False)
    shades = np.repeat(shades, len(triangles), axis=1).astype(np.float32)
    drawn = [[_mesh(wall), {**_mesh(patch), "intensity": shade}] for wall, patch, shade in zip(walls, raised, shades, strict=True)]
    frames = [{"name": str(index), "data": data, "traces": [1, 2]} for index, data in enumerate(drawn)]
    several = np.concatenate([triangles + 2 * PATCH_STATIONS * k for k in range(len(patches))])
    data = [_outline(blade, skins), _body(skins, drawn[0][0]), _actuators(several, drawn[0][1])]
    extent = max(float(np.linalg.norm(skin.points, axis=-1).max()) for skin in skins)
    return go.Figure(data=data, layout=_layout(blade, reach + 1.1 * extent, limit, motion.recording.name), frames=frames)


def _stations(blade: BladeConfig) -> Array:
    return np.linspace(0.0, blade.beam.length, STATIONS)


def _patches(blade: BladeConfig) -> list[Skin]:
    beam, patches = build_beam(blade), blade.patches
    raised = RAISED * beam.section.least_extent
    inlays = [inlay for group in patches.groups("actuators") for inlay in group.inlays("actuators", beam.length)]
    return [patch(beam, inlay, inlay.start + inlay.length * np.linspace(0.0, 1.0, PATCH_STATIONS), raised) for inlay in inlays]


def _moved(skins: Sequence[Skin], displacement: Array) -> Array:
    """(F, V, 3), m: vertices of all outlines, one after the other."""
    return np.concatenate([skin.displaced(displacement).reshape(len(displacement), -1, 3) for skin in skins], axis=1)


def _raised(blade: BladeConfig, patches: list[Skin], displacement: Array) -> Array:
    """(F, V, 3), m: vertices of all patches, which follow the body between its stations."""
    moved = [skin.displaced(displacement @ _between(_stations(blade), skin.span)) for skin in patches]
    return np.concatenate([each.reshape(len(each), -1, 3) for each in moved], axis=1)


def _between(stations: Array, span: Array) -> Array:
    """(stations, S): weights of linear interpolation."""
    return np.stack([np.interp(span, stations, each) for each in np.eye(len(stations))])


def _mesh(points: Array) -> dict[str, Any]:
    return {"type": "mesh3d", **dict(zip("xyz", points.reshape(-1, 3).T.astype(np.float32), strict=True))}


def _body(skins: Sequence[Skin], first: dict[str, Any]) -> dict[str, Any]:
    parts, before = [], 0
    for skin in skins:
        stations, corners = skin.points.shape[:2]
        end = end_triangles(skin.points[0])
        own = np.concatenate([side_triangles(stations, corners, closed=True), end, end + corners * (stations - 1)])
        parts.append(own + before)
        before += stations * corners
    triangles = np.concatenate(parts)
    light = {"ambient": 0.55, "diffuse": 0.6, "specular": 0.05, "roughness": 0.9, "fresnel": 0.0}
    look = {"color": BODY, "flatshading": True, "hoverinfo": "skip", "lighting": light}
    return {**first, **dict(zip("ijk", triangles.T, strict=True)), **look, "lightposition": {"x": 1e4, "y": 3e4, "z": -2e4}}


def _actuators(triangles: NDArray[np.intp], first: dict[str, Any]) -> dict[str, Any]:
    look = {"intensitymode": "cell", "coloraxis": "coloraxis", "flatshading": True, "lighting": {"ambient": 1.0, "diffuse": 0.0}}
    return {**first, **dict(zip("ijk", triangles.T, strict=True)), **look, "hovertemplate": "%{intensity:.0f} V<extra></extra>"}


def _outline(blade: BladeConfig, skins: Sequence[Skin]) -> dict[str, Any]:
    """Edges of the blade at rest, one line."""
    gap, pieces = np.full((1, 3), np.nan), list[Array]()
    for skin, sharp in zip(skins, edges(build_beam(blade).section), strict=True):
        walls = skin.at_rest()
        pieces += [gap] if pieces else []
        pieces += [np.concatenate([walls[:, edge], gap]) for edge in sharp]
        pieces.append(np.concatenate([walls[-1], walls[-1, :1]]))
    points = dict(zip("xyz", np.concatenate(pieces).T.astype(np.float32), strict=True))
    look = {"mode": "lines", "line": {"color": NEUTRAL, "width": 2}, "hoverinfo": "skip", "showlegend": False}
    return {"type": "scatter3d", **points, **look}


def _layout(blade: BladeConfig, half: float, limit: float, name: str) -> dict[str, Any]:
    """Of axes from −``half`` to ``half`` (m) across the span."""
    across = {"range": [-half, half], "showticklabels": False, "ticks": ""}
    share = 2.0 * half / blade.beam.length  # one scale for all directions
    below = {"orientation": "h", "thickness": 10, "len": 0.8, "y": -0.02, "yanchor": "top"}
    bar = {"title": {"text": "voltage, V", "side": "top"}, **below}
    return {
        "title": {"text": plain(name), "x": 0.0, "xanchor": "left", "font": {"size": 15}},
        "margin": {"l": 0, "r": 0, "t": 40, "b": 0},
        "scene": {
            "xaxis": {"title": {"text": "lag"}, **across},
            "yaxis": {"title": {"text": "flap"}, **across},
            "zaxis": {"title": {"text": "span, m"}, "range": [0.0, blade.beam.length], "nticks": 5},
            "aspectmode": "manual",
            "aspectratio": {"x": SPAN_SHOWN * share, "y": SPAN_SHOWN * share, "z": SPAN_SHOWN},
            "camera": _camera(blade),
        },
        "coloraxis": {"colorscale": "RdBu", "reversescale": True, "cmin": -limit, "cmax": limit, "colorbar": bar},
    }


def _camera(blade: BladeConfig) -> dict[str, Any]:
    middle = np.radians(blade.beam.presetting_deg + 0.5 * blade.beam.pretwist_deg)
    side = -1.0 if np.sin(middle) > 0.0 else 1.0
    points: dict[str, Any] = {"eye": EYE * [side, 1.0, 1.0], "up": (0.0, 1.0, 0.0), "center": (0.0, -0.12, -0.07)}
    return {name: dict(zip("xyz", map(float, point), strict=True)) for name, point in points.items()}
