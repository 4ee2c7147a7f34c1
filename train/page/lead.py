"""What a reader is told before anything else, in three sentences: what came out, of what, and how it was made."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import date

import beamenv
from beamenv.blade.build import Blade
from beamenv.blade.model_blade import ModelBlade
from beamenv.scenarios.scenario import Scenario
from beamenv.scenarios.tables import Rotor
from train.shared.command import command_line

COST = "J (vibration energy plus actuator energy, integrated over time; lower is better)"
"""The cost, where it is named for the first time."""


def _today() -> str:
    now = date.today()
    return f"{now.day} {now:%B %Y}"


@dataclass(frozen=True, slots=True)
class Lead:
    """Three sentences; the third is made of when and how."""

    result: str
    """With J."""
    subject: str
    """The blade and its load."""
    date: str = field(default_factory=_today)
    command: str = field(default_factory=command_line)
    """As it was typed; empty where there was none."""
    version: str = beamenv.__version__


def blade_in_words(blade: Blade) -> str:
    """Length, speed, actuators and sensors."""
    truth = blade.truth
    ports = f"{counted(truth.B.shape[1], 'actuator')} and {counted(len(truth.C), 'sensor')}"
    if isinstance(blade, ModelBlade):
        return f"a model with {counted(len(truth.A), 'state')}, {ports}"
    turns = f"turns at {blade.config.speed:g} rad/s" if blade.config.speed else "does not turn"
    return f"a blade of {blade.config.beam.length:g} m that {turns}, with {ports}"


def load_in_words(scenario: Scenario) -> str:
    """What acts in an episode."""
    shares = {"steps": scenario.step, "pulses": scenario.pulse, "releases from a deflection": scenario.deflection}
    shares["harmonic loads"] = scenario.harmonic
    kinds = [name for name, each in shares.items() if each]
    if scenario.rotor != Rotor():
        kinds.append("the rotor's own loads")
    if scenario.loads:
        kinds.append("loads of one's own")
    if scenario.white_load:
        kinds.append("white noise")
    return f"{', '.join(kinds[:-1])} and {kinds[-1]}" if len(kinds) > 1 else "".join(kinds) or "nothing"


def counted(count: int, what: str) -> str:
    """Say, 1 sensor, 4 sensors."""
    return f"{count} {what}{'' if count == 1 else 's'}"
