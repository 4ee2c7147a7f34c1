"""The policy that weighs a multiple-model law: the law itself at first, alike in torch and NumPy, and never without its law."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from baselines import Hypothesis, multiple_model, reference_lqg
from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.plant.plant import normalised
from beamenv.task import resolve_task
from train.controllers.policy_files import load_policy, save_policy
from train.learning.through_plant.actors import ActorSettings
from train.learning.through_plant.models_actor import ModelsActor
from train.learning.through_plant.windows import Windows


@pytest.fixture(scope="module", name="plant")
def of_the_blade():
    return build_plant(blade_config())


@pytest.fixture(scope="module", name="law")
def of_two_delays(plant):
    hypotheses = [Hypothesis(plant, delay=delay, holds_lost_readings=True) for delay in (0, 1)]
    return multiple_model(hypotheses, reference_lqg(plant))


def actor_of(plant, law, output_gain):
    torch.manual_seed(2)
    actor = ModelsActor(plant, ActorSettings(output_gain=output_gain), 1, law)
    actor.limits = torch.tensor(normalised(plant).voltage_limits, dtype=torch.float32)
    return actor


SETTLED = 200
"""Instants until gains have."""


def readings(steps, scale=0.02, count=3):
    """(steps, count, 4), of which some are lost once gains have settled: before, training leaves lost ones out otherwise."""
    generator, seen = np.random.default_rng(1), np.zeros((steps, count, 4), np.float32)
    for k in range(1, steps):
        fresh = 0.97 * seen[k - 1] + scale * generator.standard_normal((count, 4))
        seen[k] = np.where(generator.random((count, 4)) < 0.03 * (k > SETTLED), seen[k - 1], np.clip(fresh, -1.0, 1.0))
    return seen


@pytest.mark.parametrize("scale", [0.001, 0.1], ids=["a model fits", "none fits"])
def test_numpy_repeats_the_training_time_law_and_unit(plant, law, scale):
    actor, memory = actor_of(plant, law, 1.0), None
    policy, training = actor.policy(0), actor.start(3)
    for seen in readings(SETTLED + 60, scale):
        with torch.no_grad():
            voltages, training = actor(torch.as_tensor(seen), training)
        action, memory = policy.predict(seen, memory)
        np.testing.assert_allclose(action, voltages.numpy(), atol=1e-4)
    assert np.abs(action).max() > 0.01
    assert bool(training[-2].any()) == (scale == 0.1)


def test_an_untrained_policy_is_the_law(plant, law):
    policy, memory, own = actor_of(plant, law, 0.0).policy(0), None, None
    for seen in readings(60):
        action, memory = policy.predict(seen, memory)
        wanted, own = law.predict(seen, own)
        np.testing.assert_allclose(action, wanted, atol=1e-6)


def test_a_law_that_is_overruled_expects_what_the_voltages_held_do(law):
    """It goes on as one that asks for nothing by itself."""
    none, own = np.zeros_like, law.fallback
    quiet = replace(own, state_gain=none(own.state_gain), measurement_gain=none(own.measurement_gain))
    silent = replace(law, state_gain=none(law.state_gain), voltage_gain=none(law.voltage_gain), fallback=quiet)
    memory = expected = np.zeros((3, law.order))
    for seen in readings(80):
        action, memory = law.decide(seen, memory)
        memory = law.overruled(memory, -action)
        _, expected = silent.decide(seen, expected)
        for one, other in zip(law.recall(memory), law.recall(expected), strict=True):
            np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9 * np.abs(other).max(initial=1e-3))


def test_overruled_from_outside_a_policy_goes_by_what_was_held(plant, law):
    policy = actor_of(plant, law, 1.0).policy(0)
    seen = readings(3)[-1]
    action, memory = policy.predict(seen)
    held = np.full_like(action, 0.1)
    changed = policy.knowing(memory, held)
    units = policy.weights["weight_hh"].shape[1]
    np.testing.assert_array_equal(changed[:, -4:], held)
    np.testing.assert_allclose(law.recall(changed[:, units:-4]).voltages[:, 0], held * law.instruments.voltage_scale, rtol=1e-6)


def test_without_its_law_it_is_refused_in_a_sentence(plant, law, tmp_path):
    save_policy(actor_of(plant, law, 1.0).policy(0), tmp_path)
    alone = load_policy(tmp_path)
    with pytest.raises(ValueError, match=r"adds to a law that it must be given"):
        alone.predict(np.zeros(4))
    with pytest.raises(ValueError, match=r"law is None, but must be a multiple-model law with a fallback"):
        alone.beside(None)
    assert alone.beside(law).predict(np.zeros(4))[0].shape == (4,)


def test_a_law_in_volts_is_refused(plant, law):
    policy = actor_of(plant, law, 1.0).policy(0)
    with pytest.raises(ValueError, match="but must be one of 4 voltages and, together, 6 readings and models, in normalised units"):
        policy.beside(law.in_physical_units())


def test_nobody_asks_and_nobody_is_answered(law):
    assert law.predict(np.zeros((0, 4)))[0].shape == (0, 4)


def test_a_step_against_the_gradient_through_plant_and_filters_lowers_the_cost(plant, law):
    """Of one and the same window; the law's filters are part of the loop that is differentiated."""

    def cost_of(actor):
        windows = Windows(resolve_task(duration=0.05), 8, 50, np.random.default_rng(4))
        cost, left = windows.unroll(actor)
        return (cost + 0.05 * left).sum()

    actor = actor_of(plant, law, 0.3)
    before = cost_of(actor)
    before.backward()
    gradients = [weights.grad for weights in actor.parameters()]
    assert all(torch.isfinite(each).all() for each in gradients)
    length = torch.sqrt(sum((each**2).sum() for each in gradients))
    assert length > 0.0
    with torch.no_grad():
        for weights in actor.parameters():
            weights -= 1e-2 * weights.grad / length
        after = cost_of(actor)
    assert after < before
    assert float((before - after).detach()) == pytest.approx(1e-2 * float(length), rel=0.2)
