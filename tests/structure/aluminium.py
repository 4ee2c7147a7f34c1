"""Walls of aluminium, and what their sections are worth."""

from beamenv.structure import (
    Lamina,
    Layup,
)

E, NU, DENSITY = 70e9, 0.3, 2700.0
G = E / (2.0 * (1.0 + NU))
ALUMINIUM = Layup.uniform(Lamina.isotropic(E, NU, DENSITY), [0.0])


def classical(section, layup=ALUMINIUM):
    return section.properties(layup).classical_stiffness
