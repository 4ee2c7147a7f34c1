"""What may be the case in a scenario, as hypotheses of a multiple-model law: by one rule from what tier 1 is told."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import cycle, islice, product

import numpy as np
from numpy.typing import NDArray

from baselines import Hypothesis
from baselines.laws.foreseen_load import foreseen_loads, mean_square
from beamenv.blade.model_blade import ModelBlade
from beamenv.knowledge import Prior
from beamenv.plant.plant import Plant
from beamenv.scenarios.scenario import Scenario
from beamenv.scenarios.tables import Failures, PlantVariation
from beamenv.simulation.plants.banks import varied_blades

Array = NDArray[np.float64]

PLANTS = 32
"""Of what varies: a Latin hypercube with the seed of the training bank."""

SPEEDS = 13
"""Of a spin-up."""

SOONER = 1e-6
"""How likely what breaks within the episode is broken already at its start."""

MOST = 64
"""Hypotheses: of more, as many are drawn as episodes draw them."""

BETWEEN = 9.0
"""The price on quick changes, over the reference's, where most of what happens lies between hypotheses: in `unknown-everything` it
lowers J over no control's by 0.035 ± 0.020, where the bank holds all that may be it adds 0.002 (32 validation seeds)."""


@dataclass(frozen=True, slots=True, eq=False)
class Fault:
    """Actuators and sensors that are broken together, and the share of episodes in which they are."""

    actuator_gain: Array
    sensor_gain: Array
    sensor_bias: Array
    share: float


def hypotheses_of(prior: Prior, plants: int | None = None) -> list[Hypothesis]:
    """Every plant, delay and fault that a scenario may draw, with every other; from more than ``MOST``, so many drawn ones.

    Of what varies there are so many ``plants``; None: ``PLANTS``, or ``SPEEDS`` of a spin-up. Where faults set in within the
    episode the first hypothesis is that there is none. Hysteresis is left to the fallback.
    """
    scenario, faults = prior.scenario, _faults_of(prior)
    if are_drawn(prior, plants):
        return _drawn(prior, plants or MOST)
    known = _plants(prior, _how_many_plants(prior, plants))
    return [_hypothesis(scenario, *each, delay, fault) for each, delay, fault in product(known, _delays(scenario), faults)]


def are_drawn(prior: Prior, plants: int | None = None) -> bool:
    """Whether there is more that may be the case than hypotheses: most of what happens lies between them then."""
    number = _how_many_plants(prior, plants)
    return len(_delays(prior.scenario)) * len(_faults_of(prior)) * number > MOST


def varies(prior: Prior) -> bool:
    """Whether there are other plants than the blade's own."""
    return _drawn_plants(prior) or prior.scenario.plants.spin_up is not None


def _drawn_plants(prior: Prior) -> bool:
    return prior.blade.varies if isinstance(prior.blade, ModelBlade) else prior.scenario.plants.varies


def switches(prior: Prior, hypotheses: Sequence[Hypothesis]) -> Array | None:
    """Markov matrix (H, H) of faults that set in within the episode; None where all are there from the start.

    From none to each by its share, once in the mean time until they set in; what is broken stays broken.
    """
    failures = prior.scenario.failures
    if failures.onset == (0.0, 0.0) or len(hypotheses) == 1:
        return None
    interval, shares = hypotheses[0].plant.control_interval, np.array([each.prior for each in hypotheses[1:]])
    breaks = interval / max(float(np.mean(failures.onset)), 2.0 * interval)
    matrix = np.eye(len(hypotheses))
    matrix[0, 0], matrix[0, 1:] = 1.0 - breaks, breaks * shares / shares.sum()
    return matrix


def _hypothesis(scenario: Scenario, plant: Plant, speed: float, delay: int, fault: Fault) -> Hypothesis:
    return Hypothesis(
        plant,
        delay=delay,
        actuator_gain=fault.actuator_gain,
        sensor_gain=fault.sensor_gain,
        sensor_bias=fault.sensor_bias,
        load=foreseen_loads(scenario, speed, plant.loads),
        deflection=float(np.sqrt(scenario.deflection * mean_square(scenario.magnitude) / max(plant.loads, 1))),
        holds_lost_readings=scenario.acquisition.dropout > 0.0,
        prior=fault.share,
    )


def _delays(scenario: Scenario) -> range:
    return range(scenario.drive.delay[0], scenario.drive.delay[1] + 1)


def _how_many_plants(prior: Prior, wanted: int | None) -> int:
    usual = PLANTS if _drawn_plants(prior) else SPEEDS if prior.scenario.plants.spin_up is not None else 1
    return min(wanted or usual, usual)


def _plants(prior: Prior, count: int) -> list[tuple[Plant, float]]:
    """Each with the rotor's speed, rad/s."""
    plants, blade = prior.scenario.plants, prior.blade
    if isinstance(blade, ModelBlade):
        those = blade.varied(count, plants.seed)[:count] if blade.varies else [blade.truth]
        return [(each, 0.0) for each in those]
    if plants.varies:
        blades = list(varied_blades(blade, replace(plants, bank=count)))
    elif plants.spin_up is None:
        blades = [blade]
    else:
        of = blade.with_fixed_range().with_fixed_order()
        blades = [of.changed(replace(of.config, speed=float(speed))) for speed in np.linspace(*plants.spin_up, count)]
    return [(each.truth, each.config.speed) for each in blades]


def _faults_of(prior: Prior) -> list[Fault]:
    return _faults(prior.scenario.failures, prior.blade.truth.B.shape[1], len(prior.blade.truth.C))


def _faults(failures: Failures, m: int, p: int) -> list[Fault]:
    """Each that may be drawn: neighbours in a ring, as ``draw_faults`` has them."""
    sound = Fault(np.ones(m), np.ones(p), np.zeros(p), 1.0)
    weak = float(np.mean(failures.remaining))
    actuators = [
        replace(sound, actuator_gain=1.0 - (1.0 - weak) * ring, share=1.0 / m) for ring in _rings(failures.dead_actuators, m)
    ]
    bias = float(np.sqrt(mean_square(failures.bias)))
    sensors = [
        replace(sound, sensor_gain=1.0 - dead * ring, sensor_bias=(1 - dead) * bias * ring, share=share / p)
        for ring in _rings(failures.faulty_sensors, p)
        for dead, share in ((1, 1.0 - failures.biased_share), (0, failures.biased_share))
        if share > 0.0
    ]
    later = failures.onset != (0.0, 0.0)
    if failures.either:
        broken = [*actuators, *sensors]
    else:
        pairs = list(product([sound] * later + (actuators or [sound]), [sound] * later + (sensors or [sound])))[later:]
        broken = [replace(sensor, actuator_gain=each.actuator_gain, share=each.share * sensor.share) for each, sensor in pairs]
    return [sound, *(replace(each, share=SOONER * each.share) for each in broken)] if later else broken


def _rings(count: int, among: int) -> list[Array]:
    """1 for ``count`` neighbours in a ring, from each of them on."""
    places = np.arange(among)
    return [((places - first) % among < count).astype(float) for first in range(among)] if count else []


def _drawn(prior: Prior, count: int) -> list[Hypothesis]:
    """Faults of the first episodes of tuning, each with a plant of a Latin hypercube of as many."""
    scenario = prior.scenario
    faults = replace(prior, scenario=replace(scenario, plants=PlantVariation())).hypotheses(count).faults
    plants = _plants(prior, count) if _drawn_plants(prior) else [(prior.blade.truth, prior.blade.config.speed)]
    varied = islice(cycle(plants), count)
    each = zip(faults.delay, faults.actuator_gain, faults.sensor_gain, np.abs(faults.sensor_bias), strict=True)
    return [
        _hypothesis(scenario, *plant, int(delay), Fault(actuators, sensors, bias, 1.0))
        for plant, (delay, actuators, sensors, bias) in zip(varied, each, strict=True)
    ]
