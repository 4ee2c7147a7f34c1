"""What a controller may be told before it acts, tier by tier: each has an object that holds just that, and what lower ones hold.

0, the nominal plant: ``Design``. 1, the scenario's distribution: ``Prior``. 2, the same, and further measurements than the sensors'
beside each reading, such as the rotor's speed. 3, the truth: ``Truth``, and each episode's own, which no real blade tells.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.blade.design import Design
from beamenv.configuration import Count, Instance, checked
from beamenv.plant.plant import Plant
from beamenv.scenarios.named import UNSEEN
from beamenv.scenarios.scenario import SCENARIOS, Scenario
from beamenv.simulation.blades import Blades
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.plants.banks import build_bank
from beamenv.simulation.signals.faults import DRAWS, Faults, Onsets, draw_faults, draw_onsets, fault_draws
from beamenv.titles import TIERS as TIERS

TRUTH = 3
"""The tier that is no rival but a reference."""

TUNING = 2_000_000
"""The first seed of the episodes that laws are tuned in: they are compared from 1 000 000 on, and chosen from 3 000 000 on."""


class Hypotheses(NamedTuple):
    """What may be the case in an episode, H times, each as likely as any other."""

    plant: NDArray[np.int64]
    """(H,) places in the bank; of plants that change within an episode, those of its middle."""
    faults: Faults
    onsets: Onsets | None
    """When they set in; None where it is at the start."""


@dataclass(frozen=True, eq=False, repr=False)
class Prior:
    """The scenario's distribution: the design, kinds and ranges of faults, and blades to try controllers on.

    Their plants come from the training bank, a Latin hypercube of another seed than that of the bank that controllers are compared
    on and of that on which they are chosen, and their episodes from seeds from ``TUNING`` on: neither is ever met in either place.
    """

    blade: Blade
    """The blade that plants depart from: the true one, or the design's where the truth is kept for judging."""
    design_blade: Blade
    scenario: Scenario
    """With the seed of the training bank."""
    steps: int
    """Control intervals in an episode."""

    def __post_init__(self) -> None:
        """``ValueError`` for what is no blade, no scenario or no number of steps."""
        for name, kind in (("blade", Blade), ("design_blade", Blade), ("scenario", Scenario)):
            checked(f"prior.{name}", getattr(self, name), Instance(kind))
        object.__setattr__(self, "steps", checked("prior.steps", self.steps, Count()))

    def __repr__(self) -> str:
        return f"Prior({self.steps} steps; training bank of seed {self.scenario.plants.seed})"

    @property
    def design(self) -> Design:
        """What a controller of tier 0 is told."""
        return Design.of(self.design_blade)

    @cached_property
    def bank(self) -> Bank:
        """The training bank."""
        return build_bank(self.blade, self.design_blade, self.scenario.plants, self.steps)

    def hypotheses(self, count: int) -> Hypotheses:
        """``count`` of them, drawn as the episodes of tuning draw theirs."""
        failures = self.scenario.failures
        generators, walk = self.generators(checked("count", count, Count())), self.bank.walk
        uniforms = np.stack([each.random(fault_draws(failures)) for each in generators])
        m, p = self.blade.truth.B.shape[1], len(self.blade.truth.C)
        drawn = len(self.bank) > 1 and not self.bank.runs
        place = (uniforms[:, 0] * len(self.bank)).astype(np.int64) if drawn else np.zeros(len(uniforms), dtype=np.int64)
        if walk is not None:
            courses = walk.courses(np.stack([each.random(walk.draws) for each in generators]))
            place = walk.places(courses, np.full(len(courses), self.steps // 2))
        begins = draw_onsets(failures, self.bank.plant.scenario_interval, uniforms[:, DRAWS:]) if failures.drawn_instants else None
        return Hypotheses(place, draw_faults(failures, self.scenario.drive.delay, uniforms, m, p), begins)

    def generators(self, count: int) -> list[np.random.Generator]:
        """Of the first ``count`` episodes of tuning: one for each blade, as environments make them of a seed."""
        return [np.random.default_rng(TUNING + k) for k in range(count)]

    def blades(self, count: int) -> Blades:
        """So many blades with plants and faults of the training bank, in normalised units."""
        return Blades(self.bank, self.scenario, checked("count", count, Count()))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Truth:
    """All that is true of a task: the plants that episodes draw from, and the scenario they draw by."""

    design: Design
    """What a controller of tier 0 is told."""
    config: BladeConfig
    """Of the true blade."""
    bank: Bank
    scenario: Scenario
    steps: int
    """Control intervals in an episode."""

    @property
    def plant(self) -> Plant:
        """The true plant, or the one that all drawn ones depart from."""
        return self.bank.plant

    def check_state_told(self) -> None:
        """``ValueError`` where the true state cannot be told to a controller in the coordinates of its design."""
        if self.bank.to_design is None:
            why = "each of the plants has its own" if self.design.config is None else "their trial functions differ"
            raise ValueError(f"the true blade's state cannot be told in the design's coordinates: {why}.")

    def __repr__(self) -> str:
        return f"Truth({self.steps} steps; {self.bank!r})"


def on_training_bank(scenario: Scenario) -> Scenario:
    """The scenario with plants drawn from another bank than the one that controllers are compared on."""
    return _on_bank(scenario, 1)


def on_validation_bank(scenario: Scenario) -> Scenario:
    """The scenario with plants drawn from a third bank, that of the episodes which choose."""
    return _on_bank(scenario, 2)


def on_recording_bank(scenario: Scenario) -> Scenario:
    """The scenario with plants drawn from a fourth bank, that of episodes recorded for offline learning: no controller is told
    them.
    """
    return _on_bank(scenario, 3)


def _on_bank(scenario: Scenario, further: int) -> Scenario:
    return replace(scenario, plants=replace(scenario.plants, seed=scenario.plants.seed + further))


def kept_for_judging(scenario: Scenario) -> bool:
    """Whether nobody is told of it: a plant file moves, or it is one of ``UNSEEN``."""
    return scenario.plants.truth is not None or any(scenario == SCENARIOS[name] for name in UNSEEN)


def without_faults(scenario: Scenario) -> Scenario:
    """The scenario's loads on the blade as it was designed, with nothing known to be wrong on the way to it and back."""
    return replace(
        scenario, plants=_NOTHING.plants, drive=_NOTHING.drive, acquisition=_NOTHING.acquisition, failures=_NOTHING.failures
    )


_NOTHING = Scenario()
