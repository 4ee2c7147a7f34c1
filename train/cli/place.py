"""The command ``beamenv place``: its options, which go together, and which of three ways they lead to."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from train.cli.names import METHODS, check_name, check_names
from train.cli.options import BladeOption, JsonOption, PresetOption, SpeedOption, one_sentence
from train.cli.place_in_turn import METHOD, Search, place_in_turn
from train.cli.place_sizes import Written, place_sizes
from train.cli.place_together import place_together
from train.shared.files import check_picture


def place(
    actuators: Annotated[int | None, typer.Option(help="Number of actuators to place.")] = None,
    sensors: Annotated[int | None, typer.Option(help="Number of sensors to place.")] = None,
    preset: PresetOption = "thesis",
    speed: SpeedOption = None,
    blade: BladeOption = None,
    patches: Annotated[bool, typer.Option(help="Include the patches' mass and stiffness.")] = True,
    method: Annotated[
        str, typer.Option(help=f"{', '.join(METHODS)}; the thesis used ga+sqp, grid is for one or two patches.")
    ] = METHOD,
    seed: Annotated[int, typer.Option(help="Random seed of the search.")] = 0,
    leave_unreached: Annotated[
        bool,
        typer.Option("--leave-unreached", help="Accept modes that no patch can move: they keep their own damping."),
    ] = False,
    together: Annotated[
        bool, typer.Option("--together", help="Place actuators and sensors at once, by the closed loop's cost.")
    ] = False,
    size: Annotated[
        bool,
        typer.Option(
            "--size", help="Choose sizes too, of as many patches at most: the trade-off between the closed loop's cost and mass."
        ),
    ] = False,
    mass: Annotated[float | None, typer.Option(help="With --size: largest mass of the piezo sheets, kg.")] = None,
    channels: Annotated[int | None, typer.Option(help="With --size: largest number of voltages.")] = None,
    power: Annotated[float | None, typer.Option(help="With --size: largest power, W: ½CV²f of all actuators.")] = None,
    frequency: Annotated[float | None, typer.Option(help="With --size: f of the power, Hz. Default: the first mode's.")] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            help="With --size: JSON file for the best blade within --mass; without it, no heavier than its present patches."
        ),
    ] = None,
    picture: Annotated[
        Path | None,
        typer.Option(help="PNG file for the blade, its patches and the cost along the span; with --size for the trade-off."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Find the best positions of patches: actuators by least tr(P) of the regulator, sensors by least tr(S) of the filter.

    Both sides are placed, with as many patches as the blade has, unless the options name one.
    """
    drawn = picture or (None if as_json or together else Path("results/sizes.png" if size else "results/placement.png"))
    with one_sentence():
        check_names(preset, blade=blade)
        check_name("method", method, METHODS)
        from beamenv.blade.files import load_config
        from beamenv.blade.presets import blade_config

        budget = {"mass": mass, "channels": channels, "power": power, "frequency": frequency}
        check_alone(together, size, picture, {**budget, "output": output})
        check_searched("size" if size else "together" if together else "", method)
        if size and leave_unreached:
            raise ValueError("--size leaves modes that no patch reaches alone: leave --leave-unreached out.")
        if drawn is not None:
            check_picture(drawn)
        config = blade_config(preset, load_config(blade) if blade else None, speed)
        config = config if patches else replace(config, patches=config.patches.without_mass())
        counts = {"actuators": actuators, "sensors": sensors}
        if size:
            place_sizes(config, counts, budget, seed, Written(output, drawn, as_json))
        elif together:
            place_together(config, counts, seed, leave_unreached, as_json)
        else:
            place_in_turn(config, counts, Search(method, seed, leave_unreached), drawn, as_json)


def check_alone(together: bool, size: bool, picture: Path | None, of_sizes: dict[str, Any]) -> None:
    """``ValueError`` for options that do not go together."""
    if together and (size or picture):
        raise ValueError(f"--together places patches as they are and draws nothing: leave --{'size' if size else 'picture'} out.")
    given = [name for name, value in of_sizes.items() if value is not None]
    if given and not size:
        raise ValueError(f"--{given[0]} limits patches that are sized: add --size.")


def check_searched(way: str, method: str) -> None:
    """``ValueError`` for a method of one side's search beside ``way``, "size" or "together", which has a search of its own."""
    if way and method != METHOD:
        raise ValueError(f"--{way} searches in a way of its own: leave --method out.")
