"""Plant files: NumPy's ``.npz`` with an array for each field of a ``ModalPlant``, in its units; and those that ship, by name.

A file needs ``natural_frequencies``, ``gyroscopic``, ``actuation``, ``charges``, ``line_load`` and ``tip``; it may have ``strain``,
``damping_ratio``, ``speed``, ``blade``, ``origin``, further loads (``further_loads`` and ``load_places``) and further sensors
(``sensor_position``, ``sensor_rate``, ``sensor_acceleration`` and ``sensor_list``, perhaps ``sensor_static`` and
``sensor_static_rate``).
"""

from __future__ import annotations

import io
from dataclasses import MISSING, fields
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from beamenv.configuration import Instance, checked
from beamenv.configuration.files import checked_path, content_of, of_file, parsed_arrays
from beamenv.configuration.sentence import unknown_field
from beamenv.configuration.writing import write_whole
from beamenv.plant import named
from beamenv.plant.modal_plant import ModalPlant
from beamenv.plant.named import ENDING, NAMES

_FIELDS = [each.name for each in fields(ModalPlant)]
_NEEDED = [each.name for each in fields(ModalPlant) if each.default is MISSING]


def load_plant(source: str | Path) -> ModalPlant:
    """The plant in a file, or the one that ships under a name.

    Raises ``ValueError`` of one sentence, with the file's name in it, for a name that is none, a file that cannot be read, a key
    that is missing or unknown, and whatever ``ModalPlant`` refuses.
    """
    if isinstance(source, str) and source in NAMES:
        return _shipped(source)
    path = checked_path("plant", source, (ENDING,), f"one of {', '.join(NAMES)}, or the path of a {ENDING} file")
    return _of_bytes(content_of(path), str(path))


def save_plant(plant: ModalPlant, path: str | Path) -> None:
    """Write a plant to a file, whole or not at all; ``ValueError`` for another ending, and where it cannot be written."""
    checked("plant", plant, Instance(ModalPlant))
    path = checked_path("path", path, (ENDING,))
    content = {name: value for name in _FIELDS if (value := getattr(plant, name)) is not None and not _is_empty(value)}
    file = io.BytesIO()
    np.savez_compressed(file, **content)
    try:
        write_whole(path, file.getvalue())
    except OSError as error:
        raise ValueError(f"file {str(path)!r} cannot be written: {error.strerror or error}.") from None


def _is_empty(value: Any) -> bool:
    return isinstance(value, str) and not value


@lru_cache
def _shipped(name: str) -> ModalPlant:
    return _of_bytes(files(named).joinpath(f"{name}{ENDING}").read_bytes(), name)


def _of_bytes(content: bytes, name: str) -> ModalPlant:
    arrays = parsed_arrays(content, name)
    with of_file(name):
        return _of_arrays(arrays)


def _of_arrays(arrays: dict[str, Any]) -> ModalPlant:
    for key in arrays:
        if key not in _FIELDS:
            raise unknown_field("plant", key, _FIELDS)
    for key in _NEEDED:
        if key not in arrays:
            raise ValueError(f"plant.{key} is missing.")
    return ModalPlant(**{key: value.item() if value.ndim == 0 else value for key, value in arrays.items()})
