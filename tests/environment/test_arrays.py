"""One simulation on arrays of NumPy and of torch, of 64 and of 32 bits: equal noise gives equal episodes, in every scenario."""

import gymnasium
import numpy as np
import pytest
from scipy import stats

import beamenv
from beamenv.arrays import Arrays
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.simulation.blades import Blades
from beamenv.simulation.memory import product_in_parts
from beamenv.simulation.signals.normals import Normals
from beamenv.task import resolve_task

BLADE = {"modes": 4, "beam": {"terms": 8}}
STEPS, COUNT = 60, 12
OWN = {
    "loads": [
        {"course": "pulse", "magnitude": 20.0, "onset": 0.01},
        {"course": "noise", "magnitude": [5.0, 9.0]},
        {"course": "harmonic", "frequency": [10.0, 20.0], "magnitude": 3.0},
    ]
}
KINDS = {
    "torch, 64 bits": (Arrays("float64", "cpu"), 1e-10),
    "torch, 32 bits": (Arrays("float32", "cpu"), 1e-4),
    "NumPy, 32 bits": (Arrays("float32"), 1e-4),
}


def scenario_of(name):
    if name == "own loads":
        return OWN
    bank = SCENARIOS[name].plants.bank
    return {"preset": name, "plants": {"bank": 16}} if bank > 16 else name


def task_of(name, **changes):
    return resolve_task(blade=BLADE, scenario=scenario_of(name), duration=0.5, **changes)


def generators_of(kind):
    return np.random.default_rng(5) if kind == "one generator" else [np.random.default_rng(k) for k in range(COUNT)]


def episode(task, arrays, kind, steps=STEPS):
    """Every field of the motion at every instant, with episodes of some blades begun again on the way, and what is told of them."""
    blades, generators, random = (
        Blades(task.bank, task.scenario, COUNT, arrays=arrays),
        generators_of(kind),
        np.random.default_rng(1),
    )
    motions = [blades.begin(generators)]
    for k in range(steps):
        if k in (20, 21):
            again = np.arange(k - 18, COUNT, 3)
            motions.append(blades.begin(generators, arrays.exact(again)))
        motions.append(blades.step(arrays.floats(random.uniform(-1.2, 1.2, (COUNT, 4))), generators))
    told = blades.state, blades.truth, blades.speed, blades.coming_loads
    return [[np.asarray(field, dtype=np.float64) for field in motion] for motion in motions] + [[np.asarray(each) for each in told]]


def assert_agree(found, reference, share):
    """Each field within a share of what is largest of it in the whole episode."""
    for name, (ours, theirs) in enumerate(zip(_fields(found), _fields(reference), strict=True)):
        largest = max(np.abs(each).max() for each in theirs)
        for mine, other in zip(ours, theirs, strict=True):
            np.testing.assert_allclose(mine, other, rtol=0.0, atol=share * largest, err_msg=str(name))


def _fields(motions):
    *steps, told = motions
    return [*zip(*steps, strict=True), *([each] for each in told)]


@pytest.mark.parametrize("kind", ["one generator", "one for each blade"])
@pytest.mark.parametrize("name", [*SCENARIOS, "own loads"])
def test_equal_noise_gives_equal_episodes_whatever_the_arrays(name, kind):
    task = task_of(name)
    reference = episode(task, Arrays(), kind)
    assert max(np.abs(motion[5]).max() for motion in reference[:-1]) > 0.0 or name == "quiet"
    for arrays, share in KINDS.values():
        if arrays.of_numpy and arrays.precision == "float32" and kind == "one generator":
            continue  # drawn with 32 bits: other noise
        assert_agree(episode(task, arrays, kind), reference, share)


@pytest.mark.parametrize("physical_units", [False, True])
def test_a_batch_of_32_bits_meets_the_episodes_of_its_seeds_within_rounding(physical_units):
    pair = [
        gymnasium.make_vec(beamenv.ENV_ID, COUNT, dtype=dtype, blade=BLADE, duration=0.2, physical_units=physical_units)
        for dtype in ("float32", "float64")
    ]
    random, size = np.random.default_rng(0), 1500.0 if physical_units else 1.0
    met = [[envs.reset(seed=list(range(COUNT)))[0]] for envs in pair]
    for _ in range(200):
        actions = random.uniform(-0.3, 0.3, (COUNT, 4)) * size
        for envs, own in zip(pair, met, strict=True):
            observation, reward, *_, info = envs.step(actions.astype(envs.action_space.dtype))
            own += [observation, reward, *(info[name] for name in ("energy", "effort", "cost_increment", "tip_displacement"))]
            assert observation in envs.observation_space
            assert reward.dtype == observation.dtype == envs.observation_space.dtype
    fields = [[own[first::6] for first in range(1, 7)] for own in met]
    for single, double in zip(*fields, strict=True):
        assert np.abs(np.array(single) - double).max() <= 1e-4 * np.abs(double).max()


def test_normals_of_32_bits_are_standard_normal_and_independent():
    normals, generator = Normals(np.empty((13, 5, 255), np.float32)), np.random.default_rng(0)
    draws = []
    for _ in range(40):
        normals.draw(generator)
        draws.append(normals.out.astype(float).ravel())
    values = np.concatenate(draws)
    assert stats.kstest(values, "norm").pvalue > 0.01
    assert abs(stats.kurtosis(values)) < 4.0 * np.sqrt(24.0 / len(values))
    assert np.abs(values).max() < 5.8
    half = -(-len(draws[0]) // 2)  # the two that are made of the same pair
    pairs = np.concatenate([np.stack([draw[: len(draw) - half], draw[half:]]) for draw in draws], axis=1)
    for power in (1, 2):
        assert abs(np.corrcoef(pairs**power)[0, 1]) < 4.0 / np.sqrt(pairs.shape[1])


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("size", [37, 250, 256])
def test_products_in_parts_are_those_of_the_whole(size, dtype):
    random = np.random.default_rng(0)
    rows, matrix = random.normal(size=(3, 60, size)).astype(dtype).swapaxes(-1, -2), random.normal(size=(60, 66)).astype(dtype)
    out = np.empty((3, 66, size), dtype).swapaxes(-1, -2)
    assert product_in_parts(rows, matrix, out) is out
    np.testing.assert_allclose(out, rows @ matrix, rtol=0.0, atol=1e-4 if dtype == "float32" else 1e-13)
