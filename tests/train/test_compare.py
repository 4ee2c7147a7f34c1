"""The comparison in small: what it writes, what it resumes from, what it refuses."""

import csv
import json
import re

import gymnasium
import pytest

import beamenv
import train.comparison.compare
import train.learning.job
from beamenv.task import resolve_task
from train.cli.evaluations import show_compared
from train.comparison.compare import CLASSICAL, Comparison, Listener, compare, tiers_of, trained
from train.comparison.page import best_rival
from train.controllers.named import named
from train.controllers.policy_files import load_policy
from train.learning.checkpoint import NAME as CHECKPOINT
from train.learning.session import follow
from train.shared.curve import read_curve
from train.shared.interruption import Interrupted

SMALL = Comparison({"duration": 0.05}, {"gradient": 0.2, "ppo": 0.2}, seeds=4)


class Notes(Listener):
    """Remembers what it was told."""

    def __init__(self):
        self.trained, self.evaluated_names, self.from_before = [], [], []

    def resumed(self, name, finished):
        self.from_before.append((name, finished))

    def training(self, name, budget, progress):
        self.trained.append((name, progress))

    def evaluated(self, evaluation):
        self.evaluated_names.append(evaluation.name)


@pytest.fixture(scope="module")
def finished(tmp_path_factory, ticking):
    folder, notes = tmp_path_factory.mktemp("compare") / "small", Notes()
    with ticking(0.02):
        return folder, compare(SMALL, folder, notes), notes


def test_every_piece_is_written(finished):
    folder, _, _ = finished
    written = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    expected = {"configuration.json", "table.csv", "table.md", "episode.png", "learning.png", "poles.png", "report.html"}
    expected |= {f"evaluations/{name}.json" for name in (*CLASSICAL, "gradient", "ppo")}
    for agent in ("gradient", "ppo"):
        expected |= {f"agents/{agent}/{name}" for name in ("weights.npz", "agent.json", "learning.csv", CHECKPOINT)}
    assert expected == {name for name in written if "/tensorboard/" not in name}


def test_the_table_has_every_controller_on_the_same_seeds(finished):
    folder, evaluations, notes = finished
    with (folder / "table.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert sorted(row["controller"] for row in rows) == sorted(notes.evaluated_names)
    costs = [float(row["relative_cost"]) for row in rows]
    assert costs == sorted(costs)
    assert len({evaluation.episodes.seeds for evaluation in evaluations}) == 1
    markdown = (folder / "table.md").read_text()
    assert all(row["controller"] in markdown for row in rows)


def test_every_table_shows_the_tiers_of_laws_and_agents(finished, capsys):
    folder, evaluations, notes = finished
    with (folder / "table.csv").open() as file:
        tiers = {row["controller"]: row["tier"] for row in csv.DictReader(file)}
    expected = [str(named(name).tier) for name in CLASSICAL] + ["1", "1"]
    assert tiers == dict(zip(notes.evaluated_names, expected, strict=True)) and expected.count("3") == 2
    markdown = (folder / "table.md").read_text()
    for name, tier in tiers.items():
        assert f"| {name} | {tier} |" in markdown
    told = "Tiers say what a controller is told and sees"
    assert markdown.count(told) == 1
    assert told in (folder / "report.html").read_text(encoding="utf-8")
    show_compared(evaluations, tiers_of(evaluations))
    assert told in capsys.readouterr().out


def test_the_page_opens_beside_no_control_with_the_best_that_a_real_blade_offers_and_has_them_all(finished):
    folder, evaluations, _ = finished
    page = (folder / "report.html").read_text(encoding="utf-8")
    options = re.findall(r'<option value="(\d+)"( selected)?>(.*?): .*?</option>', page)
    best = sorted(evaluations, key=lambda evaluation: evaluation.relative_cost.value)
    tiers = tiers_of(evaluations)
    first = next(each.name for each in best if tiers[each.name] < 3)
    assert [name for _, selected, name in options if selected] == ["no control", first]
    assert {name for *_, name in options} == {evaluation.name for evaluation in evaluations} - {"none"} | {"no control"}
    (lead,) = re.findall(r'<p class="lead">(.*?)</p>', page)
    assert lead.startswith(f"Under {first}, J ") and f"{evaluations[0].relative_cost.value:.3f}" not in lead
    assert f"{next(each for each in best if each.name == first).relative_cost.value:.3f}" in lead


def test_without_tiers_the_best_is_one_that_sees_readings(finished):
    _, evaluations, _ = finished
    task = gymnasium.make(beamenv.ENV_ID).unwrapped.task
    laws = {name: named(name).build_for(task) for name in CLASSICAL}
    best = best_rival(evaluations[: len(laws)], laws)
    law = next(each for each in laws.values() if each.name == best.name)
    assert law.observes == "observation" and best.name != "no control"


def test_training_reports_its_cost_and_steps(finished):
    folder, _, notes = finished
    for agent in SMALL.budget:
        told = [progress for name, progress in notes.trained if name == agent]
        curve = read_curve(folder / "agents" / agent)
        assert len(told) >= len(curve) > 0
        assert (curve[:, 2] > 0.0).all()
        assert curve[-1, 1] == told[-1].steps  # the policy that is left was looked at
        assert (curve[1:, 1] > curve[:-1, 1]).all()


def test_a_second_run_takes_the_trained_agents(finished, monkeypatch):
    folder, evaluations, _ = finished

    def refuse(*arguments):
        raise AssertionError("trained again")

    monkeypatch.setattr(train.comparison.compare, "run", refuse)
    notes = Notes()
    again = compare(SMALL, folder, notes)
    assert notes.from_before == [("gradient", True), ("ppo", True)]
    assert [evaluation.relative_cost for evaluation in again] == [evaluation.relative_cost for evaluation in evaluations]


def test_an_interrupted_run_keeps_the_agents_it_has(tmp_path, ticking):
    class Impatient(Notes):
        def training(self, name, budget, progress):
            super().training(name, budget, progress)
            if name == "ppo":
                raise ValueError("the machine went down")

    with pytest.raises(ValueError, match="went down"), ticking(0.02):
        compare(SMALL, tmp_path, Impatient())
    assert load_policy(tmp_path / "agents" / "gradient").name
    assert not (tmp_path / "agents" / "ppo" / "agent.json").exists()
    assert json.loads((tmp_path / "configuration.json").read_text())["comparison"]["seeds"] == 4


def test_a_training_that_was_cut_off_resumes_from_its_checkpoint(tmp_path, monkeypatch, ticking):
    def cut_off(training, budget, report, keep, elapsed, aside):
        follow(training, budget, lambda progress: None, keep, elapsed=0.9 * budget.seconds)
        raise ValueError("the machine went down")

    comparison, notes = Comparison({"duration": 0.05}, {"gradient": 10.0}, seeds=2), Notes()
    with ticking(0.4):
        with monkeypatch.context() as patched, pytest.raises(ValueError, match="went down"):
            patched.setattr(train.learning.job, "follow", cut_off)
            compare(comparison, tmp_path)
        compare(comparison, tmp_path, notes)
    assert notes.trained == []  # the checkpoint was that of its end
    assert notes.from_before == [("gradient", False)]
    assert json.loads((tmp_path / "agents" / "gradient" / "agent.json").read_text())["seconds"] >= 10.0


def test_ctrl_c_ends_a_comparison_at_once_and_keeps_no_half_trained_agent(tmp_path, ticking):
    class Hasty(Notes):
        def training(self, name, budget, progress):
            super().training(name, budget, progress)
            if len(self.trained) == 3:
                raise KeyboardInterrupt

    comparison, hasty, patient = Comparison({"duration": 0.05}, {"gradient": 2.0}, seeds=2), Hasty(), Notes()
    with ticking(0.2):
        with pytest.raises(Interrupted):
            compare(comparison, tmp_path, hasty)
        assert hasty.evaluated_names == []
        assert {path.name for path in (tmp_path / "agents" / "gradient").iterdir()} == {CHECKPOINT, "tensorboard"}
        trained(comparison, "gradient", tmp_path, resolve_task(duration=0.05), patient)
    seconds = [[progress.elapsed for _, progress in notes.trained] for notes in (hasty, patient)]
    assert seconds[0] == pytest.approx([0.2, 0.4, 0.6])
    assert seconds[1][0] == pytest.approx(0.8) and seconds[1][-1] >= 2.0
    assert json.loads((tmp_path / "agents" / "gradient" / "agent.json").read_text())["finished"] is True


def test_an_agent_that_says_it_is_unfinished_is_trained_on(tmp_path, ticking):
    comparison, notes = Comparison({"duration": 0.05}, {"gradient": 2.0}, seeds=2), Notes()
    task = resolve_task(duration=0.05)
    path = tmp_path / "agents" / "gradient" / "agent.json"
    with ticking(0.5):
        trained(comparison, "gradient", tmp_path, task, notes)
        whole, count = path.read_bytes(), len(notes.trained)
        trained(comparison, "gradient", tmp_path, task, notes)
        assert (path.read_bytes(), len(notes.trained)) == (whole, count)
        path.write_text(json.dumps(json.loads(whole) | {"finished": False}))
        trained(comparison, "gradient", tmp_path, task, notes)
    assert path.read_bytes() == whole


@pytest.mark.parametrize("content", ["", "{", "[1]", "\0"])
def test_a_damaged_configuration_is_told_with_its_name(content, tmp_path):
    (tmp_path / "configuration.json").write_text(content)
    with pytest.raises(ValueError, match=r"configuration.json' cannot be read|is no configuration of a comparison"):
        compare(Comparison({"duration": 0.05}, {}, seeds=2), tmp_path)
    assert (tmp_path / "configuration.json").read_text() == content


def test_another_comparison_does_not_overwrite_a_folder(finished):
    folder, _, _ = finished
    before = (folder / "configuration.json").read_text()
    with pytest.raises(ValueError, match="holds another comparison"):
        compare(Comparison(SMALL.environment, SMALL.budget, seeds=5), folder)
    assert (folder / "configuration.json").read_text() == before


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"budget": {"dreamer": 1.0}}, "comparison.budget has no field 'dreamer': its fields are gradient, ppo"),
        ({"budget": {"ppo": -1.0}}, "comparison.budget.ppo is -1.0, but must be a positive number"),
        ({"seeds": 1}, "comparison.seeds is 1, but must be a whole number from 2 to 1e[+]06"),
    ],
)
def test_a_comparison_that_makes_no_sense_is_refused(arguments, sentence):
    with pytest.raises(ValueError, match=sentence):
        Comparison(**arguments)


def test_unknown_names_are_refused():
    with pytest.raises(ValueError, match="controller is 'pid', but must be one of .*lqg, lqg-load"):
        named("pid")


def tree(folder):
    return {path.relative_to(folder): path.read_bytes() if path.is_file() else None for path in folder.rglob("*")}


def test_a_comparison_without_loads_leaves_no_folder(tmp_path):
    with pytest.raises(ValueError, match="zero|rest|quiet"):
        compare(Comparison({"duration": 0.05, "scenario": "quiet"}, {"gradient": 1.0}, seeds=2), tmp_path / "new")
    assert not list(tmp_path.iterdir())


def test_what_is_refused_while_the_first_agent_is_trained_leaves_no_configuration(tmp_path, monkeypatch):
    def refuse(*arguments, **named):
        raise ValueError("nothing can be learnt here.")

    monkeypatch.setattr(train.comparison.compare, "run", refuse)
    with pytest.raises(ValueError, match="nothing can be learnt"):
        compare(Comparison({"duration": 0.05}, {"gradient": 1.0}, seeds=2), tmp_path / "new")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("table.csv", "mine", "holds table.csv, which no comparison there tells of: name another folder"),
        ("agents/mine.txt", "mine", "holds agents, which no comparison there tells of"),
        ("configuration.json", '{"seeds": [1, 2]}', "is no configuration of a comparison: name another folder"),
    ],
)
def test_what_no_comparison_made_is_not_replaced(name, content, words, tmp_path):
    path = tmp_path / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(content)
    before = tree(tmp_path)
    with pytest.raises(ValueError, match=words):
        compare(Comparison({"duration": 0.05}, {}, seeds=2), tmp_path)
    assert tree(tmp_path) == before


def test_files_of_a_training_and_of_others_stay_as_they_are(tmp_path):
    for name in ("agent.json", "weights.npz", "learning.csv", CHECKPOINT, "notes.txt", "0/agent.json"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(name)
    before = tree(tmp_path)
    compare(Comparison({"duration": 0.05}, {}, seeds=2), tmp_path)
    after = tree(tmp_path)
    assert {name: after.get(name) for name in before} == before and len(after) > len(before)


CURVES = {
    "line 1 '', but must have the columns elapsed,steps,updates,cost": "",
    "line 1 'a,b', but must have the columns": "a,b\n1,2\n",
    "line 3 '2,x,2,1', but must have numbers of elapsed,steps,updates,cost": "elapsed,steps,updates,cost\n1,1,1,nan\n2,x,2,1\n",
    "line 2 '1,1,1', but must have numbers": "elapsed,steps,updates,cost\n1,1,1\n",
    "line 2 '1,1,1,1,1', but must": "elapsed,steps,updates,cost\n1,1,1,1,1\n",
    "line 2 'inf,1,1,1', but must": "elapsed,steps,updates,cost\ninf,1,1,1\n",
    "cannot be read as the CSV file of a learning curve": 'elapsed,steps,updates,cost\n"1,1,1,1\n',
}


@pytest.mark.parametrize("words", CURVES)
def test_a_damaged_learning_curve_is_told_with_its_file_and_line(words, tmp_path):
    (tmp_path / "learning.csv").write_text(CURVES[words])
    with pytest.raises(ValueError, match=f"^file .*learning.csv' .*{words}") as told:
        read_curve(tmp_path)
    assert "\n" not in str(told.value)


def test_a_learning_curve_that_is_no_text_or_not_there_is_told(tmp_path):
    with pytest.raises(ValueError, match="learning.csv' cannot be read: No such file"):
        read_curve(tmp_path)
    (tmp_path / "learning.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match="learning.csv' cannot be read as the CSV file of a learning curve"):
        read_curve(tmp_path)
