"""Load cases drawn from a scenario."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import betaincinv

from beamenv.arrays import integers, namespace
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
    uniforms: Any,
    turns: Any,
    speeds: Any = None,
) -> LoadCases:
    """Load cases of N blades made of uniform numbers (N, ``draws``), and (N, 3) more for each of the rotor's harmonics.

    ``plant`` says what loads they are made of and how large they are. ``lowest_frequency``, of one blade or of each (N,), and
    ``speeds`` (N,) are in rad/s. The numbers are of NumPy or of torch, and so are the load cases.
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


def directions(angle: Any, further: Any, plant: Plant) -> Any:
    """(…, k): 1 N/m of a scenario in a plant's disturbances, in a direction that ``angle`` (…,), rad, says: of two from the first
    towards the second, of a single one its sign.

    Of more than two load cases are as likely in any direction: ``further`` (…, l − 2) uniform numbers turn that of the first two
    towards each further one, whose share t has the density (1 − t²)^(d/2 − 1) beside d others (that of a sphere's points).
    """
    loads, array = plant.loads, namespace(angle)
    parts = [array.cos(angle), array.sin(angle)]
    if loads < 2:
        one = array.ones_like(angle)
        parts = [array.where(parts[0] < 0.0, -one, one)] * loads
    for d in range(2, 2 + further.shape[-1]):
        t = _share(further[..., d - 2], d)
        parts = [*(array.sqrt(1.0 - t**2) * part for part in parts), t]
    parts += [array.zeros_like(angle)] * (len(plant.load_scale) - len(parts))
    return array.stack([part * float(scale) for part, scale in zip(parts, plant.load_scale, strict=True)], -1)


_HALVINGS = 60


def _share(uniform: Any, others: int) -> Any:
    """T of a uniform number: where its distribution function is that.

    Torch, which has no inverse of the incomplete beta function, halves the range of θ, t = sin θ: the function is then
    ½ + ½ Sₘ(θ)/Sₘ(½π), with m one less than ``others`` and Sₘ(θ) = ∫₀^θ cosᵐ = (cosᵐ⁻¹θ sin θ + (m − 1) Sₘ₋₂)/m.
    """
    if isinstance(uniform, np.ndarray):
        return 2.0 * betaincinv(0.5 * others, 0.5 * others, uniform) - 1.0
    torch, m = namespace(uniform), others - 1

    def integral(angle: Any) -> Any:
        total = torch.sin(angle) if m % 2 else angle
        for k in range(2 + m % 2, m + 1, 2):
            total = (torch.cos(angle) ** (k - 1) * torch.sin(angle) + (k - 1) * total) / k
        return total

    high = torch.full_like(uniform, 0.5 * np.pi)
    wanted, low = (2.0 * uniform - 1.0) * integral(high), -high
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        more = integral(middle) < wanted
        low, high = torch.where(more, middle, low), torch.where(more, high, middle)
    return torch.sin(0.5 * (low + high))


def _with_harmonics(cases: LoadCases, rotor: Rotor, uniforms: Any, revolution: Any, plant: Plant) -> LoadCases:
    harmonics, array = len(rotor.harmonics), namespace(uniforms)
    share, phase, direction = (uniforms[:, k * harmonics : (k + 1) * harmonics] for k in range(3))
    amplitude = array.stack([float(size) * (0.5 + share[:, h]) for h, size in enumerate(rotor.harmonics)], -1)
    vector = amplitude[..., None] * directions(2.0 * np.pi * direction, direction[..., None][..., :0], plant)
    turn = 2.0 * np.pi * phase[..., None]
    return replace(cases, cosine=vector * array.cos(turn), sine=vector * array.sin(turn), revolution=revolution)


def _load_cases(chosen: Scenario, plant: Plant, lowest_frequency: Any, uniforms: Any) -> LoadCases:
    """Load cases (N) made of uniform numbers (N, ``draws``)."""
    array, interval = namespace(uniforms), plant.scenario_interval
    case = _choose(chosen, uniforms[:, 0])
    is_pulse, is_release, is_harmonic, is_none = (case == CASES.index(name) for name in ("pulse", "deflection", "harmonic", "none"))
    magnitude = array.where(is_harmonic, *(_within(r, uniforms[:, 1]) for r in (chosen.harmonic_magnitude, chosen.magnitude)))
    direction = array.deg2rad(_within(chosen.direction_deg, uniforms[:, 2]))
    load = array.where(is_none, 0.0, magnitude)[:, None] * directions(direction, uniforms[:, DRAWS:], plant)
    onset = whole_intervals(_within(chosen.onset, uniforms[:, 3]), interval)
    lasting = array.clip(whole_intervals(_within(chosen.duration, uniforms[:, 4]), interval), 1, None)
    with np.errstate(over="ignore"):  # of what no load case draws
        ratio = _within(chosen.frequency_ratio, uniforms[:, 5]) * lowest_frequency * plant.control_interval
    none = array.zeros_like(load)[:, None][:, :0]
    return LoadCases(
        case=case,
        amplitude=array.where(is_release[:, None], 0.0, load),
        deflection=array.where(is_release[:, None], load, 0.0),
        onset=onset,
        end=array.where(is_pulse, onset + lasting, NEVER),
        rate=array.where(is_harmonic, array.clip(ratio, None, np.pi), 0.0),
        phase=array.deg2rad(_within(chosen.phase_deg, uniforms[:, 6])),
        cosine=none,
        sine=none,
        revolution=array.zeros_like(uniforms[:, 0]),
    )


def _choose(chosen: Scenario, uniform: Any) -> Any:
    """Positions in ``CASES``, each as often as its share says."""
    thresholds = np.cumsum(chosen.shares)
    thresholds[thresholds > 1.0 - 1e-9] = 1.0  # shares such as ten times 0.1 must leave nothing to "none"
    return sum(integers(uniform >= float(threshold)) for threshold in thresholds)


def whole_intervals(time: Any, interval: float) -> Any:
    """Whole control intervals in a time (s), no more than may be added up: what sets in later never does."""
    array = namespace(time)
    with np.errstate(over="ignore"):
        return integers(array.clip(array.round(time / interval), None, float(NEVER // 4)))


def _within(limits: Pair, uniform: Any) -> Any:
    return limits[0] + (limits[1] - limits[0]) * uniform
