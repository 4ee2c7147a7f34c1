"""Windows that training unrolls: what they cost, how they grow, and on what device."""

import numpy as np
import pytest
import torch

from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.simulation.blades import Blades
from beamenv.task import resolve_task
from train.learning.recipe import named_recipe
from train.learning.through_plant.gradient import GradientSettings, GradientTraining, new_actor, train_gradient
from train.learning.through_plant.windows import Windows
from train.learning.training import uncontrolled_cost


@pytest.fixture(scope="module")
def plant():
    return build_plant(blade_config())


def task_of(scenario="nominal", duration=0.5):
    return resolve_task(scenario=scenario, duration=duration)


def test_windows_follow_one_another_through_an_episode(plant):
    windows = Windows(task_of("quiet", 0.02), 4, 10, np.random.default_rng(0))
    actor = new_actor(task_of(), GradientSettings())
    assert windows.count == 4
    assert windows._phase.tolist() == [0, 1, 2, 3]
    windows.unroll(actor)
    assert windows._phase.tolist() == [1, 2, 3, 0]
    assert not windows._blades.moving.requires_grad


QUIET = {"white_load": False, "sensor_noise": False}
STEADY = {"preset": "step", "magnitude": [30.0, 30.0], "direction_deg": [90.0, 90.0], "onset": [0.0, 0.0], **QUIET}


def steady(**changes):
    """Without noise, under one load: all that is left to chance is a scenario's trouble."""
    return {**STEADY, **changes}


@pytest.mark.parametrize("bias", [0.0, 0.3])
@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"plants": {"spin_up": [100.0, 300.0]}},
        {"drive": {"hysteresis": 0.2, "voltage_limits": [-500.0, 1500.0], "delay": [2, 2]}},
        {"plants": {"speed_ratio": [0.7, 1.3], "bank": 2}},
        {"plants": {"mass_drift": 1.3, "drift_duration": 0.04, "bank": 8}},
        {"failures": {"dead_actuators": 4, "onset": 0.02}},
        {"loads": [{"course": "pulse", "magnitude": 20.0, "onset": 0.01}]},
    ],
    ids=["nominal", "spin-up", "hysteresis and delay", "two speeds", "drift", "failure on the way", "loads of one's own"],
)
def test_windows_cost_what_the_environment_s_blades_cost(plant, bias, changes):
    """Under one load and a constant voltage, once every blade has begun an episode of its own."""
    task, episodes = task_of(steady(**changes), 0.05), 64
    actor = new_actor(task_of(), GradientSettings())
    with torch.no_grad():
        actor.unit.out.weight.zero_()
        actor.unit.out.bias.fill_(bias)
        windows = Windows(task, episodes, 25, np.random.default_rng(0))
        for _ in range(windows.count):
            windows.unroll(actor)
        cost = sum(windows.unroll(actor)[0].numpy() for _ in range(windows.count))
    blades, generator = Blades(task.bank, task.scenario, episodes), np.random.default_rng(0)
    blades.begin(generator)
    held = np.full((episodes, 4), np.tanh(bias))
    expected = sum(blades.step(held, generator).cost_increment for _ in range(task.steps))
    for found in {round(float(each), 12) for each in expected}:  # of each plant there is
        assert np.isclose(cost, found, rtol=2e-4).any()
    assert min(expected) * (1.0 - 2e-4) <= min(cost) and max(cost) <= max(expected) * (1.0 + 2e-4)
    if bias == 0.0 and not task.scenario.plants.varies:
        assert uncontrolled_cost(task, episodes=2) == pytest.approx(expected.mean(), rel=1e-4)


@pytest.mark.parametrize(
    ("changes", "lengths"),
    [
        ({"last_window": 20, "last_share": 0.5}, [10, 10, 20, 20]),
        ({"last_window": 20, "last_share": 0.0}, [10, 10, 10, 10]),
        ({"last_window": 20, "last_share": 1.0}, [20, 20, 20, 20]),
        ({"last_window": 10, "last_share": 1.0}, [10, 10, 10, 10]),
        ({}, [10, 10, 10, 10]),
    ],
)
def test_windows_grow_for_the_last_share_of_a_training_and_learning_slows(changes, lengths):
    settings = GradientSettings(episodes=4, window=10, learning_rate=0.1, last_rate=0.5, **changes)
    training, begun, rates = GradientTraining([task_of("white", 0.02)], settings, 0), [], []
    for remaining in (1.0, 0.75, 0.5, 0.25):
        first = training._windows
        training.update(remaining)
        begun.append(training._windows is not first)
        rates.append(training._optimiser.param_groups[0]["lr"] / (0.1 * remaining))
    assert training.steps == 4 * sum(lengths)
    assert sum(begun) == (20 in lengths)
    assert rates == pytest.approx([0.5 if each == 20 else 1.0 for each in lengths])


def test_by_the_clock_windows_grow_for_the_last_share_of_the_seconds(ticking):
    seen = []
    settings = GradientSettings(episodes=4, window=10, last_window=20, last_share=0.5)
    with ticking(1.0):  # every look at the clock takes a second
        train_gradient(task_of("white", 0.02), 0, seen.append, settings, seconds=4.0)
    assert [progress.steps for progress in seen] == [40, 80, 160, 240]


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"last_window": 124}, "last_window is 124, but must be 0, or at least the window, 125"),
        ({"last_window": -1}, "last_window is -1, but must be"),
        ({"last_share": 1.1}, "last_share is 1.1, but must be"),
        ({"last_rate": 0.0}, "last_rate is 0.0, but must be"),
    ],
)
def test_windows_that_shrink_are_refused(changes, sentence):
    with pytest.raises(ValueError, match=sentence):
        GradientSettings(**changes)


@pytest.mark.parametrize("device", ["nowhere", "cuda:99", "meta", "privateuseone", "cpu:3"])
def test_a_device_that_is_not_there_is_told_before_training(device):
    with pytest.raises(ValueError, match=f"settings.device is '{device}', but must be cpu, or a device that torch has here"):
        GradientTraining([task_of()], GradientSettings(device=device), 0)


def test_a_recipe_goes_to_a_device_where_its_trainer_has_one():
    assert named_recipe("residual").on("cpu") == named_recipe("residual")
    with pytest.raises(ValueError, match="device is 'cuda', but must be left out: ppo trains on the processor"):
        named_recipe("ppo").on("cuda")


@pytest.mark.skipif(not torch.cuda.is_available(), reason="no GPU here")
@pytest.mark.parametrize("scenario", ["failure", "hysteresis", "gust-speed"])
def test_a_gpu_unrolls_what_the_processor_does(scenario):
    trained = []
    for device in ("cpu", "cuda"):
        training = GradientTraining([task_of(scenario, 0.05)], GradientSettings(episodes=16, window=50, device=device), 0)
        training.update(1.0)
        trained.append(training.cost)
    np.testing.assert_allclose(*trained, rtol=1e-4)
