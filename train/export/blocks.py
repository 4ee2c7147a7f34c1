"""Blocks without memory and delays of one interval, of which diagrams are made; signals are vectors of real numbers."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

FUNCTIONS = ("tanh", "sigmoid", "exp", "log", "absolute")
PAIRS = ("add", "subtract", "multiply", "divide", "maximum", "minimum", "greater", "equal")
REDUCTIONS = ("sum", "maximum", "minimum")


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """A block with one signal of ``size`` numbers; arithmetic with signals, numbers and arrays (size,) makes further ones."""

    size: int
    label: str = field(default="", kw_only=True)
    """What the signal is called in what is written."""

    @property
    def sources(self) -> tuple[Block, ...]:
        """Blocks whose signals it takes."""
        return ()

    def __add__(self, other: Any) -> Block:
        return pair("add", self, other)

    def __sub__(self, other: Any) -> Block:
        return pair("subtract", self, other)

    def __rsub__(self, other: Any) -> Block:
        return pair("subtract", other, self)

    def __mul__(self, other: Any) -> Block:
        return pair("multiply", self, other)

    def __truediv__(self, other: Any) -> Block:
        return pair("divide", self, other)

    def __getitem__(self, which: Any) -> Block:
        return pick(self, np.arange(self.size)[which])


@dataclass(frozen=True, slots=True, eq=False)
class Input(Block):
    """What is measured."""

    unit: str


@dataclass(frozen=True, slots=True, eq=False)
class Delay(Block):
    """What a signal was one interval before; zero at first."""


@dataclass(frozen=True, slots=True, eq=False)
class Constant(Block):
    """Numbers that stay."""

    value: Array


@dataclass(frozen=True, slots=True, eq=False)
class Affine(Block):
    """Product of a matrix and a signal x, and a bias added."""

    matrix: Array
    """(size, c)."""
    of: Block
    bias: Array | None

    @property
    def sources(self) -> tuple[Block, ...]:
        """X."""
        return (self.of,)


@dataclass(frozen=True, slots=True, eq=False)
class Blocks(Block):
    """Products of G matrices with the G parts, one after the other, of a signal: part g with matrices[k, which[g]].

    k is the number that ``step`` shows, the last matrix at most; 0 without it.
    """

    matrices: Array
    """(K, U, r, c)."""
    which: NDArray[np.int64]
    """(G,)."""
    of: Block
    step: Block | None

    @property
    def sources(self) -> tuple[Block, ...]:
        """The signal and the step."""
        return (self.of,) if self.step is None else (self.of, self.step)


@dataclass(frozen=True, slots=True, eq=False)
class Function(Block):
    """One of ``FUNCTIONS`` of every number."""

    name: str
    of: Block

    @property
    def sources(self) -> tuple[Block, ...]:
        """Its argument."""
        return (self.of,)


@dataclass(frozen=True, slots=True, eq=False)
class Pair(Block):
    """One of ``PAIRS`` of two signals, number by number; a single number goes with each. Comparisons give 1 or 0."""

    name: str
    left: Block
    right: Block

    @property
    def sources(self) -> tuple[Block, ...]:
        """Both."""
        return self.left, self.right


@dataclass(frozen=True, slots=True, eq=False)
class Choose(Block):
    """One signal where a condition, of one number or of each its own, is above zero, the other elsewhere."""

    condition: Block
    where: Block
    otherwise: Block

    @property
    def sources(self) -> tuple[Block, ...]:
        """Condition and both signals."""
        return self.condition, self.where, self.otherwise


@dataclass(frozen=True, slots=True, eq=False)
class Pick(Block):
    """Some numbers of a signal, in any order."""

    indices: NDArray[np.int64]
    of: Block

    @property
    def sources(self) -> tuple[Block, ...]:
        """The signal."""
        return (self.of,)


@dataclass(frozen=True, slots=True, eq=False)
class Join(Block):
    """Signals one after the other."""

    parts: tuple[Block, ...]

    @property
    def sources(self) -> tuple[Block, ...]:
        """All of them."""
        return self.parts


@dataclass(frozen=True, slots=True, eq=False)
class Reduce(Block):
    """One of ``REDUCTIONS`` of each of ``size`` parts, equally long, of a signal."""

    name: str
    of: Block

    @property
    def sources(self) -> tuple[Block, ...]:
        """The signal."""
        return (self.of,)


class Misfit(ValueError):
    """Signals and tables that do not go together."""


def _check(what: str, size: int, of: Block) -> None:
    if size != of.size:
        raise Misfit(f"a signal of {of.size} numbers does not go with {what} {size}.")


def signal(value: Any) -> Block:
    """The block itself, or numbers as a constant one."""
    if isinstance(value, Block):
        return value
    numbers = np.asarray(value, dtype=np.float64).ravel()
    return Constant(numbers.size, numbers)


def affine(matrix: ArrayLike, of: Block, bias: ArrayLike | None = None, label: str = "") -> Block:
    """The product of a matrix (r, c) and a signal, and a bias (r,) added; of no numbers, the bias or zero."""
    numbers = np.asarray(matrix, dtype=np.float64)
    offset = None if bias is None else np.asarray(bias, dtype=np.float64)
    _check("a matrix of", numbers.shape[1], of)
    if of.size == 0:
        return signal(np.zeros(len(numbers)) if offset is None else offset)
    return Affine(len(numbers), numbers, of, offset, label=label)


def products(matrices: ArrayLike, of: Block, step: Block | None = None, label: str = "") -> Block:
    """Parts of a signal through matrices (G, r, c), or (K, G, r, c) of the ``step``; those that are equal are kept once."""
    numbers = np.asarray(matrices, dtype=np.float64)
    numbers = numbers if numbers.ndim == 4 else numbers[None]
    _check("matrices of", numbers.shape[1] * numbers.shape[3], of)
    first: dict[bytes, int] = {}
    which = [first.setdefault(np.ascontiguousarray(numbers[:, g]).tobytes(), g) for g in range(numbers.shape[1])]
    kept = list(first.values())
    at = np.array([kept.index(g) for g in which])
    return Blocks(len(at) * numbers.shape[2], np.ascontiguousarray(numbers[:, kept]), at, of, step, label=label)


def function(name: str, of: Block, label: str = "") -> Block:
    """One of ``FUNCTIONS``."""
    return Function(of.size, name, of, label=label)


def pair(name: str, left: Any, right: Any, label: str = "") -> Block:
    """One of ``PAIRS`` of signals, numbers or arrays."""
    one, other = signal(left), signal(right)
    if 1 not in (one.size, other.size):
        _check("another signal of", one.size, other)
    return Pair(max(one.size, other.size), name, one, other, label=label)


def clip(of: Block, limits: Any, label: str = "") -> Block:
    """The signal within two limits, each a signal, a number or an array."""
    lowest, highest = limits
    return pair("maximum", pair("minimum", of, highest), lowest, label)


def choose(condition: Block, where: Any, otherwise: Any, label: str = "") -> Block:
    """One signal where the condition is above zero, the other elsewhere."""
    one, other = signal(where), signal(otherwise)
    return Choose(max(one.size, other.size), condition, one, other, label=label)


def pick(of: Block, indices: ArrayLike, label: str = "") -> Block:
    """Some numbers of a signal; of all of them in their order the signal itself."""
    which = np.asarray(indices, dtype=np.int64).ravel()
    if np.array_equal(which, np.arange(of.size)):
        return of
    return Pick(which.size, which, of, label=label)


def join(*parts: Block, label: str = "") -> Block:
    """Signals one after the other, empty ones left out."""
    kept = tuple(part for part in parts if part.size)
    return kept[0] if len(kept) == 1 else Join(sum(part.size for part in kept), kept, label=label)


def reduce(name: str, of: Block, parts: int = 1, label: str = "") -> Block:
    """One of ``REDUCTIONS`` of each of so many ``parts`` of a signal."""
    return Reduce(parts, name, of, label=label)
