"""Which controllers the table lists: those with a name, trained agents, and what the caller brings along."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from pathlib import Path
from typing import Any

from baselines.design.controller import as_controller
from beamenv.configuration import FileName, Refused, checked
from beamenv.configuration.near import meant
from beamenv.scenarios.scenario import Scenario
from train.controllers.ids import folder_id
from train.controllers.known import FORMER
from train.controllers.models import UNTRUSTED
from train.controllers.named import KINDS, any_scenario, discover
from train.controllers.runs import runs_in
from train.controllers.shipped import FOLDER, Shipped, shipped_agents
from train.controllers.shipped import GENERALIST as GENERALIST
from train.controllers.sources import Classical, Given, ModelFile, Source, Trained
from train.controllers.tiers import LEARNT as LEARNT
from train.controllers.tiers import own_tier, told_tier
from train.learning.recipes import title

ORDER = (*KINDS, "learned", "own")
"""Kinds, as tables and figures order them."""

INDISPENSABLE = ("none", "lqg")
"""What every cost is relative to, and what everyone is compared with in pairs."""


@dataclass(frozen=True, slots=True, eq=False)
class ListedController:
    """A controller of the table, with its training runs if it has learned."""

    name: str
    kind: str
    tier: int
    """Of information: what it was built from and what it sees, in ``beamenv.titles.TIERS``."""
    everywhere: Mapping[str, Source] = field(default_factory=dict)
    """Runs by name that are put into every scenario."""
    only_in: Mapping[str, Mapping[str, Source]] = field(default_factory=dict)
    """Runs by scenario, of a specialist."""
    suits: Callable[[Scenario], bool] = any_scenario
    """Whether it has something to do in a scenario."""
    at_most: int | None = None
    """How many of an agent's runs take part, if not all of them."""
    title: str = ""
    """In a line; empty of what a caller brings along."""

    def runs(self, name: str, scenario: Scenario) -> Mapping[str, Source]:
        """Those in a scenario of this name, none if it has nothing to do there."""
        found = (self.everywhere or self.only_in.get(name, {})) if self.suits(scenario) else {}
        return dict(islice(found.items(), self.at_most))

    def first(self, runs: int | None) -> ListedController:
        """The same with so many of its runs, the first ones; all of them if None, or if there are no more."""
        most = max(map(len, (self.everywhere, *self.only_in.values())))
        return self if runs is None or runs >= most else replace(self, at_most=runs)


def listed_controllers(
    controllers: Sequence[str] | None, own: Mapping[str, Any], models: Sequence[Path], trusted: bool, trained: Path = FOLDER
) -> list[ListedController]:
    """Everyone named, all controllers and shipped agents if ``controllers`` is None, and what the caller brings.

    A name may also be the folder of a trained agent, or of its runs: a name that is known comes first.
    No control and LQG are always among them. Raises ValueError for an unknown name, two of one name, an object without
    ``predict``, and models that nobody vouches for.
    """
    if models and not trusted:
        raise ValueError(UNTRUSTED)
    classical = [
        ListedController(name, each.kind, each.tier, {"": Classical(each)}, suits=each.suits, title=each.title)
        for name, each in discover().items()
    ]
    known = {each.name: each for each in [*classical, *agents(trained)]}
    asked = () if controllers is None else (FORMER.get(name, name) for name in controllers)
    names = list(known) if controllers is None else list(dict.fromkeys([*INDISPENSABLE, *asked]))
    known |= {name: of_folder(Path(name)) for name in names if name not in known and os.path.isdir(name)}
    if unknown := [name for name in names if name not in known]:
        others = f"one of {', '.join(known)}, or the folder of a trained agent"
        raise Refused("controller", unknown[0], others, meant(unknown[0], known))
    brought = [ListedController(name, "own", own_tier(each), {"": _given(name, each)}) for name, each in own.items()]
    brought += [ListedController(checked("model", path.stem, FileName()), "own", LEARNT, {"": ModelFile(path)}) for path in models]
    chosen = [*(known[name] for name in names), *brought]
    if doubled := [each.name for index, each in enumerate(chosen) if each.name in {other.name for other in chosen[:index]}]:
        raise ValueError(f"controller {doubled[0]!r} is there twice: give yours another name.")
    return sorted(chosen, key=lambda each: place(each.tier, each.kind))


def of_folder(folder: Path, tier: int | None = None) -> ListedController:
    """The agent in a folder, with all runs that lie there, by the folder's id.

    Its tier is ``tier``, or else what its own file tells, or else ``LEARNT``. ``ValueError`` of one sentence if there is no agent,
    and for a ``tier`` below what its file tells.
    """
    name, places = checked("controller", folder_id(folder), FileName()), runs_in(folder)
    told = max((each for place in places.values() if (each := told_tier(place)) is not None), default=None)
    if tier is not None and told is not None and tier < told:
        raise Refused("tier", tier, f"at least {told}, as the agent in {str(folder)!r} says of itself")
    known = (LEARNT if told is None else told) if tier is None else tier
    return ListedController(name, "learned", known, {run: Trained(place) for run, place in places.items()})


def place(tier: int, kind: str) -> tuple[int, int]:
    """By which tables and figures order controllers: by what they know, and then by kind."""
    return tier, ORDER.index(kind)


def _given(name: str, controller: Any) -> Given:
    checked("own", name, FileName())
    try:
        return Given(as_controller(controller))
    except ValueError:
        raise ValueError(
            f"controller {name!r} is of type {type(controller).__name__}, but must have Stable-Baselines3's predict, or be a "
            "function of the readings (N, p)."
        ) from None


def agents(folder: Path) -> list[ListedController]:
    """The trained agents in a folder: of each the generalist and the specialists, with all their training runs."""
    return [
        ListedController(
            each.id,
            "learned",
            LEARNT,
            _sources(each.everywhere),
            {scenario: _sources(runs) for scenario, runs in each.only_in.items()},
            title=title(each.id, each.title),
        )
        for each in shipped_agents(folder).values()
    ]


def _sources(runs: Mapping[int, Shipped]) -> dict[str, Source]:
    return {str(seed): Trained(run.folder) for seed, run in runs.items()}
