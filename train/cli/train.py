"""The command ``beamenv train``."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from beamenv.configuration import FileName, Number, checked
from train.cli.options import BladeOption, PlantOption, PresetOption, SpeedOption, environment_arguments, one_sentence, same_command
from train.learning.recipes import NAMES

if TYPE_CHECKING:
    from train.learning.session import Budget


def train(
    context: typer.Context,
    agent: Annotated[str, typer.Argument(help=f"A recipe: {', '.join(NAMES)}; or the agent of --recipe.")],
    scenario: Annotated[str, typer.Option(help="A name, a .toml file, or generalist: all but those kept for judging.")] = "nominal",
    minutes: Annotated[float | None, typer.Option(help="Training time; by the clock, so not reproducible bit for bit.")] = None,
    updates: Annotated[int | None, typer.Option(help="Updates of the policy; the recipe's if neither is given.")] = None,
    seed: Annotated[int, typer.Option(min=0, max=2**63 - 1, help="Of the training.")] = 0,
    folder: Annotated[
        Path | None, typer.Option(help="Where it is written; results/agents/AGENT-SCENARIO-SEED if left out.")
    ] = None,
    recipe: Annotated[Path | None, typer.Option(help="A recipe of your own, a TOML file.")] = None,
    start: Annotated[
        Path | None,
        typer.Option("--from", help="Folder of a trained policy to clone first, then to tune; its best run of several."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Resume from the folder's checkpoint, with the same arguments, to the same result.")
    ] = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the training or agent that the folder holds.")] = False,
    device: Annotated[
        str | None,
        typer.Option(help="cpu or cuda, of what is trained through the plant; the recipe's if left out."),
    ] = None,
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
    plant: PlantOption = None,
) -> None:
    """Train an agent and save it; Ctrl-C keeps what it has learnt. `beamenv evaluate FOLDER` then measures how good it is.

    The folder gets the policy, its learning curve, checkpoints and TensorBoard's files.
    """
    home = folder or Path("results/agents") / f"{agent}-{Path(scenario).stem}-{seed}"
    with one_sentence(lambda: _resumed_by(context, home)):
        from train.cli.progress import Progressbar
        from train.controllers.policy_files import read_about
        from train.learning.job import Job, run
        from train.learning.recipe import load_recipe, named_recipe

        checked("agent", agent, FileName())
        chosen = named_recipe(agent) if recipe is None else load_recipe(recipe)
        chosen = chosen if device is None else chosen.on(device)
        budget = _budget(minutes, updates, chosen.updates)
        environment = environment_arguments(preset, speed, blade, plant)
        job = Job(agent, chosen, scenario, seed, budget, environment, start)
        total, unit = (budget.updates, "updates") if math.isinf(budget.seconds) else (budget.seconds, "s")
        with Progressbar({agent: total}, unit) as bar:
            places = run(job, home, lambda progress: bar.training(agent, total, progress), resume, overwrite)
        Console().print(f"{agent} saved in {', '.join(map(str, places))}", soft_wrap=True, markup=False)
        if not read_about(places[0])["finished"]:
            raise KeyboardInterrupt


def _resumed_by(context: typer.Context, folder: Path) -> str:
    """What is said of an interrupted training."""
    from train.learning.checkpoint import NAME

    if not (folder / NAME).is_file():
        return "it was too early for a checkpoint, so nothing is kept"
    return f"with `{same_command(context, folder=folder, overwrite=False, resume=True)}` it resumes"


def _budget(minutes: float | None, updates: int | None, otherwise: int) -> Budget:
    """By the clock or by updates; ``otherwise`` are the recipe's."""
    from train.learning.session import Budget

    if minutes is None:
        return Budget(updates=otherwise if updates is None else updates)
    if updates is not None:
        raise ValueError("minutes and updates must not both be given.")
    return Budget(seconds=60.0 * checked("minutes", minutes, Number(gt=0.0)))
