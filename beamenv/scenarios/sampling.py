"""Which loads can act on a blade whose loads are held over each control interval: none that oscillates faster than half its rate.

A faster one would show as a slower one, another load than was asked for. It is refused; of the range that a scenario has unless it
says otherwise, made for the default blade's clock, what lies beyond is drawn at the Nyquist frequency.
"""

from __future__ import annotations

import numpy as np

from beamenv.configuration import Refused
from beamenv.scenarios.scenario import USUAL_RATIO, Scenario

SLACK = 1.0 + 1e-9


def check_frequencies(chosen: Scenario, interval: float, lowest_frequency: float, speed: float, path: str = "scenario") -> None:
    """``ValueError`` for a harmonic load or a harmonic of the rotor beyond the Nyquist frequency.

    ``interval`` in s; the plant's lowest natural frequency and the rotor's largest configured speed in rad/s.
    """
    nyquist = np.pi / interval
    highest = nyquist / lowest_frequency
    if chosen.harmonic and chosen.frequency_ratio != USUAL_RATIO and chosen.frequency_ratio[1] > highest * SLACK:
        allowed = f"at most {highest:.6g}, the Nyquist frequency of the control interval over the first natural frequency"
        raise Refused(f"{path}.frequency_ratio", list(chosen.frequency_ratio), allowed)
    amplitudes = chosen.rotor.harmonics
    last = max((k for k, amplitude in enumerate(amplitudes, 1) if amplitude), default=0)
    if last * speed > nyquist * SLACK:
        allowed = f"amplitudes of the first {int(nyquist / speed)} at most, at {speed:g} rad/s below the Nyquist frequency"
        raise Refused("scenario.rotor.harmonics", list(amplitudes), allowed)


def largest_speed(chosen: Scenario, speed: float) -> float:
    """rad/s: the largest that a rotor of a configured speed reaches in a scenario."""
    plants = chosen.plants
    return speed * plants.speed_ratio[1] if plants.spin_up is None else max(plants.spin_up)
