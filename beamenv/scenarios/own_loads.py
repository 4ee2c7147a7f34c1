"""Loads of one's own in a scenario: where each acts, and its course in time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from typing import Annotated, Any

from beamenv.blade.load_shapes import SHAPES, LoadShape, Profile, check_place, usual_size
from beamenv.configuration import Choice, Count, Number, Points, Range, Refused, check_heeded, configuration
from beamenv.configuration.heeded import Heeded
from beamenv.configuration.numbers import TURNED
from beamenv.scenarios.series import Function, Series, read_series
from beamenv.scenarios.tables import Pair
from beamenv.sensors.kinds import LARGEST, Point, Vector
from beamenv.structure import RotatingBeam

COURSES = ("step", "pulse", "harmonic", "series", "noise", "function")

Seconds = Annotated[Pair, Range(0.0, 1e6, unit="s")]

_SETS_IN = ("step", "pulse", "series", "function")
_HEEDED: Heeded = (
    ("onset", "course", _SETS_IN),
    ("duration", "course", ("pulse",)),
    ("frequency", "course", ("harmonic",)),
    ("phase_deg", "course", ("harmonic",)),
    *((name, "course", ("noise",)) for name in ("spectrum", "cutoff", "order", "damping")),
    *((name, "spectrum", (None,)) for name in ("cutoff", "order", "damping")),
    ("damping", "order", (2,)),
)


@configuration("scenario.loads")
class Load:
    """A load of one's own, in every episode. Every range is [low, high], drawn uniformly; equal ends, or one number, fix the value.

    It acts besides the scenario's load cases, held over each control interval, at the value of the interval's middle unless said
    otherwise.
    """

    shape: Annotated[str, Choice(SHAPES)] = "point"
    """Where it acts: see ``beamenv.blade.load_shapes.LoadShape`` for this and the fields up to ``direction``."""
    position: Annotated[float | None, Number(ge=0.0, unit="m")] = None
    """m along the span from the clamp, of a point; None: the tip."""
    span: Annotated[Pair | None, Range(0.0, unit="m")] = None
    """m from and to which a line load reaches; None: all of the span."""
    profile: Profile = (1.0, 1.0)
    """How large a line load is at its beginning and its end over its size; linear between."""
    point: Point = (0.0, 0.0)
    """m: x and y in the section, from the pitch axis: where a force acts."""
    direction: Vector = (0.0, 1.0, 0.0)
    """Along lag, flap and span; of any length."""
    course: Annotated[str, Choice(COURSES)] = "step"
    magnitude: Annotated[Pair | None, Range(-LARGEST, LARGEST)] = None
    """N, N/m or m/s²; of noise its standard deviation; of a series or a function a factor. None: what stands for the blade's
    reference load (``usual_size``), a tenth of it for a harmonic or noise, and 1 for a series or function."""
    onset: Seconds = (0.0, 0.0)
    """s: when a step or pulse sets in, or a series or function begins, in whole control intervals."""
    duration: Seconds = (0.01, 0.01)
    """s, of a pulse, in whole control intervals."""
    frequency: Annotated[Pair, Range(0.0, 1e6, unit="Hz")] = (10.0, 10.0)
    """Hz, of a harmonic load."""
    phase_deg: Annotated[Pair, Range(-TURNED, TURNED, unit="degrees")] = (0.0, 360.0)
    """Degrees, of a harmonic load: that of its sine at t = 0."""
    series: Annotated[str | tuple[float, ...] | None, Series()] = None
    """Measured values, or a CSV file with one a line; of them each control interval has the mean (``interval_means``)."""
    rate: Annotated[float | None, Number(gt=0.0, le=1e9, unit="Hz")] = None
    """Hz at which the series was sampled."""
    cutoff: Annotated[float, Number(gt=0.0, le=1e6, unit="Hz")] = 50.0
    """Hz, of the filter that white noise passes: its −3 dB frequency for order 1, the natural frequency for order 2."""
    order: Annotated[int, Count(1, 2)] = 1
    damping: Annotated[float, Number(ge=1e-3, le=10.0)] = 0.7
    """Damping ratio of a filter of order 2."""
    spectrum: Annotated[tuple[Pair, ...] | None, Points(least=2, most=10_000)] = None
    """Pairs of frequency (Hz) and one-sided power spectral density (squares of the unit per Hz) in place of the filter, with
    straight lines between and nothing beyond; ``magnitude`` is then a factor, 1 if None."""
    function: Annotated[Callable[..., Any] | None, Function()] = None
    """f(t) of the time in s since its onset, of a number or of an array of them."""

    def __post_init__(self) -> None:
        check_place(self)
        if (self.course == "series") != (self.series is not None):
            raise Refused("series", None if self.series is None else "given", "given where the course is 'series', and only there")
        if (self.course == "series") != (self.rate is not None):
            raise Refused("rate", self.rate, "given (Hz) where the course is 'series', and only there")
        if (self.course == "function") != (self.function is not None):
            raise Refused("function", self.function, "given where the course is 'function', and only there")
        check_heeded(self, _HEEDED)
        if self.spectrum is not None:
            _check_spectrum(self.spectrum)

    @property
    def place(self) -> LoadShape:
        """Where it acts."""
        return LoadShape(**{each.name: getattr(self, each.name) for each in fields(LoadShape)})

    @property
    def is_factor(self) -> bool:
        """Whether its magnitude is a factor of what is given otherwise."""
        return self.course in ("series", "function") or (self.course == "noise" and self.spectrum is not None)


def _check_spectrum(spectrum: tuple[Pair, ...]) -> None:
    frequencies, densities = zip(*spectrum, strict=True)
    rising = all(later > earlier for earlier, later in zip(frequencies, frequencies[1:], strict=False))
    if not rising or frequencies[0] < 0.0 or min(densities) < 0.0 or not 0.0 < max(densities) <= LARGEST:
        raise Refused("spectrum", spectrum, f"pairs of ascending frequencies (Hz) and densities of 0 to {LARGEST:g}, some positive")


TENTH = 0.1
"""Of the usual size: a harmonic load, which resonance multiplies, and noise."""


def of_blade(loads: Sequence[Load], beam: RotatingBeam, reference: float) -> tuple[Load, ...]:
    """Loads with a magnitude each, and series read from their files; ``reference`` is the blade's reference load, N/m."""
    return tuple(_of_blade(load, beam, reference, f"scenario.loads[{k}]") for k, load in enumerate(loads))


def _of_blade(load: Load, beam: RotatingBeam, reference: float, name: str) -> Load:
    if isinstance(load.series, str):
        load = replace(load, series=read_series(load.series, f"{name}.series"))
    if load.magnitude is not None:
        return load
    usual = 1.0 if load.is_factor else usual_size(beam, load.place, reference)
    size = TENTH * usual if load.course in ("harmonic", "noise") and not load.is_factor else usual
    return replace(load, magnitude=(size, size))
