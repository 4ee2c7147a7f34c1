"""Classical controllers of the blade, and the evaluation that every controller goes through."""

from baselines.clipped_lqg import ClippedLQG, clipped_lqg
from baselines.controller import Controller, LinearController
from baselines.episodes import Episodes, roll_out
from baselines.evaluation import Estimate, Evaluation, evaluate
from baselines.frequency_response import h_infinity_norm
from baselines.h_infinity import h_infinity
from baselines.lqg import lqg
from baselines.lqr import lqr
from baselines.margins import StabilityMargins, stability_margins
from baselines.metrics import EpisodeMetrics
from baselines.mpc import PredictiveController, mpc
from baselines.no_control import no_control
from baselines.persistent_load import PersistentLoad
from baselines.positive_position_feedback import positive_position_feedback
from baselines.rotor_lqg import RotorHarmonics, rotor_lqg
from baselines.scheduled_lqg import ScheduledLQG, scheduled_lqg, scheduled_lqg_for
from baselines.stationary import closed_loop_poles, stationary_cost
from baselines.velocity_feedback import velocity_feedback

__all__ = [
    "ClippedLQG",
    "Controller",
    "Episodes",
    "EpisodeMetrics",
    "Estimate",
    "Evaluation",
    "LinearController",
    "PersistentLoad",
    "PredictiveController",
    "RotorHarmonics",
    "ScheduledLQG",
    "StabilityMargins",
    "clipped_lqg",
    "closed_loop_poles",
    "evaluate",
    "h_infinity",
    "h_infinity_norm",
    "lqg",
    "lqr",
    "mpc",
    "no_control",
    "positive_position_feedback",
    "roll_out",
    "rotor_lqg",
    "scheduled_lqg",
    "scheduled_lqg_for",
    "stability_margins",
    "stationary_cost",
    "velocity_feedback",
]
