"""The comparison's figures: one episode of every controller, learning curves, closed-loop poles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines import Evaluation, LinearController, closed_loop_poles
from beamenv.plant.plant import Plant
from train.figures.paper import STYLE, VOLTAGE_LINES, save

Array = NDArray[np.float64]


def episode_figure(evaluations: Sequence[Evaluation], episode: int) -> Any:
    """Tip displacement over voltages (the layout of thesis Fig. 5.7), a panel for each controller, no control in grey behind."""
    import matplotlib.pyplot as plt

    columns = 3
    rows = -(-len(evaluations) // columns)
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=(11.0, 2.9 * rows), layout="constrained")
        cells = figure.subfigures(rows, columns, squeeze=False).ravel()
        reference = evaluations[0].reference
        largest = 1.05e6 * np.abs(reference.tip_displacement[:, episode]).max()
        for cell, evaluation in zip(cells, evaluations, strict=False):
            tip, volts = cell.subplots(2, 1, sharex=True)
            _draw_tip(tip, evaluation, episode, largest)
            _draw_voltages(volts, evaluation, episode)
            cell.suptitle(f"{evaluation.name}: J = {_relative(evaluation, episode):.3f} of no control", fontsize=9)
        for cell in cells[len(evaluations) :]:
            cell.set_facecolor("none")
        _legend(figure, evaluations[0].episodes.voltages.shape[2])
    return figure


def _relative(evaluation: Evaluation, episode: int) -> float:
    return float(np.nansum(evaluation.episodes.cost[:, episode]) / np.nansum(evaluation.reference.cost[:, episode]))


def _draw_tip(axis: Any, evaluation: Evaluation, episode: int, largest: float) -> None:
    time = 1e3 * evaluation.episodes.time
    for direction, dashes in ((0, "--"), (1, "-")):
        axis.plot(time, 1e6 * evaluation.reference.tip_displacement[:, episode, direction], color="0.75", linestyle=dashes)
        axis.plot(time, 1e6 * evaluation.episodes.tip_displacement[:, episode, direction], color="black", linestyle=dashes)
    axis.set(ylabel="tip, µm", ylim=(-largest, largest))


def _draw_voltages(axis: Any, evaluation: Evaluation, episode: int) -> None:
    time = 1e3 * evaluation.episodes.time
    for volts, (colour, dashes) in zip(evaluation.episodes.voltages[:, episode].T, VOLTAGE_LINES * 8, strict=False):
        axis.plot(time, 1e-3 * volts, color=colour, linestyle=dashes, linewidth=0.8)
    low, high = 1.08e-3 * evaluation.episodes.voltage_limits.T[0]
    axis.set(ylabel="voltage, kV", xlabel="time, ms", ylim=(low, high), xlim=(0.0, time[-1]))


def _legend(figure: Any, actuators: int) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color="black", linestyle="-", label="tip, flap"),
        Line2D([], [], color="black", linestyle="--", label="tip, lag"),
        Line2D([], [], color="0.75", label="tip without control"),
    ]
    for index, (colour, dashes) in zip(range(actuators), VOLTAGE_LINES * 8, strict=False):
        handles.append(Line2D([], [], color=colour, linestyle=dashes, label=f"actuator {index + 1}"))
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))


def learning_figure(curves: Mapping[str, Array], levels: Mapping[str, float]) -> Any:
    """Running cost of each agent over training time, (k, 3) of seconds, steps and cost, against controllers' lines."""
    import matplotlib.pyplot as plt

    with plt.rc_context(STYLE):
        figure, axis = plt.subplots(figsize=(6.4, 3.8), layout="constrained")
        for (name, curve), (colour, dashes) in zip(curves.items(), (("black", "-"), ("#0072b2", "--")), strict=False):
            axis.plot(
                curve[:, 0], curve[:, 2], color=colour, linestyle=dashes, label=f"{name} ({curve[-1, 1] / 1e6:.1f} million steps)"
            )
        lines: tuple[Any, ...] = (":", (0, (5, 1)), "-.")
        for (name, level), line in zip(levels.items(), lines, strict=False):
            axis.axhline(level, color="#d55e00", linestyle=line, label=f"{name}, held-out episodes: {level:.3f}")
        top = max([1.05, *(float(np.nanmedian(curve[:3, 2])) for curve in curves.values())])
        axis.set(
            xlabel="training time, s",
            ylabel="J / J without control, exploration included",
            ylim=(0.3, min(top, 2.0)),
            xlim=(0.0, None),
        )
        axis.legend(loc="upper right")
    return figure


def pole_figure(plant: Plant, controllers: Sequence[LinearController]) -> Any:
    """Poles of the sampled loops as their continuous equivalents, upper half plane."""
    import matplotlib.pyplot as plt

    with plt.rc_context(STYLE):
        figure, axis = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
        for controller, marker in zip(controllers, ("x", "+", "s", "o", "^", "v"), strict=False):
            poles = closed_loop_poles(plant, controller)
            shown = poles[poles.imag >= -1e-9]
            axis.plot(
                shown.real, shown.imag, linestyle="none", marker=marker, markersize=5, fillstyle="none", label=controller.name
            )
        axis.axvline(0.0, color="0.7", linewidth=0.8)
        axis.set_xscale("symlog", linthresh=10.0)
        axis.set_xlim(right=5.0)
        axis.set(xlabel="real part, rad/s", ylabel="imaginary part, rad/s", ylim=(0.0, 1.08 * plant.natural_frequencies[-1]))
        figure.legend(loc="outside upper center", ncols=4)
    return figure


def write_figures(
    folder: Path,
    plant: Plant,
    evaluations: Sequence[Evaluation],
    controllers: Sequence[LinearController],
    curves: Mapping[str, Array],
    levels: Mapping[str, float],
) -> None:
    """``episode.png``, ``poles.png`` and, when training has told of its progress, ``learning.png``."""
    save(episode_figure(evaluations, clearest_episode(evaluations[0])), folder / "episode.png")
    save(pole_figure(plant, controllers), folder / "poles.png")
    told = {name: curve for name, curve in curves.items() if len(curve)}
    if told:
        save(learning_figure(told, levels), folder / "learning.png")


def clearest_episode(evaluation: Evaluation) -> int:
    """The episode whose load lets the undriven tip swing most about where it comes to rest: it shows damping best."""
    response = evaluation.reference.load_response
    swing = np.linalg.norm(response - response[-len(response) // 5 :].mean(axis=0), axis=-1)
    return int(np.argmax(swing.max(axis=0)))
