"""What functions along the span the fields of a blade are made of: whatever these are, the same energies are integrated."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused, Texts, checked
from beamenv.structure.stations import Stations

Array = NDArray[np.float64]
Table = tuple[Array, Array, Array]
"""Values and first two derivatives (stations, functions) along the span."""

FIELDS = ("u", "v", "s", "theta_x", "theta_y", "phi")
"""Lag, flap, arc-length stretch, section rotations about x and y, twist."""

MOTIONS = {"lag": ("u", "theta_y"), "flap": ("v", "theta_x"), "extension": ("s",), "twist": ("phi",)}
"""The fields of each family of motion: a bending displacement with its section rotation."""

ROOT_ORDER = {"u": 2, "v": 2, "phi": 2, "s": 1, "theta_x": 1, "theta_y": 1}
"""The power of z with which a field leaves the clamp: 2 where its slope vanishes there too."""


class SpanSpace(ABC):
    """Functions along the span of which every field is made; fields of one kind have the same.

    In rigid theory the section rotations are no fields of their own: θy = u', θx = −v'.
    """

    __slots__ = ()

    length: float
    """m."""
    rigid: bool
    warping: bool
    """Whether sections warp at will and shear, so that no slope need vanish at the clamp."""
    plane: bool
    """Whether sections stay plane in torsion, so that the clamp holds no warping back."""
    held: ClassVar[float]
    """Share of the energy of the stiffest amplitude's function that every one is given, next to nothing."""

    @abstractmethod
    def kind(self, field: str) -> Any:
        """What ``table`` calls the functions of a field."""

    @abstractmethod
    def table(self, z: Array, kind: Any) -> Table:
        """Values and first two derivatives (stations, functions) of a kind of functions."""

    @abstractmethod
    def amplitude_table(self, z: Array) -> tuple[Array, Array]:
        """Values and slopes (stations, amplitude_terms) of the functions that the amplitudes of sections' shapes have."""

    @abstractmethod
    def count(self, kind: Any) -> int:
        """How many functions of a kind there are."""

    @property
    @abstractmethod
    def amplitude_terms(self) -> int:
        """How many functions the amplitude of each shape has."""

    @property
    @abstractmethod
    def order(self) -> int:
        """Stations that the functions need on the whole of a piece, or of the span, beside those for the blade's own changes."""

    @abstractmethod
    def stations(self, breakpoints: Array, points: int, graded: bool = False) -> Stations:
        """Stations on every piece between ascending breakpoints (m), ``points`` where functions go over the whole span."""

    def root_order(self, field: str) -> int:
        """The power of z with which a field leaves the clamp."""
        bends = field in ("u", "v") and self.rigid
        free = self.warping or (field == "phi" and self.plane)
        return ROOT_ORDER[field] if bends or not free else 1

    @property
    def fields(self) -> tuple[str, ...]:
        """Fields that have coefficients of their own, in the order of the coefficient vector."""
        return tuple(name for name in FIELDS if not (self.rigid and name.startswith("theta")))

    @property
    def size(self) -> int:
        """Number of coefficients."""
        return sum(self.count(self.kind(name)) for name in self.fields)

    def blocks(self) -> dict[str, slice]:
        """Where the coefficients of each field are."""
        ends = np.cumsum([0, *(self.count(self.kind(name)) for name in self.fields)]).tolist()
        return {name: slice(*ends[k : k + 2]) for k, name in enumerate(self.fields)}

    def columns(self, motions: tuple[str, ...] | None) -> NDArray[np.intp]:
        """Indices of the coefficients that belong to ``motions`` (None: all)."""
        if motions is not None and not set(checked("motions", motions, Texts()) or ("none",)) <= set(MOTIONS):
            raise Refused("motions", motions, f"a list of one or more of {', '.join(MOTIONS)}")
        wanted = FIELDS if motions is None else [name for motion in motions for name in MOTIONS[motion]]
        return np.concatenate([np.arange(block.start, block.stop) for name, block in self.blocks().items() if name in wanted])

    def evaluate(self, z: Array) -> dict[tuple[str, int], Array]:
        """Rows (stations, size) that give each field's derivative: keys (field, order), orders 0, 1, 2."""
        blocks = self.blocks()
        tables = {kind: self.table(z, kind) for kind in {self.kind(name) for name in blocks}}
        rows: dict[tuple[str, int], Array] = {}
        for name, block in blocks.items():
            for order in range(3):
                row = np.zeros((len(z), self.size))
                row[:, block] = tables[self.kind(name)][order]
                rows[name, order] = row
        if self.rigid:
            for order in range(2):
                rows["theta_y", order] = rows["u", order + 1]
                rows["theta_x", order] = -rows["v", order + 1]
        return rows
