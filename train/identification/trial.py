"""Whether a law of what was identified holds on what it may be as well: LQG is optimal, and need not be robust."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from baselines import lqg
from baselines.identification.identified import Identified

PLANTS = 32
"""Drawn from the spread."""


@dataclass(frozen=True, slots=True)
class Trial:
    """The LQG of the plant on so many plants within its spread."""

    plants: int
    unstable: int
    refused: str = ""
    """Why there is no such LQG, or no such plants."""

    @property
    def safe(self) -> bool:
        """Whether nothing is to be feared."""
        return not self.unstable and not self.refused

    @property
    def sentence(self) -> str:
        """What is to be said of it."""
        if self.refused:
            return f"No LQG of this plant could be tried within its spread: {self.refused}"
        if not self.unstable:
            return f"LQG of this plant is stable on all of {self.plants} plants within its spread."
        return (
            f"LQG of this plant is unstable on {self.unstable} of {self.plants} plants within its spread: the voltages hardly "
            "moved what it is to damp. Measure longer, or with voltages that are larger or each held for longer, before it meets "
            "the structure."
        )

    def to_dict(self) -> dict[str, Any]:
        """What JSON can hold of it."""
        return {"plants": self.plants, "unstable": self.unstable, "refused": self.refused}


def tried(found: Identified, about: Mapping[str, Any]) -> Trial:
    """The trial of the plant with ``about`` it, as ``Identified.plant`` takes it."""
    try:
        return Trial(PLANTS, found.unstable_on(lqg(found.plant(**about)), PLANTS, **about))
    except ValueError as error:
        return Trial(PLANTS, 0, str(error))
