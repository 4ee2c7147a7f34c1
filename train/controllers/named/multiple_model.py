"""One LQG with load estimate for each case that is possible in the scenario, weighed by the readings (Magill 1965)."""

from baselines import Controller, multiple_model
from baselines.laws.detuned_lqg import CAUTIOUS, detuned_lqg
from baselines.laws.reference_lqg import RATE_WEIGHT
from beamenv import Prior
from train.controllers.hypotheses import BETWEEN, are_drawn, hypotheses_of, switches

KIND = "adaptive"
TIER = 1


def build(prior: Prior) -> Controller:
    """Over the scenario's plants, delays and faults, and the cautious LQG where none fits; in single precision, for speed."""
    hypotheses, fallback = hypotheses_of(prior), detuned_lqg(prior.blade.truth, CAUTIOUS, name="cautious LQG")
    rate_weight = BETWEEN if are_drawn(prior) else RATE_WEIGHT
    law = multiple_model(hypotheses, fallback, transition=switches(prior, hypotheses), rate_weight=rate_weight)
    return law.in_single_precision()
