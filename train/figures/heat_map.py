"""Scenarios against controllers: relative cost and failures, however they are drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines import Evaluation

Array = NDArray[np.float64]


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
