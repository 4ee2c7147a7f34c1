"""Controllers of a benchmark: found by their files, and told what their tier knows."""

import sys
from dataclasses import fields

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import lqg, stationary_cost
from beamenv.knowledge import Truth
from tests.train.benchmarked import SHORT, SMALL
from train.benchmark import benchmark
from train.controllers import named as named_controllers
from train.controllers.named import NamedController, discover, named


def test_a_file_in_the_folder_is_a_controller(tmp_path, monkeypatch):
    (tmp_path / "half_lqg.py").write_text(
        "from dataclasses import replace\nfrom baselines import lqg\nKIND = 'fixed'\nTIER = 0\n\n"
        "def build(design):\n    law = lqg(design.plant)\n    return replace(law, state_gain=0.5 * law.state_gain)\n"
    )
    monkeypatch.setattr(named_controllers, "__path__", [*named_controllers.__path__, str(tmp_path)])
    assert named("half-lqg").kind == "fixed"
    table = benchmark(**{**SMALL, "scenarios": ["nominal"], "controllers": ["half-lqg"]})
    assert table.row("nominal", "half-lqg").estimates["difference_to_lqg"].value != 0.0


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("KIND = 'fixed'\nTIER = 0\n", "has no build"),
        ("KIND = 'fixed'\nbuild = print\n", "has no TIER"),
        ("KIND = 'fuzzy'\nTIER = 0\nbuild = print\n", "wrong.KIND is 'fuzzy', but must be one of fixed"),
        ("KIND = 'fixed'\nTIER = 4\nbuild = print\n", "wrong.TIER is 4, but must be a whole number from 0 to 3"),
    ],
)
def test_a_controller_that_lacks_something_is_named(content, sentence, tmp_path, monkeypatch):
    (tmp_path / "wrong.py").write_text(content)
    monkeypatch.setattr(named_controllers, "__path__", [str(tmp_path)])
    sys.modules.pop("train.controllers.named.wrong", None)
    with pytest.raises(ValueError, match=sentence):
        discover()


class Unseen:
    """A task whose true blade may not be looked at."""

    def __init__(self, task):
        self._task = task

    def __getattr__(self, name):
        if name in ("plant", "config", "bank"):
            raise AssertionError(f"{name} of the true blade was read")
        return getattr(self._task, name)


@pytest.mark.parametrize("name", sorted(name for name, each in discover().items() if each.tier == 0))
def test_a_controller_is_built_without_a_look_at_the_true_blade(name):
    """Nor does another true blade behind the same design change what it does."""
    electronics = {"sensor_full_scale": 2e-5}
    blades = [electronics, {**electronics, "beam": {"pretwist_deg": 25.0}}]
    tasks = [gymnasium.make(beamenv.ENV_ID, blade=blade, design=electronics, **SHORT).unwrapped.task for blade in blades]
    assert tasks[0].plant.A.tobytes() != tasks[1].plant.A.tobytes()
    actions = []
    for task in tasks:
        law = named(name).build(type(task).design.fget(Unseen(task)))
        seen = {"state": np.full((2, len(task.design_plant.A)), 1e-3), "observation": np.full((2, 4), 0.1)}
        seen["observation and speed"] = np.hstack([seen["observation"], np.full((2, 1), 190.0)])
        actions.append(law.predict(seen[law.observes])[0])
    assert np.array_equal(*actions)
    assert name == "none" or np.abs(actions[0]).max() > 0.0


def test_a_controller_is_told_what_its_tier_knows():
    assert {name for name, each in discover().items() if each.tier == 3} >= {"lqg-truth", "lqr", "lqr-load"}
    task = gymnasium.make("beamenv/RotatingBeam-off-speed-v0", **SHORT).unwrapped.task
    for tier, kind in ((0, beamenv.Design), (1, beamenv.Prior), (2, beamenv.Prior), (3, Truth)):
        told = []
        NamedController("rival", "fixed", lambda known, told=told: told.append(known), tier).build_for(task)
        assert [type(each) for each in told] == [kind]


@pytest.mark.parametrize(("name", "least"), [("lqr", 3), ("scheduled-lqg", 2)])
def test_a_controller_that_sees_more_than_its_tier_is_refused(name, least):
    task = gymnasium.make(beamenv.ENV_ID, **SHORT).unwrapped.task
    law = named(name).build(task.told(least))
    with pytest.raises(ValueError, match=f"sly.TIER is {least - 1}, but must be at least {least} for what observes"):
        NamedController("sly", "fixed", lambda known: law, least - 1).build_for(task)


def test_lqg_that_is_told_the_truth_is_designed_for_it():
    task = gymnasium.make("beamenv/RotatingBeam-solid-20-v0", **SHORT).unwrapped.task
    law = named("lqg-truth").build_for(task)
    assert stationary_cost(task.plant, law) == stationary_cost(task.plant, lqg(task.plant))
    assert np.array_equal(named("lqg-sampled").build_for(task).transition, lqg(task.design_plant).transition)


def test_a_task_that_lets_nobody_see_its_true_blade_notices_who_looks():
    task = Unseen(gymnasium.make(beamenv.ENV_ID, **SHORT).unwrapped.task)
    with pytest.raises(AssertionError, match="plant of the true blade was read"):
        lqg(task.plant)
    assert {each.name for each in fields(beamenv.Design)} == {"plant", "config"}
