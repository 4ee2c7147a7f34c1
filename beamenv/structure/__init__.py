"""Structural mechanics of rotating thin-walled composite blades (thesis chapters 2 and 3)."""

from beamenv.structure.beam import RotatingBeam
from beamenv.structure.modes import Modes
from beamenv.structure.section.airfoil import AirfoilSection
from beamenv.structure.section.closed_sections import BoxSection, PolygonSection, TubeSection
from beamenv.structure.section.open_sections import CSection, ISection, StripSection, WallsSection, ZSection
from beamenv.structure.section.properties import SectionProperties
from beamenv.structure.section.section import Section
from beamenv.structure.section.webs import Web
from beamenv.structure.walls.graded import FunctionallyGraded
from beamenv.structure.walls.inlay import Inlay
from beamenv.structure.walls.laminate import Laminate, Layup, Ply
from beamenv.structure.walls.materials import Lamina
from beamenv.structure.walls.named import ALUMINIUM, AS4_3501_6, GRAPHITE_EPOXY

__all__ = [
    "ALUMINIUM",
    "AS4_3501_6",
    "GRAPHITE_EPOXY",
    "AirfoilSection",
    "BoxSection",
    "CSection",
    "FunctionallyGraded",
    "ISection",
    "Inlay",
    "Lamina",
    "Laminate",
    "Layup",
    "Modes",
    "Ply",
    "PolygonSection",
    "RotatingBeam",
    "Section",
    "SectionProperties",
    "StripSection",
    "TubeSection",
    "WallsSection",
    "Web",
    "ZSection",
]
