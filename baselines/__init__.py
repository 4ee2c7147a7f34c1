"""Classical controllers of the blade, and the evaluation that every controller goes through."""

from baselines.controller import Controller, LinearController
from baselines.lqg import lqg
from baselines.lqr import lqr
from baselines.no_control import no_control
from baselines.persistent_load import PersistentLoad
from baselines.stationary import closed_loop_poles, stationary_cost
from baselines.velocity_feedback import velocity_feedback

__all__ = [
    "Controller",
    "LinearController",
    "PersistentLoad",
    "closed_loop_poles",
    "lqg",
    "lqr",
    "no_control",
    "stationary_cost",
    "velocity_feedback",
]
