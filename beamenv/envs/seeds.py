"""Seeds and generators of a batch: one for all its blades, or one for each."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from beamenv.configuration import Refused

Generator = np.random.Generator
Seeds = int | Sequence[int | None] | None


def checked_seed(seed: Any, allowed: str = "an integer that is not negative, or None") -> int | None:
    """The seed of one generator; ``ValueError`` unless it is None or an integer that is not negative, however large."""
    if seed is None:
        return None
    try:
        number = -1 if isinstance(seed, bool) else operator.index(seed)
    except TypeError:
        number = -1
    if number < 0:
        raise Refused("seed", seed, allowed)
    return number


class SeededVectorEnv(VectorEnv[Any, Any, Any]):
    """A vector environment that may have a generator for each blade.

    ``np_random`` and ``np_random_seed`` are then tuples, as those of Gymnasium's own vector environments.
    """

    _generators: Generator | list[Generator] | None = None
    """What the episodes that run draw from; None before a reset."""
    _own: list[tuple[Generator, int]] | None = None
    """Generators of the blades, and their seeds."""

    def _seed(self, seed: Any) -> Generator | list[Generator]:
        """Settle the generators of all blades, whose episodes begin."""
        if seed is None or _is_number(seed):
            number = checked_seed(seed, _batch_allows(self.num_envs))
            if number is not None:
                VectorEnv.reset(self, seed=number)
                self._own = None
        else:
            before = [None] * self.num_envs if self._own is None else self._own
            self._own = [_seeded(number, own) for number, own in zip(own_seeds(seed, self.num_envs), before, strict=True)]
        self._generators = self.np_random if self._own is None else [generator for generator, _ in self._own]
        return self._generators

    def _seed_some(self, seed: Any, rows: NDArray[np.int64]) -> Generator | list[Generator]:
        """Settle those of ``rows`` alone: the other blades' episodes go on."""
        if self._generators is None:
            raise gymnasium.error.ResetNeeded("Call reset without a mask first.")
        if seed is None:
            return self._generators
        if self._own is None or _is_number(seed):
            raise Refused("seed", seed, "None beside a reset_mask, unless each blade had and has a seed of its own")
        seeds = own_seeds(seed, self.num_envs)
        for row in rows.tolist():
            self._own[row] = _seeded(seeds[row], self._own[row])
        self._generators = [generator for generator, _ in self._own]
        return self._generators

    @property
    def np_random(self) -> Any:
        """The batch's generator, or those of the blades that were seeded one by one."""
        return super().np_random if self._own is None else tuple(generator for generator, _ in self._own)

    @np_random.setter
    def np_random(self, value: Generator) -> None:
        self._own = None
        VectorEnv.np_random.fset(self, value)  # type: ignore[attr-defined]

    @property
    def np_random_seed(self) -> Any:
        """Its seed, or theirs."""
        return super().np_random_seed if self._own is None else tuple(seed for _, seed in self._own)


def checked_seeds(seed: Any, count: int) -> None:
    """``ValueError`` unless it is what a batch of ``count`` may be reset with: None, one seed, or one for each."""
    if seed is None or _is_number(seed):
        checked_seed(seed, _batch_allows(count))
    else:
        own_seeds(seed, count)


def own_seeds(seed: Any, count: int) -> list[int | None]:
    """One seed for each blade, None for one that goes on with the generator that it has."""
    if not isinstance(seed, (list, tuple, range, np.ndarray)) or len(seed) != count:  # what has an order, and can be read again
        raise Refused("seed", seed, _batch_allows(count))
    try:
        return [checked_seed(number) for number in seed]
    except ValueError:
        raise Refused("seed", seed, _batch_allows(count)) from None


def _batch_allows(count: int) -> str:
    return f"an integer, or a sequence of {count} integers that are not negative, or None: a list, tuple, range or array"


def _is_number(seed: Any) -> bool:
    return np.ndim(seed) == 0 if isinstance(seed, np.ndarray) else not hasattr(seed, "__iter__")


def _seeded(seed: int | None, before: tuple[Generator, int] | None) -> tuple[Generator, int]:
    """A blade's generator and its seed: the one from before, if there is one and the seed is None."""
    return before if seed is None and before is not None else seeding.np_random(seed)
