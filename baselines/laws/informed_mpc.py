"""Model-predictive control for a scenario: within the drive limits, and told of its delay, as ``informed_lqg`` is."""

from __future__ import annotations

from baselines.design.objects import instance
from baselines.laws.detuned_lqg import detuned_design
from baselines.laws.foreseen_load import foreseen_loads
from baselines.laws.informed_lqg import chosen_detuning
from baselines.laws.mpc import PredictiveController, predictive
from beamenv.knowledge import Prior


def informed_mpc(prior: Prior) -> PredictiveController:
    """The predictive controller ``mpc`` with the delay, weights and loads that the rule of ``informed_lqg`` chooses.

    As long as its plan meets no limit it is ``informed_lqg``, with a filter that takes clipping into account. Raises
    ``ValueError`` for what is no ``Prior``, and ModuleNotFoundError without DAQP.
    """
    prior = instance("prior", prior, Prior, "a beamenv.Prior, such as env.unwrapped.task.prior")
    detuning, plant = chosen_detuning(prior), prior.blade.truth
    design = detuned_design(plant, detuning, *foreseen_loads(prior.scenario, prior.blade.config.speed, plant.loads))
    return predictive(plant, "informed MPC", design, detuning.delay)
