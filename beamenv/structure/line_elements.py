"""Finite elements along the span, of any order: Lagrange's, which go on from one to the next, and Hermite's, whose slopes do too.

A field that the energies bend, whose second derivative they have, is of Hermite elements one order above the others: its slope is
then of the order of a section's rotation, which it can follow exactly, however slender the blade. Eigenvalues converge with the
2p-th power of an element's length, p being the order of Lagrange's elements (Strang and Fix, An Analysis of the Finite Element
Method, 1973, theorem 6.1).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from beamenv.configuration.read_only import sealed
from beamenv.structure.inlays import SHORTEST
from beamenv.structure.section.elements import inverse_vandermonde
from beamenv.structure.span_space import SpanSpace, Table
from beamenv.structure.stations import Stations
from beamenv.structure.trial_functions import legendre_derivative

Array = NDArray[np.float64]

BENT = {"thesis": ("u", "v", "phi"), "rigid": ("u", "v"), "blade": ()}
"""Fields whose second derivatives are strains, in the thesis' model, and in the blade's where sections do not shear or do."""

EXTRA_POINTS = 2
"""Gauss stations of an element beyond its order: products of two functions are integrated exactly, and with them four further
orders of what varies along the element."""


class Elements(NamedTuple):
    """A kind of elements, as ``ElementSpace.table`` has it."""

    bent: bool
    """Hermite's, not Lagrange's."""
    held: int
    """1: zero at the clamp; 2: without slope there too."""


@dataclass(frozen=True, slots=True)
class ElementSpace(SpanSpace):
    """Fields of finite elements between nodes on the span."""

    length: float
    nodes: tuple[float, ...]
    """m, ascending from the clamp, 0, to the tip: ends of elements."""
    element_order: int
    """Of Lagrange's elements, p; Hermite's are of p + 1."""
    rigid: bool
    warping: bool = False
    plane: bool = False

    held: ClassVar[float] = 1e-12
    """Of functions that vary within a short element, and so the stiffer."""

    @property
    def elements(self) -> int:
        """How many."""
        return len(self.nodes) - 1

    @property
    def order(self) -> int:
        """That of the elements."""
        return self.element_order

    @property
    def amplitude_terms(self) -> int:
        """Those of a field of Lagrange's elements."""
        return self.count(AMPLITUDE)

    def kind(self, field: str) -> Elements:
        """By the derivatives that the energies have of it."""
        model = "thesis" if not self.warping else "rigid" if self.rigid else "blade"
        bent = field in BENT[model]
        return Elements(bent, self.root_order(field) if bent else 1)

    def count(self, kind: Elements) -> int:
        """Those that the clamp does not hold at zero."""
        return self.elements * self.order + 1 + kind.bent - kind.held

    def table(self, z: Array, kind: Elements) -> Table:
        """Values and first two derivatives (stations, functions)."""
        ends = np.array(self.nodes)
        at = np.clip(np.searchsorted(ends, z, side="right") - 1, 0, self.elements - 1)
        half = 0.5 * (ends[at + 1] - ends[at])[:, None]
        share = (z - ends[at])[:, None] / half - 1.0
        coefficients = _hermite(self.order + 1) if kind.bent else inverse_vandermonde(self.order)[0]
        unit = np.where(_slopes(self.order) if kind.bent else False, half / self.length, 1.0)
        columns = at[:, None] * self.order + np.arange(coefficients.shape[1])
        rows = legendre.legvander(share[:, 0], len(coefficients) - 1)
        derive, tables = legendre_derivative(len(coefficients)), []
        for power in range(3):
            table = np.zeros((len(z), self.elements * self.order + 1 + kind.bent))
            np.put_along_axis(table, columns, unit * (rows @ coefficients) / half**power, axis=1)
            tables.append(table[:, kind.held :])
            rows = rows @ derive
        value, first, second = tables
        return value, first, second

    def amplitude_table(self, z: Array) -> tuple[Array, Array]:
        """Of Lagrange's elements, zero at the clamp."""
        value, slope, _ = self.table(z, AMPLITUDE)
        return value, slope

    def stations(self, breakpoints: Array, points: int, graded: bool = False) -> Stations:
        """On every piece between ends of elements too, as many as the elements need."""
        inside = [node for node in self.nodes if breakpoints[0] < node < breakpoints[-1]]
        ends = np.unique([*breakpoints, *inside])
        apart = np.append(True, np.diff(ends) > SHORTEST * self.length)
        return Stations.between(ends[apart], self.order + 1 + EXTRA_POINTS)


AMPLITUDE = Elements(bent=False, held=1)
"""Elements of the amplitudes of sections' shapes."""


def _slopes(order: int) -> NDArray[np.bool_]:
    """(order + 2,): which functions of a Hermite element are slopes at its ends."""
    found = np.zeros(order + 2, dtype=bool)
    found[[1, -1]] = True
    return found


@lru_cache
def _hermite(order: int) -> Array:
    """(order + 1, order + 1): Legendre coefficients of an element's functions on −1 … 1.

    Value and slope at the begin, bubbles (1 − ξ²)² P_j, value and slope at the end.
    """
    ends = np.array([-1.0, 1.0])
    value, slope = legendre.legvander(ends, 3), legendre.legvander(ends, 3) @ legendre_derivative(4)
    cubics = np.zeros((order + 1, 4))
    cubics[:4] = np.linalg.inv(np.stack([value[0], slope[0], value[1], slope[1]]))
    flat = legendre.legmul([2.0 / 3.0, 0.0, -2.0 / 3.0], [2.0 / 3.0, 0.0, -2.0 / 3.0])
    bubbles = [legendre.legmul(flat, np.eye(order)[j]) for j in range(order - 3)]
    inside = np.array([np.pad(each, (0, order + 1 - len(each))) for each in bubbles]).reshape(-1, order + 1).T
    return sealed(np.hstack([cubics[:, :2], inside, cubics[:, 2:]]))
