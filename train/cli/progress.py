"""Progress bars of training, with the running cost."""

from __future__ import annotations

from collections.abc import Mapping

from rich.progress import BarColumn, TaskID, TextColumn, TimeRemainingColumn

from baselines import Evaluation
from train.cli.bars import Bars
from train.comparison.compare import Listener
from train.learning.training import Progress as TrainingProgress


class Progressbar(Bars, Listener):
    """One bar an agent, one line a controller evaluated."""

    def __init__(self, budget: Mapping[str, float], unit: str = "s") -> None:
        """Budgets in ``unit``: "s" or "updates"."""
        self._unit = unit
        self.without: list[str] = []
        super().__init__(
            TextColumn("{task.description:>10}", markup=False),
            BarColumn(),
            TextColumn("{task.completed:.0f} of {task.total:.0f} " + unit),
            TextColumn("J / no control {task.fields[cost]}  {task.fields[rate]}"),
            TimeRemainingColumn(),
        )
        self._tasks: dict[str, TaskID] = {
            name: self._bars.add_task(name, total=seconds, start=False, cost="–", rate="") for name, seconds in budget.items()
        }

    def training(self, name: str, budget: float, progress: TrainingProgress) -> None:
        """Move an agent's bar."""
        task = self._tasks[name]
        self._bars.start_task(task)
        rate = f"{progress.steps / max(progress.elapsed, 1e-9) / 1e3:.0f} k steps/s"
        self.update(
            task,
            completed=min(progress.elapsed if self._unit == "s" else progress.updates, budget),
            cost=f"{progress.cost:.3f}",
            rate=rate,
        )

    def resumed(self, name: str, finished: bool) -> None:
        """Say what of an earlier run goes on."""
        self.say(f"resumed: {name} {'is kept from an earlier run' if finished else 'goes on from its checkpoint'}.")

    def evaluated(self, evaluation: Evaluation) -> None:
        """Say how a controller did."""
        self._bars.console.print(f"{evaluation.name:>36}  J / no control {evaluation.relative_cost.value:.3f}", markup=False)

    def left_out(self, name: str, sentence: str) -> None:
        """Say which law there is not, and why."""
        self.without.append(name)
        self.say(f"{name} is left out: {sentence}")
