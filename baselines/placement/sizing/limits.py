"""What patches may be: the sizes they are cut to, how many, and the budget that they are bought from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from baselines.placement.sizing.sheets import SizeGrid, Span, cut_to
from beamenv.blade.config import BladeConfig
from beamenv.configuration import Count, Number, Numbers, Refused, configuration
from beamenv.patches.group import PatchGroup
from beamenv.patches.layout import SIDES
from beamenv.structure import RotatingBeam
from beamenv.structure.section.mesh import mesh
from beamenv.structure.walls.inlay import Strip

Array = NDArray[np.float64]

Range = Annotated[tuple[float, float] | None, Numbers(Number(gt=0.0, unit="m"), 2, 2)]

SPREAD = (0.5, 2.0)
"""Shares of the blade's own sizes between which patches are cut unless said otherwise."""

NODES = (3, 3)
"""Widths and thicknesses at which sections are computed: what is in between costs what sections of its own do within 10⁻⁴."""

WIDEST = 4.0
"""Times the blade's own width or thickness, up and down: as far as that holds."""

TRIED = 61
"""Widths of a sheet from half to twice the blade's own that are tried beside webs and corners: 2.5 % of it apart."""

MOST = Count(1, 8)


@configuration("sizes")
class Sizes:
    """Least and largest sizes, m, and the greatest numbers of patches; None: half to twice the blade's own, and as many."""

    length: Range = None
    width: Range = None
    thickness: Range = None
    actuators: Annotated[int | None, MOST] = None
    sensors: Annotated[int | None, MOST] = None

    def __post_init__(self) -> None:
        for name in ("length", "width", "thickness"):
            given = getattr(self, name)
            if given is not None and given[0] > given[1]:
                raise Refused(f"sizes.{name}", given, "the least first, then the largest (m)")


@configuration("budget")
class Budget:
    """What may be spent; None: as much as the sizes allow."""

    mass: Annotated[float | None, Number(gt=0.0, unit="kg")] = None
    """kg of piezo sheet, actuators and sensors."""
    channels: Annotated[int | None, Count()] = None
    """Voltages, one for each actuator."""
    power: Annotated[float | None, Number(gt=0.0, unit="W")] = None
    """W: Σ ½CV²f of the actuators at their voltage limit."""
    frequency: Annotated[float | None, Number(gt=0.0, unit="Hz")] = None
    """f in Hz; None: that of the bare blade's first mode."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Sizes of one blade's patches, in numbers."""

    counts: tuple[int, int]
    """The greatest numbers of actuators and of sensors."""
    end: float
    """m: where the last patch ends at most."""
    length: Span
    widths: tuple[Span, Span]
    thicknesses: tuple[Span, Span]
    """m, of the actuators and of the sensors."""

    @classmethod
    def of(cls, config: BladeConfig, sizes: Sizes, channels: int | None) -> Limits:
        """Those of a blade; ``ValueError`` for sheets that do not fit its walls, and for patches that do not fit its span."""
        groups = config.patches.pair()
        end = groups[0].outermost * config.beam.length
        length = sizes.length or spread(groups[0].length, end)
        counts = tuple(given or group.count for given, group in zip((sizes.actuators, sizes.sensors), groups, strict=True))
        if not length[0] <= length[1] <= end:
            raise Refused("sizes.length", list(length), f"at most the {end:.6g} m that patches may lie on")
        bare = config.beam.build(model=config.model)
        widths, thicknesses = [], []
        for group in groups:
            widths.append(sizes.width or free_widths(bare, group))
            thick = np.inf if group.bonded else 0.5 * bare.section.thickness_of(group.wall)
            thicknesses.append(sizes.thickness or spread(group.patch.thickness, thick))
            near("width", widths[-1], group.width)
            near("thickness", thicknesses[-1], group.patch.thickness)
            for at in (1, 0):
                sheet = cut_to(group.patch, thicknesses[-1][at])
                where = group.offset, group.face, group.bonded
                bare.room.check_fit(sheet.inlay(group.wall, 0.0, length[at], widths[-1][at], *where))
        allowed = min(counts[0], channels or counts[0]), counts[1]
        return cls(allowed, end, length, (widths[0], widths[1]), (thicknesses[0], thicknesses[1]))

    def grids(self, config: BladeConfig) -> tuple[SizeGrid, SizeGrid]:
        """Where sections are computed: over these sizes and the blade's own."""
        groups = config.patches.pair()
        above, below = (
            SizeGrid(around(self.widths[k], each.width), around(self.thicknesses[k], each.patch.thickness), NODES)
            for k, each in enumerate(groups)
        )
        return above, below

    @property
    def least_sizes(self) -> Array:
        """(4,), m: width and thickness of the actuators, then of the sensors."""
        return np.array([self._size(k, 0) for k in range(4)])

    @property
    def largest_sizes(self) -> Array:
        """(4,), m."""
        return np.array([self._size(k, 1) for k in range(4)])

    def _size(self, index: int, end: int) -> float:
        return (self.widths, self.thicknesses)[index % 2][index // 2][end]

    @property
    def side_of(self) -> NDArray[np.intp]:
        """(E,): 0 of every actuator, 1 of every sensor."""
        return np.repeat(np.arange(len(SIDES)), self.counts)


def spread(own: float, room: float) -> Span:
    """Half to twice a size, as far as there is room."""
    return min(SPREAD[0] * own, room), max(min(SPREAD[1] * own, room), own if own <= room else room)


def near(name: str, span: Span, own: float) -> None:
    """``ValueError`` for sizes too far from the blade's own."""
    low, high = own / WIDEST, own * WIDEST
    if span[0] < low * (1.0 - 1e-9) or span[1] > high * (1.0 + 1e-9):
        raise Refused(f"sizes.{name}", list(span), f"between {low:.4g} and {high:.4g} m, a quarter and four times the blade's own")


def around(span: Sequence[float], own: float) -> Span:
    """The range with a value."""
    return min(span[0], own), max(span[1], own)


def free_widths(bare: RotatingBeam, group: PatchGroup) -> Span:
    """Half to twice the blade's own width, m, as far as its wall is wide and no edge comes to a web or a corner."""
    wall = float(bare.room.narrowest * max(bare.section.wall_width(group.wall) - 2.0 * abs(group.offset), 0.0))
    least, most = spread(group.width, wall)
    tried = np.linspace(least, most, TRIED).tolist()
    met = [number for number, width in enumerate(tried) if not _lies_free(bare, group, width)]
    below = [number for number in met if tried[number] < group.width]
    above = [number for number in met if tried[number] > group.width]
    first, last = below[-1] + 1 if below else 0, above[0] - 1 if above else TRIED - 1
    return tried[min(first, last)], tried[last]


def _lies_free(bare: RotatingBeam, group: PatchGroup, width: float) -> bool:
    """Whether the edges of a sheet so wide keep away from webs and corners, at both ends of the blade."""
    sizes = np.unique([bare.narrowest, 1.0])
    try:
        mesh(bare.section.placed_chains, sizes, (Strip(group.wall, width, group.offset),), np.ones(len(sizes), dtype=bool))
    except Refused:
        return False
    return True
