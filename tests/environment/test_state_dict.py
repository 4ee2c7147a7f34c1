"""What moves is saved and put back: a batch goes on bit for bit."""

import numpy as np
import pytest

from beamenv.simulation.blades import Blades
from beamenv.simulation.mixed_blades import MixedBlades
from beamenv.task import resolve_task

SCENARIOS = [
    "nominal",
    "delay",
    "failure",
    {"preset": "mid-failure", "failures": {"onset": [0.0, 0.05]}},
    "hysteresis",
    "rotor",
    {"acquisition": {"dropout": 0.2}, "rotor": {"turbulence": 5.0}},
    {"plants": {"spin_up": [100.0, 150.0]}},
    {"plants": {"speed_ratio": [0.7, 1.3], "bank": 3}},
    {"plants": {"speed_wander": 0.05, "wander_frequency": 20.0, "bank": 8}},
]
IDS = [
    *SCENARIOS[:3],
    "failure on the way",
    *SCENARIOS[4:6],
    "dropout and turbulence",
    "spin-up",
    "drawn plants",
    "wandering speed",
]


def batch_of(scenario, count):
    task = resolve_task(scenario=scenario, duration=0.06)
    return Blades(task.bank, task.scenario, count)


def generators_of(shared, count, seed):
    return np.random.default_rng(seed) if shared else [np.random.default_rng([seed, row]) for row in range(count or 1)]


def states(generators):
    return [each.bit_generator.state for each in (generators if isinstance(generators, list) else [generators])]


def put_back(generators, saved):
    for each, state in zip(generators if isinstance(generators, list) else [generators], saved, strict=True):
        each.bit_generator.state = state


def motions(blades, generators, count, steps):
    """Every number of the motion, with an episode of the second blade that begins on the way."""
    drawn = np.random.default_rng(0)
    for step in range(steps):
        if step == 30 and count:
            yield from blades.begin(generators, np.array([1]))
        yield from blades.step(drawn.uniform(-1.0, 1.0, (count, 4) if count else 4), generators)


@pytest.mark.parametrize("count", [None, 3], ids=["alone", "three"])
@pytest.mark.parametrize("shared", [True, False], ids=["one generator", "a generator each"])
@pytest.mark.parametrize("scenario", SCENARIOS, ids=IDS)
def test_an_equal_batch_goes_on_bit_for_bit_from_a_state(scenario, shared, count):
    first, second = batch_of(scenario, count), batch_of(scenario, count)
    own, other = generators_of(shared, count, 1), generators_of(shared, count, 2)
    first.begin(own)
    second.begin(other)
    for _ in motions(first, own, count, 33):
        pass
    saved, drawn = first.state_dict(), states(own)
    expected = [np.array(each) for each in motions(first, own, count, 70)]
    second.load_state_dict(saved)
    put_back(other, drawn)
    for each, found in zip(expected, motions(second, other, count, 70), strict=True):
        np.testing.assert_array_equal(found, each)


def test_a_state_does_not_move_with_its_blades():
    blades, generator = batch_of("failure", 3), np.random.default_rng(0)
    blades.begin(generator)
    saved = blades.state_dict()
    before = saved["joined"].copy(), saved["electronics"]["memory"]["commands"].copy()
    blades.step(np.ones((3, 4)), generator)
    np.testing.assert_array_equal(saved["joined"], before[0])
    np.testing.assert_array_equal(saved["electronics"]["memory"]["commands"], before[1])
    assert not np.array_equal(blades.state_dict()["joined"], before[0])


def test_a_batch_of_several_plants_goes_on_too():
    tasks = [resolve_task(preset, duration=0.06) for preset in ("thesis", "thesis-untwisted")]
    batches = [MixedBlades([task.bank for task in tasks], np.array([0, 1, 0]), tasks[0].scenario) for _ in range(2)]
    generators = [np.random.default_rng(seed) for seed in (1, 2)]
    for batch, generator in zip(batches, generators, strict=True):
        batch.begin(generator)
    list(motions(batches[0], generators[0], 3, 33))
    batches[1].load_state_dict(batches[0].state_dict())
    put_back(generators[1], states(generators[0]))
    for each, found in zip(*(motions(*pair, 3, 40) for pair in zip(batches, generators, strict=True)), strict=True):
        np.testing.assert_array_equal(found, each)


def test_before_the_first_episode_there_is_no_state():
    with pytest.raises(ValueError, match="call reset first"):
        batch_of("nominal", 2).state_dict()
