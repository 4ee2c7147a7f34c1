"""A controller written to a file for other machines."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from beamenv.configuration import Choice, Refused, checked
from beamenv.configuration.writing import write_whole
from beamenv.plant.plant import Plant
from train.export.c_source import c_source
from train.export.exported import Exported, exported
from train.export.mat_file import mat_file
from train.shared.files import as_path, check_file


def _onnx(exported: Exported) -> bytes:
    from train.export.onnx_model import onnx_model  # a package that few have

    return onnx_model(exported)


FORMATS: Mapping[str, Callable[[Exported], str | bytes]] = {"c": c_source, "onnx": _onnx, "mat": mat_file}
"""What writes them, by the ends of files' names."""


def export(
    controller: Any,
    plant: Plant,
    path: str | Path,
    *,
    format: str | None = None,
    precision: str = "double",
    name: str | None = None,
    note: str = "",
) -> Exported:
    """Write a controller to ``path``: from what sensors show, A in general, to voltages, V, as in an environment around ``plant``.

    ``format`` is "c", a self-contained C99 file, or "onnx" or "mat", and none that the ending of the file's name contradicts; None:
    what that says. ``precision`` is "double" or "single", and ``name`` what functions and types are called; None: the controller's
    own. ``plant`` is that of the design, such as ``env.unwrapped.design_plant``: it has the full scale of the sensors, the limits
    of the drive and the interval. ``note`` stands in the file.

    Raises ``ValueError`` of one sentence for a controller that cannot be exported, and why: one that needs the true state or a
    solver, or that is a function of which nobody knows what it does.
    """
    path = as_path("path", path)
    ending = checked_format(path.suffix.removeprefix(".") if format is None else format, path, "path")
    check_file(path, "path")
    found = exported(controller, plant, precision=precision, name=name, note=note)
    write_whole(path, FORMATS[ending](found))
    return found


def checked_format(format: Any, path: Path, name: str) -> str:
    """The format; ``ValueError`` for an unknown one, and for a file, the argument ``name``, that ends as those of another do."""
    format = str(checked("format", format, Choice(tuple(FORMATS))))
    ending = path.suffix.lower().removeprefix(".")
    if ending in FORMATS and ending != format:
        raise Refused(name, str(path), f"a file that ends in .{format} with the format {format!r}")
    return format
