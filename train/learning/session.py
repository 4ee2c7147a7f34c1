"""One training from its first update, or its last checkpoint, to its end."""

from __future__ import annotations

import math
import signal
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from types import FrameType, TracebackType
from typing import Any

import numpy as np

from train.controllers.policies import Policy
from train.learning.training import Progress, Report, Training

CHECKPOINT_INTERVAL = 30.0
"""s."""


@dataclass(frozen=True, slots=True)
class Budget:
    """How long a training lasts, and with it how fast learning rates fall.

    By updates a training is deterministic; by the clock it takes the time it is given. ValueError for numbers that are not
    positive, and if neither is given.
    """

    updates: float = math.inf
    seconds: float = math.inf

    def __post_init__(self) -> None:
        for name in ("updates", "seconds"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} = {getattr(self, name)!r} must be a positive number.")
        if math.isinf(self.updates) and math.isinf(self.seconds):
            raise ValueError("updates or seconds must be given: a training must end.")

    def share(self, updates: int, elapsed: float) -> float:
        """Share of the budget that is spent, 1 at the end."""
        return min(1.0, max(updates / self.updates, elapsed / self.seconds))


def follow(
    training: Training,
    budget: Budget,
    report: Report,
    keep: Callable[[float], None] | None = None,
    elapsed: float = 0.0,
    interval: float = CHECKPOINT_INTERVAL,
) -> list[Policy]:
    """Train until the budget is spent, or until Ctrl-C; the policies learnt by then.

    ``elapsed`` s were spent before. ``keep`` is called with the seconds spent about every ``interval`` s and at the end.
    """
    begin = time.monotonic() - elapsed
    kept = elapsed
    with suppress(KeyboardInterrupt), Interruption() as interruption:
        while (spent := budget.share(training.updates, elapsed)) < 1.0 and not interruption.asked:
            training.update(1.0 - spent)
            elapsed = time.monotonic() - begin
            report(progress(training, elapsed))
            if keep is not None and elapsed - kept >= interval:
                keep(elapsed)
                kept = elapsed
    if keep is not None:
        keep(elapsed)
    return training.policies()


class Interruption:
    """Ctrl-C that waits for the end of an update: a checkpoint must not hold half of one. A second Ctrl-C does not wait."""

    def __init__(self) -> None:
        self.asked = False
        self._before: Any = None

    def __enter__(self) -> Interruption:
        if threading.current_thread() is threading.main_thread():
            self._before = signal.signal(signal.SIGINT, self._ask)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True


def progress(training: Training, elapsed: float) -> Progress:
    """How far a training is."""
    costs = tuple(np.ravel(training.cost).tolist())
    return Progress(elapsed, training.steps, float(np.mean(costs)), training.updates, costs)
