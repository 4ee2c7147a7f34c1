"""Sections by the name of their shape."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from beamenv.structure.section.airfoil import AirfoilSection
from beamenv.structure.section.closed_sections import BoxSection, PolygonSection, TubeSection
from beamenv.structure.section.open_sections import CSection, ISection, StripSection, WallsSection, ZSection
from beamenv.structure.section.section import Section

AnySection = (
    BoxSection | TubeSection | PolygonSection | AirfoilSection | StripSection | ISection | CSection | ZSection | WallsSection
)

SHAPES: Mapping[str, type[Section]] = MappingProxyType(
    {
        "box": BoxSection,
        "tube": TubeSection,
        "polygon": PolygonSection,
        "airfoil": AirfoilSection,
        "strip": StripSection,
        "i": ISection,
        "c": CSection,
        "z": ZSection,
        "walls": WallsSection,
    }
)
