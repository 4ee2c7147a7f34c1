"""Draws one blade's episode."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from beamenv.patches.layout import SIDES
from beamenv.plant.plant import drive_limit
from beamenv.rendering.canvas import Frame
from beamenv.rendering.charts import Chart, draw_scale, round_above
from beamenv.rendering.deformation import Deformation
from beamenv.rendering.episode_renderer import EpisodeRenderer
from beamenv.rendering.history import WINDOW, History
from beamenv.rendering.largest import largest_of
from beamenv.rendering.palette import OUTPUT_SCALE, VOLTAGE_SCALE, line_colours
from beamenv.rendering.scene import PLACE, Scene, Values
from beamenv.sensors.kinds import PatchSensor, Sensor
from beamenv.simulation.blades import reward_scale
from beamenv.task import Task

Array = NDArray[np.float64]

TIP = Chart("tip", Frame(682.0, 44.0, 230.0, 118.0), -1.0, 1.0)
VOLTAGES = Chart("voltage, V", Frame(682.0, 208.0, 230.0, 118.0), -1.0, 1.0)
COST = Chart("running cost J, mJ s", Frame(682.0, 372.0, 230.0, 118.0), 0.0, 1.0)
VOLTAGE_KEY, OUTPUT_KEY = Frame(34.0, 494.0, 232.0, 9.0), Frame(354.0, 494.0, 232.0, 9.0)
LEFT, TITLE_AT, CLOCK_AT, NOTES_AT = 24.0, 22.0, 45.0, (66.0, 81.0)
"""Pixels: of the letters left of the charts."""
WIDEST = PLACE.width - LEFT
CLOCK = Frame(20.0, 36.0, 606.0, 18.0)
CURVE_POINTS = 401
"""A curve is drawn through so many instants at most: more than it has pixels."""


class BladeRenderer(EpisodeRenderer):
    """Draws one blade's episode: the blade in space beside its displacement, voltages and cost."""

    def _prepare(self, task: Task) -> None:
        config, plant = task.config, task.plant
        self._largest = largest_of(task)
        self._scene = Scene(task.blade, self._largest.deflection)
        self._deformation = Deformation(task, self._scene.solid.stations)
        self._actuators = len(config.patches.actuator_positions(config.beam.length))
        self._walls = {side: _in_words([group.wall for group in config.patches.groups(side)]) for side in SIDES}
        self._others = "; diamonds: " + _in_kinds(config.sensors) if self._scene.solid.places.points else ""
        self._limit = float(drive_limit(plant).max())
        self._colours = line_colours(plant.B.shape[1])
        usual_cost = 0.1 * WINDOW / config.control_interval * reward_scale(plant)
        unit, self._per_metre = ("mm", 1e3) if self._largest.deflection > 2e-3 else ("µm", 1e6)
        tip = replace(TIP, title=f"{TIP.title}, {unit}").up_to(round_above(self._per_metre * self._largest.deflection))
        self._least = tip, COST.up_to(round_above(1e3 * usual_cost))
        self._history = History(config.control_interval)
        self._stride = -(-(round(WINDOW / config.control_interval) + 1) // CURVE_POINTS)

    def _rest(self) -> None:
        self._lay_out(*self._least)

    def _lay_out(self, tip: Chart, cost: Chart) -> None:
        """Draw what seldom changes."""
        canvas, self._tip, self._voltages, self._cost = self._canvas, tip, VOLTAGES.up_to(self._limit), cost
        canvas.clear()
        canvas.write(canvas.fitted(self.title, "title", WIDEST), LEFT, TITLE_AT, canvas.theme.ink, "title")
        for line, y in zip(canvas.wrapped(self._note(), "note", WIDEST, len(NOTES_AT)), NOTES_AT, strict=False):
            canvas.write(line, LEFT, y, canvas.theme.quiet, "note")
        draw_scale(canvas, VOLTAGE_KEY, VOLTAGE_SCALE, self._limit, "actuator voltage, V")
        draw_scale(canvas, OUTPUT_KEY, OUTPUT_SCALE, 1.0, "sensor output, full scale")
        for chart in (self._tip, self._voltages, self._cost):
            chart.draw_axes(canvas, dated=chart is self._cost)
        self._scene.draw_rest(canvas)
        canvas.keep()

    def _note(self) -> str:
        """What the drawing means."""
        sensors = f"; sensors lie in {self._walls['sensors']} and are drawn below it" if self._walls["sensors"] else ""
        dead = (
            "; crosses: dead" if self._task.scenario.failures.dead_actuators or self._task.scenario.failures.faulty_sensors else ""
        )
        return (
            f"deflection × {self._scene.solid.magnification:,.0f}; dashes: at rest; arrow: line load; "
            f"actuators lie in {self._walls['actuators']}{sensors}{self._others}{dead}"
        )

    def _paint(self) -> None:
        history, last = self._history, self._history.last
        newest_first = slice(None, None, -self._stride)
        ages, volts, costs = history.ages[newest_first], history.volts[newest_first], 1e3 * history.costs[newest_first, None]
        tip = self._per_metre * history.tips[newest_first]
        charts = self._tip.reaching(1.02 * np.abs(tip).max()), self._cost.reaching(1.02 * costs[0, 0])
        if charts != (self._tip, self._cost):
            self._lay_out(*charts)
        theme, load = self._canvas.theme, last.load[:2] if len(last.load) >= 2 else np.zeros(2)
        displacement = self._deformation.displacement(last.state, last.plant)
        self._scene.draw(self._canvas, displacement, Values.of(last, self._actuators, self._limit), load / self._largest.load)
        digits = max(0, 2 - int(np.floor(np.log10(self._tip.high))))
        told = [f"{name} {round(value, digits) + 0.0:+.{digits}f}" for name, value in zip(("lag", "flap"), tip[0], strict=True)]
        self._tip.draw(self._canvas, ages, tip, [theme.lag, theme.flap], ["lag", "flap"], told)
        self._voltages.draw(self._canvas, ages, volts, self._colours, [f"{k + 1}" for k in range(len(self._colours))])
        self._cost.draw(self._canvas, ages, costs, [theme.ink], [""], [f"{costs[0, 0]:.3g}"])
        self._canvas.open(CLOCK)
        clock = f"t = {1e3 * history.time:.1f} ms    Ω = {last.speed:.0f} rad/s    load {np.linalg.norm(load):.3g} N/m"
        self._canvas.write(clock, LEFT, CLOCK_AT, theme.ink, "label")
        self._canvas.develop(CLOCK)


def _in_kinds(sensors: Sequence[Sensor]) -> str:
    """Say, strain-gauge, velocity."""
    return ", ".join(dict.fromkeys(each.kind for each in sensors if not isinstance(each, PatchSensor)))


def _in_words(walls: Sequence[str]) -> str:
    """Say, the top wall; nothing where there are none."""
    names = list(dict.fromkeys(walls))
    return "" if not names else f"the {' and '.join(names)} wall{'s' if len(names) > 1 else ''}"
