"""The lines across walls that carry a section's displacements: which of them each element has, and which follow others.

On a line displacements are Legendre's polynomials through the wall. A line that lies along an element's face, a *joint*, takes the
displacements of that face, those it can: of polynomials along the face the part up to its own order.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed, sealed
from beamenv.structure.section.elements import ACROSS, inverse_vandermonde
from beamenv.structure.section.mesh import Mesh

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

PER_LINE = 3 * (ACROSS + 1)
"""Displacements on a line across the wall."""


@dataclass(frozen=True, slots=True, eq=False)
class Lines(Sealed):
    """Those between elements come first, then those inside, element after element, then joints."""

    of_elements: Indices
    """(K, order + 1)."""
    between: int
    """How many lie between elements or at loose ends."""
    free: int
    """How many are no joints."""
    hosts: Indices
    """(H,): elements that joints lie on; the lines inside stay in the equations."""
    faces: Indices
    """(J, order + 1): the lines that each joint follows."""
    shares: Array
    """(J, ACROSS + 1, order + 1, ACROSS + 1): its polynomials from theirs."""

    @classmethod
    def of(cls, mesh: Mesh) -> Lines:
        """Those of a mesh."""
        elements, inside = len(mesh.edges), mesh.order - 1
        free = mesh.count + elements * inside
        ends = np.where(mesh.lines < mesh.count, mesh.lines, mesh.lines - mesh.count + free)
        inner = mesh.count + np.arange(elements * inside).reshape(elements, inside)
        of_elements = np.concatenate([ends[:, :1], inner, ends[:, 1:]], axis=1)
        values = inverse_vandermonde(mesh.order)[0]
        degree, kept = np.arange(ACROSS + 1), min(mesh.order, ACROSS) + 1
        shares = np.zeros((len(mesh.joints), ACROSS + 1, mesh.order + 1, ACROSS + 1))
        for k, joint in enumerate(mesh.joints):
            turned = joint.sense ** degree[:kept, None] * values[:kept]
            shares[k, :kept] = turned[:, :, None] * joint.side**degree
        hosts = np.array(mesh.hosts, dtype=np.intp)
        on = np.array([joint.element for joint in mesh.joints], dtype=np.intp)
        return cls(of_elements, mesh.count, free, hosts, of_elements[on], sealed(shares))

    def gather(self, lines: Array) -> Array:
        """(V, K, size, c): displacements of each element from those of the free lines (V, lines, 12, c)."""
        every = np.concatenate([lines, self.following(lines)], axis=1) if len(self.faces) else lines
        return every[:, self.of_elements].reshape(len(lines), len(self.of_elements), -1, lines.shape[-1])

    def following(self, lines: Array) -> Array:
        """(V, J, 12, c): displacements of the joints."""
        faces = lines[:, self.faces].reshape(len(lines), *self.faces.shape, ACROSS + 1, 3, -1)
        moved = np.einsum("jqip,vjipxc->vjqxc", self.shares, faces, optimize=True)
        return moved.reshape(len(lines), len(self.faces), PER_LINE, -1)

    @property
    def solved(self) -> Indices:
        """(L,): the lines that the equations are of: all but those inside elements that are no hosts."""
        return np.concatenate([np.arange(self.between), self.of_elements[self.hosts, 1:-1].ravel()])

    @property
    def places(self) -> Indices:
        """(lines,): where each line is among ``solved`` and, after them, joints; −1 for the others."""
        solved, every = self.solved, self.free + len(self.faces)
        places = np.full(every, -1, dtype=np.intp)
        places[solved] = np.arange(len(solved))
        places[self.free :] = len(solved) + np.arange(len(self.faces))
        return places

    @property
    def follow(self) -> Array:
        """(12 J, 12 L): displacements of joints from those of the lines solved for."""
        there = self.places[self.faces]
        matrix = np.zeros((len(self.faces), ACROSS + 1, 3, len(self.solved), ACROSS + 1, 3))
        for joint, lines in enumerate(there):
            for axis in range(3):
                matrix[joint, :, axis, lines, :, axis] += self.shares[joint].swapaxes(0, 1)
        return matrix.reshape(len(self.faces) * PER_LINE, len(self.solved) * PER_LINE)
