"""What of a benchmark can be had of a model of one's own; what cannot is told in one sentence each, and is no failure."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from beamenv.plant.fingerprint import fingerprint
from beamenv.scenarios.of_models import fits_models
from beamenv.scenarios.scenario import Scenario
from beamenv.task import Task, resolve_task
from train.benchmark.listed import ListedController
from train.controllers.policy_files import read_about
from train.controllers.sources import Classical, Source, Trained

OF_BLADES = "they are of the rotor, the plies, the modes or a plant file of a blade, none of which a model of one's own has."
OF_OTHERS = "their training was on other plants."


@dataclass(frozen=True, slots=True)
class Applicable:
    """The rest, once what cannot be had is taken away."""

    tasks: Mapping[str, Task]
    """Of the scenarios that can be had, by name."""
    without: Mapping[tuple[str, str], str]
    """Why not, by scenario and controller."""
    sentences: tuple[str, ...]
    """One for each reason."""


def applicable(
    scenarios: Mapping[str, Scenario],
    listed: Sequence[ListedController],
    environment: Mapping[str, Any],
    asked: Collection[str] = (),
) -> Applicable:
    """What can be had of the model that is the "plant" of the ``environment``.

    ``ValueError`` says why not, where a scenario or controller is ``asked`` for by its name and cannot be had at all.
    """
    known = {name: _task(environment, name, each, asked) for name, each in scenarios.items()}
    tasks = {name: each for name, each in known.items() if isinstance(each, Task)}
    if not tasks:
        raise ValueError(next(str(each) for each in known.values()))
    without = {
        (name, each.name): why
        for name, task in tasks.items()
        for each in listed
        if (why := _why_not(each.runs(name, scenarios[name]).values(), task))
    }
    gone = {each.name: why for each in listed if (why := _everywhere(each, scenarios, tasks, without))}
    for name, why in gone.items():
        if name in asked:
            raise ValueError(why if why != OF_OTHERS else f"controller {name!r} cannot be had of this plant: {why}")
    apart = {name: str(each) for name, each in known.items() if not isinstance(each, Task)}
    partly = {f"{name} in {place}": why for (place, name), why in without.items() if name not in gone}
    return Applicable(tasks, without, (*_told("scenarios", apart), *_told("controllers", {**gone, **partly})))


def _task(environment: Mapping[str, Any], name: str, scenario: Scenario, asked: Collection[str]) -> Task | str:
    """The task, or why there is none."""
    given = {key: value for key, value in environment.items() if key != "max_episode_steps"}
    try:
        return resolve_task(**given, scenario=scenario)
    except ValueError as error:
        if name in asked:
            raise ValueError(f"scenario {name!r} cannot be had of this plant: {error}") from None
        return str(error) if fits_models(scenario) else OF_BLADES


def _why_not(runs: Collection[Source], task: Task) -> str:
    """Why no run of a controller can be had; empty where one can, or only trying shows it."""
    reasons = [_reason(each, task) for each in runs]
    return reasons[0] if reasons and all(reasons) else ""


def _reason(source: Source, task: Task) -> str:
    if isinstance(source, Trained):
        plants = read_about(source.folder).get("plants")
        known = isinstance(plants, Mapping) and fingerprint(task.design_plant) not in plants.values()
        return OF_OTHERS if known else ""
    if isinstance(source, Classical):
        try:
            source.controller.check_for(task)
        except ValueError as error:
            return str(error)
    return ""


def _everywhere(
    listed: ListedController,
    scenarios: Mapping[str, Scenario],
    tasks: Mapping[str, Task],
    without: Mapping[tuple[str, str], str],
) -> str:
    """Why a controller can be had in no scenario; empty where it can, or has nothing to do in any of them."""
    meant = [name for name in tasks if listed.runs(name, scenarios[name])]
    reasons = [without.get((name, listed.name), "") for name in meant]
    return reasons[0] if reasons and all(reasons) else ""


def _told(what: str, reasons: Mapping[str, str]) -> Iterator[str]:
    """A sentence for each reason."""
    for why in dict.fromkeys(reasons.values()):
        names = [name for name, each in reasons.items() if each == why]
        yield f"{what if len(names) > 1 else what.removesuffix('s')} {', '.join(names)} left out: {why}"
