"""What a controller may be built from: the blade as its designer believes it to be."""

from __future__ import annotations

from dataclasses import dataclass

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.blade.model_blade import ModelBlade
from beamenv.configuration import Instance, Refused, checked
from beamenv.plant.plant import Plant


@dataclass(frozen=True, slots=True, eq=False)
class Design:
    """The design plant and the blade that it was built from. The blade that really turns may differ, and is not part of this."""

    plant: Plant
    """Of the design's ``modes`` modes, without electronics."""
    config: BladeConfig | None
    """None of a model of one's own, which is no blade."""

    def __post_init__(self) -> None:
        checked("design.plant", self.plant, Instance(Plant))
        if self.config is not None:
            checked("design.config", self.config, Instance(BladeConfig))

    @classmethod
    def of(cls, blade: Blade) -> Design:
        """That of a blade, or of what is in its place."""
        return cls(blade.plant, None if isinstance(blade, ModelBlade) else blade.config)

    @property
    def full_plant(self) -> Plant:
        """All that is known of the design blade: every mode up to the Nyquist frequency, or as many as the scenario's designers may
        know, and the electronics. Built anew when asked for. A model of one's own is all that is known.
        """
        return self.plant if self.config is None else Blade(self.config).truth

    def blade_config(self, of: str) -> BladeConfig:
        """The configuration, for what a controller needs it ``of``; ``ValueError`` where the plant is a model that has none."""
        if self.config is None:
            raise ValueError(
                f"plant is a model of one's own, but {of} asks for a blade: choose another controller or give a blade."
            )
        return self.config

    def turning_config(self, of: str) -> BladeConfig:
        """As ``blade_config``; ``ValueError`` where the blade does not turn, too."""
        config = self.blade_config(of)
        if config.speed == 0.0:
            raise Refused("blade.speed", config.speed, f"above 0 (rad/s) for {of}, which asks for a rotor")
        return config
