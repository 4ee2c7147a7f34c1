"""The comparison's figures: one episode of every controller, learning curves, closed-loop poles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines import Evaluation, LinearController, closed_loop_poles
from beamenv.plant.plant import Plant
from train.figures.figure import Curve, Look, Panel
from train.figures.learning import learning_figure, with_a_cost
from train.figures.palette import BEHIND, INK, LINES
from train.figures.panels import pole_panel, voltage_curves
from train.figures.paper import draw_panel, handles, plain, save, styled

Array = NDArray[np.float64]

KILO = 300.0
"""V from which a drive's voltages are drawn in kV."""


def episode_figure(evaluations: Sequence[Evaluation], episode: int) -> Any:
    """Tip displacement over voltages (the layout of thesis Fig. 5.7), a panel for each controller, no control in grey behind.

    Of a model of one's own the displacements that it tells; of one that tells none, how J grows to that without control.
    """
    import matplotlib.pyplot as plt

    columns = 3
    rows = -(-len(evaluations) // columns)
    with styled():
        figure = plt.figure(figsize=(11.0, 3.1 * rows), layout="constrained")
        cells = figure.subfigures(rows, columns, squeeze=False).ravel()
        upper = _cost_panel if not tells_displacements(evaluations[0]) else _tip_panel
        for cell, evaluation in zip(cells, evaluations, strict=False):
            axes = cell.subplots(2, 1, sharex=True)
            drawn = [upper(evaluation, episode), _voltage_panel(evaluation, episode)]
            for axis, panel in zip(axes, drawn, strict=True):
                draw_panel(axis, panel)
            cell.suptitle(f"{plain(evaluation.name)}\nJ = {_relative(evaluation, episode):.3f} of no control", fontsize=9)
        for cell in cells[len(evaluations) :]:
            cell.set_facecolor("none")
        entries = handles(drawn)
        figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))
    return figure


def _relative(evaluation: Evaluation, episode: int) -> float:
    return float(evaluation.judged_cost[episode] / evaluation.uncontrolled[episode])


def tells_displacements(evaluation: Evaluation) -> bool:
    """Whether any is known of what moved."""
    return evaluation.reference.tip_displacement.shape[-1] > 0


def _of_model(evaluation: Evaluation) -> bool:
    """Whether what moved is a model of one's own, whose displacements may be those of any points in any direction."""
    conditions = evaluation.reference.conditions
    return conditions is not None and isinstance(conditions.blades[0], str)


def _tip_panel(evaluation: Evaluation, episode: int) -> Panel:
    points = evaluation.reference.tip_displacement.shape[-1]
    names = [f"displacement {point}" for point in range(points)] if _of_model(evaluation) else ("lag", "flap")
    curves = []
    for point, name in enumerate(names):
        line = LINES[(points - 1 - point) % len(LINES)]  # flap is solid
        for episodes, look, label in (
            (evaluation.reference, Look(BEHIND), "tip without control" if point == points - 1 else ""),
            (evaluation.episodes, Look(INK), f"tip, {name}"),
        ):
            tip = 1e6 * episodes.tip_displacement[:, episode, point]
            curves.append(Curve(1e3 * evaluation.episodes.time, tip, label, line, look))
    largest = 1.05e6 * float(np.nanmax(np.abs(evaluation.reference.tip_displacement[:, episode])))
    return Panel("", "", "tip, µm", curves, y_limits=(-largest, largest))


def _cost_panel(evaluation: Evaluation, episode: int) -> Panel:
    whole = evaluation.uncontrolled[episode]
    curves = [
        Curve(1e3 * evaluation.episodes.time, np.cumsum(episodes.cost[:, episode]) / whole, label, look=look)
        for episodes, look, label in (
            (evaluation.reference, Look(BEHIND), "J₀: J without control"),
            (evaluation.episodes, Look(INK), "J"),
        )
    ]
    highest = max(1.0, np.nan_to_num(_relative(evaluation, episode), posinf=1.0))
    return Panel("", "", "J / J₀", curves, y_limits=(0.0, 1.05 * highest))


def _voltage_panel(evaluation: Evaluation, episode: int) -> Panel:
    limits = evaluation.episodes.voltage_limits
    unit, factor = ("kV", 1e-3) if np.abs(limits).max() >= KILO else ("V", 1.0)
    time = 1e3 * evaluation.episodes.time
    low, high = 1.08 * factor * limits[0].min(), 1.08 * factor * limits[1].max()
    curves = voltage_curves(time, factor * evaluation.episodes.voltages[:, episode])
    return Panel("", "time, ms", f"voltage, {unit}", curves, x_limits=(0.0, time[-1]), y_limits=(low, high))


def pole_figure(plant: Plant, controllers: Sequence[LinearController]) -> Any:
    """Poles of the sampled loops as their continuous equivalents, upper half plane."""
    import matplotlib.pyplot as plt

    poles = {controller.name: closed_loop_poles(plant, controller) for controller in controllers}
    panel = pole_panel(poles, highest=1.08 * plant.natural_frequencies[-1])
    with styled():
        figure, axis = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
        draw_panel(axis, panel)
        axis.set_xlim(right=5.0)
        figure.legend(handles=handles([panel]), loc="outside upper center", ncols=4)
    return figure


def write_figures(
    folder: Path,
    plant: Plant,
    evaluations: Sequence[Evaluation],
    controllers: Sequence[LinearController],
    curves: Mapping[str, Array],
    levels: Mapping[str, float],
) -> None:
    """``episode.png``, ``poles.png`` and, when training reported any progress, ``learning.png``."""
    save(episode_figure(evaluations, clearest_episode(evaluations[0])), folder / "episode.png")
    save(pole_figure(plant, controllers), folder / "poles.png")
    if reported := with_a_cost(curves):
        save(learning_figure(reported, levels), folder / "learning.png")


def clearest_episode(evaluation: Evaluation) -> int:
    """The episode whose load lets the undriven tip swing most about where it comes to rest: it shows damping best.

    Blades that fail without control come last. Where no displacement is known, the episode with the largest J without control.
    """
    if not tells_displacements(evaluation):
        return int(np.argmax(evaluation.uncontrolled))
    response = evaluation.reference.load_response
    swing = np.linalg.norm(response - response[-len(response) // 5 :].mean(axis=0), axis=-1)
    return int(np.argmax(np.nan_to_num(swing, nan=-1.0).max(axis=0)))


def which_episode(evaluation: Evaluation) -> str:
    """What ``clearest_episode`` chooses, in words."""
    return "whose load makes the tip swing most" if tells_displacements(evaluation) else "whose J without control is largest"
