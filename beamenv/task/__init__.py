"""What an environment and a training have in common: the blade, the scenario, the plants, and what a step takes and tells."""

from beamenv.task.arguments import checked_action, checked_dtype, checked_task
from beamenv.task.information import INFO, STEADY_INFO, information, steady_information
from beamenv.task.reset import reset_options
from beamenv.task.resolve import DesignArgument, resolve_task
from beamenv.task.task import DType, Task

__all__ = [
    "INFO",
    "STEADY_INFO",
    "DType",
    "DesignArgument",
    "Task",
    "checked_action",
    "checked_dtype",
    "checked_task",
    "information",
    "reset_options",
    "resolve_task",
    "steady_information",
]
