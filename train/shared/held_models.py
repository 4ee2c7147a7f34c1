"""Models of one's own among the arguments of an environment: held as they are now, and told by what they are; scenarios' files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from beamenv.blade.model_blade import models_of, tables_of
from beamenv.plant.fingerprint import fingerprint
from beamenv.scenarios.scenario import Scenario

MODELS = ("plant", "design")
"""Arguments of an environment that are models where a plant is given."""


def held_models(environment: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments with tables in the place of models' files, whatever the files will say later."""
    return _with(environment, tables_of)


def told_models(environment: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments with fingerprints in the place of models: whether it is the same one does not depend on where its file lies."""
    return _with(environment, lambda given: [fingerprint(each) for each in models_of(given)])


def _with(environment: Mapping[str, Any], replacement: Any) -> dict[str, Any]:
    given = dict(environment)
    if given.get("plant") is None:
        return given
    return given | {name: replacement(given[name]) for name in MODELS if given.get(name) is not None}


def files_of(scenario: Scenario) -> list[Path]:
    """Files that a scenario names: of the plant that moves, and of measured loads."""
    named = (scenario.plants.truth, *(load.series for load in scenario.loads))
    return [Path(each) for each in named if isinstance(each, str) and Path(each).is_file()]
