"""Blades that change within an episode: which plant of a bank each has in a control interval, on a course of its own.

A bank's plants are those of some stations of what changes. In an interval a blade has the plant of the station that is nearest
to its course at the middle of the interval, held over it; from one plant to the next, displacements, velocities and what the
electronics hold go on; damping is that of the plant. With K stations evenly over a range the course is met within half the
distance of two, range/2(K − 1): in the scenarios that ship 0.14 % of the speed, at most 0.5 % of mass and 0.7 % of stiffness, and
2.4 K; twice as many stations change J by less than 1 % (``tests/scenarios/test_walks.py``).

What so slow a change does to the steady state is not vibration, as in a spin-up (``spin_up``): with it, and with what Euler's force
displaces, moves the equilibrium that vibration is about. Unlike there, the start of an episode excites nothing, for the change was
under way before; and of the strains that the total limit counts, those of Euler's force are left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import integers, namespace
from beamenv.scenarios.tables import PlantVariation

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

COMPONENTS = 6
"""J, of a speed that wanders."""

STATIONS = 16
"""Plants of one course of a blade that drifts."""


class Walk(Protocol):
    """What places the blades have in a bank, each on a course told by a few numbers; arrays of NumPy or of torch."""

    @property
    def draws(self) -> int:
        """Uniform numbers that a course takes."""
        ...

    def courses(self, uniforms: Any) -> Any:
        """Courses (N, c) of uniform numbers (N, ``draws``)."""
        ...

    def places(self, courses: Any, elapsed: Any) -> Any:
        """(N,) places in the bank in control interval ``elapsed`` (N,) of the episodes."""
        ...


@dataclass(frozen=True, slots=True)
class Wander:
    """A rotor speed that wanders about the configured one, Ω₀.

        Ω(t) = Ω₀ (1 + σ √(2/J) Σⱼ cos(2π fⱼ t + φⱼ)),    fⱼ = (j − ½) f/J,    j = 1 … J

    with phases φⱼ uniform and independent (Shinozuka and Deodatis 1991). The process is stationary, of mean Ω₀ and deviation σ Ω₀,
    with a flat spectrum up to f, near to normal, and never further than √(2J) σ Ω₀ from the mean.
    """

    deviation: float
    """σ"""
    frequency: float
    """f, in 1 per control interval."""
    plants: int
    """K, at speeds evenly over the range."""

    @property
    def draws(self) -> int:
        """J."""
        return COMPONENTS

    def courses(self, uniforms: Any) -> Any:
        """Phases (N, J), rad."""
        return 2.0 * np.pi * uniforms

    def ratios(self, courses: Any, time: Any) -> Any:
        """Ω/Ω₀ (N,) at times (N,) in control intervals."""
        array, rates = namespace(courses), 2.0 * np.pi * self.frequency * (np.arange(COMPONENTS) + 0.5) / COMPONENTS
        angles = array.stack([rate * time for rate in rates.tolist()], -1) + courses
        return 1.0 + self.deviation * float(np.sqrt(2.0 / COMPONENTS)) * array.cos(angles).sum(-1)

    def stations(self) -> Array:
        """(K,) ratios."""
        return np.linspace(-1.0, 1.0, self.plants) * self.deviation * np.sqrt(2.0 * COMPONENTS) + 1.0

    def places(self, courses: Any, elapsed: Any) -> Any:
        """The nearest stations."""
        first, *_, last = self.stations().tolist()
        place = (self.ratios(courses, elapsed + 0.5) - first) / (last - first) * (self.plants - 1)
        array = namespace(place)
        return integers(array.clip(array.round(place), 0, self.plants - 1))


@dataclass(frozen=True, slots=True)
class Drift:
    """A blade that changes from what it was designed for to the last station of one course, evenly, from an instant on."""

    onset: tuple[float, float]
    """In control intervals, as the duration: ranges to be drawn from."""
    duration: tuple[float, float]
    courses_known: int
    plants: int
    """Of each course, one course after the other."""

    @property
    def draws(self) -> int:
        """Course, onset, duration."""
        return 3

    def courses(self, uniforms: Any) -> Any:
        """(N, 3) course, onset and duration, in control intervals."""
        array = namespace(uniforms)
        course = array.floor(uniforms[:, 0] * self.courses_known)
        times = (low + (high - low) * uniforms[:, k] for k, (low, high) in enumerate((self.onset, self.duration), 1))
        return array.stack([course, *times], -1)

    def places(self, courses: Any, elapsed: Any) -> Any:
        """The nearest stations."""
        (course, onset, duration), array = courses.T, namespace(courses)
        share = array.clip((elapsed + 0.5 - onset) / array.clip(duration, 1.0, None), 0.0, 1.0)
        return integers(course * self.plants + array.round(share * (self.plants - 1)))


@dataclass(frozen=True, slots=True)
class Warming:
    """A blade whose temperature is drawn, and changes evenly from an instant on: all courses share the stations of one range."""

    first: tuple[float, float]
    change: tuple[float, float]
    """K, ranges to be drawn from."""
    onset: tuple[float, float]
    duration: tuple[float, float]
    """In control intervals, likewise."""
    plants: int

    @property
    def draws(self) -> int:
        """First temperature, change, onset, duration."""
        return 4

    def courses(self, uniforms: Any) -> Any:
        """(N, 4): those, in K and in control intervals."""
        ranges = enumerate((self.first, self.change, self.onset, self.duration))
        return namespace(uniforms).stack([low + (high - low) * uniforms[:, k] for k, (low, high) in ranges], -1)

    def stations(self) -> Array:
        """(K,) K, evenly over all that a course may reach."""
        (low, high), (fall, rise) = self.first, self.change
        return np.linspace(min(low, low + fall), max(high, high + rise), self.plants)

    def warmed(self, courses: Any, time: Any) -> Any:
        """K (N,): by how much blades are warmer at times (N,), in control intervals, than at first."""
        (_, change, onset, duration), array = courses.T, namespace(courses)
        return change * array.clip((time - onset) / array.clip(duration, 1.0, None), 0.0, 1.0)

    def warming(self, courses: Any, elapsed: Any) -> Any:
        """(N, 2): K per control interval after ``elapsed`` intervals (N,), in the mean of one around, and K since the first."""
        before, after, now = (self.warmed(courses, elapsed + shift) for shift in (-0.5, 0.5, 0.0))
        return namespace(courses).stack([after - before, now], -1)

    def places(self, courses: Any, elapsed: Any) -> Any:
        """The nearest stations."""
        first, *_, last = self.stations().tolist()
        temperatures = courses[:, 0] + self.warmed(courses, elapsed + 0.5)
        place, array = (temperatures - first) / max(last - first, 1e-9) * (self.plants - 1), namespace(courses)
        return integers(array.clip(array.round(place), 0, self.plants - 1))


def walk_of(variation: PlantVariation, interval: float) -> Walk | None:
    """How blades walk over the bank of a scenario, at a control interval in s; None where each keeps its plant."""
    if variation.speed_wander:
        return Wander(variation.speed_wander, variation.wander_frequency * interval, variation.bank)
    onset, duration = ((low / interval, high / interval) for low, high in (variation.drift_onset, variation.drift_duration))
    if variation.temperature is not None:
        return Warming(variation.temperature, variation.temperature_change, onset, duration, variation.bank)
    if variation.drifts:
        plants = min(STATIONS, variation.bank)
        return Drift(onset, duration, variation.bank // plants, plants)
    return None


def stations_of(walk: Walk, variation: PlantVariation) -> Array:
    """(K, 3): ratios of speed, modulus and mass at the stations of a bank, over those configured."""
    if isinstance(walk, Warming):
        return np.ones((walk.plants, 3))
    if isinstance(walk, Wander):
        return np.stack([walk.stations(), np.ones(walk.plants), np.ones(walk.plants)], axis=1)
    assert isinstance(walk, Drift)
    generator, courses = np.random.default_rng(variation.seed), walk.courses_known
    strata = np.stack([generator.permutation(courses) for _ in range(2)], axis=1)
    uniform = (strata + generator.random(strata.shape)) / courses
    ends = np.stack(
        [low + (high - low) * uniform[:, k] for k, (low, high) in enumerate((variation.modulus_drift, variation.mass_drift))]
    )
    share = np.linspace(0.0, 1.0, walk.plants)
    modulus, mass = 1.0 + (ends[:, :, None] - 1.0) * share
    return np.stack([np.ones(modulus.size), modulus.ravel(), mass.ravel()], axis=1)
