"""What a controller may be built from: the blade as its designer believes it to be."""

from __future__ import annotations

from dataclasses import dataclass

from beamenv.blade.config import BladeConfig
from beamenv.plant.plant import Plant


@dataclass(frozen=True, slots=True, eq=False)
class Design:
    """The design plant and what it was built from; the blade that really turns may be another one, which is not in here."""

    plant: Plant
    config: BladeConfig
