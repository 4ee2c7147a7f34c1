"""The table of what linear probes find, measured and kept: ``memory.csv`` beside this file ships."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from beamenv.configuration.writing import write_whole
from beamenv.task import resolve_task
from train.controllers.shipped import find_shipped
from train.controllers.sources import Trained
from train.probing.memories import QUESTIONS, Array, Question, Recorded, recorded
from train.probing.probe import Score, probed

FILE = Path(__file__).with_name("memory.csv")
AGENT, HOME, RUN = "gradient", "generalist", 0
WITHIN = 0.05
"""s: instants that are looked at together, those of the last one."""
HEADER = ("question", "scenario", "classes", "chance", "time", "features", "value", "low", "high")
FEATURES = ("memory", "window", "magnitudes", "shuffled")
"""Hidden units; as many of the latest readings and voltages; their magnitudes; hidden units of other episodes."""


@dataclass(frozen=True, slots=True)
class Row:
    """How well a question is answered from what there is at a time."""

    question: str
    scenario: str
    classes: bool
    chance: float
    """What guesses come to: 0 of R², one over the number of kinds of balanced accuracy."""
    time: float
    """s, at the end of the instants."""
    features: str
    score: Score


def measured(seeds: Sequence[int], progress: Callable[[str], None]) -> list[Row]:
    """The rows of all questions; ``progress`` is told of each."""
    rows: list[Row] = []
    for question in QUESTIONS:
        progress(f"{question.name} in {question.scenario}, {len(seeds)} episodes")
        policy = Trained(find_shipped(AGENT, HOME, RUN).folder).build(resolve_task(scenario=question.scenario))
        rows += rows_of(question, recorded(policy, question, seeds))
    return rows


def rows_of(question: Question, episodes: Recorded) -> Iterator[Row]:
    """Of one question, every ``WITHIN``."""
    chance = 1.0 / len(np.unique(episodes.truth)) if question.classes else 0.0
    for end in np.arange(WITHIN, episodes.time[-1] + 1e-9, WITHIN):
        some = (episodes.time > end - WITHIN + 1e-9) & (episodes.time <= end + 1e-9)
        for name, features, truth in _kinds(episodes, some):
            score = probed(features, truth, question.classes)
            yield Row(question.name, question.scenario, question.classes, chance, float(end), name, score)


def _kinds(episodes: Recorded, some: Array) -> Iterator[tuple[str, Array, Array]]:
    shuffled = np.random.default_rng(0).permutation(episodes.truth)
    window, hidden = episodes.window[:, some], episodes.hidden[:, some]
    truths = (episodes.truth, episodes.truth, episodes.truth, shuffled)
    yield from zip(FEATURES, (hidden, window, np.abs(window), hidden), truths, strict=True)


def write_rows(path: Path, rows: Sequence[Row]) -> None:
    """As CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADER)
    for row in rows:
        numbers = (row.score.value, row.score.low, row.score.high)
        named = (row.question, row.scenario, int(row.classes), f"{row.chance:.4f}", f"{row.time:.2f}", row.features)
        writer.writerow([*named, *(f"{number:.4f}" for number in numbers)])
    write_whole(path, text.getvalue().encode())


def read_rows(path: Path = FILE) -> list[Row]:
    """The rows that ship."""
    with path.open(encoding="utf-8", newline="") as file:
        return [_row(each) for each in csv.DictReader(file)]


def _row(told: dict[str, str]) -> Row:
    score = Score(float(told["value"]), float(told["low"]), float(told["high"]))
    classes, chance, time = bool(int(told["classes"])), float(told["chance"]), float(told["time"])
    return Row(told["question"], told["scenario"], classes, chance, time, told["features"], score)
