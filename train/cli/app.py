"""The command ``beamenv``."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Annotated, Any

import typer

from train.cli.benchmark import benchmark
from train.cli.export import export
from train.cli.frequencies import frequencies
from train.cli.identify import identify
from train.cli.listing import list_ids
from train.cli.names import check_names, check_studies
from train.cli.options import (
    RESUMES,
    BladeOption,
    ClusterOption,
    JobsOption,
    JsonOption,
    PlantOption,
    PresetOption,
    ScenarioOption,
    SpeedOption,
    TrainedSeedOption,
    environment_arguments,
    moving,
    one_sentence,
    overwriting,
    print_json,
    say,
    working,
)
from train.cli.place import place
from train.cli.record import record
from train.cli.schema import schema
from train.cli.section import section
from train.cli.speed import speed
from train.cli.train import train
from train.cli.tune import tune
from train.cli.usage import OneSentence
from train.controllers.ids import found

app = typer.Typer(
    cls=OneSentence,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="Vibration control of a rotating composite blade: frequencies, controllers, agents, and how they compare.",
)


def _version(asked: bool) -> None:
    if asked:
        from beamenv import __version__

        say(f"beamenv {__version__}")
        raise typer.Exit


@app.callback()
def beamenv(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """The commands below; --help after one tells of its options."""


app.command("list")(list_ids)
app.command()(frequencies)
app.command()(section)
app.command()(identify)
app.command()(place)
app.command()(export)
app.command()(train)
app.command()(tune)
app.command()(record)
app.command()(benchmark)
app.command()(schema)
app.command()(speed)


@app.command()
def evaluate(
    controller: Annotated[
        str,
        typer.Argument(
            help="Id of a controller or of a shipped agent (see beamenv list), or the folder of a trained agent. If it has several "
            "runs, all are evaluated: mean and spread are printed."
        ),
    ],
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
    scenario: ScenarioOption = "nominal",
    plant: PlantOption = None,
    episodes: Annotated[int, typer.Option(min=2, help="Number of held-out episodes.")] = 64,
    trained_seed: TrainedSeedOption = None,
    as_json: JsonOption = False,
) -> None:
    """Run one controller through held-out episodes and compare it with no control on the same ones."""
    with one_sentence():
        check_names(preset, scenario, blade, plant)
        found(controller, scenario, trained_seed)
        import gymnasium as gym

        import baselines
        import beamenv
        from beamenv.configuration import checked
        from train.benchmark.runs import Runs
        from train.controllers.choice import chosen_runs
        from train.shared.held_out import SEEDS, held_out

        seeds = checked("episodes", episodes, SEEDS)
        arguments = {**environment_arguments(preset, speed, blade, plant), "scenario": scenario}
        envs: Any = gym.make_vec(beamenv.ENV_ID, num_envs=seeds, dtype="float64", **arguments)
        each: dict[str, baselines.Evaluation] = {}
        for run, law in chosen_runs(controller, envs.unwrapped.task, scenario, trained_seed).items():
            reference = next((one.reference for one in each.values()), None)
            each[run] = baselines.evaluate(law, envs, held_out(seeds), reference=reference)
        runs = Runs(next(iter(each.values())).name, each)
    if as_json:
        print_json(runs.to_dict() if len(each) > 1 else runs.one_to_dict())
    else:
        from train.cli.evaluations import show_one

        show_one(runs, f"scenario {scenario}, {moving(preset, speed, blade, plant)}")


@app.command()
def compare(
    folder: Annotated[Path, typer.Option(help="Folder for tables, figures and agents.")] = Path("results/compare"),
    minutes: Annotated[float, typer.Option(help="Minutes of training of both agents together; with 0 none is trained.")] = 1.5,
    episodes: Annotated[int, typer.Option(min=2, help="Number of held-out episodes.")] = 64,
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
    scenario: ScenarioOption = "nominal",
    plant: PlantOption = None,
    as_json: JsonOption = False,
) -> None:
    """Train two agents and compare every controller on the same held-out episodes: tables, figures, models.

    An interrupted run resumes from what its folder holds.
    """
    with one_sentence(RESUMES):
        check_names(preset, scenario, blade, plant)
        from beamenv.configuration import Number, checked
        from train.cli.evaluations import show_compared
        from train.cli.progress import Progressbar
        from train.comparison.compare import Comparison, tiers_of
        from train.comparison.compare import compare as run
        from train.shared.held_out import SEEDS

        seeds = checked("episodes", episodes, SEEDS)
        default = Comparison().budget
        share = 60.0 * checked("minutes", minutes, Number(ge=0.0)) / sum(default.values())
        budget = {name: share * length for name, length in default.items()} if minutes else {}
        comparison = Comparison({**environment_arguments(preset, speed, blade, plant), "scenario": scenario}, budget, seeds)
        with Progressbar(budget) as bar:
            evaluations = run(comparison, folder, bar)
        tiers = tiers_of(evaluations)
    if as_json:
        print_json([{"tier": tiers[evaluation.name], **evaluation.row()} for evaluation in evaluations])
    else:
        show_compared(evaluations, tiers)
        say(f"written to {folder}")


@app.command()
def explore(
    port: Annotated[int, typer.Option(help="Port of the page; 0 takes any free one.")] = 8050,
    host: Annotated[str, typer.Option(help="Loopback address: the page can be opened on this computer only.")] = "127.0.0.1",
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
) -> None:
    """Serve a page that shows a blade and its LQG, and redraws what its controls change. Ctrl-C ends it.

    It shows section, frequencies, mode shapes, damping, step response, poles, margins, sensitivity, Bode diagram and singular
    values; geometry, plies, patches, noise and weights can be changed. The page's address holds its state, and the page saves the
    blade as a file for --blade.
    """
    with one_sentence():
        check_names(preset, blade=blade)
        from dataclasses import replace

        from rich.console import Console

        from beamenv.blade.files import load_config
        from beamenv.blade.presets import blade_config
        from train.explore import serve

        with Console(stderr=True).status("building the blade"):
            base = blade_config(preset, load_config(blade) if blade else None)
            name = Path(blade).name if blade else preset
            server = serve(port, host, base if speed is None else replace(base, speed=speed), name)
    place = f"[{host}]" if ":" in host else host
    say(f"open http://{place}:{server.port} in a browser (Ctrl-C ends it)")
    server.serve_forever()


@app.command()
def reproduce(
    names: Annotated[
        list[str] | None, typer.Argument(help="Tables and figures, such as table-3.4 figure-5.7. Default: all.")
    ] = None,
    folder: Annotated[Path, typer.Option(help="Folder for the page, and for CSV and PNG files.")] = Path("results/thesis"),
    overwrite: Annotated[bool, overwriting("results that are already finished")] = False,
    docs: Annotated[
        Path | None,
        typer.Option(help="Folder that also gets the documentation's pages: thesis.md, a page for each chapter, and figures/."),
    ] = None,
    jobs: JobsOption = None,
    cluster: ClusterOption = None,
    as_json: JsonOption = False,
) -> None:
    """Compute the thesis' tables and figures anew and judge its statements, by our model and by its own. A minute on two cores.

    An interrupted run resumes from what its folder holds.
    """
    with one_sentence(RESUMES):
        check_studies(names or ())
        from train.cli.reproduce import reproduce as run

        status = run(names or [], folder, overwrite, docs, working(jobs, cluster), as_json)
    if status:
        raise typer.Exit(status)


def _in_paragraphs(text: str) -> str:
    """A docstring with each paragraph on one line, which a terminal then breaks where it ends, and not where the source does."""
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in text.split("\n\n"))


for _command in app.registered_commands:
    _command.help = _in_paragraphs(inspect.getdoc(_command.callback) or "")
