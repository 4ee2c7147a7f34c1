"""The loads that a scenario lets foresee, as models of loads: of the sizes that it draws them in."""

from __future__ import annotations

from math import sqrt

from baselines.design.load_model import Load
from baselines.design.persistent_load import PersistentLoad
from baselines.laws.rotor_lqg import RotorHarmonics
from beamenv.plant.signals import REFERENCE_LOAD
from beamenv.scenarios.scenario import Scenario
from beamenv.scenarios.tables import Pair

LASTING = 0.25
"""s: correlation time of a load that sets in and stays, as in ``PersistentLoad``."""

LARGEST = 2.0 * REFERENCE_LOAD
"""N/m, root mean square: what the data acquisition is made for. Of larger loads its clipped readings tell too little: in `overload`
a law that is told of 353 N/m costs 1.09 of no control, and one that is told of 60 N/m 0.89."""

STEADY = 2.0
"""s: time in which a harmonic of the rotor, steady within an episode, is taken to forget its phase."""


def foreseen_loads(scenario: Scenario, speed: float, disturbances: int = 2) -> tuple[Load, ...]:
    """What lasts, turbulence and each of the rotor's harmonics at a speed in rad/s, none of those that the scenario has not.

    A step of magnitude M in any direction in a share of the episodes is √(share · mean of M² / 2) in lag and in flap, root mean
    square; a harmonic whose amplitude is drawn between half and one and a half of a, with any phase, is a √(13/48). Where load
    cases are made of other ``disturbances`` than two, their number is in the place of the 2; of none, nothing is foreseen.
    """
    loads: list[Load] = []
    if not disturbances:
        return ()
    if lasting := sqrt(scenario.step * mean_square(scenario.magnitude) / disturbances):
        loads.append(PersistentLoad(min(lasting, LARGEST), LASTING))
    if scenario.rotor.turbulence:
        loads.append(PersistentLoad(scenario.rotor.turbulence, scenario.rotor.turbulence_time))
    if speed:
        amplitudes = enumerate(scenario.rotor.harmonics, 1)
        loads += [RotorHarmonics(speed, (order,), a * sqrt(13.0 / (24.0 * disturbances)), STEADY) for order, a in amplitudes if a]
    return tuple(loads)


def mean_square(limits: Pair) -> float:
    """Of what is drawn uniformly between them."""
    low, high = limits
    return (low * low + low * high + high * high) / 3.0
