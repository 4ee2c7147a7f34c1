"""LQG with the loads to be expected in the scenario, followed by the inverse of the actuators' hysteresis."""

from baselines import Controller, full_order_lqg, inverse_hysteresis
from baselines.laws.foreseen_load import foreseen_loads
from beamenv import Prior

KIND = "fixed"
TIER = 1


def build(prior: Prior) -> Controller:
    """Told the loop; where there is none, the LQG alone."""
    loads = foreseen_loads(prior.scenario, prior.blade.config.speed, prior.blade.truth.loads)
    law = full_order_lqg(prior.blade.truth, load=loads)
    return inverse_hysteresis(law, prior.scenario.drive.hysteresis)
