"""Scenarios: from what the load case of an episode is drawn, which noises are on, and what is wrong with the blade.

Those with a name are files in ``scenarios/named``: a TOML file put there is a scenario, and an environment id, of its name.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, is_dataclass, replace
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.plant.plant import Plant
from beamenv.scenarios import named
from beamenv.scenarios.load_cases import CASES, NEVER, LoadCases
from beamenv.scenarios.named import NAMES
from beamenv.scenarios.tables import Acquisition, Drive, Failures, PlantVariation, Range, Rotor, checked_range

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

DRAWS = 7
"""Uniform numbers one load case takes, whatever the case: paired seeds stay paired when a scenario is altered."""


@dataclass(frozen=True, slots=True)
class Scenario:
    """What may happen to a blade in an episode. Every range is [low, high], drawn uniformly; equal ends fix the value.

    The default is made for the default blade. Under ±1500 V its patches hold a static line load of about 7 N/m in flap, so at
    30 N/m they are neither idle nor helpless: LQG saturates now and then, and halves the time to settle. For a blade of
    another size choose other magnitudes.
    """

    step: float = 0.25
    """Share of episodes with a load that sets in and stays."""
    pulse: float = 0.25
    """Share of episodes with a rectangular pulse."""
    deflection: float = 0.25
    """Share of episodes that start from rest in a static deflection, released at t = 0."""
    harmonic: float = 0.25
    """Share of episodes with a sinusoidal load. What the four shares leave of 1 has no load case."""
    magnitude: Range = (15.0, 45.0)
    """N/m, of step, pulse and deflection: 30 N/m on average."""
    harmonic_magnitude: Range = (1.5, 4.5)
    """N/m: a tenth of the others, within what the patches can hold, for in an episode resonance multiplies it some 30 times."""
    direction_deg: Range = (0.0, 360.0)
    """Degrees from lag towards flap: any direction, for the pretwisted blade couples both."""
    onset: Range = (0.0, 0.05)
    """s: a controller cannot count on t = 0, and at least 90 % of a 0.5 s episode is left to damp what follows."""
    duration: Range = (0.005, 0.05)
    """s, of a pulse: from a knock much shorter than the first two modes' periods, 35 and 28 ms, to a push longer than both."""
    frequency_ratio: Range = (0.5, 2.0)
    """Frequency of a harmonic load over the plant's first natural frequency: below, in and above resonance."""
    phase_deg: Range = (0.0, 360.0)
    """Degrees, of a harmonic load."""
    white_load: bool = True
    """Whether the plant's white line loads act."""
    sensor_noise: bool = True
    """Whether the plant's sensor noise is added to each reading."""
    plants: PlantVariation = field(default_factory=PlantVariation)
    """How the true plant differs from the design's."""
    drive: Drive = field(default_factory=Drive)
    acquisition: Acquisition = field(default_factory=Acquisition)
    failures: Failures = field(default_factory=Failures)
    rotor: Rotor = field(default_factory=Rotor)

    def __post_init__(self) -> None:
        for name in CASES[:-1]:
            _check_share(name, getattr(self, name))
        if sum(self.shares) > 1.0 + 1e-9:
            raise ValueError(f"scenario: the shares {CASES[:-1]} are {self.shares}, but must not add up to more than 1.")
        for name, (least, most) in _LIMITS.items():
            object.__setattr__(self, name, checked_range(name, getattr(self, name), least, most))
        for name in ("white_load", "sensor_noise"):
            if not isinstance(getattr(self, name), bool):
                raise ValueError(f"scenario: {name} is {getattr(self, name)!r}, but must be true or false.")

    @property
    def shares(self) -> tuple[float, ...]:
        """Shares of episodes with a step, a pulse, a deflection, a harmonic load."""
        return self.step, self.pulse, self.deflection, self.harmonic

    def to_dict(self) -> dict[str, Any]:
        """A dictionary that JSON can hold; ``scenario`` takes it back."""
        return _with_lists(asdict(self))

    @property
    def imperfect(self) -> bool:
        """Whether there is more between controller and patches than saturation and noise."""
        faulty = self.failures.dead_actuators or self.failures.faulty_sensors or self.acquisition.dropout
        return bool(faulty or self.drive.hysteresis or self.drive.delay != (0, 0))


def _with_lists(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _with_lists(each) for key, each in value.items()}
    return [_with_lists(each) for each in value] if isinstance(value, tuple) else value


_LIMITS = {
    "magnitude": (0.0, math.inf),
    "harmonic_magnitude": (0.0, math.inf),
    "direction_deg": (-math.inf, math.inf),
    "onset": (0.0, math.inf),
    "duration": (0.0, math.inf),
    "frequency_ratio": (0.0, math.inf),
    "phase_deg": (-math.inf, math.inf),
}


def _check_share(name: str, value: Any) -> None:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0.0 <= value <= 1.0:
        raise ValueError(f"scenario: {name} is {value!r}, but must be a share from 0 to 1.")


def _changed(base: Any, given: Mapping[str, Any], table: str = "") -> Any:
    """The scenario, or one of its tables, with the given fields changed; a table's fields change one by one."""
    known = [each.name for each in fields(base)]
    if unknown := sorted(set(given) - set(known)):
        raise ValueError(
            f"scenario has no field {table + unknown[0]!r}: its fields are {', '.join(table + name for name in known)}."
        )
    changes = {}
    for name, value in given.items():
        current = getattr(base, name)
        if is_dataclass(current) and not isinstance(value, type(current)):
            if not isinstance(value, Mapping):
                raise ValueError(f"scenario: {name} is {value!r}, but must be a table of fields.")
            value = _changed(current, value, f"{name}.")
        changes[name] = value
    return replace(base, **changes)


_ALONE = dict.fromkeys(CASES[:-1], 0.0)
SCENARIOS: dict[str, Scenario] = {
    "default": Scenario(),
    **{case: Scenario(**{**_ALONE, case: 1.0}) for case in CASES[:-1]},  # type: ignore[arg-type]
    "white": Scenario(**_ALONE),  # type: ignore[arg-type]
    "quiet": Scenario(**_ALONE, white_load=False, sensor_noise=False),  # type: ignore[arg-type]
}
"""Named scenarios: all four load cases in turn; each one alone; white load and sensor noise only (what an LQG is
designed for); nothing at all; and the benchmark's, a file each."""


def scenario(given: Scenario | Mapping[str, Any] | str | None = None) -> Scenario:
    """The scenario meant by a name in ``SCENARIOS``, the path of a TOML file, a dictionary of fields or itself; None: "default".

    A dictionary or file may name the scenario it departs from under the key "preset". Raises ValueError for an unknown name
    or field and for a value out of range.
    """
    if given is None:
        return SCENARIOS["default"]
    if isinstance(given, Scenario):
        return given
    if isinstance(given, str):
        return load_scenario(given) if given.endswith(".toml") else _named(given)
    if not isinstance(given, Mapping):
        raise ValueError(f"scenario is {given!r}, but must be a name, a dictionary or a Scenario.")
    base = _named(given.get("preset", "default"))
    chosen: Scenario = _changed(base, {name: value for name, value in given.items() if name != "preset"})
    return chosen


def load_scenario(path: str | Path) -> Scenario:
    """The scenario in a TOML file; ``ValueError`` if it cannot be read or holds what no scenario has."""
    try:
        content = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ValueError(f"scenario file {str(path)!r} cannot be read: {error}.") from None
    return scenario(content)


def _named(name: Any) -> Scenario:
    if name not in SCENARIOS:
        raise ValueError(
            f"scenario is {name!r}, but must be one of {', '.join(SCENARIOS)}, a .toml file, or a dictionary of fields."
        )
    return SCENARIOS[name]


for _name in NAMES:
    SCENARIOS[_name] = scenario(tomllib.loads(files(named).joinpath(f"{_name}.toml").read_text(encoding="utf-8")))


LOAD_OPTIONS = ("case", "magnitude", "direction_deg", "onset", "duration", "frequency_ratio", "phase_deg")


def with_load(base: Scenario, load: Mapping[str, Any]) -> Scenario:
    """The scenario with its load case fixed: ``load`` gives the "case" and, as a number or a range, any of the
    "magnitude" (N/m), "direction_deg", "onset" (s), "duration" (s), "frequency_ratio" and "phase_deg".

    What is not given is still drawn from ``base``. Raises ValueError for an unknown case or key.
    """
    if not isinstance(load, Mapping) or (unknown := sorted(set(load) - set(LOAD_OPTIONS))):
        wrong = repr(load) if not isinstance(load, Mapping) else f"a dictionary with the key {unknown[0]!r}"
        raise ValueError(f"options['load'] is {wrong}, but must be a dictionary with keys among {', '.join(LOAD_OPTIONS)}.")
    changes = {name: value for name, value in load.items() if name != "case"}
    if "case" in load:
        if load["case"] not in CASES:
            raise ValueError(f"options['load']['case'] is {load['case']!r}, but must be one of {', '.join(CASES)}.")
        changes.update({case: float(case == load["case"]) for case in CASES[:-1]})
    if "magnitude" in changes:
        changes["harmonic_magnitude"] = changes["magnitude"]
    return replace(base, **changes)


def draw_load_cases(
    chosen: Scenario,
    plant: Plant,
    generators: np.random.Generator | Sequence[np.random.Generator],
    count: int,
    speeds: NDArray[np.float64] | None = None,
) -> LoadCases:
    """Load cases of ``count`` blades from one generator for all of them, or from a sequence of one for each.

    ``speeds`` (count,) in rad/s are needed where the rotor's harmonics act.
    """
    cases = _load_cases(chosen, plant, draw_uniforms(generators, count, DRAWS))
    orders = len(chosen.rotor.harmonics)
    if not orders:
        return cases
    assert speeds is not None
    return _with_harmonics(cases, chosen.rotor, draw_uniforms(generators, count, 3 * orders), speeds * plant.control_interval)


def draw_uniforms(generators: np.random.Generator | Sequence[np.random.Generator], count: int, numbers: int) -> NDArray[np.float64]:
    """Uniform numbers (count, numbers) from one generator for all blades, or from a sequence of one for each."""
    if isinstance(generators, np.random.Generator):
        return generators.random((count, numbers))
    return np.stack([generator.random(numbers) for generator in generators])


def _with_harmonics(cases: LoadCases, rotor: Rotor, uniforms: NDArray[np.float64], revolution: NDArray[np.float64]) -> LoadCases:
    share, phase, direction = np.split(uniforms, 3, axis=1)
    amplitude = np.asarray(rotor.harmonics) * (0.5 + share)
    angle = 2.0 * np.pi * direction
    vector = amplitude[..., None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    turn = 2.0 * np.pi * phase[..., None]
    return replace(cases, cosine=vector * np.cos(turn), sine=vector * np.sin(turn), revolution=revolution)


def _load_cases(chosen: Scenario, plant: Plant, uniforms: NDArray[np.float64]) -> LoadCases:
    """Load cases (N) made of uniform numbers (N, DRAWS)."""
    case = _choose(chosen, uniforms[:, 0])
    is_pulse, is_release, is_harmonic = (case == CASES.index(name) for name in ("pulse", "deflection", "harmonic"))
    magnitude = np.where(is_harmonic, *(_within(r, uniforms[:, 1]) for r in (chosen.harmonic_magnitude, chosen.magnitude)))
    magnitude[case == CASES.index("none")] = 0.0
    direction = np.radians(_within(chosen.direction_deg, uniforms[:, 2]))
    load = magnitude[:, None] * np.stack([np.cos(direction), np.sin(direction)], axis=1)
    interval = plant.control_interval
    onset = np.rint(_within(chosen.onset, uniforms[:, 3]) / interval).astype(np.int64)
    lasting = np.maximum(np.rint(_within(chosen.duration, uniforms[:, 4]) / interval), 1).astype(np.int64)
    rate = _within(chosen.frequency_ratio, uniforms[:, 5]) * plant.natural_frequencies[0] * interval
    return LoadCases(
        case=case,
        amplitude=np.where(is_release[:, None], 0.0, load),
        deflection=np.where(is_release[:, None], load, 0.0),
        onset=onset,
        end=np.where(is_pulse, onset + lasting, NEVER),
        rate=np.where(is_harmonic, rate, 0.0),
        phase=np.radians(_within(chosen.phase_deg, uniforms[:, 6])),
        cosine=np.zeros((len(case), 0, 2)),
        sine=np.zeros((len(case), 0, 2)),
        revolution=np.zeros(len(case)),
    )


def _choose(chosen: Scenario, uniform: NDArray[np.float64]) -> NDArray[np.int64]:
    """Positions in ``CASES``, each as often as its share says."""
    thresholds = np.cumsum(chosen.shares)
    thresholds[thresholds > 1.0 - 1e-9] = 1.0  # shares such as ten times 0.1 must leave nothing to "none"
    return np.searchsorted(thresholds, uniform, side="right").astype(np.int64)


def _within(limits: Range, uniform: NDArray[np.float64]) -> NDArray[np.float64]:
    return limits[0] + (limits[1] - limits[0]) * uniform
