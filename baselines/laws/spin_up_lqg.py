"""LQG along a spin-up that is known beforehand: the gains of every instant's own plant, by Riccati recursions over the episode."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from baselines.design.controller import Array
from baselines.design.instruments import Instruments
from baselines.design.objects import instance
from baselines.laws.time_varying_lqg import TimeVaryingLQG
from beamenv.knowledge import Prior
from beamenv.scenarios.tables import PlantVariation


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SpinUpLQG(TimeVaryingLQG):
    """The optimum over an episode under white noise, for a blade that follows the planned spin-up; it sees only the readings."""

    def told(self, seen: Array) -> tuple[Array, Array]:
        """Of every blade that it is the first of the bank, or spins up along it, with the mean delay and nothing broken."""
        m, p = self._plan.sizes[1:]
        delay = round(sum(self.known.scenario.drive.delay) / 2.0)
        return seen, np.tile([0.0, delay, *np.ones(m + p), *np.zeros(p)], (len(seen), 1))


def spin_up_lqg(prior: Prior) -> SpinUpLQG:
    """LQG with the gains of a linear time-varying plant (Kwakernaak and Sivan, Linear Optimal Control Systems, 1972, sections 3.3,
    4.3 and 5.3), for scenarios whose rotor spins up or down on a course that is known.

    Along the spin-up each interval has its own plant, and the filter starts from what the start of the spin-up itself excites. If
    the rotor does not spin up, all intervals have the plant that the scenario's plants vary about; the gains then only know when
    episodes begin and end. The controller knows nothing of other plants that the scenario draws, or of faults. Since the loop ends
    with the episode, only the existence of the recursions' solutions is verified. Raises ``ValueError`` for what is no ``Prior``.
    """
    prior = instance("prior", prior, Prior, "a beamenv.Prior, such as env.unwrapped.task.prior")
    if prior.scenario.plants.spin_up is None:
        prior = replace(prior, scenario=replace(prior.scenario, plants=PlantVariation()))
    return SpinUpLQG("spin-up LQG", Instruments.of(prior.bank.plant), prior)
