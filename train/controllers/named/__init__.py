"""The controllers that agents are compared with, a file each: a file put into this folder is a controller of its name.

Such a module has a ``KIND``, one of ``KINDS``, and ``build(design)``, which returns the controller. A ``beamenv.Design`` is the
design plant and its configuration: no controller knows what the true blade is like. ``lqg_load.py`` is called "lqg-load".

A bound may say ``TOLD_THE_TRUTH = True``: its ``build`` is given the true plant and its configuration instead.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from types import MappingProxyType

from baselines import Controller, Law
from beamenv import Design
from beamenv.configuration import Refused
from beamenv.task import Task, checked_task

KINDS = ("fixed", "scheduled", "predictive", "bound")
"""Linear laws that stay as they were designed; laws that follow the rotor's speed; laws that solve a program at every instant;
and those that see the true state or know the true plant, which no real blade offers: bounds, not rivals."""


@dataclass(frozen=True, slots=True)
class NamedController:
    """A controller by its short name. Raises ValueError for a kind that is not in ``KINDS`` and for a rival told the truth."""

    name: str
    kind: str
    build: Callable[[Design], Controller]
    told_the_truth: bool = False
    """Whether it is built from the true plant."""

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise Refused(f"{self.name}.KIND", self.kind, f"one of {', '.join(KINDS)}")
        if self.told_the_truth and self.kind != "bound":
            raise Refused(f"{self.name}.TOLD_THE_TRUTH", True, "False for what is no bound")

    def build_for(self, task: Task) -> Controller:
        """The controller for a task, in its units: from its design, unless it is told the truth."""
        checked_task(task)
        law = self.build(task.true_design if self.told_the_truth else task.design)
        return law.in_physical_units() if task.physical_units and isinstance(law, Law) else law


def discover() -> Mapping[str, NamedController]:
    """Every controller in the folder by its name, in alphabetical order; ``ValueError`` for a file that lacks what it must have."""
    found = {}
    for module in sorted(pkgutil.iter_modules(__path__), key=lambda each: each.name):
        name = module.name.replace("_", "-")
        content = import_module(f"{__name__}.{module.name}")
        if missing := [wanted for wanted in ("KIND", "build") if not hasattr(content, wanted)]:
            raise ValueError(f"controller file {module.name + '.py'!r} has no {missing[0]}, but must have KIND and build(design).")
        found[name] = NamedController(name, content.KIND, content.build, getattr(content, "TOLD_THE_TRUTH", False))
    return MappingProxyType(found)


def named(name: str) -> NamedController:
    """A controller by its short name; ``ValueError`` lists the known ones."""
    known = discover()
    if not isinstance(name, str) or name not in known:
        raise Refused("controller", name, f"one of {', '.join(known)}, or the folder of a trained agent")
    return known[name]
