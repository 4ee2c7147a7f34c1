"""The command ``beamenv train``."""

from __future__ import annotations

import math
import shlex
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from beamenv.configuration import FileName, Number, Refused, checked
from beamenv.scenarios.named import UNSEEN
from train.cli.names import check_device, check_name, check_names, check_scenario, check_table
from train.cli.options import (
    BladeOption,
    ClusterOption,
    JobsOption,
    JsonOption,
    PlantOption,
    PresetOption,
    SpeedOption,
    complain,
    environment_arguments,
    one_sentence,
    overwriting,
    print_json,
    same_command,
    say,
    working,
)
from train.cli.train_options import (
    AgentsArgument,
    DeviceOption,
    FolderOption,
    LooksOption,
    MinutesOption,
    RecipeOption,
    ResumeOption,
    ScenariosOption,
    SeedsOption,
    StartOption,
    UpdatesOption,
)
from train.controllers.shipped import GENERALIST
from train.learning.recipes import NAMES as RECIPES

if TYPE_CHECKING:
    from train.learning.job import Job
    from train.learning.recipe import Recipe
    from train.learning.session import Budget
    from train.learning.several import Trained
    from train.learning.training import Progress
    from train.workers.workers import Workers


def train(
    context: typer.Context,
    agent: AgentsArgument,
    scenario: ScenariosOption = None,
    minutes: MinutesOption = None,
    updates: UpdatesOption = None,
    seed: SeedsOption = None,
    folder: FolderOption = None,
    recipe: RecipeOption = None,
    start: StartOption = None,
    looks: LooksOption = None,
    resume: ResumeOption = False,
    overwrite: Annotated[bool, overwriting("the training or agent that the folder holds")] = False,
    device: DeviceOption = None,
    jobs: JobsOption = None,
    cluster: ClusterOption = None,
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
    plant: PlantOption = None,
    as_json: JsonOption = False,
) -> None:
    """Train an agent and save it; Ctrl-C keeps what it has learnt. `beamenv evaluate FOLDER` then measures how good it is.

    The folder gets the policy, its learning curve (learning.csv, learning.png), checkpoints and TensorBoard's files. With several
    agents, scenarios or seeds every combination is trained, in parallel processes or on a cluster; --resume then also starts the
    trainings that have not begun. If one fails, the others go on.
    """
    homes: dict[Path, tuple[str, str, int]] = {}
    with one_sentence(lambda: _resumed_by(context, list(homes))):
        _check(agent, scenario or [], recipe, start)
        check_names(preset, blade=blade, plant=plant)
        if device is not None:
            check_device(device)
        workers = working(jobs, cluster)
        recipes = {each: _recipe(each, recipe, device) for each in agent}
        budgets = {each: _budget(minutes, updates, recipes[each].updates) for each in agent}
        environment = environment_arguments(preset, speed, blade, plant)
        homes |= homes_of(list(product(agent, scenario or ["nominal"], seed or [0])), folder)
        trainings = {home: _job(each, recipes, budgets, environment, start, looks) for home, each in homes.items()}
        names = {home: home.name if len(homes) > 1 else agent[0] for home in homes}
        _remark_on(scenario or [])
        trained, already, whole = _trained(trainings, names, workers, resume, overwrite)
        _draw(homes, trained)
        _tell(homes, names, trained, already, {"preset": preset, "speed": speed, "blade": blade, "plant": plant}, as_json)
        if not whole:
            raise KeyboardInterrupt
    if trained.failed:
        raise typer.Exit(1)


def _draw(homes: Mapping[Path, tuple[str, str, int]], trained: Trained) -> None:
    """The learning curve of each training."""
    from train.figures.learning import draw_learning

    for home, places in trained.places.items():
        agent = homes[home][0]
        named = {agent: places[0]} if len(places) == 1 else {f"{agent}, run {place.name}": place for place in places}
        draw_learning(named, home)


def _tell(
    homes: Mapping[Path, tuple[str, str, int]],
    names: Mapping[Path, str],
    trained: Trained,
    already: Collection[Path],
    given: Mapping[str, Any],
    as_json: bool,
) -> None:
    """What became of each training, and how the first is measured; ``already`` are those that an earlier run had finished."""
    if as_json:
        print_json([_content(home, each, trained, home in already) for home, each in homes.items()])
    else:
        for home, made in trained.places.items():
            say(f"{names[home]} {'was finished already' if home in already else 'saved'} in {', '.join(map(str, made))}")
            tell_validation(made)
        for home in list(trained.places)[:1]:
            say(f"next: {shlex.join(['beamenv', 'evaluate', str(home), *where(homes[home][1], given)])}")
    for home, clause in trained.failed.items():
        complain(f"{names[home]} failed: {clause}.")


def tell_validation(places: Sequence[Path]) -> None:
    """How good the policies in some folders are, where a training looked."""
    from train.shared.curve import validated

    if seen := [f"{cost:.3f}" for cost in map(validated, places) if math.isfinite(cost)]:
        say(f"J / no control on validation episodes, without exploration: {', '.join(seen)}")


def where(scenario: str, given: Mapping[str, Any]) -> list[str]:
    """Options of ``evaluate`` for what an agent was trained on, those that are not usual; a generalist is measured in "nominal"."""
    usual = {"scenario": "nominal", "preset": "thesis"}
    chosen = {"scenario": "nominal" if scenario == GENERALIST else scenario, **given}
    return [word for name, each in chosen.items() if each not in (None, usual.get(name)) for word in (f"--{name}", str(each))]


def _trained(
    trainings: Mapping[Path, Job], names: Mapping[Path, str], workers: Workers, resume: bool, overwrite: bool
) -> tuple[Trained, set[Path], bool]:
    """Train under a bar; what came of each, which were finished before, and whether all are now."""
    from train.cli.progress import Progressbar, told_at_once
    from train.learning.checkpoint import NAME
    from train.learning.several import is_finished, train_all

    totals = {names[home]: _total(job.budget) for home, job in trainings.items()}
    by_clock = any(math.isfinite(job.budget.seconds) for job in trainings.values())
    begun = {home for home in trainings if resume and (home / NAME).is_file()}
    already = {home for home in begun if is_finished(home)}
    with Progressbar(totals, "s" if by_clock else "updates") as bar:

        def told(home: Path, progress: Progress) -> None:
            if home in begun:
                begun.remove(home)
                bar.say(f"resumed: {names[home]} goes on from its checkpoint.")
            bar.training(names[home], totals[names[home]], progress)

        with told_at_once("finishing this update, then what was learnt is saved; a second Ctrl-C ends at once."):
            trained = train_all(trainings, workers, told, resume, overwrite)
    return trained, already, all(is_finished(home) for home in trainings if home not in trained.failed)


def _content(home: Path, training: tuple[str, str, int], trained: Trained, already: bool) -> dict[str, Any]:
    """What became of a training, as JSON."""
    agent, scenario, seed = training
    about = {"agent": agent, "scenario": scenario, "seed": seed, "folder": str(home), "finished_before": already}
    return {**about, "policies": [str(each) for each in trained.places.get(home, [])], "failed": trained.failed.get(home)}


def homes_of(trainings: Sequence[tuple[str, str, int]], folder: Path | None) -> dict[Path, tuple[str, str, int]]:
    """The folder of each training, an agent, scenario and seed; ``ValueError`` where two would have one."""
    parent, named = Path("results/agents") if folder is None else folder, dict[Path, tuple[str, str, int]]()
    for agent, scenario, seed in trainings:
        own = folder is None or len(trainings) > 1
        home = parent / f"{agent}-{Path(scenario).stem}-{seed}" if own else parent
        if home in named:
            raise ValueError(f"agent, --scenario and --seed lead twice to the folder {str(home)!r}: name each once.")
        named[home] = agent, scenario, seed
    return named


def _check(agents: Sequence[str], scenarios: Sequence[str], recipe: Path | None, start: Path | None) -> None:
    """``ValueError`` of one sentence for a name that there is not, and for a file or folder that is not there."""
    for each in agents:
        checked("agent", each, FileName())
        if recipe is None:
            check_name("agent", each, RECIPES)
    for each in scenarios:
        check_scenario(each, (GENERALIST,))
    if recipe is not None:
        if len(agents) > 1:
            raise ValueError(f"recipe = {str(recipe)!r} is of one agent: name one alone.")
        check_table(recipe, "recipe")
    if start is not None and not start.exists():
        raise Refused("from", str(start), "the folder of a trained agent")


def _remark_on(scenarios: Sequence[str]) -> None:
    """Which of some scenarios are kept for judging."""
    for each in [name for name in UNSEEN if name in scenarios]:
        complain(f"{each} is kept for judging: it cannot judge an agent that was trained on it.")


def _recipe(agent: str, own: Path | None, device: str | None) -> Recipe:
    """By its name, or of the user's own file."""
    from train.learning.recipe import load_recipe, named_recipe

    chosen = named_recipe(agent) if own is None else load_recipe(own)
    return chosen if device is None else chosen.on(device)


def _job(
    training: tuple[str, str, int],
    recipes: Mapping[str, Recipe],
    budgets: Mapping[str, Budget],
    environment: Mapping[str, Any],
    start: Path | None,
    looks: int | None,
) -> Job:
    from train.learning.job import LOOKS, Job

    agent, scenario, seed = training
    job = Job(agent, recipes[agent], scenario, seed, budgets[agent], environment, start)
    return replace(job, looks=LOOKS if looks is None else looks, sparing=looks is None)


def _total(budget: Budget) -> float:
    return budget.updates if math.isinf(budget.seconds) else budget.seconds


def _resumed_by(context: typer.Context, homes: Sequence[Path]) -> str:
    """What is said of an interrupted training."""
    from train.learning.checkpoint import NAME

    if not any((home / NAME).is_file() for home in homes):
        return "it was too early for a checkpoint, so nothing is kept"
    changed = {"folder": homes[0]} if len(homes) == 1 else {}
    return f"with `{same_command(context, **changed, overwrite=False, resume=True)}` it resumes"


def _budget(minutes: float | None, updates: int | None, otherwise: int) -> Budget:
    """By the clock or by updates; ``otherwise`` are the recipe's."""
    from train.learning.session import Budget

    if minutes is None:
        return Budget(updates=otherwise if updates is None else updates)
    if updates is not None:
        raise ValueError("--minutes and --updates must not both be given.")
    return Budget(seconds=60.0 * checked("minutes", minutes, Number(gt=0.0)))
