"""The blade in three dimensions, frame by frame, its actuators coloured by their voltage."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from beamenv.blade.build import displacement_operator
from beamenv.blade.config import BladeConfig
from beamenv.structure.walls.contour import rotated
from train.figures.palette import NEUTRAL
from train.page.recording import RecordedEpisode, Recording

Array = NDArray[np.float64]

STATIONS = 33
FRAME_INTERVAL = 4e-3
"""s between frames: some nine a period of the slowest mode."""
MOST_FRAMES = 500
SHOWN_DEFLECTION = 0.2
"""Share of the span that the largest deflection is drawn as, at most."""
BOX = np.array([[0.5, -0.5], [0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5]])
"""Corners of the section in widths and depths."""
RAISED = 0.06
"""Depths that patches are drawn above the wall they lie in, so that they are seen."""
BODY = "#a9b4c0"
SPAN_SHOWN = 1.45
"""Length of the span axis in the units of plotly's cameras."""
EYE = np.array([1.25, 0.9, -0.5])
"""Where the camera stands, in (lag, flap, span), on the side that the top wall is turned to when that is +lag."""


@dataclass(frozen=True, slots=True)
class Strip:
    """A prism or a ribbon along the span: lines through points of the section, cut at stations."""

    span: Array
    """(S,), m from the root."""
    points: Array
    """(P, 2), in widths and depths of the section."""
    closed: bool
    """Whether the last line is joined to the first, and the ends are covered."""

    def at_rest(self, blade: BladeConfig) -> Array:
        """(S, P, 3), m: lag, flap, span."""
        beam = blade.beam
        share = self.span / beam.length
        size = 1.0 + (1.0 / beam.taper - 1.0) * share
        outline = size[:, None, None] * self.points * [beam.width, beam.depth]
        turned = rotated(outline, np.radians(beam.presetting_deg + beam.pretwist_deg * share))
        return np.concatenate([turned, np.broadcast_to(self.span[:, None, None], (*turned.shape[:2], 1))], axis=-1)

    def triangles(self) -> NDArray[np.int64]:
        """(k, 3): vertices, numbered station by station."""
        stations, lines = len(self.span), len(self.points)
        s, p = np.meshgrid(np.arange(stations - 1), np.arange(lines if self.closed else lines - 1), indexing="ij")
        a, b = (s * lines + p).ravel(), (s * lines + (p + 1) % lines).ravel()
        sides = [np.stack([a, b, a + lines], axis=1), np.stack([b, b + lines, a + lines], axis=1)]
        fan = np.stack([np.zeros(lines - 2), np.arange(1, lines - 1), np.arange(2, lines)], axis=1)
        return np.concatenate([*sides, *([fan, fan + lines * (stations - 1)] if self.closed else [])]).astype(np.int64)


@dataclass(frozen=True, slots=True)
class Motion:
    """A recording as it is drawn: F frames."""

    recording: Recording
    rows: NDArray[np.int64]
    """(F,): instants of the recording; a blade that failed stays as it was last."""
    deflection: Array
    """(F, 2, STATIONS), m, as drawn: lag, flap."""


def frame_times(episode: RecordedEpisode) -> Array:
    """(F,), s."""
    time = max((recording.time for recording in episode.pair), key=len)
    stride = max(round(FRAME_INTERVAL / (time[1] - time[0])), -(-len(time) // MOST_FRAMES))
    return np.asarray(time[::stride])


def magnification(largest: float, span: float) -> float:
    """How many times larger than life a deflection (m) is drawn: the largest 1, 2 or 5 times a power of ten that keeps it below
    a fifth of the span; 1 for a blade that does not move.
    """
    if largest <= 0.0:
        return 1.0
    wanted = SHOWN_DEFLECTION * span / largest
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(power * max(factor for factor in (1.0, 2.0, 5.0) if factor * power <= wanted))


def motions(episode: RecordedEpisode) -> tuple[list[Motion], float]:
    """The pair with the deflections that are drawn, and their common magnification."""
    blade, times = episode.blade, frame_times(episode)
    operator = displacement_operator(blade, _stations(blade))[:2]
    rows = [np.searchsorted(recording.time, times).clip(max=len(recording.time) - 1) for recording in episode.pair]
    true = [np.einsum("dkn,fn->fdk", operator, each.states[row]) for each, row in zip(episode.pair, rows, strict=True)]
    factor = magnification(max(float(np.linalg.norm(each, axis=1).max()) for each in true), blade.beam.length)
    return [Motion(*parts) for parts in zip(episode.pair, rows, [factor * each for each in true], strict=True)], factor


def blade_figures(episode: RecordedEpisode) -> tuple[go.Figure, go.Figure]:
    """The pair, each with one frame for each of ``frame_times``, named "0", "1", …; same axes, same magnification."""
    pair, _ = motions(episode)
    reach = max(float(np.abs(motion.deflection).max()) for motion in pair)
    limit = float(np.abs(episode.blade.voltage_limits).max())
    left, right = (_figure(episode.blade, motion, reach, limit) for motion in pair)
    return left, right


def _figure(blade: BladeConfig, motion: Motion, reach: float, limit: float) -> go.Figure:
    body = Strip(_stations(blade), BOX, closed=True)
    patches = _patches(blade)
    moving = [1, 2]
    frames = [
        {"name": str(index), "data": _frame(blade, motion, body, patches, index), "traces": moving}
        for index in range(len(motion.rows))
    ]
    first: list[Any] = frames[0]["data"]  # type: ignore[assignment]
    data = [_outline(blade, body), _body(body, first[0]), _actuators(patches, first[1])]
    return go.Figure(data=data, layout=_layout(blade, reach, limit, motion.recording.name), frames=frames)


def _stations(blade: BladeConfig) -> Array:
    return np.linspace(0.0, blade.beam.length, STATIONS)


def _patches(blade: BladeConfig) -> list[Strip]:
    half = 0.5 * blade.patches.width / blade.beam.width
    edges = np.array([[half, 0.5 + RAISED], [-half, 0.5 + RAISED]])
    starts = blade.patches.actuator_positions(blade.beam.length)
    return [Strip(start + blade.patches.length * np.array([0.0, 0.5, 1.0]), edges, closed=False) for start in starts]


def _moved(blade: BladeConfig, strip: Strip, deflection: Array) -> Array:
    """Vertices (S P, 3), m, with the deflection (2, STATIONS) added."""
    points = strip.at_rest(blade)
    for direction in (0, 1):
        points[..., direction] += np.interp(strip.span, _stations(blade), deflection[direction])[:, None]
    return points.reshape(-1, 3)


def _frame(blade: BladeConfig, motion: Motion, body: Strip, patches: list[Strip], index: int) -> list[dict[str, Any]]:
    """What changes of body and actuators."""
    deflection = motion.deflection[index]
    corners = _moved(blade, body, deflection)
    raised = np.concatenate([_moved(blade, patch, deflection) for patch in patches])
    volts = np.broadcast_to(motion.recording.volts[motion.rows[index]], len(patches))  # ganged actuators share one voltage
    shades = np.repeat(volts, [len(patch.triangles()) for patch in patches])
    return [_mesh(corners), {**_mesh(raised), "intensity": shades.astype(np.float32)}]


def _mesh(points: Array) -> dict[str, Any]:
    return {"type": "mesh3d", **dict(zip("xyz", points.T.astype(np.float32), strict=True))}


def _body(strip: Strip, first: dict[str, Any]) -> dict[str, Any]:
    faces = dict(zip("ijk", strip.triangles().T, strict=True))
    light = {"ambient": 0.55, "diffuse": 0.6, "specular": 0.05, "roughness": 0.9, "fresnel": 0.0}
    look = {"color": BODY, "flatshading": True, "hoverinfo": "skip", "lighting": light}
    return {**first, **faces, **look, "lightposition": {"x": 1e4, "y": 3e4, "z": -2e4}}


def _actuators(patches: list[Strip], first: dict[str, Any]) -> dict[str, Any]:
    sizes = np.cumsum([0, *(len(patch.span) * len(patch.points) for patch in patches)])
    triangles = np.concatenate([patch.triangles() + size for patch, size in zip(patches, sizes[:-1], strict=True)])
    look = {"intensitymode": "cell", "coloraxis": "coloraxis", "flatshading": True, "lighting": {"ambient": 1.0, "diffuse": 0.0}}
    return {**first, **dict(zip("ijk", triangles.T, strict=True)), **look, "hovertemplate": "%{intensity:.0f} V<extra></extra>"}


def _outline(blade: BladeConfig, body: Strip) -> dict[str, Any]:
    """Edges of the blade at rest, one line."""
    corners = body.at_rest(blade)
    gap = np.full((1, 3), np.nan)
    pieces = [np.concatenate([corners[:, edge], gap]) for edge in range(len(BOX))] + [corners[-1, [0, 1, 2, 3, 0]]]
    points = dict(zip("xyz", np.concatenate(pieces).T.astype(np.float32), strict=True))
    look = {"mode": "lines", "line": {"color": NEUTRAL, "width": 2}, "hoverinfo": "skip", "showlegend": False}
    return {"type": "scatter3d", **points, **look}


def _layout(blade: BladeConfig, reach: float, limit: float, name: str) -> dict[str, Any]:
    half = reach + 0.55 * float(np.hypot(blade.beam.width, blade.beam.depth))
    across = {"range": [-half, half], "showticklabels": False, "ticks": ""}
    share = 2.0 * half / blade.beam.length  # one scale for all directions
    below = {"orientation": "h", "thickness": 10, "len": 0.8, "y": -0.02, "yanchor": "top"}
    bar = {"title": {"text": "voltage, V", "side": "top"}, **below}
    return {
        "title": {"text": name, "x": 0.0, "xanchor": "left", "font": {"size": 15}},
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
    points = {"eye": EYE * [side, 1.0, 1.0], "up": (0.0, 1.0, 0.0), "center": (0.0, -0.12, -0.07)}
    return {name: dict(zip("xyz", map(float, point), strict=True)) for name, point in points.items()}
