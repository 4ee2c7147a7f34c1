"""The command ``beamenv``."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

from train.cli.benchmark import benchmark
from train.cli.export import export
from train.cli.identify import identify
from train.cli.options import (
    RESUMES,
    BladeOption,
    JsonOption,
    PlantOption,
    PresetOption,
    ScenarioOption,
    SpeedOption,
    environment_arguments,
    one_sentence,
    print_json,
    print_table,
)
from train.cli.place import place
from train.cli.schema import schema
from train.cli.section import section
from train.cli.speed import speed
from train.cli.train import train
from train.cli.usage import OneSentence

app = typer.Typer(
    cls=OneSentence,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="Vibration control of a rotating composite blade: frequencies, controllers, agents, and how they compare.",
)
app.command()(section)
app.command()(identify)
app.command()(place)
app.command()(export)
app.command()(train)
app.command()(benchmark)
app.command()(schema)
app.command()(speed)


@app.command()
def frequencies(
    preset: PresetOption = "thesis",
    speed: Annotated[
        list[float] | None, typer.Option(help="Rotor speed in rad/s; repeat for more. 0 and the preset's if left out.")
    ] = None,
    count: Annotated[int, typer.Option(help="How many modes.")] = 6,
    gyroscopic: Annotated[bool, typer.Option(help="With gyroscopic coupling.")] = True,
    patches: Annotated[bool, typer.Option(help="With the patches' mass and stiffness.")] = True,
    blade: BladeOption = None,
    as_json: JsonOption = False,
) -> None:
    """Natural frequencies of a blade, each with the family its motion belongs to, and what steady rotation does to it."""
    with one_sentence():
        from beamenv.blade.build import build_beam
        from beamenv.blade.clamp import clamp_note
        from beamenv.blade.files import load_config
        from beamenv.blade.presets import blade_config
        from beamenv.structure.steady_deformation import steady_deformation

        config = blade_config(preset, load_config(blade) if blade else None)
        beam = build_beam(config) if patches else config.beam.build(model=config.model)
        speeds = speed or sorted({0.0, config.speed})
        found = [beam.modes(each, count, gyroscopic=gyroscopic) for each in speeds]
        steady = [steady_deformation(beam, each) for each in speeds]
        note = clamp_note(config) if patches else ""
    if as_json:
        rows = [_row(*each) for each in zip(speeds, found, steady, strict=True)]
        print_json({"preset": preset, "gyroscopic": gyroscopic, "unit": "rad/s", "speeds": rows, "note": note})
        return
    table = Table(title="Natural frequencies, rad/s (Hz)", caption=f"critical speed {beam.critical_speed:.1f} rad/s")
    table.add_column("mode", justify="right")
    for each in speeds:
        table.add_column(f"at {each:g} rad/s", justify="right")
    for mode in range(count):
        table.add_row(str(mode + 1), *(_frequency(modes, mode) for modes in found))
    print_table(table)
    for each, state in zip(speeds, steady, strict=True):
        if each > 0.0 and config.model != "thesis":
            Console().print(_turning(each, state, config.patches.failure_strain), soft_wrap=True)
    if note:
        Console().print(note, soft_wrap=True)


def _row(speed: float, modes: Any, state: Any) -> dict[str, Any]:
    """What JSON says of one speed."""
    return {
        "speed": speed,
        "natural_frequencies": modes.natural_frequencies.tolist(),
        "families": list(modes.families),
        "static": asdict(state),
    }


def _turning(speed: float, state: Any, limit: float) -> str:
    """What steady rotation does to the blade, in one sentence."""
    strain, rated = 100.0 * state.strain, 100.0 * limit
    beyond = f", beyond the {rated:.3g} % that patches are rated for" if abs(strain) > rated else ""
    return (
        f"turning steadily at {speed:g} rad/s: tip {1e3 * state.stretch:.3g} mm further out, untwisted by {state.untwist:.3g}°; "
        f"spanwise strain up to {strain:.2g} %, at {state.strain_at:.3g} m{beyond}"
    )


def _frequency(modes: Any, mode: int) -> str:
    frequency = modes.natural_frequencies[mode]
    return f"{frequency:.2f} ({frequency / (2.0 * np.pi):.2f}) {modes.families[mode]}"


@app.command()
def evaluate(
    controller: Annotated[
        str,
        typer.Argument(
            help="A controller by name, say none, lqg or lqr-load, an agent that ships, or a trained one's folder; where that "
            "holds several runs, 0, 1 and so on, all of them, with mean and spread."
        ),
    ],
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
    scenario: ScenarioOption = "default",
    plant: PlantOption = None,
    seeds: Annotated[int, typer.Option(min=2, help="How many held-out episodes.")] = 64,
    trained_seed: Annotated[int | None, typer.Option(help="Training seed of an agent that ships; the first if left out.")] = None,
    as_json: JsonOption = False,
) -> None:
    """Run one controller through held-out episodes and compare it with no control on the same ones."""
    with one_sentence():
        import gymnasium as gym

        import baselines
        import beamenv
        from beamenv.configuration import checked
        from train.benchmark.runs import Runs
        from train.controllers.choice import chosen_runs
        from train.shared.held_out import SEEDS, held_out

        seeds = checked("seeds", seeds, SEEDS)
        arguments = {**environment_arguments(preset, speed, blade, plant), "scenario": scenario}
        envs: Any = gym.make_vec(beamenv.ENV_ID, num_envs=seeds, dtype="float64", **arguments)
        found: dict[str, baselines.Evaluation] = {}
        for run, law in chosen_runs(controller, envs.unwrapped.task, scenario, trained_seed).items():
            reference = next((each.reference for each in found.values()), None)
            found[run] = baselines.evaluate(law, envs, held_out(seeds), reference=reference)
        runs = Runs(controller, found)
    if as_json:
        print_json(runs.to_dict() if len(found) > 1 else runs.first.to_dict())
    else:
        from train.cli.evaluations import runs_table, screen_table

        print_table(runs_table(runs) if len(found) > 1 else screen_table([runs.first]))


@app.command()
def compare(
    folder: Annotated[Path, typer.Argument(help="Where tables, figures and agents are written.")] = Path("results/compare"),
    minutes: Annotated[float, typer.Option(help="Training time of both agents together; 0 trains none.")] = 1.5,
    seeds: Annotated[int, typer.Option(min=2, help="How many held-out episodes.")] = 64,
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
    scenario: ScenarioOption = "default",
    plant: PlantOption = None,
    as_json: JsonOption = False,
) -> None:
    """Train two agents and compare every controller on the same held-out episodes: tables, figures, models.

    An interrupted run resumes from what its folder holds.
    """
    with one_sentence(RESUMES):
        from beamenv.configuration import Number, checked
        from train.cli.evaluations import screen_table
        from train.cli.progress import Progressbar
        from train.comparison.compare import Comparison, tiers_of
        from train.comparison.compare import compare as run

        default = Comparison().budget
        share = 60.0 * checked("minutes", minutes, Number(ge=0.0)) / sum(default.values())
        budget = {name: share * length for name, length in default.items()} if minutes else {}
        comparison = Comparison({**environment_arguments(preset, speed, blade, plant), "scenario": scenario}, budget, seeds)
        with Progressbar(budget) as bar:
            evaluations = run(comparison, folder, bar)
        tiers = tiers_of(evaluations, bar.without)
    if as_json:
        print_json([{"tier": tiers[evaluation.name], **evaluation.row()} for evaluation in evaluations])
    else:
        print_table(screen_table(evaluations, tiers))
        Console().print(f"written to {folder}", markup=False)


@app.command()
def explore(
    port: Annotated[int, typer.Option(help="Where the page is served; 0 takes any free one.")] = 8050,
    host: Annotated[str, typer.Option(help="A loopback address: the page is for this computer alone.")] = "127.0.0.1",
    preset: PresetOption = "thesis",
    blade: BladeOption = None,
) -> None:
    """Serve a page whose sliders redraw a blade's frequencies, mode shapes, damping and step response. Ctrl-C ends it."""
    with one_sentence():
        from beamenv.blade.files import load_config
        from beamenv.blade.presets import blade_config
        from train.explore import serve

        server = serve(port, host, blade_config(preset, load_config(blade) if blade else None))
    name = f"[{host}]" if ":" in host else host
    Console().print(f"http://{name}:{server.port} (Ctrl-C ends it)", markup=False, highlight=False)
    server.serve_forever()


@app.command()
def reproduce(
    names: Annotated[list[str] | None, typer.Argument(help="Tables and figures, say table-3.4 figure-5.7; all if none.")] = None,
    output: Annotated[Path, typer.Option(help="Folder for a CSV and a PNG of each, and the page.")] = Path("results/thesis"),
    fresh: Annotated[bool, typer.Option(help="Do again what is finished already.")] = False,
    docs: Annotated[Path | None, typer.Option(help="Folder that gets the page too, as thesis.md with figures/.")] = None,
) -> None:
    """Regenerate the thesis' tables and figures and judge its statements. About two minutes.

    An interrupted run resumes from what its folder holds.
    """
    with one_sentence(RESUMES):
        from train.cli.reproduce import reproduce as run

        status = run(names or [], output, fresh, docs)
    if status:
        raise typer.Exit(status)
