"""A tuning in a folder: what is kept, resumed, chosen and written; without Ray, whose part trials one after another take."""

import json
import sys
from dataclasses import replace
from types import ModuleType, SimpleNamespace

import pytest
from typer.testing import CliRunner

from tests.train import brief
from train.cli.app import app
from train.learning.recipe import load_recipe
from train.learning.recipe_file import as_toml
from train.tuning.records import FAILED, FINISHED, STOPPED, Record, finished, keep, known, rows
from train.tuning.space import space_of
from train.tuning.trial import Look
from train.tuning.tuning import Tuning, tune

COSTS = (0.9, 0.95, 0.7, 0.8)


def tuning(trials=4, **changed):
    given = {"name": "mine", "recipe": brief.GRADIENT, "scenario": "nominal", "seed": 0, "environment": brief.SHORT, **changed}
    return Tuning(**given, space=space_of(given["recipe"]), trials=trials)


@pytest.fixture
def ran(monkeypatch):
    """Trials that were run; trial 1 is stopped at its first rung, and whatever ``ran.fails`` says fails."""
    made = SimpleNamespace(trials=[], interrupted=None, fails=(), plan=None)

    def search(plan, found, cluster, side_by_side):
        made.plan, records = plan, list(plan.records)
        for record in plan.records:
            if record.ended:
                continue
            if record.trial == made.interrupted:
                raise KeyboardInterrupt
            made.trials.append(record.trial)
            if record.trial in made.fails:
                ended = replace(record, ended=FAILED, sentence="ValueError: it cannot be")
            else:
                at = plan.rungs[:1] if record.trial == 1 else plan.rungs
                for updates in at:
                    record = record.looked(Look(updates, COSTS[record.trial % 4], 0.75, 1.0))
                    found(record)
                ended = replace(record, ended=STOPPED if record.trial == 1 else FINISHED)
            found(ended)
            records[record.trial] = ended
        return records

    module = ModuleType("train.tuning.search")
    module.search, module.Search = search, SimpleNamespace
    module.Search = lambda jobs, records, rungs, folder: SimpleNamespace(jobs=jobs, records=records, rungs=rungs, folder=folder)
    monkeypatch.setitem(sys.modules, "train.tuning.search", module)
    return made


def ignore(records):
    pass


def test_the_best_of_those_that_had_all_their_updates_is_written(ran, tmp_path):
    tuned = tune(tuning(), tmp_path, ignore)
    assert tuned.chosen.trial == 2
    assert [each.ended for each in tuned.records] == ["finished", "stopped", "finished", "finished"]
    assert load_recipe(tmp_path / "recipe.toml") == tuning().job(2).recipe == tuned.recipe
    text = (tmp_path / "recipe.toml").read_text()
    assert "trial 2 of 4 of mine on nominal, seed 0" in text
    assert "seeds from 3000000 on: 0.7000, of the recipe as it was 0.9000" in text
    assert len((tmp_path / "trials.csv").read_text().splitlines()) == 5


def test_all_trials_have_one_seed_and_one_budget(ran, tmp_path):
    tune(tuning(seed=3), tmp_path, ignore)
    assert [job.seed for job in ran.plan.jobs] == 4 * [3]
    assert [job.budget for job in ran.plan.jobs] == 4 * [ran.plan.jobs[0].budget]
    assert {job.recipe.updates for job in ran.plan.jobs} == {ran.plan.jobs[0].budget.updates}


def test_an_interruption_loses_no_trial_and_the_same_call_resumes(ran, tmp_path):
    ran.interrupted = 2
    with pytest.raises(KeyboardInterrupt):
        tune(tuning(), tmp_path, ignore)
    assert ran.trials == [0, 1]
    assert not (tmp_path / "recipe.toml").exists()
    ran.interrupted = None
    tuned = tune(tuning(), tmp_path, ignore)
    assert ran.trials == [0, 1, 2, 3]
    assert tuned.chosen.trial == 2


def test_what_trials_read_goes_with_them(ran, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "calm.toml").write_text("sensor_noise = false\n")
    (tmp_path / "fast.toml").write_text("speed = 150.0\n")
    given = tuning(scenario="calm.toml", environment={**brief.SHORT, "blade": "fast.toml"})
    here = given.job(1).told()
    tune(given, tmp_path / "made", ignore)
    for name in ("calm.toml", "fast.toml"):
        (tmp_path / name).unlink()
    assert ran.plan.jobs[1].told() == here


def test_what_is_finished_is_not_run_again_but_more_trials_are(ran, tmp_path):
    first = tune(tuning(), tmp_path, ignore)
    assert tune(tuning(), tmp_path, ignore) == first
    assert ran.trials == [0, 1, 2, 3]
    more = tune(tuning(6), tmp_path, ignore)
    assert ran.trials == [0, 1, 2, 3, 4, 5]
    assert more.records[:4] == first.records


@pytest.mark.parametrize(
    "changed",
    [{"seed": 1}, {"recipe": replace(brief.GRADIENT, updates=7)}, {"scenario": "delay"}, {"environment": {"duration": 0.03}}],
    ids=lambda changed: next(iter(changed)),
)
def test_a_folder_of_another_tuning_is_refused_unless_it_is_overwritten(ran, tmp_path, changed):
    tune(tuning(), tmp_path, ignore)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*.*")}
    with pytest.raises(ValueError, match="holds another tuning: overwrite it, or name another folder"):
        tune(tuning(**changed), tmp_path, ignore)
    assert {path: path.read_bytes() for path in tmp_path.rglob("*.*")} == before
    tune(tuning(**changed), tmp_path, ignore, overwrite=True)
    assert ran.trials == 2 * [0, 1, 2, 3]


def test_settings_that_fail_are_left_out_and_the_recipe_s_own_failure_is_told(ran, tmp_path):
    ran.fails = (2,)
    tuned = tune(tuning(), tmp_path / "one", ignore)
    assert tuned.chosen.trial == 3
    assert tuned.records[2].sentence == "ValueError: it cannot be"
    ran.fails = (0,)
    with pytest.raises(ValueError, match="recipe 'mine' fails as it is: ValueError: it cannot be."):
        tune(tuning(), tmp_path / "other", ignore)
    assert not (tmp_path / "other" / "recipe.toml").exists()


def test_progress_is_told_of_every_look(ran, tmp_path):
    told = []
    tune(tuning(), tmp_path, lambda records: told.append([(each.updates, each.ended) for each in records]))
    assert told[0] == 4 * [(0, "")]
    assert told[1] == [(1, ""), *3 * [(0, "")]]
    assert told[-1] == [(6, "finished"), (1, "stopped"), (6, "finished"), (6, "finished")]


def test_of_equals_the_earlier_is_the_best_and_none_that_was_stopped(tmp_path):
    looks = (Look(6, 0.5, 0.6, 1.0),)
    records = [Record(2, {}, looks, FINISHED), Record(1, {}, looks, FINISHED), Record(3, {}, (Look(1, 0.1, 0.1, 0.0),), STOPPED)]
    assert [each.trial for each in finished(records)] == [1, 2]
    assert [row["cost"] for row in rows(records)] == [0.5, 0.5, 0.1]


@pytest.mark.parametrize(
    "content", ["[1]", '{"trial": 0}', '{"trial": 0, "settings": {"x": 2}, "looks": [], "ended": "", "sentence": ""}']
)
def test_a_record_that_is_damaged_or_of_other_settings_is_told(tmp_path, content):
    fresh = Record(0, {"x": 1})
    keep(tmp_path, fresh)
    assert known(tmp_path, fresh) == fresh
    (tmp_path / "trials" / "0.json").write_text(content)
    with pytest.raises(ValueError, match="must be the record of "):
        known(tmp_path, fresh)


def test_a_record_is_plain_json(tmp_path):
    keep(tmp_path, Record(0, {"x": 1}, (Look(1, 0.5, 0.6, 2.0),), STOPPED))
    assert json.loads((tmp_path / "trials" / "0.json").read_text())["looks"][0]["cost"] == 0.5


def test_one_trial_is_no_tuning(tmp_path):
    with pytest.raises(ValueError, match="trials is 1, but must be a whole number from 2 to 10000"):
        tune(tuning(1), tmp_path / "made", ignore)
    assert not (tmp_path / "made").exists()


def command(*words):
    return CliRunner().invoke(app, ["tune", *words])


def test_the_command_says_what_was_chosen_of_how_many_and_beside_what(ran, tmp_path):
    (tmp_path / "mine.toml").write_text(as_toml(brief.GRADIENT))
    asked = [str(tmp_path / "mine.toml"), "--trials", "4", "--folder", str(tmp_path / "made")]
    told = command(*asked)
    assert told.exit_code == 0
    said = " ".join(told.stdout.split())
    assert "Trial 2 is chosen, of 4, 3 of which had all their updates." in said
    assert "0.700, of the recipe as it is 0.900, on the 32 validation episodes that chose; 0.750 and 0.750 on 32 others" in said
    assert f"beamenv train mine --recipe {tmp_path / 'made' / 'recipe.toml'}" in said
    content = json.loads(command(*asked, "--json").stdout)
    assert content["chosen"] == 2
    assert [each["ended"] for each in content["trials"]] == ["finished", "stopped", "finished", "finished"]
    other = command(*asked, "--updates", "5")
    assert (other.exit_code, other.stdout) == (2, "")
    assert "holds another tuning" in other.stderr


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("dreamer",), "recipe is 'dreamer', but must be one of belief, gradient"),
        (("absent.toml",), "file 'absent.toml' cannot be read"),
        (("gradient", "--updates", "0"), "updates is 0, but must be a whole number"),
        (("gradient", "--cluster", "here"), "cluster is 'here', but must be local, or the address HOST:PORT"),
        (("gradient", "--space", "none.toml"), "file 'none.toml' cannot be read"),
        (("gradient", "--scenario", "gusty"), "scenario"),
    ],
)
def test_what_cannot_be_tuned_is_told_in_a_sentence_and_nothing_is_written(ran, tmp_path, monkeypatch, words, sentence):
    monkeypatch.chdir(tmp_path)
    told = command(*words)
    assert (told.exit_code, told.stdout) == (2, "")
    assert sentence in told.stderr
    assert told.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_cluster_is_not_tuned_on_from_outside(ran, tmp_path, monkeypatch):
    monkeypatch.setattr("train.tuning.tuning.check_address", lambda address: None)
    with pytest.raises(ValueError, match="cluster is 'ray://here:1', but must be local, or HOST:PORT"):
        tune(tuning(), tmp_path, ignore, cluster="ray://here:1")
