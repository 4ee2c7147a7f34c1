"""Doors of the export: controllers drawn and written."""

import shutil
from functools import cache
from pathlib import Path

from baselines import velocity_feedback
from beamenv.plant.plant import Plant
from beamenv.task import resolve_task
from tests.fuzz.meaning import ANYTHING, PATH, TEXT, instance, maybe
from tests.fuzz.oracle import Door
from train.export import export, exported


@cache
def plant():
    return resolve_task().design_plant


@cache
def law():
    return velocity_feedback(plant())


def written(**given):
    before = set(Path.cwd().iterdir())
    found = export(**given)
    for each in set(Path.cwd().iterdir()) - before:
        shutil.rmtree(each) if each.is_dir() else each.unlink()
    return found


def told(found):
    return {"plant": found.plant, "precision": found.precision, "name": found.name, "note": found.note}


KINDS = {"controller": ANYTHING, "plant": instance(Plant), "precision": TEXT, "name": maybe(TEXT), "note": TEXT}

DOORS = [
    Door(
        "exported",
        exported,
        KINDS,
        lambda: {"controller": law(), "plant": plant(), "precision": "double", "name": "mine", "note": ""},
        told,
    ),
    Door(
        "export",
        written,
        {**KINDS, "path": PATH, "format": maybe(TEXT)},
        lambda: {
            "controller": law(),
            "plant": plant(),
            "path": "mine.c",
            "format": "c",
            "precision": "double",
            "name": "mine",
            "note": "x",
        },
        plain=False,
    ),
]
