"""A picture of one blade under two controllers, one above the other, with one chart for both of all that is compared."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines import Controller
from baselines.evaluation.loop import instants
from beamenv.plant.plant import drive_limit
from beamenv.rendering.canvas import Canvas, Frame
from beamenv.rendering.charts import Chart, draw_scale, round_above
from beamenv.rendering.deformation import Deformation
from beamenv.rendering.history import History, Instant, gains
from beamenv.rendering.palette import LIGHT, OUTPUT_SCALE, VOLTAGE_SCALE, Theme, line_colours
from beamenv.rendering.scene import Scene, Values
from beamenv.task import Task

SIZE = (840, 730)
"""px: the width of a README."""
SCENES = (Frame(8.0, 66.0, 550.0, 274.0), Frame(8.0, 366.0, 550.0, 274.0))
NAMES_AT = (24.0, (82.0, 382.0))
ROOM = 70.0
TIP = Chart("tip in flap, µm", Frame(598.0, 84.0, 168.0, 146.0), -1.0, 1.0, room=ROOM)
VOLTAGES = Chart("voltage of {}, V", Frame(598.0, 282.0, 168.0, 146.0), -1.0, 1.0, room=ROOM)
COST = Chart("running cost J, mJ s", Frame(598.0, 480.0, 168.0, 146.0), 0.0, 1.0, room=ROOM)
VOLTAGE_KEY, OUTPUT_KEY = Frame(40.0, 686.0, 200.0, 9.0), Frame(330.0, 686.0, 200.0, 9.0)
CLOCK = Frame(20.0, 36.0, 700.0, 20.0)


def recorded(controller: Controller, env: Any, seed: int, load: dict[str, Any], count: int) -> list[Instant]:
    """The first ``count`` instants of an episode of a single environment of double precision."""
    return list(islice(_instants(controller, env, seed, load), count))


def _instants(controller: Controller, env: Any, seed: int, load: dict[str, Any]) -> Iterator[Instant]:
    inner = env.unwrapped
    for each in instants(controller, env, [seed], {"load": load}):
        (volts,), (tip,), (reading,) = each.info["volts"], each.info["tip_displacement"], each.observation
        truth = inner.episode_truth
        yield Instant(
            state=inner.state,
            plant=int(truth[0]),
            speed=float(inner.rotor_speed),
            tip_displacement=tip,
            volts=volts,
            reading=reading,
            cost_increment=float(each.info["cost_increment"][0]),
            load=inner.coming_loads,
            **dict(zip(("actuator_gain", "sensor_gain"), gains(truth, len(volts), len(reading)), strict=True)),
        )


class PairPicture:
    """Draws two episodes of a task, which are known to their ends: nothing changes its scale in between."""

    def __init__(self, task: Task, title: str, episodes: Mapping[str, Sequence[Instant]], theme: Theme = LIGHT) -> None:
        self._names, self._canvas, self._limit = list(episodes), Canvas(theme, SIZE), float(drive_limit(task.plant).max())
        every = [instant for episode in episodes.values() for instant in episode]
        largest = max(float(np.linalg.norm(each.tip_displacement)) for each in every)
        self._load = max(float(np.linalg.norm(each.load)) for each in every)
        self._scenes = [Scene(task.blade, largest, place, theme) for place in SCENES]
        self._deformation = Deformation(task, self._scenes[0].solid.stations)
        self._actuators = len(task.config.patches.actuator_positions(task.config.beam.length))
        self._histories = [History(task.config.control_interval) for _ in episodes]
        self._voltages = line_colours(task.plant.B.shape[1], theme)
        cost = max(sum(each.cost_increment for each in episode) for episode in episodes.values())
        tip = max(abs(float(each.tip_displacement[1])) for each in every)
        self._tip, self._cost = TIP.up_to(round_above(1e6 * tip)), COST.up_to(round_above(1e3 * cost))
        self._volts = Chart(VOLTAGES.title.format(self._names[1]), VOLTAGES.place, -self._limit, self._limit)
        self._lay_out(title)

    def _lay_out(self, title: str) -> None:
        canvas, theme = self._canvas, self._canvas.theme
        canvas.clear()
        canvas.write(title, NAMES_AT[0], 22.0, theme.ink, "title")
        draw_scale(canvas, VOLTAGE_KEY, VOLTAGE_SCALE, self._limit, "actuator voltage, V")
        draw_scale(canvas, OUTPUT_KEY, OUTPUT_SCALE, 1.0, "sensor output, full scale")
        for chart in (self._tip, self._volts, self._cost):
            chart.draw_axes(canvas, dated=chart is self._cost)
        for scene, name, y in zip(self._scenes, self._names, NAMES_AT[1], strict=True):
            scene.draw_rest(canvas)
            canvas.write(name, NAMES_AT[0], y, theme.ink, "title")
        canvas.keep()

    def begin(self, pair: Sequence[Instant]) -> None:
        """The first instants of the two."""
        for history, instant in zip(self._histories, pair, strict=True):
            history.begin(instant)

    def record(self, pair: Sequence[Instant]) -> None:
        """The next ones."""
        for history, instant in zip(self._histories, pair, strict=True):
            history.record(instant)

    def draw(self) -> NDArray[np.uint8]:
        """(730, 840, 3): the last instants recorded."""
        canvas, theme, (alone, acted) = self._canvas, self._canvas.theme, self._histories
        for scene, history in zip(self._scenes, self._histories, strict=True):
            last = history.last
            displacement = self._deformation.displacement(last.state, last.plant)
            scene.draw(canvas, displacement, Values.of(last, self._actuators, self._limit), last.load[:2] / self._load)
        newest_first, colours = slice(None, None, -1), [theme.quiet, theme.flap]
        ages = alone.ages[newest_first]
        tips = 1e6 * np.stack([history.tips[newest_first, 1] for history in self._histories], axis=-1)
        costs = 1e3 * np.stack([history.costs[newest_first] for history in self._histories], axis=-1)
        self._tip.draw(canvas, ages, tips, colours, self._names)
        numbers = [f"{k + 1}" for k in range(len(self._voltages))]
        self._volts.draw(canvas, ages, acted.volts[newest_first], self._voltages, numbers)
        self._cost.draw(canvas, ages, costs, colours, self._names)
        canvas.open(CLOCK)
        clock = f"t = {1e3 * alone.time:.0f} ms    load {np.linalg.norm(alone.last.load):.0f} N/m    "
        clock += f"deflection × {self._scenes[0].solid.magnification:,.0f}    dashes: at rest    arrow: load"
        canvas.write(clock, NAMES_AT[0], 46.0, theme.quiet, "label")
        canvas.develop(CLOCK)
        return canvas.pixels()
