"""What a controller may be built from: the blade as its designer believes it to be."""

from __future__ import annotations

from dataclasses import dataclass

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.configuration import Instance, checked
from beamenv.plant.plant import Plant


@dataclass(frozen=True, slots=True, eq=False)
class Design:
    """The design plant and what it was built from; the blade that really turns may be another one, which is not in here."""

    plant: Plant
    """Of the design's ``modes`` modes, without electronics."""
    config: BladeConfig

    def __post_init__(self) -> None:
        checked("design.plant", self.plant, Instance(Plant))
        checked("design.config", self.config, Instance(BladeConfig))

    @property
    def full_plant(self) -> Plant:
        """All that is known of the design blade: every mode up to the Nyquist frequency, or as many as the scenario's designers may
        know, and the electronics. Built anew when asked for.
        """
        return Blade(self.config).truth
