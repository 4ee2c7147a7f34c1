"""One training from its first update, or its last checkpoint, to its end."""

from __future__ import annotations

import math
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamenv.configuration import Number, checked
from train.controllers.policies import Policy
from train.learning.training import Progress, Report, Training
from train.shared.interruption import Deferred, Interrupted

CHECKPOINT_INTERVAL = 30.0
"""s."""


@dataclass(frozen=True, slots=True)
class Budget:
    """How long a training lasts, and with it how fast learning rates fall.

    By updates a training is deterministic; by the clock it takes the time it is given. ValueError for what is no positive number,
    and if neither is given.
    """

    updates: float = math.inf
    seconds: float = math.inf

    def __post_init__(self) -> None:
        for name in ("updates", "seconds"):
            given = getattr(self, name)
            if not (isinstance(given, float) and given == math.inf):
                object.__setattr__(self, name, checked(name, given, Number(gt=0.0)))
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
    aside: Callable[[], float] = lambda: 0.0,
) -> list[Policy]:
    """Train until the budget is spent, or until Ctrl-C; the policies learnt by then.

    ``elapsed`` s were spent before; what ``aside`` tells, s, is no part of the training. ``keep`` is called with the seconds spent
    about every ``interval`` s and at the end; never after half an update. A signal to end does as Ctrl-C, and then raises
    ``Interrupted``; so does a second one, at once and without ``keep``.
    """
    begin, kept = time.monotonic() - elapsed, elapsed
    with Deferred() as interruption:
        while (spent := budget.share(training.updates, elapsed)) < 1.0 and not interruption.asked:
            training.update(1.0 - spent)
            elapsed = time.monotonic() - begin - aside()
            try:
                report(progress(training, elapsed))
            except KeyboardInterrupt:
                interruption.asked = interruption.asked or signal.SIGINT
            if keep is not None and elapsed - kept >= interval:
                keep(elapsed)
                kept = elapsed
        if keep is not None:
            keep(elapsed)
    if interruption.asked not in (0, signal.SIGINT):
        raise Interrupted(interruption.asked)
    return training.policies()


def progress(training: Training, elapsed: float) -> Progress:
    """How far a training is."""
    costs = tuple(np.ravel(training.cost).tolist())
    return Progress(elapsed, training.steps, float(np.mean(costs)), training.updates, costs, training.validated)
