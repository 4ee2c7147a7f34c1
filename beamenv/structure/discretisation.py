"""How a blade's fields are made along the span: of polynomials over all of it, Galerkin's way, or of finite elements."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from beamenv.configuration import Choice, Count, Number, Numbers, Refused, check_heeded
from beamenv.configuration.heeded import Heeded
from beamenv.structure.line_elements import ElementSpace
from beamenv.structure.span_mesh import NEAREST, even_mesh, given_mesh

DISCRETISATION = Choice(("galerkin", "finite-elements"))
ELEMENTS = Count(1, 100)
ELEMENT_ORDER = Count(2, 6)
MESH = Numbers(Number(ge=0.0, le=1.0), least=2, most=101, of="shares of the span")

DEFAULT_ELEMENTS, DEFAULT_ORDER = 12, 4

MOST = 400
"""Elements times order: so many are solved as dense matrices within half a minute and 2 GB."""

_GALERKIN, _ELEMENTS = ("galerkin",), ("finite-elements",)
_HEEDED: Heeded = (
    ("terms", "discretisation", _GALERKIN),
    ("elements", "discretisation", _ELEMENTS),
    ("element_order", "discretisation", _ELEMENTS),
    ("mesh", "discretisation", _ELEMENTS),
)


def check_discretisation(table: Any) -> None:
    """``Refused`` where options of a blade's discretisation do not go together, or a mesh does not ascend from clamp to tip."""
    check_heeded(table, _HEEDED)
    order = table.element_order or DEFAULT_ORDER
    if (table.elements or 0) * order > MOST:
        raise Refused("elements", table.elements, f"at most {MOST // order} of order {order}")
    if table.mesh is None:
        return
    if (len(table.mesh) - 1) * order > MOST:
        raise Refused("mesh", table.mesh, f"at most {MOST // order} elements of order {order}")
    if table.elements is not None:
        raise Refused("elements", table.elements, "left out beside mesh")
    if table.mesh[0] != 0.0 or table.mesh[-1] != 1.0 or np.any(np.diff(table.mesh) < NEAREST):
        raise Refused("mesh", table.mesh, f"shares of the span that ascend from 0 to 1, by {NEAREST:g} or more")


def element_space(blade: Any, edges: Sequence[float], reach: float, **sections: bool) -> ElementSpace:
    """The finite elements that a blade asks for, with ends at ``edges`` (m)."""
    if blade.mesh is not None:
        nodes = given_mesh(blade.length, edges, blade.mesh)
    else:
        nodes = even_mesh(blade.length, edges, blade.elements or DEFAULT_ELEMENTS, reach)
    return ElementSpace(blade.length, nodes, blade.element_order or DEFAULT_ORDER, **sections)
