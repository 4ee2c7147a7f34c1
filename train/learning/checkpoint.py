"""Checkpoints of a training: written whole or not at all, and read as tensors and numbers alone, so loading executes no code."""

from __future__ import annotations

import io
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch

from beamenv.configuration import shown
from beamenv.configuration.writing import write_whole

NAME = "checkpoint.pt"

FORMAT = 4
"""Of what a checkpoint holds of a training; one of another format is not resumed."""


def write_checkpoint(folder: Path, content: Mapping[str, Any]) -> None:
    """``checkpoint.pt``, of numbers, strings, lists, dictionaries, tensors, and arrays, which become tensors."""
    file = io.BytesIO()
    torch.save(as_tensors(content), file)
    write_whole(folder / NAME, file.getvalue())


def as_tensors(content: Any) -> Any:
    """The content with its arrays as tensors of the processor: torch reads arrays only where code may be executed."""
    if isinstance(content, Mapping):
        return {name: as_tensors(value) for name, value in content.items()}
    if isinstance(content, list | tuple):
        return [as_tensors(value) for value in content]
    return torch.as_tensor(content).cpu() if isinstance(content, np.ndarray | torch.Tensor) else content


def as_arrays(content: Any) -> Any:
    """The content with its tensors as NumPy's arrays, of which they share the numbers."""
    if isinstance(content, Mapping):
        return {name: as_arrays(value) for name, value in content.items()}
    if isinstance(content, list | tuple):
        return [as_arrays(value) for value in content]
    return content.numpy() if isinstance(content, torch.Tensor) else content


def read_checkpoint(folder: Path, keys: Sequence[str] = ()) -> dict[str, Any]:
    """What ``write_checkpoint`` wrote, a dictionary with these keys; ``ValueError`` if nothing is there, or something else."""
    path = folder / NAME
    if not path.is_file():
        raise ValueError(f"folder = {str(folder)!r} must hold a checkpoint to resume from: {NAME} is not there.")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # torch only warns of a protocol that it never writes
            content: Any = torch.load(path, weights_only=True)
    except Exception:  # noqa: BLE001 - a damaged archive makes torch, zipfile and pickle raise whatever comes first
        raise damaged(folder, "is damaged or holds something else") from None
    if not isinstance(content, dict):
        raise damaged(folder, f"holds a {type(content).__name__}")
    if keys and content.get("format") != FORMAT:
        raise damaged(folder, f"is of format {shown(content.get('format'))} where this version of beamenv reads {FORMAT}")
    if missing := [key for key in keys if key not in content]:
        raise damaged(folder, f"has no {missing[0]!r}")
    return content


def damaged(folder: Path, what: str) -> ValueError:
    """What is said of a checkpoint that cannot be resumed from."""
    return ValueError(f"{str(folder / NAME)!r} must be a checkpoint of tensors and numbers to resume from, but {what}.")
