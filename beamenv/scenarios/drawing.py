"""Load cases drawn from a scenario."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import betaincinv

from beamenv.plant.plant import Plant
from beamenv.scenarios.load_cases import CASES, NEVER, LoadCases
from beamenv.scenarios.scenario import Scenario
from beamenv.scenarios.tables import Pair, Rotor

DRAWS = 7
"""Uniform numbers one load case takes, whatever the case: paired seeds stay paired when a scenario is altered."""


def draws(loads: int) -> int:
    """How many one takes where it is made of so many disturbances: of more than two, one for each further one."""
    return DRAWS + max(0, loads - 2)


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
    uniforms = draw_uniforms(generators, count, draws(plant.loads))
    turns = draw_uniforms(generators, count, 3 * len(chosen.rotor.harmonics))
    return load_cases(chosen, plant, plant.natural_frequencies[0], uniforms, turns, speeds)


def load_cases(
    chosen: Scenario,
    plant: Plant,
    lowest_frequency: Any,
    uniforms: NDArray[np.float64],
    turns: NDArray[np.float64],
    speeds: NDArray[np.float64] | None = None,
) -> LoadCases:
    """Load cases of N blades made of uniform numbers (N, ``draws``), and (N, 3) more for each of the rotor's harmonics.

    ``plant`` says what loads they are made of and how large they are. ``lowest_frequency``, of one blade or of each (N,), and
    ``speeds`` (N,) are in rad/s.
    """
    cases = _load_cases(chosen, plant, lowest_frequency, uniforms)
    if not len(chosen.rotor.harmonics):
        return cases
    assert speeds is not None
    return _with_harmonics(cases, chosen.rotor, turns, speeds * plant.control_interval, plant)


def draw_uniforms(generators: np.random.Generator | Sequence[np.random.Generator], count: int, numbers: int) -> NDArray[np.float64]:
    """Uniform numbers (count, numbers) from one generator for all blades, or from a sequence of one for each."""
    if isinstance(generators, np.random.Generator):
        return generators.random((count, numbers))
    return np.stack([generator.random(numbers) for generator in generators])


def directions(angle: NDArray[np.float64], further: NDArray[np.float64], plant: Plant) -> NDArray[np.float64]:
    """(…, k): 1 N/m of a scenario in a plant's disturbances, in a direction that ``angle`` (…,), rad, says: of two from the first
    towards the second, of a single one its sign.

    Of more than two load cases are as likely in any direction: ``further`` (…, l − 2) uniform numbers turn that of the first two
    towards each further one, whose share t has the density (1 − t²)^(d/2 − 1) beside d others (that of a sphere's points).
    """
    loads = plant.loads
    parts = [np.cos(angle), np.sin(angle)] if loads > 1 else [np.where(np.cos(angle) < 0.0, -1.0, 1.0)] * loads
    for d in range(2, 2 + further.shape[-1]):
        t = 2.0 * betaincinv(0.5 * d, 0.5 * d, further[..., d - 2]) - 1.0
        parts = [*(np.sqrt(1.0 - t**2) * part for part in parts), t]
    vector = np.zeros((*angle.shape, len(plant.load_scale)))
    for k, part in enumerate(parts):
        vector[..., k] = part
    return vector * plant.load_scale


def _with_harmonics(
    cases: LoadCases, rotor: Rotor, uniforms: NDArray[np.float64], revolution: NDArray[np.float64], plant: Plant
) -> LoadCases:
    share, phase, direction = np.split(uniforms, 3, axis=1)
    amplitude = np.asarray(rotor.harmonics) * (0.5 + share)
    vector = amplitude[..., None] * directions(2.0 * np.pi * direction, np.empty((*direction.shape, 0)), plant)
    turn = 2.0 * np.pi * phase[..., None]
    return replace(cases, cosine=vector * np.cos(turn), sine=vector * np.sin(turn), revolution=revolution)


def _load_cases(chosen: Scenario, plant: Plant, lowest_frequency: Any, uniforms: NDArray[np.float64]) -> LoadCases:
    """Load cases (N) made of uniform numbers (N, ``draws``)."""
    case, interval = _choose(chosen, uniforms[:, 0]), plant.scenario_interval
    is_pulse, is_release, is_harmonic = (case == CASES.index(name) for name in ("pulse", "deflection", "harmonic"))
    magnitude = np.where(is_harmonic, *(_within(r, uniforms[:, 1]) for r in (chosen.harmonic_magnitude, chosen.magnitude)))
    magnitude[case == CASES.index("none")] = 0.0
    direction = np.radians(_within(chosen.direction_deg, uniforms[:, 2]))
    load = magnitude[:, None] * directions(direction, uniforms[:, DRAWS:], plant)
    onset = whole_intervals(_within(chosen.onset, uniforms[:, 3]), interval)
    lasting = np.maximum(whole_intervals(_within(chosen.duration, uniforms[:, 4]), interval), 1)
    with np.errstate(over="ignore"):  # of what no load case draws
        ratio = _within(chosen.frequency_ratio, uniforms[:, 5]) * lowest_frequency * plant.control_interval
    rate = np.minimum(ratio, np.pi)
    return LoadCases(
        case=case,
        amplitude=np.where(is_release[:, None], 0.0, load),
        deflection=np.where(is_release[:, None], load, 0.0),
        onset=onset,
        end=np.where(is_pulse, onset + lasting, NEVER),
        rate=np.where(is_harmonic, rate, 0.0),
        phase=np.radians(_within(chosen.phase_deg, uniforms[:, 6])),
        cosine=np.zeros((len(case), 0, load.shape[1])),
        sine=np.zeros((len(case), 0, load.shape[1])),
        revolution=np.zeros(len(case)),
    )


def _choose(chosen: Scenario, uniform: NDArray[np.float64]) -> NDArray[np.int64]:
    """Positions in ``CASES``, each as often as its share says."""
    thresholds = np.cumsum(chosen.shares)
    thresholds[thresholds > 1.0 - 1e-9] = 1.0  # shares such as ten times 0.1 must leave nothing to "none"
    return np.searchsorted(thresholds, uniform, side="right").astype(np.int64)


def whole_intervals(time: NDArray[np.float64], interval: float) -> NDArray[np.int64]:
    """Whole control intervals in a time (s), no more than may be added up: what sets in later never does."""
    with np.errstate(over="ignore"):
        return np.minimum(np.rint(time / interval), float(NEVER // 4)).astype(np.int64)


def _within(limits: Pair, uniform: NDArray[np.float64]) -> NDArray[np.float64]:
    return limits[0] + (limits[1] - limits[0]) * uniform
