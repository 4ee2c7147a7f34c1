"""A section as it is: its walls, what lies in them and on them, and its centres."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import build_beam
from beamenv.blade.config import BladeConfig
from beamenv.patches.layout import SIDES
from beamenv.structure.section.mesh import Mesh, mesh
from beamenv.structure.section.properties import SectionProperties
from beamenv.structure.walls.inlay import Inlay
from train.figures.palette import PALETTE
from train.figures.paper import THEMES, save, styled

Array = NDArray[np.float64]

LEGEND = {"ncols": 5, "handlelength": 1.2, "columnspacing": 1.2}
WIDTH = 7.0
"""Inches; the height follows the section's shape, within limits."""
THINNEST = 0.012
"""Of the section's extent: patches thinner than that are drawn so thick."""


def draw_section(config: BladeConfig, found: SectionProperties, at: float, path: Path) -> None:
    """Write the picture of a blade's section at a share of the span, with the patches that there are anywhere along it."""
    save(section_figure(config, found, at), path)


def section_figure(config: BladeConfig, found: SectionProperties, at: float, theme: str = "light") -> Any:
    """Walls in grey, actuators and sensors in colours, centres by their signs."""
    import matplotlib.pyplot as plt

    elements = elements_of(config, at)
    with styled(theme):
        figure, axis = plt.subplots(figsize=_shape(elements), layout="constrained")
        draw_on(axis, config, found, elements, theme)
        axis.set_title(f"section {'at the root' if at == 0.0 else f'at {at:g} of the span'}, patches of every station")
        axis.margins(0.06, 0.15)
        figure.legend(handles=axis.get_legend_handles_labels()[0], loc="outside lower center", **LEGEND)
    return figure


def elements_of(config: BladeConfig, at: float) -> Mesh:
    """The walls of a blade's section at a share of the span, cut where patches begin and end."""
    beam = build_beam(config)
    size = beam.planform.scale(np.array([at * beam.length]))
    inlays = [group.inlay(0.0, 1.0) for side in SIDES for group in config.patches.groups(side)]
    strips = {inlay.strip for inlay in inlays}
    return mesh(beam.section.chains, size, sorted(strips, key=lambda strip: (strip.wall, strip.width, strip.offset)))


def draw_on(axis: Any, config: BladeConfig, found: SectionProperties, elements: Mesh, theme: str = "light") -> None:
    """A section on a pair of axes, with labels for a legend."""
    extent, wall = float(np.ptp(elements.points[0], axis=0).max()), THEMES[theme]["wall"]
    for k in range(len(elements.edges)):
        half = 0.5 * elements.thickness[k]
        axis.fill(*(1e3 * piece(elements, k, -half, half)).T, facecolor=wall, edgecolor=wall, linewidth=0.3)
    beneath: list[Inlay] = []
    for side, colour in zip(SIDES, PALETTE[:2], strict=True):
        inlays = [group.inlay(0.0, 1.0) for group in config.patches.groups(side)]
        _draw_patches(axis, elements, side, inlays, colour, extent, beneath)
        beneath = inlays
    for name, (x, y), sign in (
        ("tension centre", found.tension_centre, "+"),
        ("shear centre", found.shear_centre, "x"),
        ("mass centre", found.mass_centre, "o"),
    ):
        axis.plot(1e3 * x, 1e3 * y, sign, color=THEMES[theme]["ink"], markerfacecolor="none", markersize=7, label=name)
    axis.set(xlabel="x, along the chord, mm", ylabel="y, mm", aspect="equal")


def _draw_patches(
    axis: Any, elements: Mesh, side: str, inlays: list[Inlay], colour: str, extent: float, beneath: list[Inlay]
) -> None:
    """Of those that lie where some of ``beneath`` do, at another station, the half that is nearer to the face."""
    label: str | None = side
    for inlay in inlays:
        for k, edge in enumerate(elements.edges):
            if not edge.lies_under(inlay):
                continue
            low, high = inlay.depths(float(elements.thickness[k]))
            if (least := THINNEST * extent) > high - low:  # on a face it grows away from the wall, in a wall into it
                low, high = (low, low + least) if inlay.bonded == (inlay.face == "outer") else (high - least, high)
            if any(other.face == inlay.face and edge.lies_under(other) for other in beneath):
                low, high = (0.5 * (low + high), high) if inlay.face == "outer" else (low, 0.5 * (low + high))
            axis.fill(*(1e3 * piece(elements, k, low, high)).T, facecolor=colour, edgecolor=colour, linewidth=0.3, label=label)
            label = None


def piece(elements: Mesh, k: int, low: float, high: float) -> Array:
    """(4, 2), m: an element of the first size between two distances from the mid-line."""
    P, d, Q, e = elements.points[0, k], elements.directions[0, k], elements.last_points[0, k], elements.last_directions[0, k]
    return np.array([P + low * d, Q + low * e, Q + high * e, P + high * d])


def _shape(elements: Mesh) -> tuple[float, float]:
    wide, high = np.ptp(elements.points[0], axis=0) + elements.thickness.max()
    return WIDTH, float(np.clip(WIDTH * high / wide, 1.2, 6.0)) + 1.4
