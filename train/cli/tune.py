"""The command ``beamenv tune``."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn

from beamenv.configuration import Count, FileName, checked
from train.cli.bars import Bars
from train.cli.names import check_names, check_recipe, check_scenario, check_table
from train.cli.options import (
    RESUMES,
    BladeOption,
    ClusterOption,
    JsonOption,
    PlantOption,
    PresetOption,
    SpeedOption,
    complain,
    environment_arguments,
    one_sentence,
    overwriting,
    print_json,
    say,
)
from train.cli.tables import Column, show_table
from train.controllers.shipped import GENERALIST
from train.learning.recipes import NAMES

if TYPE_CHECKING:
    from train.tuning.records import Record
    from train.tuning.tuning import Tuned


def tune(
    recipe: Annotated[str, typer.Argument(help=f"Recipe: {', '.join(NAMES)}; or a TOML file of your own.")],
    scenario: Annotated[
        str, typer.Option(help="Scenario name, .toml file, or generalist: all scenarios but those kept for judging.")
    ] = "nominal",
    trials: Annotated[int, typer.Option(min=2, help="Number of trials: the recipe as it is, and variants drawn at random.")] = 16,
    updates: Annotated[int | None, typer.Option(help="Policy updates of each trial. Default: the recipe's.")] = None,
    seed: Annotated[int, typer.Option(min=0, max=2**63 - 1, help="Random seed of every training and of the variants.")] = 0,
    space: Annotated[
        Path | None, typer.Option(help="TOML file of what is tried. Default: the one shipped for the recipe's trainer.")
    ] = None,
    folder: Annotated[Path | None, typer.Option(help="Folder of the search. Default: results/tuning/RECIPE-SCENARIO-SEED.")] = None,
    overwrite: Annotated[bool, overwriting("another tuning that the folder holds")] = False,
    cluster: ClusterOption = "local",
    jobs: Annotated[
        int | None, typer.Option(min=1, help="Number of trials in parallel. Default: as many as there are cores.")
    ] = None,
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
    plant: PlantOption = None,
    as_json: JsonOption = False,
) -> None:
    """Search better settings of a recipe on validation seeds, and write the best recipe for `beamenv train --recipe`.

    All trials have the same budget of updates; after a sixteenth and a quarter of it the worse ones are stopped (ASHA, by Ray
    Tune). An interrupted search resumes from what its folder holds; the same command with more --trials continues it.
    """
    name = recipe if recipe in NAMES else Path(recipe).stem
    home = folder or Path("results/tuning") / f"{name}-{Path(scenario).stem}-{seed}"
    with one_sentence(RESUMES):
        check_recipe(recipe, "recipe")
        check_scenario(scenario, (GENERALIST,))
        check_names(preset, blade=blade, plant=plant)
        if space is not None:
            check_table(space, "space")
        from train.learning.recipe import load_recipe, named_recipe
        from train.tuning.space import space_of
        from train.tuning.tuning import Tuning
        from train.tuning.tuning import tune as run

        chosen = named_recipe(recipe) if recipe in NAMES else load_recipe(Path(recipe))
        chosen = chosen if updates is None else replace(chosen, updates=checked("updates", updates, Count()))
        environment = environment_arguments(preset, speed, blade, plant)
        tuning = Tuning(checked("recipe", name, FileName()), chosen, space_of(chosen, space), scenario, seed, trials, environment)
        with _Bar(trials) as bar:
            tuned = run(tuning, home, bar.show, cluster or "local", jobs, overwrite)
    if as_json:
        print_json(_content(tuned))
    else:
        _show(name, tuned)


class _Bar(Bars):
    """Trials that have ended, with the best of those that had all their updates."""

    def __init__(self, trials: int) -> None:
        best = TextColumn("{task.fields[best]}")
        super().__init__(TextColumn("trials"), BarColumn(), MofNCompleteColumn(), best, TimeElapsedColumn())
        self._task = self._bars.add_task("trials", total=trials, best="")
        self._begun = False

    def show(self, records: Sequence[Record]) -> None:
        """How far it is."""
        from train.tuning.records import FINISHED, finished

        ended = sum(bool(each.ended) for each in records)
        if not self._begun and ended:
            self.say(f"resumed: {ended} of {len(records)} trials are kept from an earlier run.")
        self._begun = True
        best = "".join(f"J / no control {each.looks[-1].cost:.3f} at best" for each in finished(records)[:1])
        if records[0].ended == FINISHED:
            best += f", {records[0].looks[-1].cost:.3f} as it is"
        self._bars.update(self._task, completed=ended, best=best)


def _show(name: str, tuned: Tuned) -> None:
    """The trials, the best first, and what was chosen."""
    from train.tuning.records import finished

    whole = finished(tuned.records)
    settings = (Column(each) for each in tuned.untuned.settings)
    columns = [Column("trial", words=True), Column("ended", words=True), Column("updates"), Column("J / J₀"), *settings]
    rows = []
    for each in [*whole, *(other for other in tuned.records if other not in whole)]:
        cost = f"{each.looks[-1].cost:.3f}" if each.looks else "–"
        values = [f"{value:.3g}" if isinstance(value, float) else str(value) for value in each.settings.values()]
        rows.append([str(each.trial), each.ended, str(each.updates), cost, *values])
    show_table(columns, rows, f"Trials of {name}, on validation seeds")
    say(_sentence(tuned, len(whole)))
    for each in tuned.records:
        if each.sentence:
            complain(f"trial {each.trial} failed: {each.sentence}.")
    say(f"{tuned.path}, for {shlex.join(['beamenv', 'train', name, '--recipe', str(tuned.path)])}")


def _sentence(tuned: Tuned, whole: int) -> str:
    """What was chosen, of how many, and what that is worth."""
    from train.learning.validation import EPISODES

    best, own = tuned.chosen.looks[-1], tuned.untuned.looks[-1]
    what = f"Trial {tuned.chosen.trial} is chosen" if tuned.chosen.trial else "The recipe as it is stays: no trial was better"
    return (
        f"{what}, of {len(tuned.records)}, {whole} of which had all their updates. J over no control {best.cost:.3f}, of the "
        f"recipe as it is {own.cost:.3f}, on the {EPISODES} validation episodes that chose; {best.apart:.3f} and {own.apart:.3f} "
        f"on {EPISODES} others. One training each, of one seed."
    )


def _content(tuned: Tuned) -> dict[str, Any]:
    """As JSON."""
    return {
        "chosen": tuned.chosen.trial,
        "recipe": tuned.recipe.to_dict(),
        "path": str(tuned.path),
        "trials": [asdict(each) for each in tuned.records],
    }
