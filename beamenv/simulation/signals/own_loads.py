"""Loads of one's own in time: what each of N blades is given of each, interval by interval.

Noise of order 1 has the one-sided power spectral density S(f) = (2σ²/π f_c) / (1 + (f/f_c)²), of order 2 with damping ratio ζ
S(f) = (4ζσ²/π f_0) / ((1 − (f/f_0)²)² + (2ζ f/f_0)²), ∫₀^∞ S df = σ²; sampled exactly from the steady state. Noise of a table is
a sum of sines of random phases and amplitudes that repeats itself after ``PERIOD`` intervals.

What is random is drawn when an episode begins, from the numbers that its own generator gives: the same seed has the same loads.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import expm

from beamenv.arrays import namespace
from beamenv.configuration import clause
from beamenv.scenarios.drawing import whole_intervals
from beamenv.scenarios.own_loads import Load
from beamenv.scenarios.series import interval_means
from beamenv.sensors.kinds import LARGEST

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

DRAWS = 6
"""Uniform numbers that a load takes of each episode: magnitude, onset, duration, frequency, phase, and its noise."""

BLOCK = 1024
"""Intervals of noise that are drawn at a time."""

PERIOD = 2**14
"""Intervals after which noise of a table begins anew: 8 s of 0.5 ms."""


class OwnLoads:
    """The loads of N blades; disturbances from ``first`` on are theirs."""

    def __init__(self, loads: Sequence[Load], interval: float, count: int, first: int) -> None:
        self._loads, self._interval, self._first = tuple(loads), interval, first
        self._uniforms, self._step = np.zeros((count, DRAWS * len(loads))), np.zeros(count, dtype=np.int64)
        self._courses = [_course(load, interval) for load in self._loads]
        self._noises: list[dict[int, Noise]] = [{} for _ in self._loads]

    def __getstate__(self) -> tuple[Any, ...]:
        return self._loads, self._interval, self._first, self.state_dict()

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        """What is worked out of the loads is worked out anew."""
        loads, interval, first, moving = state
        self.__init__(loads, interval, len(moving["step"]), first)  # type: ignore[misc]
        self.load_state_dict(moving)

    def begin(self, rows: Rows, uniforms: Array) -> None:
        """Begin the episodes of ``rows`` with uniform numbers (len(rows), draws)."""
        self._uniforms[rows], self._step[rows] = uniforms, 0
        for noises in self._noises:
            for row in rows.tolist():
                noises.pop(row, None)

    def added(self, loads: Any) -> Any:
        """Disturbances (…, k) with what acts in this interval: NumPy's in place."""
        if isinstance(loads, np.ndarray):
            for k, values in enumerate(self.values.T):
                place = loads[..., self._first + k]
                place += values.reshape(place.shape)
            return loads
        own = namespace(loads).as_tensor(self.values, dtype=loads.dtype, device=loads.device)
        last = self._first + own.shape[-1]
        parts = loads[..., : self._first], loads[..., self._first : last] + own, loads[..., last:]
        return namespace(loads).concatenate(parts, -1)

    @property
    def values(self) -> Array:
        """(N, loads) in this interval."""
        parts = np.split(self._uniforms, len(self._loads), axis=1)
        return np.stack([self._value(k, part) for k, part in enumerate(parts)], axis=1)

    def elapse(self) -> None:
        """Go to the next interval."""
        self._step += 1

    def _value(self, k: int, uniforms: Array) -> Array:
        load = self._loads[k]
        assert load.magnitude is not None
        size = _within(load.magnitude, uniforms[:, 0])
        if load.course != "noise":
            return size * self._courses[k](self._step, uniforms)
        return size * np.array([self._noise(k, row, uniforms[row, 5]) for row in range(len(size))])

    def _noise(self, k: int, row: int, uniform: float) -> float:
        if row not in self._noises[k]:
            self._noises[k][row] = noise_of(self._loads[k], self._interval, int(uniform * 2**53))
        return self._noises[k][row].at(int(self._step[row]))

    def state_dict(self) -> dict[str, Any]:
        """Copies of what moves."""
        return {"uniforms": self._uniforms.copy(), "step": self._step.copy()}

    def load_state_dict(self, state: Mapping[str, ArrayLike]) -> None:
        """Go back to a ``state_dict`` of equally made loads."""
        self._uniforms, self._step = np.asarray(state["uniforms"]).copy(), np.asarray(state["step"]).copy()
        self._noises = [{} for _ in self._loads]


Course = Callable[[Rows, Array], Array]


def _course(load: Load, interval: float) -> Course:
    """What a load of size 1 is in intervals (N,), given its uniform numbers (N, draws)."""

    def since(step: Rows, uniforms: Array) -> Rows:
        return np.asarray(step - whole_intervals(_within(load.onset, uniforms[:, 1]), interval))

    def step_or_pulse(step: Rows, uniforms: Array) -> Array:
        lasting = np.maximum(whole_intervals(_within(load.duration, uniforms[:, 2]), interval), 1)
        past = since(step, uniforms)
        return ((past >= 0) & ((past < lasting) | (load.course == "step"))).astype(np.float64)

    def harmonic(step: Rows, uniforms: Array) -> Array:
        angle = 2.0 * np.pi * _within(load.frequency, uniforms[:, 3]) * (step + 0.5) * interval
        return np.asarray(np.sin(angle + np.radians(_within(load.phase_deg, uniforms[:, 4]))))

    def function(step: Rows, uniforms: Array) -> Array:
        past = since(step, uniforms)
        return np.where(past < 0, 0.0, values_of(load.function, (np.maximum(past, 0) + 0.5) * interval))

    if load.course == "series":
        assert isinstance(load.series, tuple) and load.rate is not None
        means = np.append(interval_means(load.series, load.rate, interval), 0.0)

        def series(step: Rows, uniforms: Array) -> Array:
            past = since(step, uniforms)
            return np.where(past < 0, 0.0, means[np.clip(past, 0, len(means) - 1)])

        return series
    return {"harmonic": harmonic, "function": function}.get(load.course, step_or_pulse)


def values_of(function: Any, times: Array) -> Array:
    """(N,): a function at times (N,), s, taken one by one where it does not take an array; ``ValueError`` for what is no number."""
    try:
        values = np.asarray(function(times), dtype=np.float64)
        if values.shape != times.shape:
            raise TypeError
    except (TypeError, ValueError):
        values = np.array([_number(_called(function, time), time) for time in times.tolist()])
    for value, time in zip(values, times, strict=True):
        _number(value, time)
    return values


def _called(function: Any, time: float) -> Any:
    try:
        return function(time)
    except TypeError as error:
        raise ValueError(f"scenario.loads: function({time:g}) cannot be called: {clause(error)}.") from None


def _number(value: Any, time: float) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = np.nan
    if not abs(number) <= LARGEST:
        raise ValueError(f"scenario.loads: function({time:g}) is {value!r}, but must be a finite number, at most {LARGEST:g}.")
    return number


def _within(limits: tuple[float, float], uniform: Array) -> Array:
    return np.asarray(limits[0] + (limits[1] - limits[0]) * uniform)


class Noise:
    """Noise of standard deviation 1, or of a table's spectrum, block after block from a seed."""

    def __init__(self, draw: Callable[[np.random.Generator, Array | None], tuple[Array, Array]], seed: int) -> None:
        self._draw, self._generator = draw, np.random.default_rng(seed)
        self._block, self._state = draw(self._generator, None)
        self._from = 0

    def at(self, step: int) -> float:
        """Its value in an interval, none before the last asked for."""
        while step >= self._from + len(self._block):
            self._from += len(self._block)
            self._block, self._state = self._draw(self._generator, self._state)
        return float(self._block[step - self._from])


def noise_of(load: Load, interval: float, seed: int) -> Noise:
    """That of a load in one episode."""
    if load.spectrum is not None:
        return Noise(lambda generator, kept: _of_table(load, interval, generator, kept), seed)
    transition, root, steady = _filter(load, interval)

    def draw(generator: np.random.Generator, state: Array | None) -> tuple[Array, Array]:
        values = np.empty(BLOCK)
        state = steady @ generator.standard_normal(len(steady)) if state is None else state
        for k, pushed in enumerate(generator.standard_normal((BLOCK, len(root))) @ root.T):
            values[k], state = state[0], transition @ state + pushed
        return values, state

    return Noise(draw, seed)


def _filter(load: Load, interval: float) -> tuple[Array, Array, Array]:
    """Transition, root of what each interval adds and root of the covariance of the steady state, of a filter whose output is state
    1 and has a standard deviation of 1.
    """
    omega = 2.0 * np.pi * load.cutoff
    if load.order == 1:
        decay = np.exp(-omega * interval)
        return np.array([[decay]]), np.array([[np.sqrt(1.0 - decay**2)]]), np.eye(1)
    transition = expm(interval * omega * np.array([[0.0, 1.0], [-1.0, -2.0 * load.damping]]))
    added = np.eye(2) - transition @ transition.T  # displacement and velocity over ω have the covariance 1
    values, vectors = np.linalg.eigh(added)
    return transition, (vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T, np.eye(2)


def _of_table(load: Load, interval: float, generator: np.random.Generator, kept: Array | None) -> tuple[Array, Array]:
    """A period of noise, the same again once it is known."""
    if kept is not None:
        return kept, kept
    assert load.spectrum is not None
    frequencies, densities = np.array(load.spectrum).T
    bins = np.fft.rfftfreq(PERIOD, interval)
    density = np.interp(bins, frequencies, densities, left=0.0, right=0.0)
    amplitude = np.sqrt(density * PERIOD / (4.0 * interval))
    amplitude[[0, -1]] = 0.0
    spectrum = amplitude * (generator.standard_normal(len(bins)) + 1j * generator.standard_normal(len(bins)))
    values = np.fft.irfft(spectrum, PERIOD)
    return values, values
