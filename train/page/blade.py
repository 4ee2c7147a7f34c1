"""The blade as the page's script draws it: its surface once, and its motion as a few shapes and their amplitudes."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.blade.build import Blade
from beamenv.blade.shape import Skin, bodies, edges, patch
from beamenv.patches.layout import SIDES
from beamenv.plant.plant import drive_limit
from beamenv.rendering import scene
from beamenv.rendering.deformation import Deformation
from beamenv.rendering.palette import DARK, INK, LIGHT, OUTPUT_SCALE, VOLTAGE_SCALE, colour_table
from beamenv.rendering.solid import SHOWN_DEFLECTION, BladeSolid
from train.figures.themes import THEMES, Theme
from train.page.recording import RecordedEpisode, Recording

Array = NDArray[np.float64]

FRAME_INTERVAL = 4e-3
"""s between frames: some nine a period of the slowest mode."""
MOST_FRAMES = 500
COLOURS = 17
"""Of a scale, evenly spaced; between them the script interpolates."""
NEGLIGIBLE = 1e-7
"""Share of a displacement that shapes may leave out: single precision tells no more."""


def frame_times(episode: RecordedEpisode) -> Array:
    """(F,), s."""
    time = episode.time
    stride = max(round(FRAME_INTERVAL / (time[1] - time[0])), -(-len(time) // MOST_FRAMES))
    return np.asarray(time[::stride])


def frame_rows(episode: RecordedEpisode, recording: Recording) -> NDArray[np.int64]:
    """(F,): instants of a recording; a blade that failed stays as it was last."""
    return np.searchsorted(recording.time, frame_times(episode)).clip(max=len(recording.time) - 1)


def displacements(episode: RecordedEpisode, stations: Array) -> list[Array]:
    """(F, 3, S) of each recording: lag and flap in m, twist in rad, at stations (S,), m from the root."""
    deformation, found = Deformation(episode.task, stations), []
    for recording in episode.recordings:
        rows = frame_rows(episode, recording)
        plants = recording.truth[:, 0] if recording.truth.size else np.zeros(len(recording.time))
        found.append(np.stack([deformation.displacement(recording.states[row], int(plants[row])) for row in rows]))
    return found


def shapes_and_amplitudes(moved: Sequence[Array]) -> tuple[Array, list[Array]]:
    """(r, 3, S) orthonormal shapes and (F, r) amplitudes of each of the displacements (F, 3, S), which are their products.

    As many shapes as it takes; a blade that moves out of all bounds has no more weight than any other.
    """
    flat = [each.reshape(len(each), -1) for each in moved]
    every = np.concatenate(flat)
    size = np.linalg.norm(every, axis=1, keepdims=True)
    _, weights, basis = np.linalg.svd(every / np.where(size > 0.0, size, 1.0), full_matrices=False)
    basis = basis[: max(1, int(np.sum(weights > NEGLIGIBLE * weights[0])))]
    return basis.reshape(-1, *moved[0].shape[1:]), [each @ basis.T for each in flat]


def drawn_blade(episode: RecordedEpisode) -> dict[str, Any]:
    """All that the script needs, as JSON holds it; arrays are in base64, of single precision."""
    solid, blade = BladeSolid(episode.blade), episode.blade
    moved = displacements(episode, solid.stations)
    shapes, amplitudes = shapes_and_amplitudes(moved)
    pairs = zip(episode.recordings, moved, amplitudes, strict=True)
    return {
        **_surface(blade, solid),
        **_view(blade),
        "arrow": _arrow(episode, solid),
        "shapes": packed(shapes),
        "shownDeflection": SHOWN_DEFLECTION * blade.config.beam.length,
        "limit": float(drive_limit(blade.truth).max()),
        "scales": {"voltage": _scale(VOLTAGE_SCALE), "output": _scale(OUTPUT_SCALE)},
        "recordings": [_motion(episode, recording, *each) for recording, *each in pairs],
    }


def packed(values: ArrayLike) -> str:
    """Little-endian, of single precision, in base64."""
    return base64.b64encode(np.asarray(values, dtype="<f4").tobytes()).decode()


def _motion(episode: RecordedEpisode, recording: Recording, moved: Array, amplitudes: Array) -> dict[str, Any]:
    rows = frame_rows(episode, recording)
    actuators = sum(group.count for group in episode.blade.config.patches.groups("actuators"))
    volts = recording.volts[rows]
    seen = len(recording.readings) == len(recording.time)
    outputs = recording.readings[rows] / episode.blade.truth.sensor_full_scale if seen else np.zeros((len(rows), 0))
    return {
        "name": recording.name,
        "amplitudes": packed(amplitudes),
        "largest": float(np.linalg.norm(moved[:, :2], axis=1).max()),
        "tip": packed(1e6 * recording.tip[rows]),
        "load": packed(recording.load[rows]),
        "volts": packed(np.broadcast_to(volts, (len(rows), actuators))),  # ganged actuators share one voltage
        "outputs": packed(outputs),
        "dead": _dead(episode, recording)[rows].tolist() if recording.truth.size else [],
        "failed": None if len(recording.time) == len(episode.time) else float(1e3 * recording.time[-1]),
    }


def _dead(episode: RecordedEpisode, recording: Recording) -> NDArray[np.object_]:
    """(K,): which actuators and which readings are dead, each by its place; readings come after all actuators."""
    m, p = recording.volts.shape[1], len(episode.blade.truth.C)
    actuators = sum(group.count for group in episode.blade.config.patches.groups("actuators"))
    gains = recording.truth[:, 2 : 2 + m + p]
    dead = np.concatenate([np.broadcast_to(gains[:, :m], (len(gains), actuators)), gains[:, m:]], axis=1) == 0.0
    found = np.empty(len(dead), dtype=object)
    found[:] = [np.flatnonzero(row).tolist() for row in dead]
    return found


def _surface(blade: Blade, solid: BladeSolid) -> dict[str, Any]:
    """Vertices one after the other, and which are whose."""
    beam, length, places = blade.beam, blade.config.beam.length, solid.places
    skins = bodies(beam, solid.stations)
    inlays = [[each for group in blade.config.patches.groups(side) for each in group.inlays(side, length)] for side in SIDES]
    strips = [[patch(beam, each, np.array([each.start, each.start + each.length])) for each in side] for side in inlays]
    actuators, sensors = strips
    every = [*skins, *actuators, *sensors, *places.points]
    first = np.concatenate([[0], np.cumsum([skin.points.shape[0] * skin.points.shape[1] for skin in every])]).tolist()
    sharp = [each.tolist() for each in edges(beam.section)]
    starts = iter(first)
    return {
        "stations": packed(solid.stations),
        "even": solid.even.tolist(),
        "vertices": {name: packed(values) for name, values in _vertices(every, solid.stations).items()},
        "bodies": [
            {"first": next(starts), "stations": skin.points.shape[0], "corners": skin.points.shape[1], "edges": edge}
            for skin, edge in zip(skins, sharp, strict=True)
        ],
        "actuators": [next(starts) for _ in actuators],
        "sensors": [next(starts) for _ in sensors],
        "points": [next(starts) for _ in places.points],
        "readBy": {"sensors": places.of_patches.tolist(), "points": places.of_points.tolist()},
        "hub": [face.tolist() for faces in scene.hub([skin.at_rest() for skin in skins], length) for face in faces],
    }


def _vertices(skins: Iterable[Skin], stations: Array) -> dict[str, Array]:
    """(V,) each: place of the station, along the chord and across it (m), angle of the chord (rad)."""
    found: list[Array] = []
    for skin in skins:
        count = skin.points.shape[1]
        places = np.repeat(np.searchsorted(stations, skin.span), count)
        found.append(np.stack([places, *skin.points.reshape(-1, 2).T, np.repeat(skin.angle, count)]))
    return dict(zip(("station", "along", "across", "angle"), np.concatenate(found, axis=1), strict=True))


def _view(blade: Blade) -> dict[str, Any]:
    """Where the eye and the light are at first, and the colours: those of the environment's own pictures."""
    beam = blade.config.beam
    middle = np.radians(beam.presetting_deg + 0.5 * beam.pretwist_deg)
    side = np.array([-1.0 if np.sin(middle) < 0.0 else 1.0, 1.0, 1.0])
    return {
        "towards": (side * scene.TOWARDS).tolist(),
        "light": (side * scene.SUN / np.linalg.norm(scene.SUN)).tolist(),
        "distance": scene.DISTANCE * beam.length,
        "drop": scene.SENSOR_DROP * beam.length,
        "ribs": scene.RIBS,
        "themes": {name: _colours(name, theme) for name, theme in THEMES.items()},
    }


def _arrow(episode: RecordedEpisode, solid: BladeSolid) -> dict[str, Any]:
    """The line load: the station where its arrow ends, how long the largest of the episode is drawn (m), and its size (N/m)."""
    length = episode.blade.config.beam.length
    sizes = [np.linalg.norm(recording.load[frame_rows(episode, recording)], axis=1).max() for recording in episode.recordings]
    return {
        "station": int(np.abs(solid.stations - scene.ARROW_AT * length).argmin()),
        "length": scene.ARROW * length,
        "largest": float(max(sizes)),
        "head": scene.HEAD,
        "shaft": scene.SHAFT,
        "shortest": scene.SHORTEST,
    }


def _colours(name: str, theme: Theme) -> dict[str, Any]:
    """Of what stands for no value."""
    body, hub = ([list(shade) for shade in shades] for shades in (LIGHT.body, LIGHT.hub))
    load = {"light": LIGHT, "dark": DARK}[name].load
    return {"ink": theme.ink, "rest": theme.faint, "load": load, "outline": INK, "body": body, "hub": hub}


def _scale(name: str) -> list[list[int]]:
    return np.rint(colour_table(name)[np.linspace(0, 255, COLOURS).round().astype(int)]).astype(int).tolist()
