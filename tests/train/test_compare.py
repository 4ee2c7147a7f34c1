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
from train.comparison.compare import CLASSICAL, Comparison, Listener, compare, read_curve, trained
from train.comparison.page import shown_pair
from train.controllers.named import named
from train.controllers.policy_files import load_policy
from train.learning.checkpoint import NAME as CHECKPOINT
from train.learning.session import follow
from train.shared.interruption import Interrupted

SMALL = Comparison({"duration": 0.05}, {"gradient": 0.5, "ppo": 0.5}, seeds=4)


class Notes(Listener):
    """Remembers what it was told."""

    def __init__(self):
        self.trained, self.evaluated_names = [], []

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


def test_the_page_shows_the_best_law_with_sensors_beside_the_best_agent(finished):
    folder, evaluations, notes = finished
    page = (folder / "report.html").read_text(encoding="utf-8")
    figures = dict(re.findall(r'data-figure="(.*?)">(.*?)</script>', page))
    shown = [json.loads(figures[name])["layout"]["title"]["text"] for name in ("blade-left", "blade-right")]
    best = sorted(evaluations, key=lambda evaluation: evaluation.relative_cost.value)
    agents = notes.evaluated_names[len(CLASSICAL) :]
    laws = [each.name for each in best if each.name not in agents and "true state" not in each.name]
    assert shown == [laws[0], next(each.name for each in best if each.name in agents)]
    assert all(evaluation.name in page for evaluation in evaluations)


def test_without_agents_the_page_shows_no_control_beside_the_best_law(finished):
    _, evaluations, _ = finished
    design = gymnasium.make(beamenv.ENV_ID).unwrapped.task.design
    laws = {name: named(name).build(design) for name in CLASSICAL}
    left, right = shown_pair(evaluations[: len(laws)], laws)
    assert left is laws["none"]
    assert right.observes == "observation" and right is not left


def test_training_reports_its_cost_and_steps(finished):
    folder, _, notes = finished
    for agent in SMALL.budget:
        told = [progress for name, progress in notes.trained if name == agent]
        curve = read_curve(folder, agent)
        assert len(curve) == len(told) > 0
        assert (curve[:, 2] > 0.0).all()
        assert (curve[1:, 1] > curve[:-1, 1]).all()


def test_a_second_run_takes_the_trained_agents(finished, monkeypatch):
    folder, evaluations, _ = finished

    def refuse(*arguments):
        raise AssertionError("trained again")

    monkeypatch.setattr(train.comparison.compare, "run", refuse)
    again = compare(SMALL, folder)
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
    def cut_off(training, budget, report, keep, elapsed):
        follow(training, budget, lambda progress: None, keep, elapsed=0.9 * budget.seconds)
        raise ValueError("the machine went down")

    comparison, notes = Comparison({"duration": 0.05}, {"gradient": 10.0}, seeds=2), Notes()
    with ticking(0.4):
        with monkeypatch.context() as patched, pytest.raises(ValueError, match="went down"):
            patched.setattr(train.learning.job, "follow", cut_off)
            compare(comparison, tmp_path)
        compare(comparison, tmp_path, notes)
    assert notes.trained == []  # the checkpoint was that of its end
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
        trained(comparison, "gradient", tmp_path, resolve_task(duration=0.05).design_plant, patient)
    seconds = [[progress.elapsed for _, progress in notes.trained] for notes in (hasty, patient)]
    assert seconds[0] == pytest.approx([0.2, 0.4, 0.6])
    assert seconds[1][0] == pytest.approx(0.8) and seconds[1][-1] >= 2.0
    assert json.loads((tmp_path / "agents" / "gradient" / "agent.json").read_text())["finished"] is True


def test_an_agent_that_says_it_is_unfinished_is_trained_on(tmp_path, ticking):
    comparison, notes = Comparison({"duration": 0.05}, {"gradient": 2.0}, seeds=2), Notes()
    plant = resolve_task(duration=0.05).design_plant
    path = tmp_path / "agents" / "gradient" / "agent.json"
    with ticking(0.5):
        trained(comparison, "gradient", tmp_path, plant, notes)
        whole, count = path.read_bytes(), len(notes.trained)
        trained(comparison, "gradient", tmp_path, plant, notes)
        assert (path.read_bytes(), len(notes.trained)) == (whole, count)
        path.write_text(json.dumps(json.loads(whole) | {"finished": False}))
        trained(comparison, "gradient", tmp_path, plant, notes)
    assert path.read_bytes() == whole


@pytest.mark.parametrize("content", ["", "{", "[1]", "\0"])
def test_a_damaged_configuration_is_told_with_its_name(content, tmp_path):
    (tmp_path / "configuration.json").write_text(content)
    with pytest.raises(ValueError, match=r"configuration.json' cannot be read|holds another comparison"):
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
        ({"seeds": 1}, "comparison.seeds is 1, but must be a whole number not below 2"),
    ],
)
def test_a_comparison_that_makes_no_sense_is_refused(arguments, sentence):
    with pytest.raises(ValueError, match=sentence):
        Comparison(**arguments)


def test_unknown_names_are_refused():
    with pytest.raises(ValueError, match="controller is 'pid', but must be one of .*lqg, lqg-load"):
        named("pid")
