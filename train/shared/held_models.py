"""Files among the arguments of an environment, a blade's and models of one's own: held as they are now; scenarios' files."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from beamenv.blade.config import BladeConfig
from beamenv.blade.files import of_path, to_dict
from beamenv.blade.model_blade import models_of, tables_of
from beamenv.configuration.files import ENDINGS
from beamenv.plant.fingerprint import fingerprint
from beamenv.scenarios.scenario import Scenario, load_scenario

MODELS = ("plant", "design")
"""Arguments of an environment that are models where a plant is given."""


def held_models(environment: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments with tables in the place of files of blades and models, whatever the files will say later."""
    return _with(environment, tables_of)


def told_models(environment: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments with fingerprints in the place of models and a table in that of a blade's file: whether it is the same one does
    not depend on where its file lies.
    """
    return _with(environment, lambda given: [fingerprint(each) for each in models_of(given)])


def _with(environment: Mapping[str, Any], replacement: Any) -> dict[str, Any]:
    given = dict(environment)
    if given.get("plant") is None:
        return given if given.get("blade") is None else given | {"blade": _table(given["blade"])}
    return given | {name: replacement(given[name]) for name in MODELS if given.get(name) is not None}


def _table(blade: Any) -> Any:
    """What a blade's file says; what JSON can hold of a configuration."""
    said = of_path(blade)
    return to_dict(said) if isinstance(said, BladeConfig) else said


def scenario_of_file(given: Any) -> Scenario | None:
    """What a scenario's file says that is given by its path; None for a name, a table or a scenario."""
    named = isinstance(given, os.PathLike) or (isinstance(given, str) and given.lower().endswith(ENDINGS))
    return load_scenario(given) if named else None


def files_of(scenario: Scenario) -> list[Path]:
    """Files that a scenario names: of the plant that moves, and of measured loads."""
    named = (scenario.plants.truth, *(load.series for load in scenario.loads))
    return [Path(each) for each in named if isinstance(each, str) and Path(each).is_file()]
