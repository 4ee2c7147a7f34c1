"""Names that options take, checked before what they name is imported: a typo is answered at once."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable
from pathlib import Path

from beamenv.configuration import Refused, unknown_name
from beamenv.configuration.files import ENDINGS, checked_path, content_of, read_table
from beamenv.scenarios.named import FORMER as FORMER_SCENARIOS
from beamenv.scenarios.named import GROUPS, LOADS, NOMINAL
from beamenv.scenarios.named import NAMES as IN_FILES
from beamenv.titles import BLADES
from train.controllers.ids import is_known, unknown
from train.learning.recipes import NAMES as RECIPES
from train.reproduce.names import NAMES as STUDIES

PRESETS = tuple(BLADES)

SCENARIOS = tuple(dict.fromkeys((NOMINAL, *LOADS, *IN_FILES)))

DEVICES = ("cpu", "cuda", "mps", "xpu")
"""Kinds of them that torch has."""

METHODS = ("multistart", "ga+sqp", "ga", "sqp", "cma-es", "grid")
"""Of placing patches."""

FORMATS = ("c", "onnx", "mat")
"""Of a controller that is exported."""

PRECISIONS = ("double", "single")

MODELS = (".npz", ".mat", ".json")
"""Endings of files of plants."""


def check_names(
    preset: str | None = None, scenario: str | None = None, blade: Path | None = None, plant: Path | None = None
) -> None:
    """``ValueError`` of one sentence for a preset or scenario that there is not, and for a file that cannot be read."""
    if preset is not None:
        check_name("preset", preset, PRESETS)
    if scenario is not None:
        check_scenario(scenario)
    if blade is not None:
        check_table(blade, "blade")
        if preset not in (None, PRESETS[0]):  # the first is what the option is where it is left out
            raise Refused("preset", preset, f"left out beside --blade {blade}: give one of them")
    if plant is not None and plant.suffix.lower() in MODELS:
        content_of(plant, 1)


def check_table(path: Path, argument: str) -> None:
    """The same of a .toml or .json file."""
    read_table(checked_path(argument, path, ENDINGS))


def check_scenario(name: str, others: Collection[str] = ()) -> None:
    """The same of a scenario's name or file, or one of some other words."""
    if name.lower().endswith(ENDINGS):
        read_table(name)
    elif name not in FORMER_SCENARIOS:
        check_name("scenario", name, [*others, *SCENARIOS], ", or a .toml or .json file")


def check_scenarios(names: Iterable[str]) -> None:
    """The same of those that a benchmark takes, groups of them too."""
    for each in names:
        check_scenario(each, tuple(GROUPS))


def check_controller(name: str, argument: str = "controller", others: str = "") -> None:
    """The same of the id of a controller or of an agent that ships, and of the folder of a trained one, or ``others``."""
    if not is_known(name) and not os.path.exists(name):
        raise unknown(name, argument, others)


def check_recipe(name: str, argument: str) -> None:
    """The same of a recipe that ships, or a file of one's own."""
    if name.lower().endswith(ENDINGS):
        read_table(name)
    else:
        check_name(argument, name, RECIPES, ", or a file that ends in .toml or .json")


def check_device(name: str) -> None:
    """The same of a device of torch; whether it is here, torch itself says."""
    if name.partition(":")[0] not in DEVICES:
        raise Refused("device", name, "cpu, or a device that torch has here, such as cuda")


def check_studies(names: Iterable[str]) -> None:
    """The same of the thesis' tables and figures."""
    for each in names:
        check_name("name", each, STUDIES)


def check_name(argument: str, name: str, known: Collection[str], others: str = "") -> None:
    """The same of one of some names."""
    if name not in known:
        raise unknown_name(argument, name, known, others)
