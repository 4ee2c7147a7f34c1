"""Trained policies in folders: ``weights.npz`` and ``agent.json``. Loading one executes no code."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from baselines.design.instruments import checked_plant
from beamenv.configuration import Choice, Refused, Text, checked
from beamenv.configuration.files import of_file, parsed_arrays
from beamenv.configuration.writing import write_whole
from beamenv.plant.differences import differences
from beamenv.plant.fingerprint import fingerprint
from beamenv.plant.plant import Plant, normalised
from beamenv.task import resolve_task
from train.controllers.belief_policy import BeliefPolicy
from train.controllers.lstm_policy import LSTMPolicy
from train.controllers.models_policy import ModelsPolicy
from train.controllers.policies import HistoryPolicy, Policy, RecurrentPolicy, ResidualPolicy, StateSpacePolicy
from train.controllers.policy_parts import checked_settings, checked_weights, limits
from train.shared.files import as_path, read_json, write_json

KINDS: Mapping[str, type[Policy]] = {
    kind.kind: kind
    for kind in (HistoryPolicy, RecurrentPolicy, StateSpacePolicy, ResidualPolicy, ModelsPolicy, LSTMPolicy, BeliefPolicy)
}

FORMAT = 1
"""Of ``agent.json``, and what it says if it says none."""

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
    write_json(folder / "agent.json", {"format": FORMAT, **dict(zip(OWN_KEYS, own, strict=True)), **(about or {})})


def read_about(folder: Path) -> dict[str, Any]:
    """What ``agent.json`` says; ``ValueError`` if it is not there, or is no such file."""
    folder = as_path("folder", folder)
    path = folder / "agent.json"
    if not path.is_file():
        runs = sorted(str(each.parent) for each in folder.glob("*/agent.json"))
        found = f"it holds those of {len(runs)} runs, so name one of {', '.join(runs)}" if runs else "agent.json is not there"
        raise ValueError(f"folder = {str(folder)!r} must hold a trained agent: {found}.")
    about = read_json(path)
    missing = [key for key in OWN_KEYS if not isinstance(about, dict) or key not in about]
    if missing:
        raise ValueError(f"{str(path)!r} must be a JSON object with the keys {', '.join(OWN_KEYS)}: {missing[0]!r} is not there.")
    with of_file(path):
        if about.get("format", FORMAT) != FORMAT:
            raise Refused("format", about["format"], f"{FORMAT}: another version of beamenv has written this agent")
        checked("kind", about["kind"], Choice(tuple(KINDS)))
    whole: dict[str, Any] = about
    return whole


def load_policy(folder: Path, plant: Plant | None = None) -> Policy:
    """The policy saved in a folder, within the drive limits of ``plant``, the design plant it is to work on, if one is given.

    Raises ValueError of one sentence, with the file's name in it, if there is none, if files are damaged or hold what no policy can
    act by, and if it was trained on other plants than ``plant``.
    """
    folder, about = as_path("folder", folder), read_about(folder)
    if plant is not None:
        _check_plant(about, folder, checked_plant(plant))
    path = folder / "weights.npz"
    with of_file(folder / "agent.json"):
        name, lowest, highest = checked("name", about["name"], Text()), *limits(about["lowest"], about["highest"])
        settings = checked_settings(about["kind"], about["settings"])
    try:
        content = path.read_bytes()
    except OSError as error:
        raise ValueError(f"file {str(path)!r} cannot be read: {error.strerror}.") from None
    arrays = parsed_arrays(content, str(path))
    with of_file(path):
        weights = checked_weights(about["kind"], arrays, len(lowest), None if plant is None else len(plant.C))
    policy = KINDS[about["kind"]](name, weights, settings, lowest, highest)
    return policy if plant is None else within_limits(policy, plant)


def within_limits(policy: Policy, plant: Plant) -> Policy:
    """The policy behind the drive of a plant."""
    lowest, highest = normalised(plant).voltage_limits.astype(np.float32)
    return replace(policy, lowest=lowest, highest=highest)


def _check_plant(about: Mapping[str, Any], folder: Path, plant: Plant) -> None:
    known, own = about.get("plants"), fingerprint(plant)
    if not isinstance(known, Mapping) or not known or not all(isinstance(each, str) for each in known.values()):
        raise ValueError(f"the agent in {str(folder)!r} does not say what plant it was trained on: train it again.")
    if own not in known.values():
        raise ValueError(
            f"plant is none of those the agent in {str(folder)!r} was trained on, in {', '.join(known)}: {_other(about, plant)}."
        )


def _other(about: Mapping[str, Any], plant: Plant) -> str:
    """In what a plant differs from the first that an agent was trained on, where its file tells how that is made."""
    plants = about["plants"]
    name = "nominal" if "nominal" in plants else next(iter(plants))
    try:
        trained = resolve_task(**{**about["environment"], "scenario": name}).design_plant
    except (KeyError, TypeError, ValueError):  # a file or a model that is not here, or arguments of another version
        trained = None
    if trained is None or fingerprint(trained) != plants[name]:
        return f"it has the fingerprint {fingerprint(plant)[:12]}…, and that of {name} {plants[name][:12]}…"
    return f"beside that of {name} it has {differences(plant, trained)}"
