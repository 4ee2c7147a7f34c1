"""Models in files: .npz of NumPy, .mat of MATLAB and SciPy, .json; what is in them goes by the names of ``state_space``."""

from __future__ import annotations

import io
import os
from collections.abc import Mapping
from dataclasses import MISSING, asdict, fields
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import loadmat

from beamenv.configuration.files import checked_path, content_of, of_file, parsed_arrays, read_table
from beamenv.configuration.sentence import shown, unknown_field
from beamenv.plant.matrices import PlantMatrices
from beamenv.plant.signals import Signal
from beamenv.plant.state_space import FIELDS, plant_of_model

ENDINGS = (".npz", ".mat", ".json")

NEEDED = ("A", "B", "C")
SIGNALS = ("disturbances", "sensors")
NUMBERS = ("dt", "interval")
WORDS = ("disturbance_names", "disturbance_units", "sensor_names", "sensor_units")
BESIDE = ("origin",)
"""In words, where a model comes from: read by people alone."""


def plant_from_file(path: str | os.PathLike[str], name: str = "plant") -> PlantMatrices:
    """The plant of the model in a file. ``A``, ``B`` and ``C`` must be there, what else ``state_space`` takes may.

    Raises ``ValueError`` of one sentence, with the file's name in it, for another ending, a file that cannot be read, a key that is
    missing or unknown, and whatever ``Plant.from_state_space`` refuses.
    """
    place = checked_path(name, path, ENDINGS)
    content = _content(place)
    with of_file(place):
        return plant_from_table(content)


def plant_from_table(content: Mapping[str, Any]) -> PlantMatrices:
    """The plant of a table of matrices: of a model, or with ``state_weight`` all fields of a ``Plant``, as ``plant_table`` tells
    them. ``ValueError`` for a key that is missing or unknown.
    """
    if "state_weight" not in content:
        return plant_of_model(**fields_of(content))
    known = [each.name for each in fields(PlantMatrices)]
    for key in content:
        if key not in known:
            raise unknown_field("plant", key, known)
    for each in fields(PlantMatrices):
        if each.default is MISSING and each.name not in content:
            raise ValueError(f"plant.{each.name} is missing.")
    states = len(np.atleast_1d(content["A"]))
    return PlantMatrices(**{key: _whole(key, value, states) for key, value in content.items()})


def plant_table(plant: PlantMatrices) -> dict[str, Any]:
    """Every field of a plant as JSON can hold it; ``plant_from_table`` takes it back, to the last bit."""
    table = {}
    for each in fields(PlantMatrices):
        value = getattr(plant, each.name)
        signals = each.name in SIGNALS
        table[each.name] = [asdict(one) for one in value] if signals else value.tolist() if isinstance(value, np.ndarray) else value
    return {**table, "assumed": list(plant.assumed)}


def _whole(key: str, value: Any, states: int) -> Any:
    """Signals of tables, and the shape that lists without entries have lost."""
    if key in SIGNALS and isinstance(value, (list, tuple)):
        return tuple(Signal(**each) if isinstance(each, Mapping) and set(each) == {"name", "unit"} else each for each in value)
    if key in ("tip_displacement", "strain", "process_noise") and np.size(value) == 0:
        return np.zeros((0, 0 if key == "process_noise" else states))
    return value


def fields_of(content: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of ``plant_of_model`` in a file's content; ``ValueError`` for a key that is missing or unknown."""
    for key in content:
        if key not in (*FIELDS, *BESIDE):
            raise unknown_field("the model", key, FIELDS)
    for key in NEEDED:
        if key not in content:
            raise ValueError(f"{key} is missing.")
    return {key: _plain(key, value) for key, value in content.items() if key not in BESIDE and value is not None}


def _content(place: Path) -> dict[str, Any]:
    ending = place.suffix.lower()
    if ending == ".json":
        return read_table(place)
    return parsed_arrays(content_of(place), str(place)) if ending == ".npz" else _of_mat(content_of(place), str(place))


def _of_mat(content: bytes, name: str) -> dict[str, Any]:
    try:
        there = loadmat(io.BytesIO(content))
    except Exception as error:  # noqa: BLE001 - a damaged file makes SciPy raise whatever comes first
        why = (
            "it is of MATLAB 7.3, save it with -v7"
            if "HDF" in str(error) or isinstance(error, NotImplementedError)
            else "it is no .mat"
        )
        raise ValueError(f"file {shown(name)} cannot be read: {why}.") from None
    return {key: value for key, value in there.items() if not key.startswith("__")}


def _plain(key: str, value: Any) -> Any:
    """Numbers of arrays with one entry, and lists of the strings in cells; everything else as it is."""
    if not isinstance(value, np.ndarray):
        return value
    if key in NUMBERS and value.size == 1:
        return value.reshape(()).item()
    if key in WORDS:
        return [str(np.asarray(each).reshape(-1)[0]) if np.size(each) else "" for each in value.reshape(-1)]
    if value.ndim == 2 and 1 in value.shape and key not in ("A", "B", "C", "D", "disturbance_input", "tip_displacement"):
        return value.reshape(-1) if value.size > 1 else value.reshape(())  # MATLAB's numbers and rows are matrices
    return value
