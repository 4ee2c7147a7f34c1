"""Blades on a GPU: the processor's episodes of equal seeds, and steps that never wait. Where there is no GPU nothing is tested."""

import copy

import numpy as np
import pytest

import beamenv
from beamenv.arrays import Arrays
from beamenv.simulation.strain_limit import safe_energy, strained_too_much
from tests.environment.test_captured import SCENARIOS

torch = pytest.importorskip("torch")

pytestmark = [
    pytest.mark.skipif(not torch.cuda.is_available(), reason="torch finds no GPU"),
    pytest.mark.filterwarnings("ignore::DeprecationWarning:torch.*"),
]

COUNT = 7
SHARES = {"float64": 1e-10, "float32": 1e-4}


def batch(device="cuda", **arguments):
    return beamenv.torch_vec(COUNT, device, **{"duration": 0.02, "autoreset_mode": "SameStep", **arguments})


def acting(steps):
    random = np.random.default_rng(1)
    return [torch.tensor(random.uniform(-0.2, 0.2, (COUNT, 4))) for _ in range(steps)]


@pytest.mark.parametrize("dtype", SHARES)
@pytest.mark.parametrize("name", SCENARIOS)
def test_a_seed_for_each_blade_gives_the_episodes_of_the_processor(name, dtype):
    there, here = (batch(device, scenario=SCENARIOS[name], dtype=dtype) for device in ("cuda", "cpu"))
    first = [envs.reset(seed=list(range(50, 50 + COUNT)))[0] for envs in (there, here)]
    assert first[0].device.type == "cuda"
    largest = [0.0] * 5
    for actions in acting(100):
        told, expected = there.step(actions.to("cuda")), here.step(actions)
        pairs = zip((*told[:4], there.state), (*expected[:4], here.state), strict=True)
        for k, (ours, theirs) in enumerate(pairs):
            theirs = theirs.double()
            largest[k] = max(largest[k], theirs.abs().max().item())
            assert (ours.cpu().double() - theirs).abs().max().item() <= 2.0 * SHARES[dtype] * largest[k], k


@pytest.mark.parametrize("recording", ["graph", "compiled", "both"])
@pytest.mark.parametrize("name", SCENARIOS)
def test_a_recorded_step_is_the_plain_one(name, recording):
    how = {which: recording in (which, "both") for which in ("graph", "compiled")}
    plain, recorded = (batch(scenario=SCENARIOS[name], dtype="float64", **more) for more in ({}, how))
    for seed in (4, 5):
        observations = [envs.reset(seed=seed, options={"elapsed": np.arange(COUNT)})[0] for envs in (plain, recorded)]
        assert torch.equal(*observations)
        for actions in acting(60):
            (*told, info), (*expected, other) = (envs.step(actions.to("cuda")) for envs in (recorded, plain))
            assert info.keys() == other.keys()
            for ours, theirs in zip((*told, recorded.state), (*expected, plain.state), strict=True):
                torch.testing.assert_close(ours, theirs, rtol=1e-11, atol=1e-11)
    kept, actions = recorded.state_dict(), acting(1)[0].to("cuda")
    first = recorded.step(actions)[0]
    recorded.load_state_dict(kept)
    assert torch.equal(recorded.step(actions)[0], first)


@pytest.mark.parametrize("name", ["nominal", "hysteresis", "wandering speed"])
def test_a_compiled_step_of_32_bits_is_the_plain_one(name):
    plain, compiled = (batch(scenario=SCENARIOS[name], compiled=which) for which in (False, True))
    for envs in (plain, compiled):
        envs.reset(seed=4, options={"elapsed": np.arange(COUNT)})
    largest = [0.0] * 5
    for actions in acting(60):
        told, expected = (envs.step(actions.to("cuda")) for envs in (compiled, plain))
        for k, (ours, theirs) in enumerate(zip((*told[:4], compiled.state), (*expected[:4], plain.state), strict=True)):
            largest[k] = max(largest[k], theirs.double().abs().max().item())
            assert (ours.double() - theirs.double()).abs().max().item() <= 1e-4 * largest[k], k


@pytest.mark.parametrize("recording", [{}, {"graph": True}])
@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
@pytest.mark.parametrize("name", SCENARIOS)
def test_a_step_waits_for_nothing(name, mode, recording):
    envs = batch(scenario=SCENARIOS[name], autoreset_mode=mode, **recording)
    envs.reset(seed=0)
    actions = torch.zeros(COUNT, 4, device="cuda")
    for _ in range(3):
        envs.step(actions)
    try:
        torch.cuda.set_sync_debug_mode("error")
        for _ in range(3):
            envs.step(actions)
    finally:
        torch.cuda.set_sync_debug_mode("default")


def test_gradients_are_those_of_the_processor():
    found = []
    for device in ("cuda", "cpu"):
        envs = batch(device, dtype="float64", differentiable=True, autoreset_mode="Disabled")
        envs.reset(seed=list(range(COUNT)))
        actions = torch.full((COUNT, 4), 0.1, dtype=torch.float64, device=device, requires_grad=True)
        sum(envs.step(actions)[1].sum() for _ in range(10)).backward()
        found.append(actions.grad.cpu())
    torch.testing.assert_close(*found, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
@pytest.mark.parametrize("plants", [1, 3])
def test_the_kernel_finds_the_blades_that_are_strained_too_much(plants, dtype):
    generator = torch.Generator("cuda").manual_seed(0)
    strain, standing, states, size = (
        torch.randn(shape, generator=generator, device="cuda", dtype=dtype)
        for shape in ((plants, 70, 54), (plants, 70), (1000, 54), (1000, 1))
    )
    limit, index = torch.full((plants,), 3.0, device="cuda", dtype=dtype), torch.arange(1000, device="cuda") % plants
    standing, states = 0.1 * standing, 0.3 * size * states
    states[5, 3], states[80, 0] = float("nan"), float("inf")
    safe = safe_energy(*(each.cpu().numpy() for each in (strain, standing, limit)))
    energy = 0.5 * (states**2).sum(1)
    found = Arrays(device="cuda").kernels.strained_too_much(energy, states, strain, standing, limit, index, safe)
    expected = strained_too_much(strain[index], standing[index], limit[index], states)
    assert torch.equal(found, expected)
    assert 100 < expected.sum() < 900


def test_a_copied_batch_goes_on_alike():
    envs = batch(graph=True)
    envs.reset(seed=1)
    actions = torch.zeros(COUNT, 4, device="cuda")
    envs.step(actions)
    other = copy.deepcopy(envs)
    assert torch.equal(envs.step(actions)[0], other.step(actions)[0])
