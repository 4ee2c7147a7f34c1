"""Trained policies in folders: ``weights.npz`` and ``agent.json``. Loading one executes no code."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from beamenv.configuration.writing import write_whole
from beamenv.plant.fingerprint import fingerprint
from beamenv.plant.plant import Plant, normalised
from train.controllers.lstm_policy import LSTMPolicy
from train.controllers.policies import HistoryPolicy, Policy, RecurrentPolicy, ResidualPolicy
from train.shared.files import write_json

KINDS: Mapping[str, type[Policy]] = {kind.kind: kind for kind in (HistoryPolicy, RecurrentPolicy, ResidualPolicy, LSTMPolicy)}

OWN_KEYS = ("kind", "name", "settings", "lowest", "highest")
"""What ``agent.json`` must hold."""


def save_policy(policy: Policy, folder: Path, about: Mapping[str, Any] | None = None) -> None:
    """``weights.npz`` and, last, ``agent.json``: a folder with the latter is whole.

    ``about`` is what else the latter is to tell; "plants", fingerprints by scenario, are those that ``load_policy`` accepts.
    """
    arrays = io.BytesIO()
    np.savez_compressed(arrays, **cast(dict[str, Any], policy.weights))
    (folder / "agent.json").unlink(missing_ok=True)  # that of an earlier agent must never stand beside other weights
    write_whole(folder / "weights.npz", arrays.getvalue())
    own = (policy.kind, policy.name, dict(policy.settings), policy.lowest.tolist(), policy.highest.tolist())
    write_json(folder / "agent.json", {**dict(zip(OWN_KEYS, own, strict=True)), **(about or {})})


def read_about(folder: Path) -> dict[str, Any]:
    """What ``agent.json`` says; ``ValueError`` if it is not there, or is no such file."""
    path = folder / "agent.json"
    if not path.is_file():
        runs = sorted(str(each.parent) for each in folder.glob("*/agent.json"))
        found = f"it holds those of {len(runs)} runs, so name one of {', '.join(runs)}" if runs else "agent.json is not there"
        raise ValueError(f"folder = {str(folder)!r} must hold a trained agent: {found}.")
    try:
        about = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ValueError(f"{str(path)!r} cannot be read: {error}.") from None
    missing = [key for key in OWN_KEYS if not isinstance(about, dict) or key not in about]
    if missing:
        raise ValueError(f"{str(path)!r} must be a JSON object with the keys {', '.join(OWN_KEYS)}: {missing[0]!r} is not there.")
    if about["kind"] not in KINDS:
        raise ValueError(f"kind = {about['kind']!r} of the agent in {str(folder)!r} must be one of {', '.join(KINDS)}.")
    whole: dict[str, Any] = about
    return whole


def load_policy(folder: Path, plant: Plant | None = None) -> Policy:
    """The policy saved in a folder, within the drive limits of ``plant``, the design plant it is to work on, if one is given.

    Raises ValueError if there is none, if files are damaged, and if it was trained on other plants than ``plant``.
    """
    about = read_about(folder)
    if plant is not None:
        _check_plant(about, folder, plant)
    path = folder / "weights.npz"
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as arrays:
            weights = {name: arrays[name] for name in arrays.files}
        lowest, highest = (np.array(about[name], dtype=np.float32) for name in ("lowest", "highest"))
        policy = KINDS[about["kind"]](about["name"], weights, about["settings"], lowest, highest)
        assert policy.memory_size
    except KeyError as error:
        raise ValueError(f"{str(path)!r} must hold the weights of a {about['kind']!r} policy: {error} is not there.") from None
    except (OSError, ValueError, TypeError, IndexError, EOFError, AttributeError, zipfile.BadZipFile) as error:
        raise ValueError(f"the agent in {str(folder)!r} cannot be read: {error}.") from None
    return policy if plant is None else within_limits(policy, plant)


def within_limits(policy: Policy, plant: Plant) -> Policy:
    """The policy behind the drive of a plant."""
    lowest, highest = normalised(plant).voltage_limits.astype(np.float32)
    return replace(policy, lowest=lowest, highest=highest)


def _check_plant(about: Mapping[str, Any], folder: Path, plant: Plant) -> None:
    known, own = about.get("plants"), fingerprint(plant)
    if not isinstance(known, Mapping) or not known:
        raise ValueError(f"the agent in {str(folder)!r} does not say what plant it was trained on: train it again.")
    if own not in known.values():
        raise ValueError(
            f"plant with the fingerprint {own[:12]}… is none of those the agent in {str(folder)!r} was trained on: "
            f"{', '.join(f'{name} {value[:12]}…' for name, value in known.items())}."
        )
