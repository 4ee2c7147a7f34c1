"""Classical controllers of the blade, and the evaluation that every controller goes through."""

from baselines.controller import Controller, LinearController
from baselines.episodes import Episodes, roll_out
from baselines.evaluation import Estimate, Evaluation, evaluate
from baselines.lqg import lqg
from baselines.lqr import lqr
from baselines.metrics import EpisodeMetrics
from baselines.mpc import PredictiveController, mpc
from baselines.no_control import no_control
from baselines.persistent_load import PersistentLoad
from baselines.stationary import closed_loop_poles, stationary_cost
from baselines.velocity_feedback import velocity_feedback

__all__ = [
    "Controller",
    "Episodes",
    "EpisodeMetrics",
    "Estimate",
    "Evaluation",
    "LinearController",
    "PersistentLoad",
    "PredictiveController",
    "closed_loop_poles",
    "evaluate",
    "lqg",
    "lqr",
    "mpc",
    "no_control",
    "roll_out",
    "stationary_cost",
    "velocity_feedback",
]
