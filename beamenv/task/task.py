"""What an environment is made of: the blades, the scenario, their plants, and the spaces."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.clamp import clamp_note
from beamenv.blade.config import BladeConfig
from beamenv.blade.design import Design
from beamenv.blade.model_blade import ModelBlade
from beamenv.configuration import Count, checked
from beamenv.knowledge import TIERS, TRUTH, Prior, Truth, kept_for_judging, on_training_bank, without_faults
from beamenv.plant.plant import Plant
from beamenv.plant.spread import Spread
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.plants.banks import build_bank
from beamenv.task.sharing import shared

Array = NDArray[np.float64]

DType = Literal["float32", "float64"]
"""Numbers of the spaces, and of what is in them; a batch may be stepped with as many bits."""


@dataclass(frozen=True)
class Task:
    """What an environment is made of, its arguments checked and resolved.

    It owns its blades, with their plants, and its bank: each is built when it is first asked for. ``dataclasses.replace`` gives a
    task that shares the blades that are not replaced.
    """

    blade: Blade
    """The true blade: what moves."""
    design_blade: Blade
    """The blade that controllers are designed for; the true one unless said otherwise."""
    scenario: Scenario
    steps: int
    """Control intervals in an episode."""
    physical_units: bool
    told_scenario: Scenario | None = None
    """What controllers are told of where plants are of another bank than that of the scenario they are for; None: ``scenario``."""

    @property
    def config(self) -> BladeConfig:
        """Of the true blade."""
        return self.blade.config

    @property
    def design_config(self) -> BladeConfig:
        """Of the blade that controllers are designed for."""
        return self.design_blade.config

    @property
    def plant(self) -> Plant:
        """The true plant: what moves."""
        return self.blade.truth

    @property
    def design_plant(self) -> Plant:
        """The plant that controllers are designed for: the design blade's, of its ``modes`` modes and without electronics."""
        return self.design_blade.plant

    @property
    def design(self) -> Design:
        """What a controller of tier 0 may be built from (``beamenv.knowledge``)."""
        return Design.of(self.design_blade)

    @cached_property
    def prior(self) -> Prior:
        """What a controller of tier 1 may be built from."""
        known = self.scenario if self.told_scenario is None else self.told_scenario
        if kept_for_judging(known):
            own = self._as_designed
            return Prior(own, own, on_training_bank(without_faults(known)), self.steps)
        return Prior(self.blade, self.design_blade, on_training_bank(known), self.steps)

    @property
    def _as_designed(self) -> Blade:
        """The design blade alone, which may have a plant file's modes."""
        if isinstance(self.design_blade, ModelBlade):
            return replace(self.design_blade, spread=Spread(), others=())
        return shared(Blade(self.design_config))

    @property
    def truth(self) -> Truth:
        """What a controller of tier 3 may be built from."""
        return Truth(self.design, self.config, self.bank, self.scenario, self.steps)

    def told(self, tier: int) -> Design | Prior | Truth:
        """What a controller of that tier may be built from, and no more; ``ValueError`` for a tier that is not in ``TIERS``."""
        tier = checked("tier", tier, Count(0, max(TIERS)))
        return self.design if tier == 0 else self.truth if tier == TRUTH else self.prior

    @cached_property
    def bank(self) -> Bank:
        """The true plants that episodes draw from."""
        return build_bank(self.blade, self.design_blade, self.scenario.plants, self.steps)

    def on_other_plants(self, scenario: Scenario) -> Task:
        """The task in the same scenario on another bank of plants, with controllers told no more and nothing else than here."""
        return replace(self, scenario=scenario, told_scenario=self.told_scenario or self.scenario)

    @property
    def note(self) -> str:
        """What is to be said of where the true blade's patches are; empty if nothing is."""
        return "" if isinstance(self.blade, ModelBlade) else clamp_note(self.config)

    @property
    def identity(self) -> BladeConfig | str:
        """What the true blade is, for comparisons: its configuration, or the fingerprints of a model of one's own."""
        return self.blade.identity if isinstance(self.blade, ModelBlade) else self.config

    def action_space(self, dtype: DType = "float32") -> Box:
        """Voltages, normalised or in V."""
        lowest, highest = self.plant.voltage_limits
        one = np.ones_like(lowest)
        return _box(lowest, highest, dtype) if self.physical_units else _box(-one, one, dtype)

    def observation_space(self, dtype: DType = "float32") -> Box:
        """Sensor readings, normalised or in A."""
        high = self.plant.sensor_full_scale if self.physical_units else np.ones_like(self.plant.sensor_full_scale)
        return _box(-high, high, dtype)


def _box(low: Array, high: Array, dtype: DType) -> Box:
    return Box(low.astype(dtype), high.astype(dtype), dtype=np.dtype(dtype).type)
