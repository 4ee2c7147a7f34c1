"""Several trainings: each in its folder, and none the worse for the others."""

import csv
import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from tests.train.brief import GRADIENT, PPO, SHORT, assert_same, ignore, interrupted_after, job, weights
from train.cli.app import app
from train.cli.train import homes_of
from train.learning.checkpoint import NAME
from train.learning.job import run, teacher_for
from train.learning.several import Stretch, Trained, files, held, is_finished, train_all, trained_on, written
from train.workers.parcel import packed, unpacked
from train.workers.workers import Workers

BRIEF = 'agent = "gradient"\ntitle = "Brief"\nupdates = 2\n[settings]\nepisodes = 8\nwindow = 20\n'


def silent(home, progress):
    pass


def about(folder):
    """What an agent tells but how long it took."""
    return json.loads((folder / "agent.json").read_text()) | {"seconds": 0.0}


def trained_in_stretches(training, home, seconds):
    """As workers do it, one stretch after the other; how many there were."""
    stretch, count = Stretch(held(training), home, None, seconds), 0
    while True:
        made, count = trained_on(unpacked(packed(stretch, files(stretch.job)))), count + 1
        written(home, made.files, begins=stretch.checkpoint is None)
        if made.finished:
            return count
        stretch = replace(stretch, checkpoint=made.files[NAME])


@pytest.mark.parametrize("recipe", [GRADIENT, PPO], ids=["gradient", "ppo"])
def test_a_training_in_stretches_of_one_update_is_the_whole_one(recipe, tmp_path):
    run(job(recipe), tmp_path / "whole", ignore)
    assert trained_in_stretches(job(recipe), tmp_path / "parts", 0.0) == 6
    assert_same(weights(tmp_path / "whole"), weights(tmp_path / "parts"))
    assert about(tmp_path / "whole") == about(tmp_path / "parts")


def test_what_a_training_reads_goes_with_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lost.toml").write_text("[plants]\nbank = 2\ndamping_ratio = [0.003, 0.02]\n")
    (tmp_path / "fast.toml").write_text("speed = 150.0\n")
    teacher = tmp_path / "teacher"
    scenario, environment = "lost.toml", {**SHORT, "blade": "fast.toml"}
    run(replace(job(GRADIENT, scenario, updates=1), environment=environment), teacher, ignore)
    training = replace(job(PPO, scenario), teacher=teacher, environment=environment)
    told, taught = training.told(), weights(teacher)
    parcel = packed(held(training), files(held(training)))
    for name in ("lost.toml", "fast.toml", "teacher/weights.npz", "teacher/agent.json"):
        (tmp_path / name).unlink()
    there = unpacked(parcel)
    assert there.told() == told
    assert_same(teacher_for(there.teacher, there.tasks()).weights, taught)


def test_several_are_resumed_each_from_where_it_is(tmp_path):
    trainings = {tmp_path / str(seed): job(GRADIENT, seed=seed) for seed in range(3)}
    for home, training in trainings.items():
        run(training, tmp_path / "alone" / home.name, ignore)
    run(trainings[tmp_path / "0"], tmp_path / "0", ignore)
    run(trainings[tmp_path / "1"], tmp_path / "1", interrupted_after(3))
    touched = (tmp_path / "0" / "agent.json").stat().st_mtime_ns
    with pytest.raises(ValueError, match="holds a training already: resume or overwrite it"):
        train_all(trainings, Workers(), silent)
    assert train_all(trainings, Workers(), silent, resume=True) == Trained({home: [home] for home in trainings})
    assert (tmp_path / "0" / "agent.json").stat().st_mtime_ns == touched
    for home in trainings:
        assert is_finished(home)
        assert_same(weights(tmp_path / "alone" / home.name), weights(home))


def test_an_interruption_ends_all_of_them_and_keeps_what_is_learnt(tmp_path):
    trainings = {tmp_path / str(seed): job(GRADIENT, seed=seed) for seed in range(3)}

    def told(home, progress):
        interrupted_after(2)(progress) if home.name == "1" else None

    assert list(train_all(trainings, Workers(), told).places) == [tmp_path / "0", tmp_path / "1"]
    assert [is_finished(home) for home in trainings] == [True, False, False]
    assert (tmp_path / "1" / NAME).is_file() and not (tmp_path / "2").exists()


@pytest.mark.parametrize(
    "workers", [pytest.param(Workers(), id="here"), pytest.param(Workers(2), id="processes", marks=pytest.mark.slow)]
)
def test_a_training_that_fails_costs_no_other(workers, tmp_path):
    teacher = tmp_path / "teacher"
    run(job(GRADIENT, updates=1), teacher, ignore)
    taught = replace(job(GRADIENT, seed=1), teacher=teacher)
    trainings = {tmp_path / "first": taught, tmp_path / "second": job(GRADIENT), tmp_path / "third": replace(taught, seed=2)}
    trained = train_all(trainings, workers, silent)
    why = "agent = 'gradient' must start from scratch: only ppo, sac and tqc start from a teacher"
    assert trained == Trained(
        {tmp_path / "second": [tmp_path / "second"]}, dict.fromkeys(map(tmp_path.joinpath, ("first", "third")), why)
    )
    run(job(GRADIENT), tmp_path / "alone", ignore)
    assert_same(weights(tmp_path / "second"), weights(tmp_path / "alone"))
    with pytest.raises(ValueError, match="must start from scratch"):
        train_all({tmp_path / "only": taught}, workers, silent)


def test_none_of_several_begins_before_all_are_looked_at(tmp_path):
    trainings = {tmp_path / str(seed): job(GRADIENT, seed=seed) for seed in range(2)}
    run(trainings[tmp_path / "1"], tmp_path / "1", ignore)
    with pytest.raises(ValueError, match="1' holds a training already"):
        train_all(trainings, Workers(), silent)
    assert not (tmp_path / "0").exists()


def command(*words):
    return CliRunner().invoke(app, ["train", *words])


def test_each_agent_scenario_and_seed_has_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "brief.toml").write_text(BRIEF)
    words = (
        "mine",
        "--recipe",
        "brief.toml",
        "--scenario",
        "white",
        "--scenario",
        "pulse",
        "--seed",
        "3",
        "--seed",
        "4",
        "--jobs",
        "1",
        "--looks",
        "0",
    )
    result = command(*words)
    assert result.exit_code == 0, result.output
    names = {f"mine-{scenario}-{seed}" for scenario in ("white", "pulse") for seed in (3, 4)}
    assert {each.name for each in (tmp_path / "results" / "agents").iterdir()} == names
    assert {name for name in names if f"{name} saved in results/agents/{name}" in result.output} == names
    assert command(*words[:3], "--scenario", "pulse", "--seed", "4", "--looks", "0", "--folder", "alone").exit_code == 0
    assert_same(weights(tmp_path / "alone"), weights(tmp_path / "results/agents/mine-pulse-4"))
    assert command(*words, "--resume").exit_code == 0
    assert "holds a training already" in command(*words).stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("ppo", "--seed", "1", "--seed", "1"), "lead twice to the folder 'results/agents/ppo-nominal-1'"),
        (("ppo", "sac", "--recipe", "brief.toml"), "recipe = 'brief.toml' is of one agent: name one alone"),
        (("ppo", "dreamer"), "dreamer"),
        (("ppo", "--seed", "0", "--seed", "-1"), "--seed is '-1', but must be at least 0"),
        (("ppo", "--cluster", "nowhere"), "cluster is 'nowhere', but must be local"),
    ],
)
def test_what_no_training_can_be_made_of_is_refused_before_any_begins(words, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = command(*words)
    assert result.exit_code == 2 and said in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_the_command_says_of_each_that_failed_why_and_saves_the_others(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "brief.toml").write_text(BRIEF)
    words = ["mine", "--recipe", "brief.toml", "--scenario", "quiet", "--scenario", "white", "--jobs", "1", "--looks", "0"]
    result = command(*words)
    assert result.exit_code == 1
    first, second = result.stdout.splitlines()
    assert first == "mine-white-0 saved in results/agents/mine-white-0"
    assert second.startswith("next: beamenv evaluate results/agents/mine-white-0 --scenario white")
    said = "beamenv: mine-quiet-0 failed: scenario leaves the blade at rest: there is nothing to learn in it."
    assert [line for line in result.stderr.splitlines() if line.startswith("beamenv")] == [said]


def test_the_last_lines_are_the_cost_on_validation_episodes_and_the_next_command(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "brief.toml").write_text(BRIEF)
    result = command("mine", "--recipe", "brief.toml", "--scenario", "white", "--looks", "1", "--folder", "own")
    saved, cost, following = result.stdout.splitlines()
    last = list(csv.DictReader((tmp_path / "own" / "learning.csv").read_text().splitlines()))[-1]
    assert cost == f"J / no control on validation episodes, without exploration: {float(last['looked']):.3f}"
    assert (saved, following) == ("mine saved in own", "next: beamenv evaluate own --scenario white")


def test_scenarios_that_are_kept_for_judging_are_remarked_on(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "brief.toml").write_text(BRIEF)
    scenarios = ("--scenario", "long-delay", "--scenario", "delay")
    result = command("mine", "--recipe", "brief.toml", *scenarios, "--looks", "0", "--jobs", "1", "--updates", "1")
    remarks = [line for line in result.stderr.splitlines() if "kept for judging" in line]
    assert remarks == ["beamenv: long-delay is kept for judging: it cannot judge an agent that was trained on it."]


def test_of_one_training_the_folder_is_its_own_of_several_it_holds_theirs(tmp_path):
    one, other = ("ppo", "nominal", 0), ("ppo", "a/gust.toml", 1)
    assert list(homes_of([one], tmp_path)) == [tmp_path]
    assert list(homes_of([one, other], tmp_path)) == [tmp_path / "ppo-nominal-0", tmp_path / "ppo-gust-1"]


def test_an_interrupted_command_of_several_tells_the_one_that_resumes_it(tmp_path, monkeypatch):
    def interrupted(jobs, *rest):
        home = next(iter(jobs))
        home.mkdir(parents=True)
        (home / NAME).touch()
        raise KeyboardInterrupt

    monkeypatch.setattr("train.learning.several.train_all", interrupted)
    monkeypatch.chdir(tmp_path)
    told = command("ppo", "sac", "--seed", "3", "--seed", "4", "--overwrite").stderr
    assert told == "beamenv: interrupted: with `beamenv train ppo sac --seed 3 --seed 4 --resume` it resumes.\n"
