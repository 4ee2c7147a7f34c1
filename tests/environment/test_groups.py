"""Blades of several layouts in one batch: advanced together, and each layout's as if they were alone."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade.layouts import with_positions
from beamenv.simulation.blades import Blades
from beamenv.simulation.mixed_blades import MixedBlades
from beamenv.simulation.plants.bank import Bank
from beamenv.task import resolve_task

SIZES = (3, 3, 2, 70)
POSITIONS = ((0.1, 0.4, 0.7, 1.0), (0.1, 0.4, 0.8, 1.0), (0.2, 0.4, 0.7, 1.1), (0.2, 0.5, 0.7, 1.1))
STARTS = np.cumsum((0, *SIZES))
SCENARIOS = (
    "nominal",
    "rotor",
    {"preset": "off-speed", "plants": {"bank": 3}},
    "spin-up",
    "hysteresis",
    {"plants": {"mass_drift": 1.2, "drift_duration": 0.03, "bank": 3}},
)


@pytest.fixture(scope="module", params=SCENARIOS, ids=str)
def tasks(request):
    home = resolve_task(scenario=request.param, duration=0.08)
    blade = home.blade.with_fixed_range()
    blades = [blade.changed(with_positions(blade.config, {"actuators": each})) for each in POSITIONS]
    return [replace(home, blade=each, design_blade=each) for each in blades]


def joined(tasks):
    return Blades(Bank.joined([task.bank for task in tasks]), tasks[0].scenario, SIZES)


def apart(tasks):
    return [Blades(task.bank, task.scenario, size) for task, size in zip(tasks, SIZES, strict=True)]


def seeded():
    return [np.random.default_rng(seed) for seed in range(sum(SIZES))]


def assert_same(motion, motions):
    for name, whole, *parts in zip(motion._fields, motion, *motions, strict=True):
        np.testing.assert_allclose(whole, np.concatenate(parts), rtol=1e-9, atol=1e-12, err_msg=name)


def test_a_batch_of_several_layouts_moves_as_one_batch_of_each(tasks):
    together, each, generators, own = joined(tasks), apart(tasks), seeded(), seeded()
    shares = [own[start:stop] for start, stop in zip(STARTS[:-1], STARTS[1:], strict=True)]
    assert_same(together.begin(generators), [blades.begin(share) for blades, share in zip(each, shares, strict=True)])
    for k in range(70):
        actions = np.random.default_rng(k).uniform(-1.0, 1.0, (sum(SIZES), 4))
        held = np.split(actions, STARTS[1:-1])
        motions = [blades.step(*rest) for blades, *rest in zip(each, held, shares, strict=True)]
        assert_same(together.step(actions, generators), motions)
    for name in ("state", "design_state", "speed", "index"):
        whole, parts = getattr(together, name), [getattr(blades, name) for blades in each]
        np.testing.assert_allclose(whole, np.concatenate(parts), rtol=1e-9, atol=1e-12)
    assert not np.allclose(each[0].state, each[1].state)


def test_one_generator_serves_layout_after_layout():
    home = resolve_task()
    tasks = [home, home]
    together, each = joined([*tasks, *tasks]), apart([*tasks, *tasks])
    generator, same = np.random.default_rng(3), np.random.default_rng(3)
    assert_same(together.begin(generator), [blades.begin(same) for blades in each])
    for _ in range(5):
        assert_same(
            together.step(np.zeros((78, 4)), generator),
            [blades.step(np.zeros((n, 4)), same) for blades, n in zip(each, SIZES, strict=True)],
        )
    assert generator.bit_generator.state == same.bit_generator.state


def test_a_pickled_batch_of_several_layouts_goes_on(tasks):
    blades, generator = joined(tasks), np.random.default_rng(1)
    blades.begin(generator)
    blades.step(np.ones((78, 4)), generator)
    copied, same = pickle.loads(pickle.dumps((blades, generator)))
    for _ in range(3):
        motions = [each.step(np.ones((78, 4)), own) for each, own in ((blades, generator), (copied, same))]
        for expected, found in zip(*motions, strict=True):
            np.testing.assert_array_equal(found, expected)


def test_kinds_of_any_numbers_of_blades_come_back_in_the_order_of_the_batch(tasks):
    kind = np.array([1, 0, 3, 1, 2, 1, 0])
    mixed = MixedBlades([task.bank for task in tasks], kind, tasks[0].scenario)
    generators, own = seeded()[:7], seeded()[:7]
    alone = [Blades(tasks[k].bank, tasks[k].scenario, 1) for k in kind]
    assert_same(mixed.begin(generators), [blades.begin([each]) for blades, each in zip(alone, own, strict=True)])
    for k in range(5):
        actions = np.random.default_rng(k).uniform(-1.0, 1.0, (7, 4))
        motions = [blades.step(action[None], [each]) for blades, action, each in zip(alone, actions, own, strict=True)]
        assert_same(mixed.step(actions, generators), motions)
    np.testing.assert_allclose(mixed.state, np.concatenate([blades.state for blades in alone]), rtol=1e-9, atol=1e-12)
