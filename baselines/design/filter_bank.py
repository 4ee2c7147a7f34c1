"""Kalman filters of several hypotheses side by side, for a batch of blades: every product runs over hypotheses × blades at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from baselines.design.controller import Array
from beamenv.configuration.read_only import ReadOnly

SETTLED = 1e-3
"""A filter's gain counts as that of the steady state when no correction, in standard deviations, differs by more than this."""

LONGEST = 200
"""Instants at most with gains of their own. Modes that are hardly seen take longer to settle than an episode lasts; on the default
blade, what a reading that is off by a standard deviation does to the voltages is within 2 % of the steady state by then."""


class Filter(NamedTuple):
    """x⁺ = A x + B u + w, y = C x + v with covariances W and V, S₀ of x at the start, and S of its prediction in the long run."""

    A: Array
    B: Array
    C: Array
    W: Array
    V: Array
    at_start: Array
    in_the_long_run: Array


MOST_PATTERNS = 256
"""Of lost readings, for which the steady state's matrices are kept."""


class Correction(NamedTuple):
    """What readings say of H hypotheses' predictions for N blades."""

    whitened: Array
    """(H, N, p): covariance⁻¹ innovation, zero of what is lost. S Cᵀ times it is to be added to the predicted states."""
    squared: Array
    """(H, N): normalised innovation squared, χ² with as many degrees of freedom as there are readings."""
    log_density: Array
    """(H, N): of the readings, but for (2π)^(−p/2)."""


@dataclass(frozen=True, slots=True, eq=False)
class FilterBank(ReadOnly):
    """H filters of s states, shorter ones with zeros behind their own, with gains for K instants, of which the last stays."""

    transition: Array
    """(H, s, s): Aᵀ."""
    voltage_input: Array
    """(m (D + 1), H, s): Bᵀ, from this instant's voltages and the D before, newest first."""
    output: Array
    """(H, s, p): Cᵀ."""
    cross: Array
    """(K, H, p, s): covariance of readings and states, C S."""
    covariance: Array
    """(K, H, p, p): of innovations, C S Cᵀ + V."""
    inverse: Array
    """(K, H, p, p): of it."""
    log_determinant: Array
    """(K, H)."""
    full_scale: Array
    """(p,), A: where readings are clipped."""
    holds: NDArray[np.bool_]
    """(H,): whether lost readings show as the one before."""
    sizes: tuple[int, ...]
    """(H,): states of each filter's own."""
    left: tuple[tuple[Array, Array], ...]
    """Of the last instant, by the pattern of what is lost, bit by bit: inverse and logarithm of the determinant of what is left."""

    @classmethod
    def of(
        cls, filters: Sequence[Filter], delays: Sequence[int], depth: int, full_scale: Array, holds: Sequence[bool]
    ) -> FilterBank:
        """From each hypothesis' filter and delay; ``depth`` D is how many voltages before are remembered."""
        size = max(len(each.A) for each in filters)
        same = [_padded(each, size) for each in filters]
        first = {_equation(each): each for each in same}
        which = [list(first).index(_equation(each)) for each in same]
        of = _recursion(*(np.stack(part) for part in zip(*first.values(), strict=True)))
        cross, covariance = of[0][:, which], of[1][:, which]
        m = filters[0].B.shape[1]
        voltage_input = np.zeros(((depth + 1) * m, len(same), size))
        for h, (each, delay) in enumerate(zip(same, delays, strict=True)):
            voltage_input[delay * m : (delay + 1) * m, h] = each.B.T
        patterns = 2 ** covariance.shape[-1] if any(holds) else 0
        return cls(
            transition=np.stack([each.A.T for each in same]),
            voltage_input=voltage_input,
            output=np.stack([each.C.T for each in same]),
            cross=cross,
            covariance=covariance,
            inverse=np.asarray(np.linalg.inv(covariance), dtype=np.float64),
            log_determinant=np.linalg.slogdet(covariance)[1],
            full_scale=full_scale,
            holds=np.array(holds, dtype=bool),
            sizes=tuple(len(each.A) for each in filters),
            left=tuple(_without(covariance[-1], code) for code in range(patterns if patterns <= MOST_PATTERNS else 0)),
        )

    @property
    def counts(self) -> tuple[int, int]:
        """Hypotheses H and states s."""
        return self.transition.shape[0], self.transition.shape[1]

    @property
    def alike(self) -> Iterator[tuple[slice, int]]:
        """Hypotheses next to each other that have as many states, and how many."""
        first = 0
        for size, those in groupby(self.sizes):
            following = first + len(list(those))
            yield slice(first, following), size
            first = following

    def lost(self, reading: Array, before: Array, first: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """(N, p): readings that show the one before exactly, unless both are clipped, if any hypothesis says that lost ones do."""
        again = (reading == before) & (np.abs(reading) < self.full_scale) & ~first[:, None]
        return np.asarray(again & self.holds.any())

    def corrections(self, instant: Array, innovation: Array, lost: NDArray[np.bool_]) -> Correction:
        """From ``innovation`` (H, N, p), A, and what is ``lost`` of it (N, p), each blade at an ``instant`` (N,) of its own.

        A lost reading counts in no likelihood, nor for filters that know.
        """
        step, codes = self.step(instant), 1 << lost.shape[1]
        keys = step * codes + lost @ (1 << np.arange(lost.shape[1]))
        if (keys == keys[0]).all():
            return self._correction(divmod(int(keys[0]), codes), innovation)
        found, counts = np.unique(keys, return_counts=True)
        most = int(found[counts.argmax()])
        all_of_them = self._correction(divmod(most, codes), innovation)
        for key in found[found != most].tolist():
            rows = np.flatnonzero(keys == key)
            for whole, part in zip(all_of_them, self._correction(divmod(key, codes), innovation[:, rows]), strict=True):
                whole[:, rows] = part
        return all_of_them

    def carried(self, instant: Array, whitened: Array, onward: Array) -> Array:
        """(H, N, q): ``whitened`` innovations (H, N, p) through matrices ``onward`` (K, H, p, q) of each blade's instant (N,)."""
        step = self.step(instant)
        if (step == step[0]).all():
            return np.matmul(whitened, onward[step[0]])
        carried = np.empty((*whitened.shape[:2], onward.shape[-1]), whitened.dtype)
        for k in np.unique(step):
            carried[:, step == k] = np.matmul(whitened[:, step == k], onward[k])
        return carried

    def driven(self, voltages: Array) -> Array:
        """(N, H, s): what voltages (N, m (D + 1)), V, newest first, add to the states of the next instant."""
        return np.asarray(np.tensordot(voltages, self.voltage_input, 1))

    def step(self, instant: Array) -> NDArray[np.int64]:
        """(N,): which of the gains, of which the last stays."""
        return np.minimum(instant, len(self.cross) - 1).astype(np.int64)

    def _correction(self, at: tuple[int, int], innovation: Array) -> Correction:
        """Of blades ``at`` one instant that have lost the same readings, the bits of a number.

        With z = covariance⁻¹ innovation of those that are left and zero of the others, S Cᵀ z is the optimum from them.
        """
        k, code = at
        inverse, log_determinant = self.inverse[k], self.log_determinant[k]
        if code:
            kept = k == len(self.cross) - 1 and code < len(self.left)
            inverse, log_determinant = self.left[code] if kept else _without(self.covariance[k], code)
        whitened = np.matmul(innovation, inverse)
        squared = (innovation * whitened) @ np.ones(innovation.shape[-1], innovation.dtype)
        log_density = -0.5 * (squared + log_determinant[:, None])
        if code and not self.holds.all():
            others = ~self.holds
            whitened[others] = np.matmul(innovation[others], self.inverse[k, others])
        return Correction(whitened, squared, log_density)


def _without(covariance: Array, code: int) -> tuple[Array, Array]:
    """Inverse (H, p, p), zero in rows and columns of what is lost, and logarithm of the determinant (H,) of what is left."""
    left = np.flatnonzero(~(code >> np.arange(covariance.shape[-1])) & 1)
    inverse, log_determinant = np.zeros_like(covariance), np.zeros(len(covariance), covariance.dtype)
    if len(left):
        kept = covariance[:, left[:, None], left]
        inverse[:, left[:, None], left], log_determinant = np.linalg.inv(kept), np.linalg.slogdet(kept)[1]
    return inverse, log_determinant


def _padded(each: Filter, size: int) -> Filter:
    """The same filter with zeros behind its own states."""
    more = size - len(each.A)
    both, below, right = ((0, more), (0, more)), ((0, more), (0, 0)), ((0, 0), (0, more))
    widths = (both, below, right, both, ((0, 0), (0, 0)), both, both)
    return Filter(*(np.pad(part, width) for part, width in zip(each, widths, strict=True)))


def _equation(each: Filter) -> tuple[bytes, ...]:
    """What its covariance goes by, whatever its voltages do."""
    return tuple(part.tobytes() for name, part in each._asdict().items() if name != "B")


def _recursion(A: Array, B: Array, C: Array, W: Array, V: Array, S: Array, last: Array) -> tuple[Array, Array]:
    """C S (K, H, p, s) and C S Cᵀ + V (K, H, p, p) of Riccati's recursion from ``S``, until they are those of ``last``.

    S⁺ = A (S − S Cᵀ (C S Cᵀ + V)⁻¹ C S) Aᵀ + W for all H filters at once.
    """

    def seen(S: Array) -> tuple[Array, Array]:
        cross = C @ S
        return cross, cross @ C.swapaxes(-1, -2) + V

    steady = seen(last)
    spread = np.sqrt(np.maximum(np.diagonal(last, axis1=-2, axis2=-1), 0.0))[:, None]
    size = np.sqrt(np.diagonal(steady[1], axis1=-2, axis2=-1))[..., None] * np.where(spread > 0.0, spread, np.inf)
    found: list[tuple[Array, Array]] = []
    for _ in range(LONGEST):
        cross, covariance = seen(S)
        if (np.abs(cross - steady[0]) / size).max(initial=0.0) < SETTLED:
            break
        found.append((cross, covariance))
        S = S - cross.swapaxes(-1, -2) @ np.linalg.solve(covariance, cross)
        S = A @ S @ A.swapaxes(-1, -2) + W
        S = 0.5 * (S + S.swapaxes(-1, -2))
    found.append(steady)
    return np.stack([each[0] for each in found]), np.stack([each[1] for each in found])
