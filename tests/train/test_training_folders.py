"""Folders of trainings: what they hold is neither lost nor mixed, and damaged checkpoints are told."""

import os
import pickle
from dataclasses import replace

import pytest
import torch

from tests.train.brief import GRADIENT, PPO, RECURRENT, SAC, TQC, assert_same, ignore, interrupted_after, job, weights
from train.controllers.policy_files import load_policy
from train.learning.checkpoint import FORMAT, NAME, read_checkpoint, write_checkpoint
from train.learning.job import run

STABLE_BASELINES = [PPO, RECURRENT, SAC, TQC]


def test_a_folder_s_training_is_neither_overwritten_nor_taken_for_another(tmp_path):
    run(job(PPO, updates=1), tmp_path, ignore)
    before = (tmp_path / NAME).read_bytes()
    with pytest.raises(ValueError, match="holds a training already"):
        run(job(PPO, updates=1), tmp_path, ignore)
    with pytest.raises(ValueError, match=r"another training, of .* with seed 0 \(seed differs\): resume with the same arguments"):
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
        ({"weights": 1}, f"is of format None where this version of beamenv reads {FORMAT}"),
        ({"format": FORMAT + 1}, f"is of format {FORMAT + 1} where"),
        ({"format": FORMAT, "identity": ""}, "has no 'training'"),
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
    with pytest.raises(ValueError, match=r"another training, of .* in mine.toml with seed 0 \(scenario's content differs\)"):
        run(job(PPO, "mine.toml"), tmp_path / "agent", ignore, resume=True)
