"""The command ``beamenv frequencies``."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from train.cli.names import check_names
from train.cli.options import (
    BladeOption,
    JsonOption,
    PlantOption,
    PresetOption,
    environment_arguments,
    note,
    one_sentence,
    print_json,
)
from train.cli.tables import Column, show_table

DUST = 1e-9
"""Degrees and millimetres below are rounding, and told as 0."""

SHARE = 0.01
"""Of a period: an episode that lasts no longer shows nothing of the first mode."""

FASTEST = 1e6
"""rad/s: a critical speed beyond is none that a rotor has, and is not told."""


def frequencies(
    preset: PresetOption = "thesis",
    speed: Annotated[
        list[float] | None, typer.Option(help="Rotor speed in rad/s; repeat for several. Default: 0 and the blade's own.")
    ] = None,
    count: Annotated[int, typer.Option(help="Number of modes.")] = 6,
    gyroscopic: Annotated[bool, typer.Option(help="Include gyroscopic coupling.")] = True,
    patches: Annotated[bool, typer.Option(help="Include the patches' mass and stiffness.")] = True,
    blade: BladeOption = None,
    plant: PlantOption = None,
    as_json: JsonOption = False,
) -> None:
    """Print a blade's natural frequencies, the kind of motion of each mode, and what steady rotation does to the blade.

    With --plant, print the frequencies and damping ratios of your model, and what was assumed about it.
    """
    if plant is not None:
        _of_model(plant, preset, speed, blade, count, as_json)
        return
    with one_sentence():
        check_names(preset, blade=blade)
        from beamenv.blade.build import build_beam
        from beamenv.blade.clamp import clamp_note
        from beamenv.blade.files import load_config
        from beamenv.blade.presets import blade_config
        from beamenv.configuration.files import read_table
        from beamenv.structure.steady_deformation import steady_deformation
        from train.cli.untold import left_out

        untold = left_out(read_table(blade)) if blade else []
        config = blade_config(preset, load_config(blade) if blade else None)
        beam = build_beam(config) if patches else config.beam.build(model=config.model)
        speeds = speed or sorted({0.0, config.speed})
        found = [beam.modes(each, count, gyroscopic=gyroscopic) for each in speeds]
        steady = [steady_deformation(beam, each) for each in speeds]
        near = clamp_note(config) if patches else ""
    if as_json:
        rows = [_row(*each) for each in zip(speeds, found, steady, strict=True)]
        told = {"unit": "rad/s", "speeds": rows, "note": near, "assumed": untold}
        print_json({"preset": preset, "gyroscopic": gyroscopic, **told})
        return
    _show(speeds, found, count)
    if beam.critical_speed < FASTEST:
        note(f"critical speed {beam.critical_speed:.1f} rad/s")
    for each, state in zip(speeds, steady, strict=True):
        if each > 0.0 and config.model != "thesis":
            note(_turning(each, state, config.patches.failure_strain))
    assumed = f"assumed, as of the default blade: {'; '.join(untold)}" if untold else ""
    for sentence in filter(None, (near, _slow(found), assumed)):
        note(sentence)


def _show(speeds: list[float], found: list[Any], count: int) -> None:
    """Frequencies and families, a column for each speed."""
    columns = [Column("mode", words=True), *(Column(f"at {each:g} rad/s", words=True) for each in speeds)]
    by_mode = [[str(mode + 1), *(_frequency(modes, mode) for modes in found)] for mode in range(count)]
    show_table(columns, by_mode, "Natural frequencies, rad/s (Hz)")


def _slow(found: list[Any]) -> str:
    """On a first mode that no episode is long enough for, at any of the speeds; empty where none is so slow."""
    from beamenv.task.resolve import DURATION

    period = max(2.0 * np.pi / modes.natural_frequencies[0] for modes in found)
    if SHARE * period <= DURATION:
        return ""
    return f"the first period is {period:.3g} s, an episode lasts {DURATION:g} s: were lengths given in millimetres?"


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
        f"turning steadily at {speed:g} rad/s: tip {_clean(1e3 * state.stretch):.3g} mm further out, "
        f"untwisted by {_clean(state.untwist):.3g}°; "
        f"spanwise strain up to {strain:.2g} %, at {state.strain_at:.3g} m{beyond}"
    )


def _clean(value: float) -> float:
    return 0.0 if abs(value) < DUST else value


def _frequency(modes: Any, mode: int) -> str:
    frequency = modes.natural_frequencies[mode]
    return f"{frequency:8.2f} {f'({frequency / (2.0 * np.pi):.2f})':>9} {modes.families[mode]}"


def _of_model(plant: Path, preset: str, speed: list[float] | None, blade: Path | None, count: int, as_json: bool) -> None:
    """What is known of the modes of a model."""
    with one_sentence():
        check_names(preset, blade=blade, plant=plant)
        from beamenv.plant.poles import swinging
        from beamenv.task import resolve_task

        first = speed[0] if speed else None
        model = resolve_task(**environment_arguments(preset, first, blade, plant)).plant
        frequencies, ratios = (each[:count] for each in swinging(np.linalg.eigvals(model.A).astype(np.complex128)))
    if as_json:
        told = {"unit": "rad/s", "natural_frequencies": frequencies.tolist(), "damping_ratios": ratios.tolist()}
        print_json({"plant": str(plant), **told, "assumed": list(model.assumed)})
        return
    columns = [Column("mode", words=True), Column("frequency"), Column("damping, %")]
    rows = [
        [str(number), f"{frequency:.2f} ({frequency / (2.0 * np.pi):.2f})", f"{100.0 * ratio:.3g}"]
        for number, (frequency, ratio) in enumerate(zip(frequencies, ratios, strict=True), start=1)
    ]
    show_table(columns, rows, "Natural frequencies, rad/s (Hz)")
    note(model.sizes)
    if model.assumed:
        note(f"assumed: {'; '.join(model.assumed)}")
