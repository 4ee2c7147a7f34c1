"""Classical controllers of the blade, and the evaluation that every controller goes through."""

from baselines.analysis.frequency_response import h_infinity_norm
from baselines.analysis.margins import StabilityMargins, stability_margins
from baselines.analysis.small_gain import small_gain
from baselines.analysis.stationary import closed_loop_poles, stationary_cost
from baselines.design.adapting import AdaptiveNeural
from baselines.design.controller import Controller
from baselines.design.hypothesis import Hypothesis
from baselines.design.instruments import Instruments
from baselines.design.law import Law
from baselines.design.linear import LinearController
from baselines.design.persistent_load import PersistentLoad
from baselines.design.weighing import MultipleModel
from baselines.evaluation.episodes import Episodes, roll_out
from baselines.evaluation.evaluate import Evaluation, evaluate
from baselines.evaluation.metrics import EpisodeMetrics
from baselines.evaluation.statistics import Estimate
from baselines.identification.files import read_measurement
from baselines.identification.identified import Identified
from baselines.identification.identify import identify
from baselines.identification.measurement import Measurement
from baselines.laws.adaptive_neural import AdaptationSettings, adaptive_neural
from baselines.laws.clairvoyant_lqg import ClairvoyantLQG, clairvoyant_lqg
from baselines.laws.clipped_lqg import ClippedLQG, clipped_lqg
from baselines.laws.detuned_lqg import Detuning, detuned_lqg
from baselines.laws.h_infinity import h_infinity
from baselines.laws.informed_lqg import informed_lqg
from baselines.laws.informed_mpc import informed_mpc
from baselines.laws.inverse_hysteresis import InverseHysteresis, inverse_hysteresis
from baselines.laws.lqg import lqg
from baselines.laws.lqr import lqr
from baselines.laws.mpc import PredictiveController, mpc
from baselines.laws.multiple_model import multiple_model
from baselines.laws.no_control import no_control
from baselines.laws.positive_position_feedback import positive_position_feedback
from baselines.laws.reference_lqg import full_order_lqg, reference_lqg
from baselines.laws.robust_lqg import robust_lqg
from baselines.laws.rotor_lqg import RotorHarmonics, rotor_lqg
from baselines.laws.scheduled_lqg import ScheduledLQG, scheduled_lqg, scheduled_lqg_for
from baselines.laws.spin_up_lqg import SpinUpLQG, spin_up_lqg
from baselines.laws.velocity_feedback import velocity_feedback

__all__ = [
    "AdaptationSettings",
    "AdaptiveNeural",
    "ClairvoyantLQG",
    "ClippedLQG",
    "Controller",
    "Detuning",
    "Episodes",
    "EpisodeMetrics",
    "Estimate",
    "Evaluation",
    "Hypothesis",
    "Identified",
    "Instruments",
    "InverseHysteresis",
    "Law",
    "LinearController",
    "Measurement",
    "MultipleModel",
    "PersistentLoad",
    "PredictiveController",
    "RotorHarmonics",
    "SpinUpLQG",
    "ScheduledLQG",
    "StabilityMargins",
    "adaptive_neural",
    "clairvoyant_lqg",
    "clipped_lqg",
    "closed_loop_poles",
    "detuned_lqg",
    "evaluate",
    "full_order_lqg",
    "h_infinity",
    "h_infinity_norm",
    "identify",
    "informed_lqg",
    "informed_mpc",
    "inverse_hysteresis",
    "lqg",
    "lqr",
    "mpc",
    "multiple_model",
    "no_control",
    "positive_position_feedback",
    "read_measurement",
    "reference_lqg",
    "robust_lqg",
    "roll_out",
    "rotor_lqg",
    "spin_up_lqg",
    "scheduled_lqg",
    "scheduled_lqg_for",
    "small_gain",
    "stability_margins",
    "stationary_cost",
    "velocity_feedback",
]
