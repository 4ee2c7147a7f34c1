"""A trial of a tuning: trained as `beamenv train` does, looked at on validation seeds alone, and resumed bit for bit."""

from dataclasses import replace

import numpy as np
import pytest

from tests.train import brief
from train.controllers.policy_files import load_policy
from train.learning import job as jobs
from train.learning import validation
from train.learning.checkpoint import NAME
from train.learning.validation import EPISODES, Validation
from train.shared.held_out import HELD_OUT, VALIDATION
from train.tuning.trial import Look, looks, rungs


def without_seconds(found):
    return [replace(each, seconds=0.0) for each in found]


@pytest.mark.parametrize(
    ("updates", "at"), [(1, (1,)), (3, (1, 3)), (6, (1, 4, 6)), (16, (1, 4, 16)), (200, (12, 48, 200)), (822, (51, 204, 822))]
)
def test_rungs_are_a_sixteenth_and_a_quarter_and_all(updates, at):
    assert rungs(updates) == at


@pytest.mark.parametrize("recipe", [brief.GRADIENT, brief.PPO, brief.SAC], ids=lambda recipe: recipe.agent)
def test_a_trial_is_the_training_that_the_recipe_gives(recipe, tmp_path):
    job = brief.job(recipe)
    last = list(looks(job, (1, 4, 6), tmp_path / "trial"))[-1]
    (place,) = jobs.run(job, tmp_path / "trained", brief.ignore)
    policy = load_policy(place)
    tasks = list(job.tasks().values())
    assert last.cost == Validation(tasks).cost(policy)
    assert last.apart == Validation(tasks, VALIDATION + EPISODES).cost(policy)
    assert last.cost != last.apart


def test_a_trial_that_is_stopped_anywhere_resumes_bit_for_bit(tmp_path):
    job, at = brief.job(brief.PPO), (1, 4, 6)
    whole = list(looks(job, at, tmp_path / "whole"))
    found = []
    for _ in at:  # a process each: what the one before told is known
        trial = looks(job, at, tmp_path / "parts", found)
        found = [next(trial) for _ in range(len(found) + 1)]
        trial.close()
    assert without_seconds(found) == without_seconds(whole)
    (tmp_path / "parts" / NAME).unlink()  # as on another machine
    assert without_seconds(looks(job, at, tmp_path / "parts", found[:1])) == without_seconds(whole)
    (tmp_path / "parts" / NAME).write_bytes(b"damaged")
    assert without_seconds(looks(job, at, tmp_path / "parts")) == without_seconds(whole)


def test_what_is_known_is_not_trained_again(tmp_path):
    known = [Look(1, 0.9, 0.9, 0.0), Look(4, 0.8, 0.8, 0.0), Look(6, 0.7, 0.7, 0.0)]
    assert list(looks(brief.job(brief.PPO), (1, 4, 6), tmp_path, known)) == known
    assert list(tmp_path.iterdir()) == []


def test_no_seed_that_judges_is_drawn_from(tmp_path, monkeypatch):
    seeds, drawn = [], np.random.default_rng

    def watched(seed=None):
        seeds.append(seed)
        return drawn(seed)

    monkeypatch.setattr(validation.np.random, "default_rng", watched)
    list(looks(brief.job(brief.GRADIENT), (1, 6), tmp_path))
    whole = {seed for seed in seeds if isinstance(seed, int)}
    assert set(range(VALIDATION, VALIDATION + 2 * EPISODES)) <= whole
    assert not [seed for seed in whole if HELD_OUT <= seed < 2 * HELD_OUT]
