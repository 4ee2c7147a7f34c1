"""Where Minari keeps data sets, and how one gets there: whole, or not at all."""

from __future__ import annotations

import os
import re
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from minari.data_collector import EpisodeBuffer
from minari.dataset.minari_storage import METADATA_FILE_NAME, MinariStorage

from beamenv.configuration import Refused
from train.datasets.taped import Episode
from train.shared.files import check_folder
from train.shared.lock import held

DATA = "data"
"""Folder of a data set's files, within that of its name."""

NAME = re.compile(r"([-\w]{2,60}/([-\w]{1,60}/){0,4})?[-\w]{1,120}-v\d{1,6}", re.ASCII)
"""What Minari takes, and every file system."""


def root_of(folder: Path | None) -> Path:
    """The folder of all data sets: the one given, or where Minari itself looks. Absolute: Minari does not find relative ones."""
    home = os.environ.get("MINARI_DATASETS_PATH") or Path.home() / ".minari" / "datasets"
    return Path(home if folder is None else folder).absolute()


def checked_place(root: Path, name: str, overwrite: bool) -> Path:
    """The folder of a data set of that name; ``ValueError`` for a name that is none, and one that something else has.

    What is there is replaced only if it is a data set and ``overwrite`` is given.
    """
    if not isinstance(name, str) or not NAME.fullmatch(name):
        raise Refused(
            "name", name, "as beamenv/lqg-nominal-v0: letters, digits, - and _, perhaps namespaces before, a version last"
        )
    place = root / name
    for path, argument in ((root, "folder"), (place, "name")):
        check_folder(path, argument)
    if around := next((each for each in place.parents if each != root and root in each.parents and _is_data_set(each)), None):
        raise Refused("name", name, f"outside the data set {around.relative_to(root).as_posix()!r}")
    if place.exists() and not _is_data_set(place):
        raise Refused("name", name, f"another one: {str(place)!r} is there, and is no data set")
    if place.exists() and not overwrite:
        raise ValueError(f"name = {name!r} is a data set already, in {str(root)!r}: overwrite it, or give another name.")
    return place


def _is_data_set(place: Path) -> bool:
    return (place / DATA / METADATA_FILE_NAME).is_file()


@contextmanager
def put_in_place(place: Path) -> Iterator[Path]:
    """A hidden folder beside a place that takes it, in place of what is there, when the block has ended without an error.

    Otherwise nothing stays; what an earlier process that was killed has left there is removed.
    """
    made = [each for each in place.parents if not each.exists()]
    place.parent.mkdir(parents=True, exist_ok=True)
    _remove_left(place)
    folder, former = (place.with_name(f".{place.name}.{secrets.token_hex(4)}.part") for _ in range(2))
    try:
        folder.mkdir()
        with held(folder):
            yield folder
        if place.exists():
            os.replace(place, former)
        os.replace(folder, place)
    finally:
        for each in (folder, former):
            shutil.rmtree(each, ignore_errors=True)
        with suppress(OSError):  # one that is not empty stays
            for each in made:
                each.rmdir()


def _remove_left(place: Path) -> None:
    """What others had begun beside a place and do not hold any more."""
    for each in place.parent.glob(f".{place.name}.*.part"):
        with suppress(ValueError, OSError), held(each):
            shutil.rmtree(each, ignore_errors=True)


def begun(folder: Path, env: Any) -> MinariStorage:
    """An empty data set of an environment in a folder."""
    return MinariStorage.new(
        folder / DATA, observation_space=env.observation_space, action_space=env.action_space, env_spec=env.spec, data_format="hdf5"
    )


def add(storage: MinariStorage, episodes: list[Episode]) -> None:
    """Append whole episodes."""
    storage.update_episodes(
        EpisodeBuffer(
            seed=each.seed,
            observations=each.observations,
            actions=each.actions,
            rewards=each.rewards,
            terminations=each.terminations,
            truncations=each.truncations,
            infos=each.infos,
        )
        for each in episodes
    )
