"""How the states of a bank of filters go on, from one instant to the next: by the matrices as they are, or mode by mode."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields, is_dataclass
from itertools import groupby
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from baselines.design.controller import Array
from baselines.design.filter_bank import FilterBank
from baselines.design.modes import Modes, common_modes, modes_of

T = TypeVar("T")

SINGLE = {np.dtype(np.float64): np.float32, np.dtype(np.complex128): np.complex64}


def in_single_precision(part: T) -> T:
    """The same with all numbers of arrays in single precision, in tuples and dataclasses too."""
    found: Any = part
    if isinstance(part, np.ndarray):
        found = part.astype(SINGLE.get(part.dtype, part.dtype))
    elif isinstance(part, tuple) and type(part) is tuple:
        found = tuple(map(in_single_precision, part))
    elif is_dataclass(part) and not isinstance(part, type):
        found = type(part)(*(in_single_precision(getattr(part, each.name)) for each in fields(part)))
    of_the_same_kind: T = found
    return of_the_same_kind


class Motion(ABC):
    """Predicted states of N blades, (N, size), in coordinates of its own: what they show, and what follows them."""

    @property
    @abstractmethod
    def size(self) -> int:
        """Numbers of a blade's states, of all hypotheses."""

    @abstractmethod
    def seen(self, states: Array) -> Array:
        """(H, N, p + m): readings to be expected, A, and K x̂, V, of predicted ``states`` (N, size)."""

    @abstractmethod
    def answers(self, instant: Array, whitened: Array) -> Array:
        """(H, N, m), V: what ``whitened`` innovations (H, N, p) add to −K x̂, each blade at an ``instant`` (N,) of its own."""

    @abstractmethod
    def follow(self, instant: Array, states: Array, whitened: Array, voltages: Array, out: Array) -> None:
        """The next prediction, into ``out`` (N, size), with ``voltages`` (N, m (D + 1)), V, newest first."""

    @abstractmethod
    def driven(self, voltages: Array) -> Array:
        """(N, size): what voltages (N, m (D + 1)) add to the states of the next instant."""

    @abstractmethod
    def by_hypothesis(self, states: Array) -> Array:
        """(N, H, …), a view of states (N, size) where all hypotheses have as many."""

    @abstractmethod
    def plain(self, states: Array) -> Array:
        """(N, H, s): the filters' own states, of states (N, size)."""


@dataclass(frozen=True, slots=True, eq=False)
class DenseMotion(Motion):
    """The filters' own states, each multiplied by its whole matrix."""

    bank: FilterBank
    moved: Array
    """(H, s, p + m + s): [Cᵀ, Kᵀ, Aᵀ], from a prediction to the readings, to what is not asked for and to the next prediction."""
    onward: Array
    """(K, H, p, m + s): C S [−Kᵀ, Aᵀ], from what readings add to it."""

    @classmethod
    def of(cls, bank: FilterBank, state_gain: Array) -> DenseMotion:
        """From regulators' gains (H, m, s)."""
        asked = state_gain.swapaxes(-1, -2)
        moved = np.concatenate([bank.output, asked, bank.transition], axis=-1)
        return cls(bank, moved, np.matmul(bank.cross, np.concatenate([-asked, bank.transition], axis=-1)))

    @property
    def size(self) -> int:
        """Shorter filters have zeros behind their own states."""
        H, s = self.bank.counts
        return H * s

    def by_hypothesis(self, states: Array) -> Array:
        """(N, H, s)."""
        return states.reshape(len(states), *self.bank.counts)

    def plain(self, states: Array) -> Array:
        """A copy."""
        return self.by_hypothesis(states).copy()

    def seen(self, states: Array) -> Array:
        """Products with [Cᵀ, Kᵀ]."""
        return self._through(states, slice(0, self._shown))

    def answers(self, instant: Array, whitened: Array) -> Array:
        """Products with −C S Kᵀ."""
        return self.bank.carried(instant, whitened, self.onward[..., : self._asked])

    def follow(self, instant: Array, states: Array, whitened: Array, voltages: Array, out: Array) -> None:
        """Products with Aᵀ, C S Aᵀ and Bᵀ."""
        onward = self._through(states, slice(self._shown, None))
        onward += self.bank.carried(instant, whitened, self.onward[..., self._asked :])
        np.add(onward.swapaxes(0, 1), self.bank.driven(voltages), out=self.by_hypothesis(out))

    def driven(self, voltages: Array) -> Array:
        """Products with Bᵀ."""
        return self.bank.driven(voltages).reshape(len(voltages), -1)

    @property
    def _shown(self) -> int:
        return self.moved.shape[-1] - self.moved.shape[-2]

    @property
    def _asked(self) -> int:
        return self.onward.shape[-1] - self.moved.shape[-2]

    def _through(self, states: Array, columns: slice) -> Array:
        """(H, N, …): predictions through some columns of ``moved``, shorter ones by what is theirs."""
        predicted, matrix = self.by_hypothesis(states).swapaxes(0, 1), self.moved[..., columns]
        through = np.empty((*predicted.shape[:2], matrix.shape[-1]), states.dtype)
        for those, size in self.bank.alike:
            np.matmul(predicted[those, :, :size], matrix[those, :size], out=through[those])
        return through


@dataclass(frozen=True, slots=True, eq=False)
class _Alike:
    """Hypotheses next to each other that have as many numbers c."""

    those: slice
    """Which."""
    columns: slice
    """Where their numbers are, among all."""
    shape: tuple[int, int]
    """How many hypotheses G, and c."""
    back: Array
    """(G, c, s): to the filters' own states."""
    seen: Array
    """(G, c, p + m)."""
    gains: Array
    """(K, G, p, c): C S Aᵀ."""
    drive: Array
    """(G, m, c): Bᵀ, of those voltages that act."""
    settled: Array
    """(G, p + m, c): the last of ``gains`` above ``drive``."""

    def of(self, states: Array) -> Array:
        """(N, G, c): theirs, a view of states (N, size)."""
        return states[:, self.columns].reshape(len(states), *self.shape)


@dataclass(frozen=True, slots=True, eq=False)
class ModalMotion(Motion):
    """Modes of the filters, each a complex number that is multiplied by its eigenvalue; real ones stand together in pairs.

    Real and imaginary part follow each other. A filter without voltages that come late in several ways needs but m of them.
    """

    bank: FilterBank
    alike: tuple[_Alike, ...]
    eigenvalues: NDArray[np.complexfloating[Any, Any]]
    """(size / 2,)."""
    late: tuple[tuple[int, NDArray[np.intp]], ...]
    """How many instants ago, where not now, the voltages were asked for that act, and by which hypotheses."""
    answer: Array
    """(K, H, p, m): −C S Kᵀ."""

    @classmethod
    def of(cls, bank: FilterBank, state_gain: Array, common: bool) -> ModalMotion | None:
        """From regulators' gains (H, m, s); None where a filter has no well-conditioned modes, or voltages act in several ways.

        ``common``: states of different hypotheses are added, so all must have the same coordinates.
        """
        H, m = len(state_gain), state_gain.shape[1]
        modes = (common_modes if common else modes_of)([bank.transition[h, :s, :s].T for h, s in enumerate(bank.sizes)])
        blocks = bank.voltage_input.reshape(-1, m, H, bank.counts[1])
        acts = blocks.any(axis=(1, 3))
        if modes is None or (acts.sum(axis=0) > 1).any():
            return None
        alike: list[_Alike] = []
        acting, first, column = np.argmax(acts, axis=0), 0, 0
        shown = np.concatenate([bank.output, state_gain.swapaxes(-1, -2)], axis=-1)
        drive = np.stack([blocks[acting[h], :, h] for h in range(H)])
        for size, members in groupby(modes, key=lambda each: 2 * len(each.eigenvalues)):
            group = list(members)
            those, columns = slice(first, first + len(group)), slice(column, column + len(group) * size)
            alike.append(_alike(group, those, columns, shown, bank.cross, drive))
            first, column = first + len(group), column + len(group) * size
        answer = np.matmul(bank.cross, -state_gain.swapaxes(-1, -2))
        late = tuple((int(d), np.flatnonzero(acting == d)) for d in np.unique(acting) if d)
        return cls(bank, tuple(alike), np.concatenate([each.eigenvalues for each in modes]), late, answer)

    @property
    def size(self) -> int:
        """Of all modes."""
        return 2 * len(self.eigenvalues)

    def by_hypothesis(self, states: Array) -> Array:
        """(N, H, c)."""
        (only,) = self.alike
        return only.of(states)

    def plain(self, states: Array) -> Array:
        """Modes back into states."""
        H, s = self.bank.counts
        own = np.empty((len(states), H, s), states.dtype)
        for each in self.alike:
            own[:, each.those] = np.matmul(each.of(states).swapaxes(0, 1), each.back).swapaxes(0, 1)
        return own

    def seen(self, states: Array) -> Array:
        """Products with modes of [Cᵀ, Kᵀ]."""
        shown = np.empty((self.bank.counts[0], len(states), self.alike[0].seen.shape[-1]), states.dtype)
        for each in self.alike:
            np.matmul(each.of(states).swapaxes(0, 1), each.seen, out=shown[each.those])
        return shown

    def answers(self, instant: Array, whitened: Array) -> Array:
        """Products with −C S Kᵀ."""
        return self.bank.carried(instant, whitened, self.answer)

    def follow(self, instant: Array, states: Array, whitened: Array, voltages: Array, out: Array) -> None:
        """Each by its eigenvalue, and one product with what comes in: innovations and those voltages that act."""
        step, (H, N, p), last = self.bank.step(instant), whitened.shape, len(self.answer) - 1
        inputs = np.empty((H, N, p + self.answer.shape[-1]), states.dtype)
        inputs[..., :p] = whitened
        self._act(voltages, inputs[..., p:])
        if (step == step[0]).all():
            self._enter(inputs, self._entries(int(step[0]), last), out)
        else:
            for k in np.unique(step).tolist():
                rows = np.flatnonzero(step == k)
                self._enter(inputs[:, rows], self._entries(k, last), out, rows)
        onward = np.empty(states.shape, states.dtype)
        turning = self.eigenvalues.dtype
        np.multiply(states.view(turning), self.eigenvalues, out=onward.view(turning))
        out += onward

    def driven(self, voltages: Array) -> Array:
        """Products with modes of Bᵀ."""
        H, N, kind = self.bank.counts[0], len(voltages), self.answer.dtype
        acting, driven = np.empty((H, N, self.answer.shape[-1]), kind), np.empty((N, self.size), kind)
        self._act(voltages, acting)
        for each in self.alike:
            np.matmul(acting[each.those], each.drive, out=each.of(driven).swapaxes(0, 1))
        return driven

    def _act(self, voltages: Array, into: Array) -> None:
        """Writes into (H, N, m), of voltages (N, m (D + 1)), those that act by each hypothesis."""
        m = into.shape[-1]
        into[...] = voltages[:, :m]
        for delay, those in self.late:
            into[those] = voltages[:, delay * m : (delay + 1) * m]

    def _entries(self, k: int, last: int) -> list[Array]:
        """(G, p + m, c) of each that are alike: what comes in at instant k."""
        if k == last:
            return [each.settled for each in self.alike]
        return [np.concatenate([each.gains[k], each.drive], axis=-2) for each in self.alike]

    def _enter(self, inputs: Array, entries: list[Array], out: Array, rows: NDArray[np.intp] | None = None) -> None:
        """Writes what ``inputs`` (H, n, p + m) add into ``out`` (N, size), or some rows of it."""
        for each, matrix in zip(self.alike, entries, strict=True):
            into = each.of(out)
            if rows is None:
                np.matmul(inputs[each.those], matrix, out=into.swapaxes(0, 1))
            else:
                into[rows] = np.matmul(inputs[each.those], matrix).swapaxes(0, 1)


def motion_of(bank: FilterBank, state_gain: Array, mixed: bool) -> Motion:
    """By modes where that is accurate for each filter, as they are elsewhere; ``mixed``: states of hypotheses are added."""
    return ModalMotion.of(bank, state_gain, mixed) or DenseMotion.of(bank, state_gain)


def _alike(group: list[Modes], those: slice, columns: slice, shown: Array, cross: Array, drive: Array) -> _Alike:
    s, c = shown.shape[1], 2 * len(group[0].eigenvalues)
    back, forth = np.zeros((len(group), c, s)), np.zeros((len(group), s, c))
    for g, each in enumerate(group):
        own = len(each.states)
        back[g, :, :own], forth[g, :own] = each.states.T, each.of_states.T
    turning = np.stack([each.eigenvalues for each in group])
    gains = np.ascontiguousarray(np.matmul(cross[:, those], forth))
    entering = gains.view(np.complex128)
    entering *= turning[:, None]
    into = np.matmul(drive[those], forth)
    settled = np.concatenate([gains[-1], into], axis=-2)
    return _Alike(those, columns, (len(group), c), back, np.matmul(back, shown[those]), gains, into, settled)
