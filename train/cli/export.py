"""The command ``beamenv export``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from train.cli.names import FORMATS, PRECISIONS, check_name, check_names
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
    moving,
    one_sentence,
    overwriting,
    print_json,
    say,
)
from train.controllers.ids import found

if TYPE_CHECKING:
    from train.export import Exported

STEPS, PASSES = 2000, 20
"""Of a measurement: on random readings."""


def export(
    controller: ControllerArgument,
    format: Annotated[
        str | None, typer.Option("--format", help=f"{', '.join(FORMATS)}. Default: by the output's ending, or else c.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option(help="File to write. Default: the controller's name with the format's ending.")
    ] = None,
    precision: Annotated[str, typer.Option(help=f"{' or '.join(PRECISIONS)}.")] = "double",
    name: Annotated[str | None, typer.Option(help="Name of functions and types. Default: the controller's.")] = None,
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
    scenario: ScenarioOption = "nominal",
    plant: PlantOption = None,
    trained_seed: TrainedSeedOption = None,
    measure: Annotated[bool, typer.Option("--measure", help="Compile the C file and measure the time of a step.")] = False,
    overwrite: Annotated[bool, overwriting("a file that is there")] = False,
    as_json: JsonOption = False,
) -> None:
    """Write a controller for your hardware: it turns sensor readings into voltages, with its scales, limits and clock."""
    with one_sentence():
        check_names(preset, scenario, blade, plant)
        whose = found(controller, scenario, trained_seed)
        check_name("precision", precision, PRECISIONS)
        if format is not None:
            check_name("format", format, FORMATS)
        from beamenv.configuration import Refused
        from beamenv.task import resolve_task
        from train.controllers.choice import chosen
        from train.export import export, exported
        from train.export.exported import identifier

        format = _format(format, output)
        if measure and format != "c":
            raise Refused("measure", measure, f"left out with the format {format!r}: it is C that is compiled")
        task = resolve_task(**environment_arguments(preset, speed, blade, plant), scenario=scenario)
        called = identifier(whose.id) if name is None else name
        path = output or Path(f"{called}.{format}")
        _check_free(path, overwrite)
        law = chosen(controller, task, scenario, trained_seed)
        model = moving(preset, speed, blade, plant)
        more: dict[str, Any] = {"precision": precision, "name": called, "note": f"{controller}, {model}, scenario {scenario}"}
        written = exported(law, task.design_plant, **more)
        seconds = _measured(written) if measure else None
        export(law, task.design_plant, path, format=format, **more)
    if as_json:
        print_json({"file": str(path), "format": format, "name": written.name, **written.facts, "seconds_a_step": seconds})
    else:
        _show(written, path, seconds)


def _format(format: str | None, output: Path | None) -> str:
    """The one that is asked for, else that of the output's ending, else C."""
    from train.export.writing import checked_format

    ending = "" if output is None else output.suffix.lower().removeprefix(".")
    return checked_format(format or (ending if ending in FORMATS else "c"), output or Path(), "output")


def _check_free(path: Path, overwrite: bool) -> None:
    """``ValueError`` for a file that cannot be written, and for one that is there and is to stay."""
    from train.shared.files import check_file

    check_file(path, "output")
    if path.is_file() and not overwrite:
        raise ValueError(f"output = {str(path)!r} is there already: overwrite it, or name another file.")


def _measured(found: Exported) -> float:
    """Seconds of this processor, a step, on random readings of a tenth of full scale."""
    import numpy as np

    from train.export.compiled import seconds_a_step

    plant, random = found.plant, np.random.default_rng(0)
    rows: list[Any] = [0.1 * plant.sensor_full_scale * random.standard_normal((STEPS, len(plant.C)))]
    rows += [np.full((STEPS, each.size), 1.0) for each in found.diagram.inputs[1:]]
    with Console(stderr=True).status("compiling and measuring"):
        return seconds_a_step(found, np.hstack(rows), PASSES)


def _show(found: Exported, path: Path, seconds: float | None) -> None:
    remembered = sum(delay.size for delay in found.diagram.following)
    say(f"written to {path}: {found.controller}, in {found.precision} precision, with {remembered} numbers to remember")
    if seconds is not None:
        interval = found.plant.control_interval
        say(
            f"a step takes {1e6 * seconds:.3g} µs on this computer, {100.0 * seconds / interval:.2g} % of the control interval of "
            f"{1e6 * interval:.4g} µs"
        )
