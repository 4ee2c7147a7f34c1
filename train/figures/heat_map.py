"""Scenarios against controllers: relative cost and failures, however they are drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines import Evaluation
from train.shared.columns import number, share

Array = NDArray[np.float64]

SCALE = "cividis_r"
"""Of both renderers; its lightness falls steadily: dark is bad in greyscale too, and for those who are colour-blind."""
RANGE = (0.35, 2.0)
"""J / J without control between which shades differ, on a logarithmic scale: twice no control and worse is all the same dark."""
TICKS = (0.35, 0.5, 0.7, 1.0, 1.4, 2.0)
QUANTITY, WAY = "J / J without control", "lower is better"
UNSTABLE, LOST, NOTHING = "▲", "✕", "–"
"""Signs of cells: a share of unstable episodes, what was run but not measured, what has nothing to do there."""


@dataclass(frozen=True, slots=True, eq=False)
class HeatMap:
    """How S scenarios went under C controllers. Raises ``ValueError`` for arrays of another shape."""

    scenarios: tuple[str, ...]
    controllers: tuple[str, ...]
    relative_cost: Array
    """(S, C): J over J without control; not finite where a blade failed, NaN where nothing was run."""
    failed: Array
    """(S, C): share of episodes in which the blade failed or, where that is judged, the loop was unstable."""
    kinds: tuple[str, ...] = ()
    """Of each controller, neighbours of one kind together; may be left out."""
    best: tuple[str, ...] = ()
    """The controller that is pointed out in each scenario; may be left out."""
    lost: frozenset[tuple[str, str]] = frozenset()
    """Scenario and controller of what was run, but could not be measured."""
    groups: tuple[str, ...] = ()
    """Of each scenario; may be left out."""

    def __post_init__(self) -> None:
        shape = (len(self.scenarios), len(self.controllers))
        for name in ("relative_cost", "failed"):
            value = np.shape(getattr(self, name))
            if value != shape:
                raise ValueError(f"{name} has shape {value}, but must have {shape}: scenarios by controllers.")

    @classmethod
    def of(cls, evaluations: Mapping[str, Sequence[Evaluation]]) -> HeatMap:
        """From the evaluations of each scenario; controllers are told apart by name and need not be in every scenario."""
        controllers = tuple(dict.fromkeys(each.name for row in evaluations.values() for each in row))
        relative_cost = np.full((len(evaluations), len(controllers)), np.nan)
        failed = np.zeros_like(relative_cost)
        for row, several in enumerate(evaluations.values()):
            for each in several:
                place = row, controllers.index(each.name)
                relative_cost[place], failed[place] = each.relative_cost.value, each.episodes.failed.mean()
        return cls(tuple(evaluations), controllers, relative_cost, failed)

    def text(self, line: int, column: int) -> tuple[str, str]:
        """What is written in a cell: the cost, or the sign of what is missing; and the share of unstable episodes, if any."""
        cost, part = self.relative_cost[line, column], self.failed[line, column]
        if np.isnan(cost):
            return (LOST if (self.scenarios[line], self.controllers[column]) in self.lost else NOTHING), ""
        return number(cost, "{:.2f}" if cost < 10.0 else "{:.0f}"), f"{UNSTABLE} {share(part)}" if part > 0.0 else ""

    def is_best(self, line: int, column: int) -> bool:
        """Whether a cell is the one pointed out in its scenario."""
        return bool(self.best) and self.best[line] == self.controllers[column]

    @property
    def key(self) -> str:
        """What the signs mean that are there."""
        best = ["bold: least of those shown, tier 3 aside"] if any(self.best) else []
        written = [self.text(*place) for place in np.ndindex(self.relative_cost.shape)]
        unstable = [f"{UNSTABLE} share of unstable episodes"] if any(part for _, part in written) else []
        signs = {LOST: "not measured", NOTHING: "nothing to do there"}
        missing = [f"{sign} {meaning}" for sign, meaning in signs.items() if any(cost == sign for cost, _ in written)]
        return "    ".join([*best, *unstable, *missing])
