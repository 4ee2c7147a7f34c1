"""The command ``beamenv identify``: from measured voltages and readings to a plant."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn

from beamenv.configuration.files import content_of
from train.cli.bars import fleeting
from train.cli.options import JsonOption, note, one_sentence, print_json, say
from train.cli.tables import Column, show_table
from train.shared.files import check_folder


def identify(
    data: Annotated[
        Path, typer.Argument(help="CSV file whose first line names its columns; a unit may follow in brackets, as in y1 [A].")
    ],
    order: Annotated[str, typer.Option(help="Number of states, or auto: chosen by the rows that are held back.")] = "auto",
    folder: Annotated[Path, typer.Option(help="Folder for plant, report and figures.")] = Path("results/identified"),
    voltage: Annotated[
        list[str] | None, typer.Option(help="Column of an actuator's voltage; repeat for several. Default: all that begin with u.")
    ] = None,
    reading: Annotated[
        list[str] | None, typer.Option(help="Column of a sensor's reading; repeat for several. Default: all that begin with y.")
    ] = None,
    time: Annotated[str | None, typer.Option(help="Column of the time in s. Default: time or t.")] = None,
    interval: Annotated[float | None, typer.Option(help="Seconds between rows, needed if no column holds the time.")] = None,
    before: Annotated[
        bool, typer.Option("--before", help="The voltages of each row were applied before its readings were taken.")
    ] = False,
    held_back: Annotated[float, typer.Option(help="Share of the rows, from the end, that the model is judged on.")] = 0.25,
    collocated: Annotated[
        float | None,
        typer.Option(
            help="If each current sensor lies at an actuator: its charge per strain over moment per volt; 1 for equal patches."
        ),
    ] = None,
    ensemble: Annotated[int, typer.Option(help="Number of further plants to write, drawn within the estimated uncertainty.")] = 16,
    seed: Annotated[int, typer.Option(help="Random seed of the ensemble.")] = 0,
    drive_limit: Annotated[
        float | None, typer.Option(help="Largest voltage of the actuators, V. Default: the largest in the data.")
    ] = None,
    full_scale: Annotated[
        list[float] | None,
        typer.Option(help="Range of a sensor, in its unit; one for each reading. Default: from the loads that move the plant."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Identify a plant from measured voltages and readings: its modes, its noise, and how uncertain they are.

    The folder gets plant.npz, an ensemble of plants within the uncertainty, report.md, report.json, stabilisation.png and fit.png.
    """
    with one_sentence():
        content_of(data, 1)
        from baselines.identification.files import read_measurement
        from baselines.identification.identify import identify as run
        from beamenv.configuration import Count, checked

        check_folder(folder)
        members, seed = checked("ensemble", ensemble, Count(0, 1000)), checked("seed", seed, Count(0, 2**63 - 1))
        limits = {} if drive_limit is None else {"actuator_limits": _limit(drive_limit)}
        measurement = read_measurement(data, voltages=voltage, readings=reading, time=time, interval=interval, before=before)
        about = {**limits, **_ranges(full_scale, measurement.reading_names)}
        with bar() as report:
            found = run(measurement, _order(order), held_back=held_back, collocated=collocated, progress=report)
        from train.identification.files import write_all
        from train.identification.trial import tried

        trial = tried(found, about)
        written = write_all(found, folder, members, seed, about, trial)
    _tell(found, trial, written, as_json)


def _tell(found: Any, trial: Any, written: Sequence[Path], as_json: bool) -> None:
    """What was found, whether its LQG is safe, and where it lies."""
    if not trial.safe:
        typer.echo(f"warning: {trial.sentence}", err=True)
    if as_json:
        print_json({**found.to_dict(), "lqg": trial.to_dict()})
        return
    show(found)
    if trial.safe:
        note(trial.sentence)
    for path in written:
        say(f"written to {path}")


def _order(order: str) -> Any:
    return int(order) if order.isdecimal() and len(order) < 10 else order


def _limit(limit: float) -> float:
    from beamenv.configuration import Number, checked
    from beamenv.plant.limits import STRONGEST_DRIVE

    return checked("drive_limit", limit, Number(gt=0.0, le=STRONGEST_DRIVE, unit="V"))


def _ranges(full_scale: list[float] | None, names: Sequence[str]) -> dict[str, Any]:
    """The argument of a plant, one range for each reading; none where none is asked for."""
    from beamenv.configuration import Number, Refused, checked

    if not full_scale:
        return {}
    if len(full_scale) != len(names):
        raise Refused("full_scale", full_scale, f"{len(names)} numbers, one for each of {', '.join(names)}")
    return {"full_scale": [checked("full_scale", each, Number(gt=0.0)) for each in full_scale]}


@contextmanager
def bar() -> Iterator[Callable[[str, float], None]]:
    """What is being done."""
    with fleeting(TextColumn("{task.description:>12}", markup=False), BarColumn(), TimeElapsedColumn()) as progress:
        task = progress.add_task("reading", total=1.0)
        yield lambda what, done: progress.update(task, description=what, completed=done)


def show(found: Any) -> None:
    """Modes and fits on the screen."""
    modes, fit, names = found.modes, found.fit, found.measurement.reading_names
    columns = [Column(each) for each in ("rad/s", "±", "damping\nratio, %", "±", "certainty")]
    rows = zip(modes.frequency, modes.frequency_spread, modes.damping_ratio, modes.damping_spread, modes.certainty, strict=True)
    show_table(
        [Column("mode", words=True), *columns],
        [
            [str(k), f"{frequency:.2f}", f"{spread:.2g}", f"{100.0 * ratio:.3f}", f"{100.0 * of_ratio:.2g}", f"{certainty:.3g}"]
            for k, (frequency, spread, ratio, of_ratio, certainty) in enumerate(rows, start=1)
        ],
        "Modes",
    )
    note("± one standard deviation; certainty about 1: none")
    of_readings = zip(names, fit.one_step, fit.free_run, fit.attainable, strict=True)
    show_table(
        [Column("reading", words=True), Column("one step"), Column("free run"), Column("attainable")],
        [[name, *(f"{value:.3f}" for value in values)] for name, *values in of_readings],
        "Fit on rows held back",
    )
    note(found.choice.reason)
