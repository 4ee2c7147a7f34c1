"""A moving picture of each scenario, as SVG: one episode without control and the same one under LQG, slower than life.

``python -m train.tools.scenario_pictures`` writes them into ``docs/images/scenarios``, in about a minute; names as
arguments write those alone. Colours are legible on white and on black, so that one picture does for both themes.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

import beamenv
from baselines import Controller, no_control, reference_lqg
from baselines.evaluation.loop import instants
from beamenv.configuration.writing import write_whole
from beamenv.rendering.deformation import Deformation
from beamenv.scenarios.named import NAMES
from train.figures.palette import NEUTRAL, PALETTE

Array = NDArray[np.float64]

FOLDER = Path("docs/images/scenarios")
SEED = 3_000_000
"""A validation seed."""
FRAMES, SECONDS = 100, 16.0
"""Of the moving picture."""
STATIONS = 11
"""Along the span."""
WIDTH, SPAN, MIDDLE, REACH = 480, (28.0, 456.0), 74.0, 46.0
"""px: of the picture; where the blade begins and ends; its height at rest; its largest deflection."""
TRACE = (28.0, 456.0, 196.0, 34.0)
"""px: left, right, middle and half height of the tip's displacement over time."""
HEIGHT = 244
LETTERS = "#808890"
BLUE = PALETTE[0]


@dataclass(frozen=True, slots=True, eq=False)
class Filmed:
    """One episode."""

    time: Array
    """(K,), s."""
    shape: Array
    """(K, 2, k), m: lag and flap along the span."""
    cost: float
    """J, J s; infinite where the blade failed."""
    working: tuple[bool, ...]
    """Of each actuator, at the end."""


def filmed(controller: Controller, env: Any) -> Filmed:
    """What one blade does in the episode of ``SEED``."""
    inner = env.unwrapped
    deformation = Deformation(inner.task, np.linspace(0.0, inner.task.config.beam.length, STATIONS))
    shapes, cost, failed = [], 0.0, False
    for instant in instants(controller, env, [SEED]):
        if not np.isfinite(inner.state).all():
            break
        shapes.append(deformation.displacement(inner.state, int(inner.episode_truth[0]))[:2])
        cost += float(np.sum(instant.info.get("cost_increment", 0.0)))
        failed = failed or bool(instant.failed[0])
    count = inner.plant.B.shape[1]
    working = tuple(bool(gain > 0.0) for gain in inner.episode_truth[2 : 2 + count])
    time = inner.plant.control_interval * np.arange(len(shapes))
    return Filmed(time, np.array(shapes), np.inf if failed else cost, working)


def picture(scenario: str) -> str:
    """The SVG of a scenario."""
    env = gymnasium.make(beamenv.ENV_ID, scenario=scenario, dtype="float64")
    inner: Any = env.unwrapped
    idle = filmed(no_control(inner.design.plant), env)
    held = filmed(reference_lqg(inner.design.full_plant), env)
    end = inner.task.steps * inner.plant.control_interval
    length = inner.task.config.beam.length
    sheets = [inlay for group in inner.task.config.patches.groups("actuators") for inlay in group.inlays("actuators", length)]
    edges = [(sheet.start / length, (sheet.start + sheet.length) / length) for sheet in sheets]
    env.close()
    return drawn(idle, held, end, edges, length)


def drawn(idle: Filmed, held: Filmed, end: float, edges: Sequence[tuple[float, float]], length: float) -> str:
    """The blade's shapes above, its tip over time below; the direction is that in which the idle tip moves most."""
    tip = idle.shape[:, :, -1]
    direction = np.linalg.svd(tip, full_matrices=False)[2][0]
    moves = [np.einsum("kds,d->ks", film.shape, direction) for film in (idle, held)]
    reach = max(float(np.abs(moves[0]).max()), 1e-12)
    magnified = REACH / reach / ((SPAN[1] - SPAN[0]) / length)
    said = "failed" if np.isinf(held.cost) else f"J = {held.cost / idle.cost:.2f} × no control's"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="14">',
        _words(SPAN[0], 16, "no control", NEUTRAL, weight=True) + _words(118, 16, f"LQG: {said}", BLUE, weight=True),
        _words(SPAN[1], 16, f"deflection × {_round(magnified)}", LETTERS, anchor="end"),
        f'<path d="M{SPAN[0]} {MIDDLE}H{SPAN[1]}" stroke="{LETTERS}" stroke-width="0.6" stroke-dasharray="3 4"/>',
        f'<rect x="8" y="{MIDDLE - 26}" width="20" height="52" fill="{LETTERS}" fill-opacity="0.45"/>',
        *(_patch(low, high, works) for (low, high), works in zip(edges, held.working, strict=False)),
        _moving_blade(idle.time, moves[0] / reach, end, NEUTRAL, 2.2, "6 4"),
        _moving_blade(held.time, moves[1] / reach, end, BLUE, 2.6),
        *_trace(idle.time, moves[0][:, -1] / reach, end, NEUTRAL, 1.2),
        *_trace(held.time, moves[1][:, -1] / reach, end, BLUE, 1.5),
        *_axis(end, reach),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


def _words(x: float, y: float, text: str, colour: str, anchor: str = "start", weight: bool = False) -> str:
    bold = ' font-weight="bold"' if weight else ""
    return f'<text x="{x:g}" y="{y:g}" fill="{colour}" text-anchor="{anchor}"{bold}>{text}</text>'


def _patch(low: float, high: float, works: bool) -> str:
    """An actuator below the blade, crossed out where it is dead."""
    left, right = (SPAN[0] + share * (SPAN[1] - SPAN[0]) for share in (low, high))
    y = MIDDLE + REACH + 8.0
    cross = "" if works else f'<path d="M{left:.0f} {y - 4:g}L{right:.0f} {y + 10:g}M{left:.0f} {y + 10:g}L{right:.0f} {y - 4:g}" '
    cross += "" if works else f'stroke="{LETTERS}" stroke-width="2"/>'
    return f'<rect x="{left:.0f}" y="{y:g}" width="{right - left:.0f}" height="6" fill="{PALETTE[1]}"/>{cross}'


def _moving_blade(time: Array, moves: Array, end: float, colour: str, width: float, dash: str = "") -> str:
    """A line along the span that is moved from picture to picture."""
    across = np.linspace(*SPAN, STATIONS)
    down = np.stack([np.interp(np.linspace(0.0, end, FRAMES), time, row) for row in moves.T], axis=-1)
    down = MIDDLE - REACH * np.clip(down, -1.5, 1.5)
    frames = ["M" + "L".join(f"{x:.0f} {y:.1f}" for x, y in zip(across, row, strict=True)) for row in down]
    first = frames[int(np.abs(down - MIDDLE).max(axis=1).argmax())]
    dashed = f' stroke-dasharray="{dash}"' if dash else ""
    return (
        f'<path d="{first}" fill="none" stroke="{colour}" stroke-width="{width}"{dashed}>'
        f'<animate attributeName="d" dur="{SECONDS:g}s" repeatCount="indefinite" values="{";".join(frames)}"/></path>'
    )


def _trace(time: Array, tip: Array, end: float, colour: str, width: float) -> list[str]:
    """The tip's displacement, every third instant, and a dot that runs along it."""
    left, right, middle, half = TRACE
    xs = left + (right - left) * time[::3] / end
    ys = middle - half * np.clip(tip[::3], -1.5, 1.5)
    line = "M" + "L".join(f"{x:.0f} {y:.1f}" for x, y in zip(xs, ys, strict=True))
    at = np.linspace(0.0, end, FRAMES)
    dots = middle - half * np.clip(np.interp(at, time, tip), -1.5, 1.5)
    heights = ";".join(f"{y:.1f}" for y in dots)
    return [
        f'<path d="{line}" fill="none" stroke="{colour}" stroke-width="{width}"/>',
        f'<circle r="3.5" fill="{colour}" cx="{left:g}" cy="{dots[0]:.1f}">'
        f'<animate attributeName="cx" dur="{SECONDS:g}s" repeatCount="indefinite" values="{left:g};{right:g}"/>'
        f'<animate attributeName="cy" dur="{SECONDS:g}s" repeatCount="indefinite" values="{heights}"/></circle>',
    ]


def _axis(end: float, reach: float) -> list[str]:
    """Time, and how far the tip goes without control."""
    left, right, middle, half = TRACE
    size = f"{1e6 * reach:.0f} µm" if reach < 1e-3 else f"{1e3 * reach:.1f} mm"
    lines = f"M{left:g} {middle}H{right:g}M{left:g} {middle - half}V{middle + half}"
    return [
        f'<path d="{lines}" stroke="{LETTERS}" stroke-width="0.6" fill="none"/>',
        _words(left, HEIGHT - 2, "0", LETTERS) + _words(right, HEIGHT - 2, f"{end:g} s", LETTERS, anchor="end"),
        _words(left, 158, f"tip displacement, at most {size} without control", LETTERS),
    ]


def _round(number: float) -> str:
    """To two digits."""
    digits = 1 - int(np.floor(np.log10(number)))
    return f"{round(number, digits):g}"


def write_pictures(folder: Path = FOLDER, names: Sequence[str] = NAMES) -> None:
    """Write the picture of each scenario, whole or not at all."""
    for name in names:
        write_whole(folder / f"{name}.svg", picture(name).encode())


if __name__ == "__main__":
    write_pictures(names=sys.argv[1:] or NAMES)
