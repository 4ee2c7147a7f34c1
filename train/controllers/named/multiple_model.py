"""An LQG with load estimate for each thing that may be the case in the scenario, weighed by what is read (Magill 1965)."""

from baselines import Controller, multiple_model, reference_lqg
from beamenv import Prior
from train.controllers.hypotheses import hypotheses_of, switches

KIND = "adaptive"
TIER = 1


def build(prior: Prior) -> Controller:
    """Over the scenario's plants, delays and faults, and the reference LQG where none of them fits."""
    hypotheses = hypotheses_of(prior)
    return multiple_model(hypotheses, reference_lqg(prior.blade.truth), transition=switches(prior, hypotheses))
