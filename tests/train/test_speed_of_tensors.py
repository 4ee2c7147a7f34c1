"""The speed of batches of tensors: what is measured, and what is said of it."""

import pytest

pytest.importorskip("torch")

from train.speed import __main__ as command
from train.speed import tensors
from train.speed.tensors import rate, rates


def test_steps_are_counted_over_the_time_they_take():
    ticks = iter(range(1000))
    found = rate(lambda: next(ticks), 7, 1e-6)
    assert found > 0.0
    assert next(ticks) >= 10  # five that do not count, and five at least that do


def test_each_size_is_measured_beside_cartpole(monkeypatch):
    monkeypatch.setattr(tensors, "SIZES", {"cpu": (2, 3)})
    found = list(rates("cpu", 0.01))
    assert [(each.label, each.size) for each in found] == [("CartPole-v1, NumPy", 4096), ("plain", 2), ("plain", 3)]
    assert all(each.rate > 0.0 for each in found)


def test_the_command_says_that_it_is_no_gpu(monkeypatch, capsys):
    monkeypatch.setattr(tensors, "SIZES", {"cpu": (2,)})
    assert command.main(["--device", "cpu", "--seconds", "0.01"]) == 0
    told = capsys.readouterr().out
    assert "not measured on a GPU" in told and "× CartPole" in told


@pytest.mark.parametrize(
    "words", [["--device", "cuda:99"], ["--seconds", "nan"], ["--ppo", "-1"], ["--dtype", "float16"], ["--scenario", "x"]]
)
def test_a_wrong_option_is_refused_in_one_sentence(words, capsys):
    assert command.main(words) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_the_example_that_it_runs_is_there():
    assert command.EXAMPLE.is_file()
