"""What every environment of this package tells of its task: the plants, and all that a controller may be built from."""

from __future__ import annotations

from beamenv.blade.design import Design
from beamenv.plant.plant import Plant
from beamenv.task import Task


class OfTask:
    """An environment with a ``task``."""

    task: Task

    @property
    def plant(self) -> Plant:
        """The true plant, the one that moves."""
        return self.task.plant

    @property
    def design_plant(self) -> Plant:
        """The plant controllers are to be designed for, of few modes and without electronics."""
        return self.task.design_plant

    @property
    def design(self) -> Design:
        """All that a controller may be built from: ``design.full_plant`` has every mode that is known and the electronics."""
        return self.task.design
