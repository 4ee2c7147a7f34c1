"""What decides an episode besides its seed and the controller: two runs are in pairs only where it is the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from baselines.evaluation.loop import Environment, attribute
from beamenv.blade.config import BladeConfig
from beamenv.scenarios.scenario import Scenario
from beamenv.task import Task


@dataclass(frozen=True, slots=True)
class Conditions:
    """Of the episodes of N seeds. What controllers are designed for is none of them: without control nobody knows it."""

    blades: tuple[BladeConfig | str, ...]
    """The true blade of each seed; of a model of one's own its fingerprints."""
    interval: float
    """s, of control."""
    scenario: Scenario
    steps: int
    """Control intervals in a whole episode."""
    physical_units: bool

    def and_then(self, others: Conditions) -> Conditions:
        """Those of these seeds and of others that the same environment ran after them."""
        return replace(self, blades=self.blades + others.blades)

    def check(self, reference: Conditions | None) -> None:
        """``ValueError`` says in what those of a ``reference`` differ from these."""
        if reference is None:
            raise ValueError("reference is of an environment that does not tell its blade: leave it out.")
        for what, other, own in (
            ("control intervals of (s)", reference.interval, self.interval),
            ("control intervals in an episode", reference.steps, self.steps),
            ("physical_units", reference.physical_units, self.physical_units),
        ):
            if other != own:
                raise ValueError(f"reference has {what} {other}, but the evaluation has {own}.")
        for what, same in (("scenario", reference.scenario == self.scenario), ("blade", reference.blades == self.blades)):
            if not same:
                raise ValueError(f"reference is of another {what}, but must be of the very episodes of the evaluation.")


def conditions(env: Environment, seeds: int) -> Conditions | None:
    """Those of an environment that has been reset for so many seeds, one a blade; None if it is not of this package."""
    tasks = tasks_of(env)
    if not tasks:
        return None
    each = [tasks[row % len(tasks)] for row in range(seeds)]
    interval = tasks[0].plant.control_interval
    return Conditions(tuple(task.identity for task in each), interval, tasks[0].scenario, steps(env), tasks[0].physical_units)


def check_alike(env: Environment) -> None:
    """``ValueError`` says in what the blades of a batch differ that must be equal in one evaluation."""
    tasks = tasks_of(env)
    if len(tasks) < 2:
        return
    specs: Sequence[Any] = attribute(env, "spec")
    limits = [spec.max_episode_steps for spec in specs if spec is not None] if len(specs) == len(tasks) else []
    for what, values in (
        ("scenario", [task.scenario for task in tasks]),
        ("duration", [task.steps for task in tasks]),
        ("max_episode_steps", limits),
        ("physical_units", [task.physical_units for task in tasks]),
        ("control_interval", [task.plant.control_interval for task in tasks]),
        ("voltage_limits", [task.plant.voltage_limits.tolist() for task in tasks]),
    ):
        if other := next((k for k, value in enumerate(values) if value != values[0]), 0):
            raise ValueError(
                f"env has blades that differ in their {what}: blade {other} has another than blade 0, but one evaluation is of "
                "one kind of episode; evaluate each kind in an environment of its own."
            )


def steps(env: Environment) -> int:
    """Control intervals in a whole episode: the task's, or fewer by a time limit; 0 where no task tells."""
    if not (tasks := tasks_of(env)):
        return 0
    limits = [tasks[0].steps, getattr(env.unwrapped, "steps", None)]
    limits += [spec.max_episode_steps for spec in (env.spec, *attribute(env, "spec")) if spec is not None]
    return min(limit for limit in limits if limit is not None)


def tasks_of(env: Environment) -> Sequence[Task]:
    """Blade k of the environment has that at k modulo their number; none of an environment that is not of this package."""
    inner: Any = env.unwrapped
    found = getattr(inner, "tasks", None) or (
        attribute(env, "task") if hasattr(inner, "get_attr") or hasattr(inner, "task") else ()
    )
    return found if all(isinstance(task, Task) for task in found) else ()
