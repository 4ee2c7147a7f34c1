"""Folders of trainings: what they hold is neither lost nor mixed, and damaged checkpoints are told."""

import os
import pickle
from dataclasses import replace

import numpy as np
import pytest
import torch

from train.controllers.policy_files import load_policy
from train.learning.checkpoint import NAME, read_checkpoint, write_checkpoint
from train.learning.job import Job, run
from train.learning.recipe import parsed
from train.learning.session import Budget

SHORT = {"duration": 0.02}  # 40 control intervals


ROWS = "agent = {!r}\ntitle = 'Brief'\nupdates = 6\n[settings]\n"


CRITICS = "critic_units = 16\ncritic_first = 1\ncritic_steps = 2\ngradient_steps = 2\n"


GRADIENT = parsed(ROWS.format("gradient") + "episodes = 8\nwindow = 10\n[settings.actor_settings]\nunits = 6\n", "brief")


PPO = parsed(ROWS.format("ppo") + "blades = 8\nhistory = 3\nrollout = 4\nbatch = 32\nunits = 8\n", "brief")


SAC = parsed(
    ROWS.format("sac") + "blades = 8\nhistory = 3\nrollout = 4\nbatch = 16\nfirst = 32\nbuffer = 256\nunits = 8\n" + CRITICS,
    "brief",
)


TQC = parsed(
    ROWS.format("tqc") + "blades = 8\nhistory = 3\nrollout = 4\nbatch = 16\nfirst = 32\nbuffer = 64\nunits = 8\n" + CRITICS, "brief"
)


RECURRENT = parsed(ROWS.format("recurrent-ppo") + "blades = 8\nrollout = 4\nbatch = 32\nunits = 8\n", "brief")


def job(recipe, scenario="nominal", seed=0, updates=6):
    return Job(recipe.agent, recipe, scenario, seed, Budget(updates=updates), SHORT)


def ignore(progress):
    pass


def interrupted_after(updates):
    def report(progress):
        if progress.updates == updates:
            raise KeyboardInterrupt

    return report


def weights(folder):
    with np.load(folder / "weights.npz", allow_pickle=False) as arrays:
        return {name: arrays[name] for name in arrays.files}


def assert_same(first, second):
    assert set(first) == set(second)
    for name, weight in first.items():
        np.testing.assert_array_equal(weight, second[name])


STABLE_BASELINES = [PPO, RECURRENT, SAC, TQC]


def test_a_folder_s_training_is_neither_overwritten_nor_taken_for_another(tmp_path):
    run(job(PPO, updates=1), tmp_path, ignore)
    before = (tmp_path / NAME).read_bytes()
    with pytest.raises(ValueError, match="holds a training already"):
        run(job(PPO, updates=1), tmp_path, ignore)
    with pytest.raises(ValueError, match="holds another training"):
        run(job(PPO, updates=1, seed=1), tmp_path, ignore, resume=True)
    assert (tmp_path / NAME).read_bytes() == before
    with pytest.raises(ValueError, match="must hold a checkpoint"):
        run(job(PPO), tmp_path / "nothing", ignore, resume=True)


def test_an_agent_without_a_checkpoint_is_not_overwritten_unless_told(tmp_path):
    recipe = replace(GRADIENT, settings=replace(GRADIENT.settings, runs=2))
    for name, made in (("one", PPO), ("several", recipe)):
        folder = tmp_path / name
        run(job(made, updates=1), folder, ignore)
        (folder / NAME).unlink()
        before = {path: path.read_bytes() for path in folder.rglob("*.*") if path.is_file()}
        with pytest.raises(ValueError, match="holds a trained agent already: resume or overwrite it, or name another folder"):
            run(job(SAC, updates=1), folder, ignore)
        assert {path: path.read_bytes() for path in folder.rglob("*.*") if path.is_file()} == before
        run(job(SAC, updates=1), folder, ignore, overwrite=True)
        assert load_policy(folder).name == "SAC"
        assert not list(folder.glob("*/agent.json"))
    with pytest.raises(ValueError, match="resume and overwrite must not both be given"):
        run(job(SAC, updates=1), folder, ignore, resume=True, overwrite=True)


def test_what_cannot_be_trained_leaves_the_agent_that_was_to_be_overwritten(tmp_path):
    run(job(PPO, updates=1), tmp_path, ignore)
    before = weights(tmp_path)
    with pytest.raises(ValueError, match="nothing to learn"):
        run(job(PPO, "quiet"), tmp_path, ignore, overwrite=True)
    assert_same(before, weights(tmp_path))


def test_two_trainings_do_not_share_a_folder(tmp_path):
    def second(progress):
        with pytest.raises(ValueError, match=f"is in use by process {os.getpid()}: wait until that has ended, or name another"):
            run(job(PPO, updates=1), tmp_path / "agent", ignore, overwrite=True)

    run(job(GRADIENT, updates=1), tmp_path / "agent", second)
    assert load_policy(tmp_path / "agent").name == "gradient (GRU)"


class Bomb:
    """Unpickled, it leaves a file behind."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return open, (str(self.path), "w")


@pytest.mark.parametrize("write", [torch.save, lambda content, path: path.write_bytes(pickle.dumps(content))])
def test_a_checkpoint_executes_no_code(write, tmp_path):
    write({"training": Bomb(tmp_path / "trace")}, tmp_path / NAME)
    with pytest.raises(ValueError, match="must be a checkpoint of tensors and numbers"):
        read_checkpoint(tmp_path)
    assert not (tmp_path / "trace").exists()


def test_half_a_checkpoint_is_told_in_a_sentence(tmp_path):
    write_checkpoint(tmp_path, {"weights": torch.arange(100.0)})
    torch.testing.assert_close(read_checkpoint(tmp_path)["weights"], torch.arange(100.0))
    whole = (tmp_path / NAME).read_bytes()
    for length in (0, 1, len(whole) // 2):
        (tmp_path / NAME).write_bytes(whole[:length])
        with pytest.raises(ValueError, match="must be a checkpoint"):
            read_checkpoint(tmp_path)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ([1, 2], "holds a list"),
        ({"weights": 1}, "is of format None where this version of beamenv reads 2"),
        ({"format": 3}, "is of format 3 where"),
        ({"format": 2, "identity": ""}, "has no 'training'"),
    ],
)
def test_another_kind_of_checkpoint_is_told_with_the_file_s_name(content, sentence, tmp_path):
    torch.save(content, tmp_path / NAME)
    with pytest.raises(ValueError, match=f"checkpoint.pt' must be a checkpoint .* but {sentence}"):
        run(job(PPO), tmp_path, ignore, resume=True)


@pytest.mark.parametrize("recipe", [GRADIENT, *STABLE_BASELINES], ids=lambda recipe: recipe.agent)
def test_a_checkpoint_whose_state_does_not_fit_is_told_with_the_file_s_name(recipe, tmp_path):
    run(job(recipe), tmp_path, interrupted_after(1))
    whole = read_checkpoint(tmp_path)
    for wrong in ({}, [], {**whole["training"], "counters": {}}, None):
        write_checkpoint(tmp_path, {**whole, "training": wrong})
        with pytest.raises(ValueError, match="checkpoint.pt' must be a checkpoint .* a state that does not fit this training"):
            run(job(recipe), tmp_path, ignore, resume=True)


def test_a_scenario_file_that_has_changed_is_another_training(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text("[plants]\nbank = 2\ndamping_ratio = [0.003, 0.02]\n")
    run(job(PPO, "mine.toml"), tmp_path / "agent", interrupted_after(1))
    (tmp_path / "mine.toml").write_text("[plants]\nbank = 2\ndamping_ratio = [0.004, 0.02]\n")
    with pytest.raises(ValueError, match="holds another training"):
        run(job(PPO, "mine.toml"), tmp_path / "agent", ignore, resume=True)
