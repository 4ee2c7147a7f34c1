"""Training through the plant: exact gradients, and a policy that damps."""

import gymnasium
import numpy as np
import pytest
import torch

import beamenv
from baselines import PersistentLoad, RotorHarmonics, evaluate, reference_lqg
from baselines.laws.lqg import sampled_with_loads
from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.plant.plant import normalised
from beamenv.simulation.kernel import Operators, advance
from beamenv.task import resolve_task
from train.learning.through_plant.actors import ActorSettings
from train.learning.through_plant.gradient import GradientSettings, new_actor, train_gradient
from train.learning.through_plant.linear_base import SPREAD, linear_base
from train.learning.training import on_training_bank


@pytest.fixture(scope="module")
def plant():
    return build_plant(blade_config())


def total_cost(operators, voltages, loads):
    """J of one blade from rest under voltages (T, m) and loads (T, 2)."""
    state, total = torch.zeros(operators.states, dtype=torch.float64), torch.zeros((), dtype=torch.float64)
    for each, load in zip(voltages, loads, strict=True):
        state, _, _, increment = advance(operators, torch.cat([state, each, load]))
        total = total + increment
    return total


def test_gradients_through_the_kernel_are_those_of_finite_differences(plant):
    operators = Operators.from_plant(normalised(plant)).convert(torch.as_tensor)
    generator = torch.Generator().manual_seed(0)
    voltages = torch.randn(6, 4, generator=generator, dtype=torch.float64, requires_grad=True)
    loads = 30.0 * torch.randn(6, 2, generator=generator, dtype=torch.float64)
    total_cost(operators, voltages, loads).backward()
    largest = float(voltages.grad.abs().max())
    for step, actuator in ((0, 0), (2, 3), (5, 1)):
        change = torch.zeros_like(voltages)
        change[step, actuator] = 1e-3
        with torch.no_grad():
            rise = total_cost(operators, voltages + change, loads) - total_cost(operators, voltages - change, loads)
        # J is quadratic in the voltages, so that central differences are exact but for rounding
        assert float(voltages.grad[step, actuator]) == pytest.approx(float(rise) / 2e-3, abs=1e-6 * largest)


def task_of(scenario="nominal", duration=0.5):
    return resolve_task(scenario=scenario, duration=duration)


@pytest.mark.parametrize(
    ("kind", "base"),
    [
        *(("recurrent", "lqg"), ("residual", "lqg"), ("residual", "lqg-load"), ("residual", "lqg-rotor")),
        *(("state-space", "lqg"), ("state-space", "lqg-rotor"), ("belief", "lqg"), ("belief", "lqg-load")),
    ],
)
def test_an_actor_and_its_policy_ask_for_the_same_voltages(kind, base):
    torch.manual_seed(1)
    actor = new_actor(task_of(), GradientSettings(kind, base, "base", ActorSettings(output_gain=3.0), runs=2))
    with torch.no_grad():
        for weights in actor.parameters():
            weights *= 1.0 + 0.02 * torch.randn(weights.shape)
    readings = torch.clamp(torch.randn(20, 6, 4), -1.0, 1.0)
    memory, policy_memory = actor.start(6), None
    policy = actor.policy(1)
    for each in readings:
        voltages, memory = actor(each, memory)
        action, policy_memory = policy.predict(each[3:].numpy(), policy_memory)  # rows of the second run
        np.testing.assert_allclose(action, voltages[3:].detach().numpy(), atol=2e-5)


REFERENCES = {"lqg": (), "lqg-load": (PersistentLoad(),), "lqg-rotor": (RotorHarmonics(200.0), PersistentLoad())}


@pytest.mark.parametrize("base", REFERENCES)
@pytest.mark.parametrize("kind", ["residual", "state-space", "belief"])
def test_an_untrained_actor_is_the_law_it_starts_from(kind, base):
    """While no reading that it expects is beyond full scale."""
    task = task_of()
    law, memories = reference_lqg(task.design.full_plant, load=REFERENCES[base]), [None, None]
    policy = new_actor(task, GradientSettings(kind, base, "base", ActorSettings(output_gain=0.0))).policy(0)
    for observed in np.random.default_rng(0).normal(0.0, 0.01, (40, 5, 4)):
        action, memories[0] = law.predict(observed, memories[0])
        other, memories[1] = policy.predict(observed, memories[1])
        np.testing.assert_allclose(other, action, atol=1e-5)
    assert np.abs(action).max() > 0.002


@pytest.mark.parametrize("kind", ["state-space", "belief"])
def test_an_idle_actor_asks_for_nothing(kind):
    policy = new_actor(task_of(), GradientSettings(kind, "lqg", "idle")).policy(0)
    action, memory = policy.predict(np.full((2, 4), 0.1))
    assert not policy.predict(np.full((2, 4), 0.1), memory)[0].any()
    assert not action.any() and memory.any()


def test_a_base_moves_as_its_scale_says_in_the_design_s_own_noise():
    """Largest root mean square of its memory, simulated with the plant's white noise and a load that lasts."""
    plant, base = task_of().design.full_plant, linear_base("lqg", task_of())
    held, generator, order = sampled_with_loads(plant, PersistentLoad()), np.random.default_rng(0), base.feedback.shape[1]
    state, memory, squares = np.zeros((200, len(held.A))), np.zeros((200, order)), []
    factors = [np.linalg.cholesky(each) for each in (held.process_noise, held.sensor_noise)]
    for k in range(2500):
        load, noise = (generator.standard_normal((200, len(each))) @ each.T for each in factors)
        product = np.hstack([memory, (state @ held.C.T + noise) / plant.sensor_full_scale]) @ base.fused
        voltages = product[:, order:]
        memory = product[:, :order] + voltages @ base.feedback
        state = state @ held.A.T + 1500.0 * voltages @ held.B.T + load @ held.disturbance_input.T
        squares += [(memory**2).mean(axis=0)] if k >= 1000 else []
    assert np.sqrt(np.mean(squares, axis=0)).max() == pytest.approx(SPREAD, rel=0.05)


def test_a_filter_that_knows_that_readings_clip_takes_one_at_full_scale_for_what_it_expects():
    """Three full scales expected and one shown: no innovation, as if three had been shown to a filter without a range."""
    base, policy = linear_base("lqg", task_of()), new_actor(task_of(), GradientSettings("state-space", "lqg")).policy(0)
    estimate = 3.0 * np.linalg.lstsq(base.readout.T, np.eye(4)[0], rcond=None)[0]
    asked = (np.concatenate([estimate, 3.0 * np.eye(4)[0]]) @ base.fused)[-4:]
    action, _ = policy.predict(np.eye(4)[0], np.concatenate([estimate, np.zeros(4)])[None].astype(np.float32))
    np.testing.assert_allclose(action, np.clip(asked, -1.0, 1.0), atol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["state-space", "belief"])
def test_training_under_the_noise_of_the_design_does_not_leave_the_optimum(kind):
    """In white noise alone nothing linear beats LQG, and the rate-penalised reference is 0.3 % from it."""
    task = task_of("white", 0.25)
    settings = GradientSettings(kind, "lqg", episodes=32, learning_rate=1e-3)
    (policy,) = train_gradient(task, 0, lambda progress: None, settings, updates=60)
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=64, scenario="white", duration=0.25)
    law = reference_lqg(task.design.full_plant)
    trained, reference = (evaluate(each, envs, range(64)).relative_cost.value for each in (policy, law))
    assert trained == pytest.approx(reference, rel=0.02)


@pytest.mark.slow
def test_a_gain_from_the_belief_that_starts_at_nothing_finds_lqg_s():
    task = task_of("white", 0.25)
    settings = GradientSettings("belief", "lqg", "idle", episodes=64, learning_rate=2e-2)
    (policy,) = train_gradient(task, 0, lambda progress: None, settings, updates=80)
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=64, scenario="white", duration=0.25)
    law = reference_lqg(task.design.full_plant)
    trained, reference = (evaluate(each, envs, range(64)).relative_cost.value for each in (policy, law))
    assert trained <= 1.05 * reference


def test_runs_side_by_side_do_not_see_one_another(plant):
    """What one run does leaves the gradients of the others alone."""
    torch.manual_seed(0)
    actor = new_actor(task_of(), GradientSettings(runs=3))
    voltages, _ = actor(torch.randn(12, 4), actor.start(12))
    voltages[4:8].sum().backward()
    for name, weights in actor.named_parameters():
        assert not weights.grad[[0, 2]].any(), name
    assert actor.unit.out.weight.grad[1].any()


def test_the_same_seed_trains_the_same_agent():
    settings = GradientSettings(episodes=8, window=25, runs=2)
    first, second = (train_gradient(task_of("failure", 0.025), 3, lambda progress: None, settings, updates=6) for _ in range(2))
    for one, other in zip(first, second, strict=True):
        for name, weight in one.weights.items():
            np.testing.assert_array_equal(weight, other.weights[name])
    assert not np.array_equal(first[0].weights["weight_ih"], first[1].weights["weight_ih"])


def test_plants_are_drawn_from_another_bank_than_the_evaluation_s():
    task = task_of({"plants": {"speed_ratio": [0.7, 1.3], "bank": 3}})
    assert not np.isclose(on_training_bank(task).bank.speeds, task.bank.speeds).any()


def test_twenty_steps_of_training_damp_the_blade():
    seen = []
    (policy,) = train_gradient(task_of(), 0, seen.append, GradientSettings(episodes=16), updates=20)
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=32)
    assert evaluate(policy, envs, range(32)).relative_cost.high < 0.9
    assert [progress.steps for progress in seen] == sorted({progress.steps for progress in seen})
    assert len(seen) == 20


def test_an_interrupted_training_gives_what_it_has():
    def interrupt(progress):
        raise KeyboardInterrupt

    (policy,) = train_gradient(task_of(), 0, interrupt, seconds=60.0)
    assert policy.predict(np.zeros(4))[0].shape == (4,)
