"""Progress bars of training, with the running cost."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from rich.progress import BarColumn, TaskID, TextColumn, TimeRemainingColumn

from baselines import Evaluation
from train.cli.bars import Bars
from train.comparison.compare import Listener
from train.learning.training import Progress as TrainingProgress
from train.shared.interruption import WHEN_ASKED


@contextmanager
def told_at_once(sentence: str) -> Iterator[None]:
    """Within it an interruption that waits is answered with a sentence, on standard error."""
    line = f"\nbeamenv: {sentence}\n".encode()
    token = WHEN_ASKED.set(lambda: os.write(2, line))  # a signal may come while a buffered stream is written
    try:
        yield
    finally:
        WHEN_ASKED.reset(token)


class Progressbar(Bars, Listener):
    """One bar an agent, one line a controller evaluated."""

    def __init__(self, budget: Mapping[str, float], unit: str = "s") -> None:
        """Budgets in ``unit``: "s" or "updates"."""
        self._unit = unit
        self.without: list[str] = []
        super().__init__(
            TextColumn("{task.description:>10}", markup=False),
            BarColumn(),
            TextColumn("{task.completed:.0f} of {task.total:.0f} {task.fields[unit]}"),
            TextColumn("{task.fields[about]}", markup=False),
            TimeRemainingColumn(),
        )
        self._tasks: dict[str, TaskID] = {
            name: self._bars.add_task(name, total=seconds, start=False, unit=unit, about="J / no control in training –")
            for name, seconds in budget.items()
        }
        self._page: TaskID | None = None

    def training(self, name: str, budget: float, progress: TrainingProgress) -> None:
        """Move an agent's bar."""
        task = self._tasks[name]
        self._bars.start_task(task)
        rate = f"{progress.steps / max(progress.elapsed, 1e-9) / 1e3:.0f} k steps/s"
        self.update(
            task,
            completed=min(progress.elapsed if self._unit == "s" else progress.updates, budget),
            about=f"J / no control in training {progress.cost:.3f}  {rate}",
        )

    def resumed(self, name: str, finished: bool) -> None:
        """Say what of an earlier run goes on."""
        self.say(f"resumed: {name} {'is kept from an earlier run' if finished else 'goes on from its checkpoint'}.")

    def evaluated(self, evaluation: Evaluation) -> None:
        """Say how a controller did."""
        self._bars.console.print(f"{evaluation.name:>36}  J / no control {evaluation.relative_cost.value:.3f}", markup=False)

    def recording(self, done: int, total: int, name: str) -> None:
        """Move the page's bar."""
        if self._page is None:
            self._page = self._bars.add_task("report.html", total=total, unit="recordings", about="")
        self.update(self._page, completed=done, about=name)

    def left_out(self, name: str, sentence: str) -> None:
        """Say which law there is not, and why."""
        self.without.append(name)
        self.say(f"{name} is left out: {sentence}")
