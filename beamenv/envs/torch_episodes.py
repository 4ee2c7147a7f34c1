"""Episodes of a batch of tensors, one after the other: which blades are at their end, and how the next ones begin."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import torch
from gymnasium.vector import AutoresetMode

from beamenv.arrays import Masked, SomeRows, Those
from beamenv.envs.batch_arguments import BatchReset
from beamenv.simulation.blades import Blades
from beamenv.simulation.motion import Motion


class Outcome(NamedTuple):
    """What a step brought to N blades."""

    shown: Motion
    """As it ends: of blades that have begun another episode, their first instant."""
    reward: Any
    """(N,)"""
    terminated: Any
    """(N,) bools"""
    truncated: Any
    """(N,) bools"""
    begun: Any
    """(N,) bools: which have begun another episode; None where none does by itself."""
    final: Motion | None
    """Where the next episode begins in the same step, the motion before it did."""


class TorchEpisodes:
    """The episodes of a batch of ``Blades`` made of tensors.

    Where to look at a value costs nothing, or each blade has its own generator, nothing is done for blades unless their episode
    is over. A device is never waited for: there all blades begin another episode in every step, and a mask says for which it holds.
    """

    def __init__(self, blades: Blades, steps: int, mode: AutoresetMode) -> None:
        assert blades.count is not None
        self.blades, self.steps, self.mode, self.arrays = blades, steps, mode, blades.arrays
        self.elapsed = self.arrays.exact(np.zeros(blades.count, dtype=np.int64))
        """(N,) control intervals since each episode began."""
        self.over = self.elapsed < 0
        """(N,) which episodes were over at the last step."""

    def begin(self, generators: Any, asked: BatchReset) -> tuple[Motion, Any]:
        """Begin the episodes that a reset asks for: the motion of all or of these alone, and which they are, (N,) bools."""
        rows = None if asked.rows is None else self.arrays.exact(asked.rows)
        motion = self.blades.begin(generators, rows, asked.scenario, asked.initial_state)
        elapsed, mask = self.arrays.exact(asked.elapsed), torch.ones_like(self.over)
        if rows is not None:
            mask = torch.zeros_like(mask).index_fill(0, rows, True)
        self.elapsed, self.over = torch.where(mask, elapsed, self.elapsed), self.over & ~mask
        return motion, mask

    def step(self, actions: Any, generators: Any) -> Outcome:
        """One control interval under actions (N, m), and what follows where an episode is over."""
        resting, next_step = self.over, self.mode is AutoresetMode.NEXT_STEP
        waits = resting.nonzero()[:, 0].numpy(force=True) if next_step and not isinstance(generators, torch.Generator) else None
        motion = self.blades.step(actions, generators, waits)
        self.elapsed = self.elapsed + 1
        truncated, begun, final = self.elapsed >= self.steps, None, None
        if next_step:
            truncated = truncated & ~resting
            motion, begun = self._begun(resting, motion, generators), resting
        reward, terminated = motion.reward, motion.failed
        self.over = terminated | truncated
        if self.mode is AutoresetMode.SAME_STEP:
            final, begun = motion, self.over
            motion, self.over = self._begun(begun, motion, generators), torch.zeros_like(resting)
        return Outcome(motion, reward, terminated, truncated, begun, final)

    def _begun(self, mask: Any, motion: Motion, generators: Any) -> Motion:
        """The motion with that of the mask's blades exchanged for the start of another episode."""
        looks = self.arrays.looks or not isinstance(generators, torch.Generator)
        rows = mask.nonzero()[:, 0] if looks else mask
        if looks and not len(rows):
            return motion
        those: Those = SomeRows(rows, ()) if looks else Masked(mask)
        first = self.blades.begin(generators, rows)
        self.elapsed = those.put(self.elapsed, 0)
        return Motion(*(those.put(each, new) for each, new in zip(motion, first, strict=True)))

    def state_dict(self) -> dict[str, Any]:
        """Copies of what moves; the generator is the caller's."""
        return {"blades": self.blades.state_dict(), "elapsed": self.elapsed.clone(), "over": self.over.clone()}

    def load_state_dict(self, state: Any) -> None:
        """Go back to a ``state_dict`` of equally made episodes."""
        self.blades.load_state_dict(state["blades"])
        self.elapsed, self.over = (state[name].to(self.over.device).clone() for name in ("elapsed", "over"))
