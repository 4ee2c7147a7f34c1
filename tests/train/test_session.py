"""A training from beginning to end: its budget, its checkpoints, and resuming from them."""

import csv
import json
import os
import signal
import time
from contextlib import nullcontext
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

import train.learning.job
from beamenv.plant.fingerprint import fingerprint
from beamenv.task import resolve_task
from tests.train.brief import GRADIENT, PPO, RECURRENT, SAC, SHORT, TQC, assert_same, ignore, interrupted_after, job, weights
from train.controllers.policy_files import load_policy
from train.controllers.tiers import told_tier
from train.learning.checkpoint import read_checkpoint
from train.learning.job import run
from train.learning.session import Budget, follow
from train.learning.validation import Validation
from train.shared.interruption import WHEN_ASKED, Interrupted, ending_as_interrupted


def curve(folder):
    with (folder / "learning.csv").open() as file:
        return list(csv.DictReader(file))


@dataclass
class Counting:
    """A training that only counts."""

    updates: int = 0
    steps: int = 0
    cost: float = 1.0
    validated: float = float("nan")
    losses: dict = field(default_factory=dict)
    remaining: list = field(default_factory=list)

    def update(self, remaining):
        self.updates += 1
        self.remaining.append(remaining)

    def policies(self):
        return []


def test_by_updates_the_learning_rate_falls_with_them():
    training = Counting()
    follow(training, Budget(updates=4), ignore)
    assert training.remaining == [1.0, 0.75, 0.5, 0.25]


def test_by_the_clock_it_falls_with_time(ticking):
    training = Counting()
    with ticking(1.0):  # every look at the clock takes a second
        follow(training, Budget(seconds=4), ignore)
    assert training.remaining == [1.0, 0.75, 0.5, 0.25]


def test_a_checkpoint_is_written_every_so_often_and_at_the_end(ticking):
    kept = []
    with ticking(10.0):
        follow(Counting(), Budget(updates=7), ignore, kept.append, interval=30.0)
    assert kept == [30.0, 60.0, 70.0]


class Signalled(Counting):
    """A training whose third update meets signals."""

    def __init__(self, *numbers):
        super().__init__()
        self.numbers = numbers

    def update(self, remaining):
        if self.updates == 2:
            for number in self.numbers:
                signal.raise_signal(number)
        super().update(remaining)


ENDING = [signal.SIGINT, *(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if os.name == "posix")]


@pytest.fixture
def not_ignored():
    """Signals that end: under nohup, say, a hang-up is ignored, and whoever is told to ignore it goes on ignoring it."""
    before = {each: signal.signal(each, signal.SIG_DFL) for each in ENDING if signal.getsignal(each) is signal.SIG_IGN}
    yield
    for each, handler in before.items():
        signal.signal(each, handler)


@pytest.mark.usefixtures("not_ignored")
@pytest.mark.parametrize("number", ENDING)
def test_a_signal_waits_for_the_end_of_an_update(number):
    training, kept = Signalled(number), []
    handlers = [signal.getsignal(each) for each in ENDING]
    with ending_as_interrupted(), nullcontext() if number == signal.SIGINT else pytest.raises(Interrupted) as raised:
        follow(training, Budget(updates=9), ignore, kept.append)
    assert training.updates == 3
    assert len(kept) == 1
    assert [signal.getsignal(each) for each in ENDING] == handlers
    if raised is not None:
        assert raised.value.status == 128 + number


def test_ctrl_c_that_waits_is_answered_at_once():
    training, answered = Signalled(signal.SIGINT), []
    told = WHEN_ASKED.set(lambda: answered.append(training.updates))
    try:
        follow(training, Budget(updates=5), ignore)
    finally:
        WHEN_ASKED.reset(told)
    assert answered == [2] and training.updates == 3  # in the midst of the third update


def test_a_second_ctrl_c_does_not_wait_and_half_an_update_is_not_kept():
    training, kept = Signalled(signal.SIGINT, signal.SIGINT), []
    with pytest.raises(KeyboardInterrupt):
        follow(training, Budget(updates=9), ignore, kept.append)
    assert training.updates == 2
    assert kept == []


@pytest.mark.parametrize("given", [{"updates": "6"}, {"updates": True}, {"seconds": None}, {"seconds": [1.0]}])
def test_a_budget_is_made_of_numbers(given):
    with pytest.raises(ValueError, match="must be a positive number"):
        Budget(**given)


@pytest.mark.parametrize("given", [{"updates": 0}, {"seconds": -1.0}, {"seconds": float("nan")}, {}])
def test_a_budget_must_end(given):
    with pytest.raises(ValueError, match="must be"):
        Budget(**given)


@pytest.mark.parametrize(
    "scenario",
    ["nominal", "delay", "failure", "hysteresis", "rotor", pytest.param("spin-up", marks=pytest.mark.slow), "off-damping.toml"],
)
def test_a_resumed_gradient_training_ends_with_the_very_weights_of_an_uninterrupted_one(scenario, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "off-damping.toml").write_text("[plants]\nbank = 4\ndamping_ratio = [0.003, 0.02]\n")
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    run(job(GRADIENT, scenario), whole, ignore)
    run(job(GRADIENT, scenario), broken, interrupted_after(3))
    halfway = weights(broken)
    run(job(GRADIENT, scenario), broken, ignore, resume=True)
    assert_same(weights(whole), weights(broken))
    assert any((halfway[name] != weight).any() for name, weight in weights(whole).items())
    costs = [[row["cost"] for row in curve(folder)] for folder in (whole, broken)]
    assert costs[0] == costs[1]


LENGTHENING = replace(GRADIENT, settings=replace(GRADIENT.settings, last_window=20, last_share=0.5, last_rate=0.3))
"""Of its six updates the fourth is the first with long windows."""


@pytest.mark.parametrize("updates", [2, 3, 4, 5])
def test_a_training_whose_windows_grow_resumes_to_the_very_weights_before_at_and_after_it(updates, tmp_path):
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    run(job(LENGTHENING, "rotor"), whole, ignore)
    run(job(LENGTHENING, "rotor"), broken, interrupted_after(updates))
    run(job(LENGTHENING, "rotor"), broken, ignore, resume=True)
    assert_same(weights(whole), weights(broken))
    assert [float(row["steps"]) for row in curve(whole)] == [80.0, 160.0, 240.0, 400.0, 560.0, 720.0]
    assert [row["cost"] for row in curve(whole)] == [row["cost"] for row in curve(broken)]


STABLE_BASELINES = [PPO, RECURRENT, SAC, TQC]


@pytest.mark.parametrize("scenario", ["failure", *(pytest.param(name, marks=pytest.mark.slow) for name in ("rotor", "spin-up"))])
@pytest.mark.parametrize("recipe", STABLE_BASELINES, ids=lambda recipe: recipe.agent)
def test_a_resumed_training_ends_with_the_very_weights_of_an_uninterrupted_one(recipe, scenario, tmp_path):
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    run(job(recipe, scenario, updates=8), whole, ignore)
    run(job(recipe, scenario, updates=8), broken, interrupted_after(5))
    halfway = weights(broken)
    run(job(recipe, scenario, updates=8), broken, ignore, resume=True)
    assert_same(weights(whole), weights(broken))
    assert any((halfway[name] != weight).any() for name, weight in weights(whole).items())
    costs = [[row["cost"] for row in curve(folder)] for folder in (whole, broken)]
    assert costs[0] == costs[1]


def test_several_scenarios_side_by_side_resume_to_the_same_weights(tmp_path, monkeypatch):
    monkeypatch.setattr(train.learning.job, "NAMES", ("nominal", "hysteresis"))
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    run(job(PPO, "generalist", updates=5), whole, ignore)
    run(job(PPO, "generalist", updates=5), broken, interrupted_after(2))
    run(job(PPO, "generalist", updates=5), broken, ignore, resume=True)
    assert_same(weights(whole), weights(broken))


def test_a_training_can_be_resumed_from_its_first_update_on(tmp_path):
    class Killed(Exception):  # noqa: N818 - no error of ours
        pass

    def at_once(progress):
        raise Killed

    run(job(PPO), tmp_path / "whole", ignore)
    with pytest.raises(Killed):
        run(job(PPO), tmp_path / "broken", at_once)
    run(job(PPO), tmp_path / "broken", ignore, resume=True)
    assert_same(weights(tmp_path / "whole"), weights(tmp_path / "broken"))


def test_a_training_that_is_over_keeps_no_memory_of_experience(tmp_path):
    run(job(SAC), tmp_path, interrupted_after(3))
    assert len(read_checkpoint(tmp_path)["training"]["memory"]["rewards"]) == 3 * 4
    run(job(SAC), tmp_path, ignore, resume=True)
    assert "memory" not in read_checkpoint(tmp_path)["training"]
    before = weights(tmp_path)
    run(job(SAC), tmp_path, ignore, resume=True)
    assert_same(before, weights(tmp_path))


def test_an_agent_tells_whether_its_training_was_finished(tmp_path):
    run(job(PPO), tmp_path, interrupted_after(3))
    about = json.loads((tmp_path / "agent.json").read_text())
    assert (about["finished"], about["updates"]) == (False, 3)
    run(job(PPO), tmp_path, ignore, resume=True)
    about = json.loads((tmp_path / "agent.json").read_text())
    assert (about["finished"], about["updates"]) == (True, 6)


def test_a_signal_to_end_saves_what_has_been_learnt(tmp_path):
    def ended(progress):
        if progress.updates == 2:
            signal.raise_signal(signal.SIGTERM)

    with pytest.raises(Interrupted):
        run(job(PPO), tmp_path / "broken", ended)
    assert json.loads((tmp_path / "broken" / "agent.json").read_text())["finished"] is False
    run(job(PPO), tmp_path / "broken", ignore, resume=True)
    run(job(PPO), tmp_path / "whole", ignore)
    assert_same(weights(tmp_path / "whole"), weights(tmp_path / "broken"))


@pytest.mark.parametrize("recipe", [GRADIENT, PPO, SAC], ids=["gradient", "ppo", "sac"])
def test_a_training_begun_again_is_the_same(recipe, tmp_path):
    for name in ("first", "second"):
        run(job(recipe, updates=3), tmp_path / name, ignore)
    run(job(recipe, updates=3, seed=1), tmp_path / "other", ignore)
    first, second, other = (weights(tmp_path / name) for name in ("first", "second", "other"))
    assert_same(first, second)
    assert any((first[name] != other[name]).any() for name in first)


def test_what_is_saved_tells_what_it_depends_on(tmp_path):
    (place,) = run(job(GRADIENT), tmp_path / "agent", ignore)
    about = json.loads((place / "agent.json").read_text())
    plant = resolve_task(**SHORT).design_plant
    assert about["recipe"] == GRADIENT.to_dict()
    assert (about["agent"], about["scenario"], about["seed"], about["updates"]) == ("gradient", "nominal", 0, 6)
    assert {"Python", "numpy", "torch", "stable-baselines3", "sb3-contrib", "gymnasium"} <= set(about["versions"])
    assert about["plants"] == {"nominal": fingerprint(plant)}
    assert about["tier"] == told_tier(place) == 1
    assert load_policy(place, plant).predict(np.zeros(4))[0].shape == (4,)
    assert [int(row["updates"]) for row in curve(place)] == [1, 2, 3, 4, 5, 6]
    assert list((place / "tensorboard").glob("events.out.tfevents.*"))


def test_runs_side_by_side_are_saved_apart(tmp_path):
    recipe = replace(GRADIENT, settings=replace(GRADIENT.settings, runs=2))
    places = run(job(recipe, updates=2), tmp_path, ignore)
    assert [place.name for place in places] == ["0", "1"]
    with pytest.raises(ValueError, match="it holds those of 2 runs, so name one of .*0, .*1"):
        load_policy(tmp_path)
    curves = [(place / "learning.csv").read_text() for place in places]
    assert curves[0] != curves[1]


def test_looks_at_a_policy_are_in_its_curve_and_leave_its_weights_alone(tmp_path):
    several = replace(GRADIENT, settings=replace(GRADIENT.settings, runs=2))
    alone = run(job(several), tmp_path / "alone", ignore)
    looked_at = run(replace(job(several), looks=3), tmp_path / "looked", ignore)
    (task,) = job(several).tasks().values()
    for one, other in zip(alone, looked_at, strict=True):
        assert_same(weights(one), weights(other))
        rows = curve(other)
        assert [row["updates"] for row in rows if row["looked"] != "nan"] == ["2", "4", "6"]
        assert float(rows[-1]["looked"]) == pytest.approx(Validation([task]).cost(load_policy(other)), rel=1e-9)
    assert "looked" not in curve(alone[0])[0]


def test_looks_go_on_where_a_training_was_interrupted(tmp_path):
    whole, rest = (replace(job(GRADIENT), looks=3) for _ in range(2))
    run(whole, tmp_path / "whole", ignore)
    run(rest, tmp_path / "parts", interrupted_after(3))
    run(rest, tmp_path / "parts", ignore, resume=True)
    seen = [[row["looked"] for row in curve(tmp_path / name)] for name in ("whole", "parts")]
    assert seen[0] == seen[1]


def test_sparing_looks_that_are_dear_are_the_first_and_the_last_and_take_no_time_of_the_training(tmp_path, monkeypatch):
    looks = []

    def dear(validation, policy):
        time.sleep(0.5)
        looks.append(policy)
        return 1.0

    monkeypatch.setattr(Validation, "cost", dear)
    (place,) = run(replace(job(GRADIENT), looks=6, sparing=True), tmp_path, ignore)
    rows = curve(place)
    assert [row["updates"] for row in rows if row["looked"] != "nan"] == ["1", "6"]
    looks.clear()
    begin = time.monotonic()
    run(replace(job(GRADIENT), budget=Budget(seconds=0.6), looks=6), tmp_path / "by the clock", ignore)
    assert looks and time.monotonic() - begin > 0.6 + 0.5 * len(looks)


def test_a_training_that_looks_itself_is_not_looked_at(tmp_path):
    looking = replace(PPO, settings=replace(PPO.settings, validation=3))
    (place,) = run(replace(job(looking), looks=6), tmp_path, ignore)
    assert "validation" in curve(place)[0] and "looked" not in curve(place)[0]


def test_a_generalist_knows_the_plant_of_every_scenario(tmp_path, monkeypatch):
    monkeypatch.setattr(train.learning.job, "NAMES", ("nominal", "hysteresis"))
    (place,) = run(job(PPO, "generalist", updates=1), tmp_path, ignore)
    tasks = [resolve_task(**{**SHORT, "scenario": name}) for name in ("nominal", "hysteresis")]
    assert load_policy(place, tasks[0].design_plant).lowest == pytest.approx(-1.0)
    assert load_policy(place, tasks[1].design_plant).lowest == pytest.approx(-1.0 / 3.0)


def test_a_teacher_must_know_the_plant(tmp_path):
    (teacher,) = run(job(GRADIENT, updates=1), tmp_path / "teacher", ignore)
    for_other = replace(job(PPO, "hysteresis"), teacher=teacher)
    with pytest.raises(ValueError, match="none of those the agent .* was trained on"):
        run(for_other, tmp_path / "student", ignore)
    with pytest.raises(ValueError, match="'gradient' must start from scratch"):
        run(replace(job(GRADIENT), teacher=teacher), tmp_path / "student", ignore)
