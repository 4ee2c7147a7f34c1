"""The command ``beamenv record``: a controller's episodes as a data set."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn

from train.cli.bars import fleeting
from train.cli.names import check_names
from train.cli.options import (
    BladeOption,
    ControllerArgument,
    JsonOption,
    PlantOption,
    PresetOption,
    ScenarioOption,
    SpeedOption,
    TrainedSeedOption,
    environment_arguments,
    one_sentence,
    overwriting,
    print_json,
    say,
)
from train.controllers.ids import found

if TYPE_CHECKING:
    from minari import MinariDataset


def record(
    controller: ControllerArgument,
    scenario: ScenarioOption = "nominal",
    episodes: Annotated[int, typer.Option(min=1, help="Number of episodes.")] = 100,
    seed: Annotated[
        int | None,
        typer.Option(
            min=0,
            help="Random seed of the first episode; each further episode has one more. Seeds on which controllers are compared are "
            "refused; the default lies behind them.",
        ),
    ] = None,
    name: Annotated[str | None, typer.Option(help="Name of the data set. Default: beamenv/CONTROLLER-SCENARIO-v0.")] = None,
    folder: Annotated[
        Path | None,
        typer.Option(help="Folder of all data sets. Default: where Minari looks, MINARI_DATASETS_PATH or ~/.minari/datasets."),
    ] = None,
    trained_seed: TrainedSeedOption = None,
    overwrite: Annotated[bool, overwriting("the data set of this name")] = False,
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
    plant: PlantOption = None,
    as_json: JsonOption = False,
) -> None:
    """Record a controller's episodes as a Minari data set, for offline learning.

    If the scenario is kept for judging, the data set says so. An interrupted recording leaves no data set behind.
    """
    with one_sentence("nothing is kept"):
        check_names(preset, scenario, blade, plant)
        found(controller, scenario, trained_seed)
        from train.datasets import record as run
        from train.shared.held_out import RECORDED

        with bar(episodes) as report:
            made = run(
                controller,
                scenario,
                episodes,
                RECORDED if seed is None else seed,
                name=name,
                folder=folder,
                environment=environment_arguments(preset, speed, blade, plant),
                trained_seed=trained_seed,
                overwrite=overwrite,
                progress=report,
            )
    _show(made, folder, as_json)


@contextmanager
def bar(episodes: int) -> Iterator[Callable[[int, int], None]]:
    """Episodes done."""
    with fleeting(TextColumn("episodes"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()) as progress:
        task = progress.add_task("", total=episodes)
        yield lambda done, total: progress.update(task, completed=done, total=total)


def _show(made: MinariDataset, folder: Path | None, as_json: bool) -> None:
    """Where it is, what it tells of itself, and how it is loaded."""
    spec, told = made.spec, made.storage.metadata
    if as_json:
        about = {"dataset_id": spec.dataset_id, "folder": str(spec.data_path), "episodes": spec.total_episodes}
        print_json({**about, "steps": spec.total_steps, **told["beamenv"]})
        return
    say(f"written to {spec.data_path}: {spec.total_episodes} episodes, {spec.total_steps} steps")
    say(told["description"])
    where = "" if folder is None else f", with MINARI_DATASETS_PATH={folder}"
    say(f"minari.load_dataset({spec.dataset_id!r}) loads it{where}")
