"""Checkpoints of a training: written whole or not at all, and read as tensors and numbers alone, so loading executes no code."""

from __future__ import annotations

import io
import pickle
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import torch

from beamenv.configuration.writing import write_whole

NAME = "checkpoint.pt"


def write_checkpoint(folder: Path, content: Mapping[str, Any]) -> None:
    """``checkpoint.pt``, of numbers, strings, lists, dictionaries, tensors, and arrays, which become tensors."""
    file = io.BytesIO()
    torch.save(as_tensors(content), file)
    write_whole(folder / NAME, file.getvalue())


def as_tensors(content: Any) -> Any:
    """The content with its arrays as tensors: torch reads arrays only where code may be executed."""
    if isinstance(content, Mapping):
        return {name: as_tensors(value) for name, value in content.items()}
    if isinstance(content, list | tuple):
        return [as_tensors(value) for value in content]
    return torch.as_tensor(content) if isinstance(content, np.ndarray) else content


def read_checkpoint(folder: Path) -> dict[str, Any]:
    """What ``write_checkpoint`` wrote; ``ValueError`` if nothing is there, or something else."""
    path = folder / NAME
    if not path.is_file():
        raise ValueError(f"folder = {str(folder)!r} must hold a checkpoint to resume from: {NAME} is not there.")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # torch only warns of a protocol that it never writes
            content: dict[str, Any] = torch.load(path, weights_only=True)
    except (OSError, EOFError, RuntimeError, UserWarning, pickle.UnpicklingError):
        raise ValueError(
            f"{str(path)!r} must be a checkpoint of tensors and numbers, but is damaged or holds something else."
        ) from None
    return content
