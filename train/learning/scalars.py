"""TensorBoard's view of a training."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from train.learning.training import Progress


class Scalars:
    """Event files in ``folder``: cost relative to no control, steps/s and losses, by environment steps."""

    def __init__(self, folder: Path) -> None:
        from torch.utils.tensorboard import SummaryWriter  # takes seconds to import

        self._writer = SummaryWriter(str(folder))
        self._before = Progress(0.0, 0, 0.0)

    def write(self, progress: Progress, losses: Mapping[str, float]) -> None:
        """One point of every curve."""
        lasted = max(progress.elapsed - self._before.elapsed, 1e-9)
        scalars = {
            "cost/relative to no control": progress.cost,
            "speed/steps per s": (progress.steps - self._before.steps) / lasted,
        }
        if len(progress.costs) > 1:
            scalars |= {f"cost/run {run}": cost for run, cost in enumerate(progress.costs)}
        for name, value in {**scalars, **losses}.items():
            self._writer.add_scalar(name, value, progress.steps)
        self._before = progress

    def close(self) -> None:
        """Write what is left."""
        self._writer.close()
