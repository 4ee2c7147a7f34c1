"""Threads that build and step environments of one blade, one bank, one cache get what one thread alone gets."""

import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields

import gymnasium
import numpy as np
import pytest

from beamenv import ENV_ID, RotatingBeamEnv, VectorPlacementWrapper
from beamenv.blade.build import Blade
from beamenv.blade.presets import blade_config
from beamenv.patches.operators import actuation, sensing
from beamenv.structure.section.elements import inverse_vandermonde, lobatto_nodes
from beamenv.structure.stations import gauss_rule, remaining_integrals
from beamenv.structure.trial_functions import legendre_derivative
from beamenv.structure.walls.laminate import wall_law
from beamenv.task import resolve_task

SMALL = {"modes": 3, "beam": {"terms": 6}}
THREADS = 4
KEPT = (gauss_rule, legendre_derivative, remaining_integrals, inverse_vandermonde, lobatto_nodes, wall_law)
PARTS = ("truth", "plant", "full", "standing_strain", "true_modal", "modal", "at_rest")


@pytest.fixture(autouse=True)
def eager_to_switch():
    usual = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    yield
    sys.setswitchinterval(usual)


def together(work):
    """What each of several threads gets that begin at one instant."""
    ready = threading.Barrier(THREADS)

    def begin(k):
        ready.wait(timeout=60)
        return work(k)

    with ThreadPoolExecutor(THREADS) as threads:
        return list(threads.map(begin, range(THREADS)))


def numbers(value):
    """Every array and number within, by its path."""
    if isinstance(value, np.ndarray | float | int):
        return {"": np.asarray(value)}
    own = {each.name: getattr(value, each.name) for each in fields(value)} if hasattr(value, "__dataclass_fields__") else {}
    return {f"{name}.{rest}": array for name, part in own.items() for rest, array in numbers(part).items()}


def assert_same(found, alone):
    assert found.keys() == alone.keys() and len(found) > 0
    for name in alone:
        np.testing.assert_array_equal(found[name], alone[name], err_msg=name)


def parts_of(blade, order=PARTS):
    found = {name: numbers(getattr(blade, name)) for name in order}
    return {f"{name}.{rest}": array for name in sorted(found) for rest, array in found[name].items()}


def forget():
    for kept in KEPT:
        kept.cache_clear()


def test_a_lazily_built_blade_asked_by_threads_in_different_orders_is_the_blade_that_one_asks():
    config = blade_config(overrides=SMALL)
    alone = parts_of(Blade(config))
    forget()
    shared = Blade(config)
    for found in together(lambda k: parts_of(shared, PARTS[k:] + PARTS[:k])):
        assert_same(found, alone)


def test_blades_built_at_once_from_empty_caches_are_those_built_one_after_the_other():
    configs = [blade_config(overrides={**SMALL, "speed": 100.0 + 20.0 * k, "beam": {"terms": 5 + k}}) for k in range(THREADS)]

    def built(k):
        return parts_of(Blade(configs[k]), ("plant", "standing_strain"))

    alone = [built(k) for k in range(THREADS)]
    forget()
    for found, expected in zip(together(built), alone, strict=True):
        assert_same(found, expected)


def test_patches_of_one_beam_asked_at_once_push_and_sense_as_when_asked_one_after_the_other():
    def asked(blade):
        layout, at = blade.config.patches, blade.config.speed
        return np.concatenate([actuation(blade.beam, layout, at), sensing(blade.beam, layout, at).T])

    def fresh():
        blade = Blade(blade_config(overrides=SMALL))
        blade.beam.at(blade.config.speed)  # all but what the patches alone need
        return blade

    alone = asked(fresh())
    for _ in range(3):
        shared = fresh()
        for found in together(lambda k, shared=shared: asked(shared)):
            np.testing.assert_array_equal(found, alone)


def episode(env, seed):
    """Observations and rewards, as one array."""
    random, (observation, _) = np.random.default_rng(seed), env.reset(seed=seed)
    rows = [np.ravel(observation)]
    for _ in range(60):
        observation, reward, *_ = env.step(random.uniform(-1.2, 1.2, env.action_space.shape))
        rows.append(np.append(observation, reward))
    return np.concatenate(rows)


@pytest.mark.parametrize("scenario", ["nominal", {"preset": "off-model", "plants": {"bank": 4}}, "hysteresis"])
def test_environments_of_one_task_whose_bank_is_built_by_whoever_comes_first(scenario):
    def task():
        return resolve_task(blade=SMALL, scenario=scenario, duration=0.02)

    def run(shared, k):
        env = RotatingBeamEnv(blade=SMALL, scenario=scenario, duration=0.02)
        env.set_task(shared)
        return episode(env, k)

    own = task()
    alone, shared = [run(own, k) for k in range(THREADS)], task()
    np.testing.assert_array_equal(together(lambda k: run(shared, k)), alone)
    assert not np.array_equal(alone[0], alone[1])


@pytest.mark.parametrize("mode", ["SameStep", "NextStep"])
def test_batches_made_and_stepped_in_threads_are_as_one_after_the_other(mode):
    def run(k):
        scenario = {"preset": "off-speed", "plants": {"bank": 3}}
        envs = gymnasium.make_vec(ENV_ID, num_envs=6, blade=SMALL, scenario=scenario, duration=0.01, autoreset_mode=mode)
        return episode(envs, k)

    np.testing.assert_array_equal(together(run), [run(k) for k in range(THREADS)])


def test_layouts_drawn_in_threads_are_as_one_after_the_other():
    def run(k):
        envs = gymnasium.make_vec(ENV_ID, num_envs=2, blade=SMALL, duration=0.01)
        return episode(VectorPlacementWrapper(envs, actuators={"low": 0.1}, bank=2), k)

    np.testing.assert_array_equal(together(run), [run(k) for k in range(THREADS)])
