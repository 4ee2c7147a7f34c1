"""Draws an episode of a model of one's own, which has no shape: its time histories."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from beamenv.plant.plant import drive_limit
from beamenv.rendering.canvas import Frame
from beamenv.rendering.charts import Chart, round_above
from beamenv.rendering.episode_renderer import EpisodeRenderer
from beamenv.rendering.history import WINDOW, History
from beamenv.rendering.palette import line_colours
from beamenv.simulation.blades import reward_scale
from beamenv.task import Task

READINGS = Chart("sensor readings, full scale", Frame(66.0, 100.0, 372.0, 160.0), -1.0, 1.0)
DISPLACEMENTS = Chart("displacement, m", Frame(66.0, 318.0, 372.0, 160.0), -1.0, 1.0)
VOLTAGES = Chart("voltage, V", Frame(546.0, 100.0, 372.0, 160.0), -1.0, 1.0)
COST = Chart("running cost J", Frame(546.0, 318.0, 372.0, 160.0), 0.0, 1.0)
CLOCK = Frame(20.0, 36.0, 400.0, 18.0)
LEFT, WIDEST = 24.0, 912.0
POINTS = 401
"""A curve is drawn through so many instants at most: more than it has pixels."""


class ModelRenderer(EpisodeRenderer):
    """Draws a model's episode: readings, voltages, cost, and displacements where the model has them."""

    def _prepare(self, task: Task) -> None:
        plant = task.plant
        window = float(f"{WINDOW * plant.time_scale:.1g}")
        usual_cost = 0.1 * window / plant.control_interval * reward_scale(plant)
        self._history = History(plant.control_interval, window)
        self._stride = -(-(round(window / plant.control_interval) + 1) // POINTS)
        readings, displacements, voltages, cost = (
            replace(each, window=window) for each in (READINGS, DISPLACEMENTS, VOLTAGES, COST)
        )
        self._least = [readings, voltages.up_to(float(drive_limit(plant).max())), cost.up_to(round_above(usual_cost))]
        self._least += [displacements.up_to(1e-12)] if len(plant.tip_displacement) else []
        self._titles = [each.name for each in plant.sensors]

    def _rest(self) -> None:
        self._charts = self._least
        self._lay_out()

    def _lay_out(self) -> None:
        self._canvas.clear()
        canvas, theme = self._canvas, self._canvas.theme
        canvas.write(canvas.fitted(self.title, "title", WIDEST), LEFT, 22.0, theme.ink, "title")
        canvas.write(canvas.fitted(f"sensors: {', '.join(self._titles)}", "note", WIDEST), LEFT, 66.0, theme.quiet, "note")
        for chart in self._charts:
            chart.draw_axes(self._canvas, dated=chart.place.top > VOLTAGES.place.top or len(self._charts) == 3)
        self._canvas.keep()

    def _paint(self) -> None:
        history, newest_first = self._history, slice(None, None, -self._stride)
        series = [history.readings, history.volts, history.costs[:, None], history.tips]
        shown = [each[newest_first] for each in series[: len(self._charts)]]
        charts = [
            chart.reaching(1.02 * float(np.abs(each).max(initial=0.0))) for chart, each in zip(self._charts, shown, strict=True)
        ]
        if charts != self._charts:
            self._charts = charts
            self._lay_out()
        for chart, values in zip(self._charts, shown, strict=True):
            several, ages, ink = values.shape[1] > 1, history.ages[newest_first], self._canvas.theme.ink
            colours = line_colours(values.shape[1]) if several else [ink]
            names = [f"{k + 1}" if several else "" for k in range(values.shape[1])]
            chart.draw(self._canvas, ages, values, colours, names, [] if several else [f"{values[0, 0]:.3g}"])
        self._canvas.open(CLOCK)
        self._canvas.write(f"t = {history.time:.4g} s", LEFT, 45.0, self._canvas.theme.ink, "label")
        self._canvas.develop(CLOCK)
