"""Scenarios: from what the load case of an episode is drawn, which noises are on, and what is wrong with the blade.

Those with a name are files in ``scenarios/named``: a TOML file put there is a scenario, and an environment id, of its name.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import asdict, field, replace
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any

from beamenv.configuration import (
    Choice,
    Flag,
    Items,
    Range,
    Refused,
    Share,
    checked,
    checked_table,
    configuration,
    read,
    unknown_name,
)
from beamenv.configuration.files import ENDINGS, of_file, parsed_table, read_table
from beamenv.configuration.numbers import TURNED
from beamenv.plant.named import ENDING
from beamenv.scenarios import named
from beamenv.scenarios.load_cases import CASES
from beamenv.scenarios.named import FORMER, NAMES, NOMINAL
from beamenv.scenarios.own_loads import Load
from beamenv.scenarios.series import ENDING as SERIES
from beamenv.scenarios.tables import STRONGEST, Acquisition, Drive, Failures, Pair, PlantVariation, Rotor

Loads = Annotated[Pair, Range(0.0, STRONGEST, unit="N/m")]
Seconds = Annotated[Pair, Range(0.0, unit="s")]
Degrees = Annotated[Pair, Range(-TURNED, TURNED, unit="degrees")]

USUAL_RATIO: Pair = (0.5, 2.0)

PRESET = "preset"
"""The key under which a dictionary or file names the scenario that it departs from."""


@configuration("scenario")
class Scenario:
    """What may happen to a blade in an episode. Every range is [low, high], drawn uniformly; equal ends fix the value.

    The default is made for the default blade. Under ±1500 V its patches hold a static line load of about 7 N/m in flap, so at
    30 N/m they are neither idle nor helpless: LQG saturates now and then, and halves the time to settle. For a blade of
    another size choose other magnitudes.
    """

    step: Share = 0.25
    """Share of episodes with a load that sets in and stays."""
    pulse: Share = 0.25
    """Share of episodes with a rectangular pulse."""
    deflection: Share = 0.25
    """Share of episodes that start from rest in a static deflection, released at t = 0."""
    harmonic: Share = 0.25
    """Share of episodes with a sinusoidal load. What the four shares leave of 1 has no load case."""
    magnitude: Loads = (15.0, 45.0)
    """N/m, of step, pulse and deflection: 30 N/m on average."""
    harmonic_magnitude: Loads = (1.5, 4.5)
    """N/m: a tenth of the others, within what the patches can hold, for in an episode resonance multiplies it some 30 times."""
    direction_deg: Degrees = (0.0, 360.0)
    """Degrees from lag towards flap: any direction, for the pretwisted blade couples both."""
    onset: Seconds = (0.0, 0.05)
    """s: a controller cannot count on t = 0, and at least 90 % of a 0.5 s episode is left to damp what follows."""
    duration: Seconds = (0.005, 0.05)
    """s, of a pulse: from a knock much shorter than the first two modes' periods, 35 and 28 ms, to a push longer than both."""
    frequency_ratio: Annotated[Pair, Range(0.0)] = USUAL_RATIO
    """Frequency of a harmonic load over the plant's first natural frequency: below, in and above resonance. Loads are held
    over each control interval: none may oscillate faster than the Nyquist frequency (``beamenv.scenarios.sampling``)."""
    phase_deg: Degrees = (0.0, 360.0)
    """Degrees, of a harmonic load."""
    white_load: Annotated[bool, Flag()] = True
    """Whether the plant's white line loads act."""
    sensor_noise: Annotated[bool, Flag()] = True
    """Whether the plant's sensor noise is added to each reading."""
    plants: PlantVariation = field(default_factory=PlantVariation)
    """How the true plant differs from the design's."""
    drive: Drive = field(default_factory=Drive)
    acquisition: Acquisition = field(default_factory=Acquisition)
    failures: Failures = field(default_factory=Failures)
    rotor: Rotor = field(default_factory=Rotor)
    loads: Annotated[tuple[Load, ...], Items(Load)] = ()
    """Loads of one's own, all of them in every episode."""

    def __post_init__(self) -> None:
        if sum(self.shares) > 1.0 + 1e-9:
            raise Refused("shares", self.shares, f"shares of {', '.join(CASES[:-1])} that do not add up to more than 1")

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
    if callable(value):  # which JSON cannot hold
        return getattr(value, "__qualname__", repr(value))
    return [_with_lists(each) for each in value] if isinstance(value, tuple) else value


_ALONE = dict.fromkeys(CASES[:-1], 0.0)
_SCENARIOS: dict[str, Scenario] = {
    NOMINAL: Scenario(),
    **{case: Scenario(**{**_ALONE, case: 1.0}) for case in CASES[:-1]},  # type: ignore[arg-type]
    "white": Scenario(**_ALONE),  # type: ignore[arg-type]
    "quiet": Scenario(**_ALONE, white_load=False, sensor_noise=False),  # type: ignore[arg-type]
}
SCENARIOS: Mapping[str, Scenario] = MappingProxyType(_SCENARIOS)
"""Named scenarios: ``beamenv.scenarios.named.titles`` says what each is. "nominal" is that of every default."""


def scenario(given: Scenario | Mapping[str, Any] | str | os.PathLike[str] | None = None) -> Scenario:
    """The scenario meant by a name in ``SCENARIOS``, a TOML or JSON file, a dictionary of fields or itself; None: "nominal".

    A dictionary or file may name the scenario it departs from under the key "preset". Raises ValueError for an unknown name
    or field and for a value out of range.
    """
    if given is None:
        return SCENARIOS[NOMINAL]
    if isinstance(given, os.PathLike) or (isinstance(given, str) and given.lower().endswith(ENDINGS)):
        return load_scenario(given)
    if isinstance(given, (str, Scenario)):
        return _named(given) if isinstance(given, str) else given
    if not isinstance(given, Mapping):
        raise Refused("scenario", given, "a name, a .toml or .json file, a dictionary of fields or a Scenario")
    base = _named(given[PRESET], f"scenario.{PRESET}") if PRESET in given else SCENARIOS[NOMINAL]
    return read(base, {name: value for name, value in given.items() if name != PRESET})


def load_scenario(path: str | os.PathLike[str]) -> Scenario:
    """The scenario in a TOML or JSON file; ``ValueError`` names the file and what is wrong in it."""
    content = read_table(path)
    with of_file(path):
        return scenario(_beside(Path(path), content))


def _beside(path: Path, content: dict[str, Any]) -> dict[str, Any]:
    """The content of a file with the plant file that it names taken to lie where it does itself."""
    content = _series_beside(path, content)
    plants = content.get("plants")
    truth = plants.get("truth") if isinstance(plants, dict) else None
    if plants is None or not isinstance(truth, str) or not truth.lower().endswith(ENDING):
        return content
    return {**content, "plants": {**plants, "truth": str(path.parent / truth)}}


def _series_beside(path: Path, content: dict[str, Any]) -> dict[str, Any]:
    loads = content.get("loads")
    if not isinstance(loads, list):
        return content
    return {**content, "loads": [_beside_file(path, each) for each in loads]}


def _beside_file(path: Path, load: Any) -> Any:
    series = load.get("series") if isinstance(load, dict) else None
    if not isinstance(series, str) or not series.lower().endswith(SERIES):
        return load
    return {**load, "series": str(path.parent / series)}


def scenario_schema() -> dict[str, Any]:
    """The JSON schema of a scenario's files."""
    from beamenv.configuration.schema import json_schema

    return json_schema(Scenario, {PRESET: {"enum": list(SCENARIOS), "description": "The scenario this one departs from."}})


def _named(name: Any, path: str = "scenario") -> Scenario:
    name = FORMER.get(name, name) if isinstance(name, str) else name
    if not isinstance(name, str) or name not in SCENARIOS:
        others = ", a .toml or .json file, or a dictionary of fields" if path == "scenario" else ""
        raise unknown_name(path, name, SCENARIOS, others)
    return SCENARIOS[name]


def _read_in(name: str, unread: dict[str, dict[str, Any]]) -> None:
    """Put a file's scenario among those with names, and before it the one that it departs from."""
    content = unread.pop(name)
    if (base := content.get(PRESET)) in unread:
        _read_in(base, unread)
    _SCENARIOS[name] = scenario(content)


_UNREAD = {name: parsed_table(files(named).joinpath(f"{name}.toml").read_text(encoding="utf-8"), f"{name}.toml") for name in NAMES}
while _UNREAD:
    _read_in(next(iter(_UNREAD)), _UNREAD)


LOAD_OPTIONS = ("case", "magnitude", "direction_deg", "onset", "duration", "frequency_ratio", "phase_deg")


def with_load(base: Scenario, load: Mapping[str, Any]) -> Scenario:
    """The scenario with its load case fixed: ``load`` gives the "case" and, as a number or a range, any of the
    "magnitude" (N/m), "direction_deg", "onset" (s), "duration" (s), "frequency_ratio" and "phase_deg".

    What is not given is still drawn from ``base``. Raises ValueError for an unknown case or key.
    """
    changes = checked_table("options.load", load, LOAD_OPTIONS)
    if "case" in changes:
        chosen = checked("options.load.case", changes.pop("case"), Choice(CASES))
        changes.update({case: float(case == chosen) for case in CASES[:-1]})
    changed = read(base, changes, "options.load")
    return replace(changed, harmonic_magnitude=changed.magnitude) if "magnitude" in changes else changed
