"""Digests of what a kept result depends on: it is used again only while its digest is the same.

What a result depends on is a list of modules and packages by their dotted names. A name that no longer leads to a file is an
error: else a file that is moved would silently stop to count.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

import beamenv

ROOT = Path(__file__).resolve().parents[2]
"""Folder that holds ``baselines`` and ``train``: beside ``beamenv``, or inside it once that is installed."""

CONTROLLERS = (
    "beamenv",
    "baselines.analysis",
    "baselines.design",
    "baselines.evaluation",
    "baselines.laws",
    "train.controllers.policies",
    "train.controllers.general_bank",
    "train.controllers.hypotheses",
    "train.controllers.lstm_policy",
    "train.controllers.models_policy",
    "train.controllers.policy_files",
)
"""What decides the voltages of a controller and the motion they cause: of ``baselines`` all but identification and placement, which
make plants and layouts that are given."""

SUFFIXES = (".py", ".csv", ".toml", ".mplstyle")
"""Of files in a package that decide results."""


def digest(*contents: bytes) -> str:
    """Sixteen hexadecimal digits that change with any of the contents and with where one ends and the next begins."""
    total = hashlib.sha256()
    for content in contents:
        total.update(len(content).to_bytes(8, "big") + content)
    return total.hexdigest()[:16]


def source_digest(names: Iterable[str], root: Path | None = None) -> str:
    """Of all source and data files of modules and packages; ``ModuleNotFoundError`` if one of them is not there."""
    return digest(*(path.read_bytes() for name in names for path in source_files(name, root)))


def source_files(name: str, root: Path | None = None) -> list[Path]:
    """The file of a module, or all in a package, in order of their paths; ``ModuleNotFoundError`` if it is not there.

    ``root`` is the folder that holds the packages, if they are not to be those that run.
    """
    parts = name.split(".")
    home = Path(beamenv.__file__).resolve().parents[1] if parts[0] == "beamenv" else ROOT
    place = (root or home).joinpath(*parts)
    module = place.with_name(f"{place.name}.py")
    own = (path for path in place.rglob("*") if "_wings" not in path.relative_to(place).parts)  # installed, they lie in beamenv
    found = [module] if module.is_file() else sorted(path for path in own if path.suffix in SUFFIXES)
    if not found:
        raise ModuleNotFoundError(f"module {name!r}, which kept results depend on, is not in {str(root or home)!r}.", name=name)
    return found
