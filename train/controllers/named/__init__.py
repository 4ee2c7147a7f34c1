"""The controllers that agents are compared with, a file each: a file put into this folder is a controller of its name.

Such a module has a ``KIND``, one of ``KINDS``, a ``TIER`` of information, and ``build(known)``, which returns the controller and is
given what that tier knows and no more: a ``beamenv.Design`` at 0, a ``beamenv.Prior`` at 1 and 2, the ``Truth`` at 3
(``beamenv.knowledge``). It may have ``suits(scenario)``: false where the controller has nothing to do; and ``check(known)``, which
says beforehand, as a ``ValueError`` of one sentence, why there is no such controller. ``lqg_load.py`` is called "lqg-load".
"""

from __future__ import annotations

import pkgutil
from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass
from importlib import import_module
from types import MappingProxyType
from typing import Any

from baselines import Controller, Law
from baselines.design.controller import LEAST_TIER
from beamenv.configuration import Count, Refused, checked
from beamenv.configuration.near import meant
from beamenv.scenarios.scenario import Scenario
from beamenv.task import Task, checked_task
from beamenv.titles import TIERS
from train.controllers.known import FORMER
from train.controllers.shipped import recipes, shipped_agents

KINDS = ("fixed", "scheduled", "adaptive", "predictive")
"""Linear laws that stay as they were designed; laws that follow the rotor's speed or the time; laws that find out what is the case;
laws that solve a program at every instant."""


def any_scenario(scenario: Scenario) -> bool:
    """Whether a controller that says nothing else has something to do in a scenario: always."""
    return True


def nothing_asked(known: Any) -> None:
    """Of a controller that asks for nothing in particular."""


@dataclass(frozen=True, slots=True)
class NamedController:
    """A controller by its short name. Raises ValueError for a kind that is not in ``KINDS`` and a tier that is none."""

    name: str
    kind: str
    build: Callable[[Any], Controller]
    """From what its tier is told."""
    tier: int = 0
    """Of information, in ``beamenv.titles.TIERS``."""
    suits: Callable[[Scenario], bool] = any_scenario
    """Whether it is meant for a scenario: the benchmark leaves out the others."""
    check: Callable[[Any], None] = nothing_asked
    """``ValueError`` where what its tier is told has not what it asks for; at once, and not of all that may go wrong."""
    title: str = ""
    """In a line: the first of its file."""

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise Refused(f"{self.name}.KIND", self.kind, f"one of {', '.join(KINDS)}")
        checked(f"{self.name}.TIER", self.tier, Count(0, max(TIERS)))

    def check_for(self, task: Task) -> None:
        """``ValueError`` where it is clear before anything is built that there is no such controller for a task."""
        self.check(checked_task(task).told(self.tier))

    def build_for(self, task: Task) -> Controller:
        """The controller for a task, in its units and called by its short name, built from what its tier is told.

        Raises ``ValueError`` for one that observes what its tier does not see.
        """
        law = self.build(checked_task(task).told(self.tier))
        observes = getattr(law, "observes", "observation")
        least = LEAST_TIER.get(observes, 0)
        if least > self.tier:
            raise Refused(f"{self.name}.TIER", self.tier, f"at least {least} for what observes the {observes}")
        if not isinstance(law, Law):
            return law
        return called(law.in_physical_units() if task.physical_units else law, self.name)


def called(law: Law, name: str) -> Law:
    """The same law under another name; a copy, for some take long to be made once more."""
    same = copy(law)
    object.__setattr__(same, "name", name)
    return same


def discover() -> Mapping[str, NamedController]:
    """Every controller in the folder by its name, in alphabetical order; ``ValueError`` for a file that lacks what it must have."""
    found = {}
    for module in sorted(pkgutil.iter_modules(__path__), key=lambda each: each.name):
        name = module.name.replace("_", "-")
        content = import_module(f"{__name__}.{module.name}")
        if missing := [wanted for wanted in ("KIND", "TIER", "build") if not hasattr(content, wanted)]:
            raise ValueError(
                f"controller file {module.name + '.py'!r} has no {missing[0]}, but must have KIND, TIER and build(known)."
            )
        optional = getattr(content, "suits", any_scenario), getattr(content, "check", nothing_asked)
        title = (content.__doc__ or "").strip().partition("\n")[0]
        found[name] = NamedController(name, content.KIND, content.build, content.TIER, *optional, title)
    return MappingProxyType(found)


def named(name: str) -> NamedController:
    """A controller by its short name; ``ValueError`` lists the known ones, and who has a name like it, agents that ship as well."""
    known = discover()
    name = FORMER.get(name, name) if isinstance(name, str) else name
    if not isinstance(name, str) or name not in known:
        ids = shipped_agents()
        agents = {short: f"{each}, an agent that ships" for short, each in [*recipes(ids).items(), *zip(ids, ids, strict=True)]}
        raise Refused("controller", name, f"one of {', '.join(known)}", meant(name, [*known, *agents], agents))
    return known[name]
