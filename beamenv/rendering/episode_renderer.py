"""What every picture of an episode does, whatever it draws: follow the episode, be drawn, be shown in a window, be copied."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.rendering.canvas import Canvas
from beamenv.rendering.history import History, Instant
from beamenv.rendering.installed import check_installed
from beamenv.rendering.titles import in_a_line, named_scenario
from beamenv.rendering.window import Window
from beamenv.task import Task


class EpisodeRenderer(ABC):
    """Draws an episode: ``begin``, then ``record`` after every step, and ``draw`` whenever a picture is wanted.

    ``rate`` (1/s) opens a window, which then shows every instant at this rate; None is for pictures as arrays alone.
    Raises DependencyNotInstalled without pygame, which draws, or matplotlib, which lends colour scales and letters.
    """

    _history: History
    _whose = ""
    """Who acts and which episode it is, as the title says it."""

    def __init__(self, task: Task, rate: float | None = None) -> None:
        check_installed()
        self._task, self._rate = task, rate
        self._prepare(task)
        self._canvas = Canvas()
        self._window = None if rate is None else Window("beamenv", rate)
        self._rest()

    def __getstate__(self) -> tuple[Any, ...]:
        return self._task, self._rate, self._history, self._whose

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        """Surfaces and windows are made anew: they cannot be copied."""
        task, rate, history, self._whose = state
        self.__init__(task, rate)  # type: ignore[misc]
        self._history = history

    @abstractmethod
    def _prepare(self, task: Task) -> None:
        """The history, and what is drawn of it."""

    @abstractmethod
    def _rest(self) -> None:
        """Draw what seldom changes, as an episode begins."""

    @abstractmethod
    def _paint(self) -> None:
        """Draw the last instant recorded."""

    @property
    def title(self) -> str:
        """Scenario, controller and seed, as far as they are known."""
        return in_a_line(named_scenario(self._task.scenario), self._whose)

    def begin(self, first: Instant, whose: str = "") -> None:
        """Start an episode; ``whose`` says who acts, and which it is."""
        self._whose = whose
        self._history.begin(first)
        self._rest()
        self._show()

    def record(self, instant: Instant) -> None:
        """Take down what one control interval brought."""
        self._history.record(instant)
        self._show()

    def draw(self) -> NDArray[np.uint8]:
        """The picture of the last instant recorded: (540, 960, 3)."""
        self._paint()
        return self._canvas.pixels()

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._window.close()

    def _show(self) -> None:
        if self._window is not None:
            self._paint()
            self._window.show(self._canvas.picture)
