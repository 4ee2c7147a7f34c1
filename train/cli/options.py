"""What the commands of ``beamenv`` have in common: options, one sentence for bad input, JSON."""

from __future__ import annotations

import json
import shlex
import sys
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from train.cli.names import PRESETS, SCENARIOS, check_names
from train.cli.said import said
from train.shared.interruption import status_of

if TYPE_CHECKING:
    from train.workers.workers import Workers

RESUMES = "what was finished is kept, and the same command resumes"
"""What is said of an interruption where it holds."""

JOBS = 2
"""Processes, if nobody says how many."""

PresetOption = Annotated[str, typer.Option(help=f"Blade that comes with the package: {', '.join(PRESETS)}.")]
SpeedOption = Annotated[float | None, typer.Option(help="Rotor speed in rad/s. Default: the blade's own.")]
BladeOption = Annotated[Path | None, typer.Option(help="TOML or JSON file of a blade, used instead of the preset.")]
PlantOption = Annotated[
    Path | None,
    typer.Option(
        help="File with a model of your own, used instead of a blade: .npz, .mat or .json, with A, B, C and what else is known."
    ),
]
ScenarioOption = Annotated[str, typer.Option(help=f"Scenario: {', '.join(SCENARIOS)}, or a TOML or JSON file.")]
JobsOption = Annotated[
    int | None, typer.Option(min=1, help=f"Number of parallel processes. Default: {JOBS}, or on a cluster as many as it has.")
]
ClusterOption = Annotated[
    str | None,
    typer.Option(
        help="HOST:PORT or ray://HOST:PORT of a running Ray cluster, or local for Ray on this machine. Needs the extra cluster."
    ),
]
ControllerArgument = Annotated[
    str, typer.Argument(help="Id of a controller or of a shipped agent (see beamenv list), or the folder of a trained agent.")
]
TrainedSeedOption = Annotated[
    int | None,
    typer.Option(
        help="Training seed that selects one run of a shipped agent. Default: all runs, or the first where only one is needed."
    ),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print JSON, and nothing else, to standard output.")]


def overwriting(what: str) -> Any:
    """The option --overwrite, of what is there and would else be kept."""
    return typer.Option("--overwrite", help=f"Replace {what}.")


def environment_arguments(preset: str, speed: float | None, blade: Path | None, plant: Path | None = None) -> dict[str, Any]:
    """Keyword arguments of the environment that the options stand for."""
    check_names(preset, blade=blade, plant=plant)
    from beamenv.blade.files import load_config, to_dict

    arguments: dict[str, Any] = {"preset": preset}
    if plant is not None:
        arguments["plant"] = str(plant)
    if speed is not None:
        arguments["speed"] = speed
    if blade is not None:
        arguments["blade"] = to_dict(load_config(blade))
    return arguments


def moving(preset: str, speed: float | None, blade: Path | None, plant: Path | None) -> str:
    """What moves, in words."""
    if plant is not None:
        return f"plant {plant}"
    return f"blade {blade or preset}{'' if speed is None else f' at {speed:g} rad/s'}"


def working(jobs: int | None, cluster: str | None) -> Workers:
    """Who works, by the options; this process alone where joblib, which starts others, is not installed and nobody asks for any."""
    from train.workers.workers import Workers

    if jobs is None and cluster is None and find_spec("joblib") is not None:
        return Workers(JOBS)
    return Workers(jobs, cluster)


@contextmanager
def one_sentence(interrupted: str | Callable[[], str] = "") -> Iterator[None]:
    """Bad input ends with its one sentence on standard error and status 2, not with a traceback.

    So does an interruption, with what then holds, said or asked for, and the status that shells know it by.
    """
    try:
        yield
    except BrokenPipeError:
        raise
    except (ValueError, OSError) as error:
        complain(said(error))
        raise typer.Exit(2) from None
    except KeyboardInterrupt as error:
        holds = interrupted if isinstance(interrupted, str) else interrupted()
        complain(f"interrupted{holds and ': '}{holds}.")
        raise typer.Exit(status_of(error)) from None


def same_command(context: typer.Context, **changed: Any) -> str:
    """The command that was given, with some of its parameters changed, as a shell takes it."""
    words = ["beamenv", str(context.info_name)]
    for parameter in context.command.params:
        value = changed.get(str(parameter.name), context.params.get(str(parameter.name)))
        several = list(value) if isinstance(value, (list, tuple)) else [value]
        if parameter.param_type_name == "argument":
            words += map(str, several)
        elif value is True:
            words += parameter.opts[:1]
        elif value not in (None, False, parameter.default):
            words += [word for each in several for word in (parameter.opts[0], str(each))]
    return shlex.join(words)


def say(line: str) -> None:
    """To standard output; a terminal breaks it between words, and whatever else reads gets one line."""
    screen = Console()
    screen.print(line, soft_wrap=not screen.is_terminal, markup=False, highlight=False)


def note(line: str) -> None:
    """To standard output, below a table: broken between words as that is, whoever reads."""
    print(textwrap.fill(line, Console().width, break_long_words=False, break_on_hyphens=False))  # noqa: T201 - the command's own voice


def complain(sentence: str) -> None:
    """To standard error, in the name of the command."""
    print(f"beamenv: {sentence}", file=sys.stderr)  # noqa: T201 - the command's own voice


def print_json(content: Any) -> None:
    """To standard output, as JSON."""
    print(json.dumps(content, indent=2, allow_nan=False))  # noqa: T201 - for machines
