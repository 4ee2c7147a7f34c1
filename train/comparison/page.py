"""The comparison as a page: ``report.html``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines import Controller, Evaluation, LinearController, closed_loop_poles
from beamenv.knowledge import TRUTH
from beamenv.plant.plant import Plant
from train.comparison.figures import clearest_episode, which_episode
from train.comparison.table import Tiers, caption, cells, headings, notes, ranked
from train.page import Cell, Lead, LearningCurves, PageContent, RecordedEpisode, Table, record_episode, write_page
from train.page.lead import COST, blade_in_words, load_in_words
from train.page.recording import RecordingProgress
from train.shared.columns import EVALUATION

Array = NDArray[np.float64]

COLUMN = next(column for column in EVALUATION if column.name == "relative_cost")

NO_SHAPE = "The plant is a model without a shape: no blade is drawn."


def write_comparison_page(
    folder: Path,
    plant: Plant,
    evaluations: Sequence[Evaluation],
    controllers: Mapping[str, Controller],
    curves: Mapping[str, Array],
    levels: Mapping[str, float],
    configuration: Mapping[str, Any],
    environment: Mapping[str, Any],
    tiers: Tiers = None,
    left_out: Mapping[str, str] = MappingProxyType({}),
    progress: RecordingProgress | None = None,
) -> None:
    """Write ``report.html``; ``controllers`` are in the order of the ``evaluations``, ``curves`` and ``levels`` as in ``figures``.

    The blade is shown in the episode of ``figures``, first without control beside the best controller; readers choose among all.
    A model of one's own, which has no shape, shows the signals of that episode alone. ``progress`` is called before each recording.
    """
    seed = evaluations[0].episodes.seeds[clearest_episode(evaluations[0])]
    linear = {law.name: law for law in controllers.values() if isinstance(law, LinearController)}
    best = best_rival(evaluations, controllers, tiers)
    ordered = sorted(zip(evaluations, controllers.values(), strict=True), key=lambda each: each[0].relative_cost.value)
    episode = record_episode(environment, seed, {evaluation.name: law for evaluation, law in ordered}, best.name, progress)
    content = PageContent(
        title=f"Controllers compared on a {'rotating blade' if episode.has_shape else 'model'}",
        lead=lead(evaluations, best, episode, environment),
        note="\n".join([*notes(left_out), *([] if episode.has_shape else [NO_SHAPE])]),
        table=page_table(evaluations, tiers),
        episode=episode,
        episode_note=f"Held-out episode of seed {seed}, {which_episode(evaluations[0])}. J₀: J without control, in this episode.",
        poles={name: closed_loop_poles(plant, law) for name, law in linear.items() if law.observes == "observation"},
        learning=LearningCurves(curves, levels),
        configuration=configuration,
    )
    write_page(folder / "report.html", content)


def lead(evaluations: Sequence[Evaluation], best: Evaluation, episode: RecordedEpisode, environment: Mapping[str, Any]) -> Lead:
    """The best controller's J, what moved under which loads, and how this was made."""
    scenario, count = environment.get("scenario", "nominal"), len(best.episodes.seeds)
    named = f", those of the scenario {scenario!r}" if isinstance(scenario, str) else ""
    return Lead(
        f"Under {best.name}, {COST} is {COLUMN.text(best.relative_cost)} of what it is without control, the least of all the "
        "controllers here that see no more than a real blade shows.",
        f"What moves is {blade_in_words(episode.blade)}; its loads are {load_in_words(episode.task.scenario)}{named}, in {count} "
        "held-out episodes.",
    )


def page_table(evaluations: Sequence[Evaluation], tiers: Tiers = None) -> Table:
    """Controllers, best first, to be sorted by a click."""
    rows = []
    for evaluation in ranked(evaluations):
        name, *texts = cells(evaluation, tiers)
        numbers = [float(tiers[name])] if tiers else []
        numbers += [getattr(evaluation, column.name).value for column in EVALUATION]
        rows.append((Cell(name), *(Cell(text, number) for text, number in zip(texts, numbers, strict=True))))
    return Table(tuple(headings(tiers)), tuple(rows), caption(evaluations, tiers))


def best_rival(evaluations: Sequence[Evaluation], controllers: Mapping[str, Controller], tiers: Tiers = None) -> Evaluation:
    """The least J of all that see no more than sensors show; without any, of all."""
    pairs = list(zip(evaluations, controllers.values(), strict=True))
    rivals = [evaluation for evaluation, law in pairs if _is_rival(evaluation, law, tiers)]
    return ranked(_controlling(rivals, evaluations[0]) or _controlling(evaluations, evaluations[0]) or evaluations)[0]


def _controlling(evaluations: Sequence[Evaluation], idle: Evaluation) -> list[Evaluation]:
    return [each for each in evaluations if each is not idle]


def _is_rival(evaluation: Evaluation, law: Controller, tiers: Tiers) -> bool:
    if tiers:
        return tiers[evaluation.name] < TRUTH
    return not isinstance(law, LinearController) or law.observes == "observation"
