"""Progress bars, on standard error, so that standard output stays for results."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn, TimeElapsedColumn
from typing_extensions import Self


class Bars:
    """Bars that stay; on a terminal from the beginning, elsewhere from the first progress: bad input leaves its one line alone."""

    def __init__(self, *columns: ProgressColumn) -> None:
        self._bars = Progress(*columns, console=Console(stderr=True))

    def __enter__(self) -> Self:
        if self._bars.console.is_terminal:
            self._bars.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._bars.live.is_started:
            self._bars.stop()

    def say(self, sentence: str) -> None:
        """Above the bars, in the name of the command."""
        self._bars.console.print(f"beamenv: {sentence}", markup=False, highlight=False, soft_wrap=True)

    def update(self, task: Any, **changed: Any) -> None:
        """Show how far a task is."""
        self._bars.start()
        self._bars.update(task, **changed)


@contextmanager
def fleeting(*columns: ProgressColumn) -> Iterator[Progress]:
    """Bars that are gone with what they told of, and none where no terminal shows them."""
    screen = Console(stderr=True)
    with Progress(*columns, console=screen, transient=True, disable=not screen.is_terminal) as progress:
        yield progress


@contextmanager
def one_cost_bar(name: str) -> Iterator[Callable[[float, float], None]]:
    """A bar of the share that is done, with the least cost so far."""
    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[cost]}"), TimeElapsedColumn()
    with fleeting(*columns) as progress:
        task = progress.add_task(name, total=1.0, cost="")
        yield lambda done, cost: progress.update(task, completed=done, cost=f"least cost {cost:.4g} J")
