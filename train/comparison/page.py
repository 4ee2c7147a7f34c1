"""The comparison as a page: ``report.html``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines import Controller, Evaluation, LinearController, closed_loop_poles
from beamenv.plant.plant import Plant
from train.comparison.figures import clearest_episode, which_episode
from train.comparison.table import Tiers, caption, cells, headings, notes, ranked
from train.page import Cell, LearningCurves, PageContent, Table, record_episode, write_page
from train.shared.columns import EVALUATION

Array = NDArray[np.float64]

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
) -> None:
    """Write ``report.html``; ``controllers`` are in the order of the ``evaluations``, ``curves`` and ``levels`` as in ``figures``.

    The blade is shown in the episode of ``figures`` under the best law with sensors and the best agent; without agents, under
    no control and the best law. A model of one's own, which has no shape, shows the signals of that episode alone.
    """
    seed = evaluations[0].episodes.seeds[clearest_episode(evaluations[0])]
    linear = {law.name: law for law in controllers.values() if isinstance(law, LinearController)}
    episode = record_episode(environment, seed, shown_pair(evaluations, controllers))
    content = PageContent(
        title=f"Controllers compared on a {'rotating blade' if episode.has_shape else 'model'}",
        note="\n".join([*notes(left_out), *([] if episode.has_shape else [NO_SHAPE])]),
        table=page_table(evaluations, tiers),
        episode=episode,
        episode_note=f"Held-out episode of seed {seed}, {which_episode(evaluations[0])}.",
        poles={name: closed_loop_poles(plant, law) for name, law in linear.items() if law.observes == "observation"},
        learning=LearningCurves(curves, levels),
        configuration=configuration,
    )
    write_page(folder / "report.html", content)


def page_table(evaluations: Sequence[Evaluation], tiers: Tiers = None) -> Table:
    """Controllers, best first, to be sorted by a click."""
    rows = []
    for evaluation in ranked(evaluations):
        name, *texts = cells(evaluation, tiers)
        numbers = [float(tiers[name])] if tiers else []
        numbers += [getattr(evaluation, column.name).value for column in EVALUATION]
        rows.append((Cell(name), *(Cell(text, number) for text, number in zip(texts, numbers, strict=True))))
    return Table(tuple(headings(tiers)), tuple(rows), caption(evaluations, tiers))


def shown_pair(evaluations: Sequence[Evaluation], controllers: Mapping[str, Controller]) -> tuple[Controller, Controller]:
    """Best law with sensors and best agent, or no control, the first of ``controllers``, and the best law."""
    best = sorted(zip(evaluations, controllers.values(), strict=True), key=lambda each: each[0].relative_cost.value)
    laws = [law for _, law in best if isinstance(law, LinearController) and law.observes == "observation"]
    agents = [law for _, law in best if not isinstance(law, LinearController)]
    return (laws[0], agents[0]) if agents else (next(iter(controllers.values())), laws[0])
