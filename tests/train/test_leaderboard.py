"""Entries of the leaderboard: what is run again, what is entered, and what is refused and leaves it as it was."""

import json
import shutil
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from stable_baselines3 import PPO

import beamenv
from tests.train.entries import SHORT, SMALL, agent, refused, rows, run
from train.benchmark import leaderboard, submission
from train.benchmark.leaderboard import COLUMNS, NAME, PAGE, Entry, enter, page, read_leaderboard
from train.benchmark.score import aggregates
from train.benchmark.submission import entrant, submit
from train.shared.lock import held


@pytest.fixture(autouse=True)
def small(monkeypatch, tmp_path):
    """In a folder of one's own."""
    monkeypatch.chdir(tmp_path)
    for name, value in SMALL.items():
        monkeypatch.setattr(submission, name, value)


def test_an_agent_is_run_again_and_entered_with_all_its_runs():
    for number in (0, 1):
        agent(Path("mine", str(number)), gain=0.02 * number, seconds=30.0 + 20.0 * number)
    result = run("--submit", "mine")
    assert result.exit_code == 0, result.output
    (row,) = rows()
    assert tuple(row) == COLUMNS
    about = ("name", "tier", "kind", "runs", "seeds", "training_seconds", "unstable")
    assert [row[name] for name in about] == ["mine", "1", "learned", "2", "2", "40.0", "0.0"]
    cells = [json.loads(path.read_text()) for path in sorted(Path("results/benchmark-submit-mine/cells/nominal").glob("mine-*"))]
    cost = np.mean([cell["series"]["cost"] for cell in cells]) / np.mean(cells[0]["series"]["uncontrolled"])
    assert float(row["cost single fault"]) == pytest.approx(cost, rel=1e-5)
    beside = {path.stem for path in Path("results/benchmark-submit-mine/cells/nominal").iterdir()}
    assert beside == {"none", "lqg", "clairvoyant", "mine-0", "mine-1"}
    text = Path("results", PAGE).read_text()
    assert text == page(read_leaderboard(Path("results", NAME))) and "| mine | 1 | learned |" in text
    shown = " ".join(result.stdout.split())
    assert "mine is on the leaderboard" in shown and "single fault: J / J₀" in shown


@pytest.mark.slow
def test_every_split_has_its_cost_and_its_score(monkeypatch):
    monkeypatch.setattr(submission, "SCENARIOS", ("nominal", "delay", "mid-failure", "delay-failure"))
    monkeypatch.setattr(submission, "ENVIRONMENT", json.dumps({"duration": 0.1}))
    entry, table = submit("lqg", Path("board"))
    of = {name: table.row(name, "lqg").estimates for name in table.scenarios}
    costs = [of["nominal"]["relative_cost"].value + of["delay"]["relative_cost"].value, of["mid-failure"]["relative_cost"].value]
    assert entry.values["cost single fault"] == pytest.approx(0.5 * costs[0], rel=1e-5)
    assert entry.values["cost open"] == pytest.approx(costs[1], rel=1e-5)
    scores = {each.split: each.score.value for each in aggregates(table) if each.controller == "lqg"}
    assert scores and {split: entry.values[f"score {split}"] for split in scores} == pytest.approx(scores, rel=1e-5)
    assert read_leaderboard(Path("board", NAME))[0].values == entry.values


def test_the_same_entry_is_refused_and_another_of_its_name_replaces_it_if_told_to(board):
    before = board.read_text()
    with pytest.raises(
        ValueError, match="^submit = 'lqg' is on the leaderboard .* already, the very same one: there is nothing to"
    ):
        submit("lqg", board.parent, overwrite=True)
    agent(Path("mine"))
    (first,) = read_leaderboard(board)
    enter(board, Entry({**first.values, "name": "mine", "digest": "0" * 16}), overwrite=False)
    with pytest.raises(ValueError, match="^submit = 'mine' is the name of another entry .*: take --overwrite to replace that"):
        submit("mine", board.parent)
    assert board.read_text().startswith(before)
    enter(board, Entry({**first.values, "name": "mine", "digest": "1" * 16}), overwrite=True)
    assert [(each.name, each.digest) for each in read_leaderboard(board)] == [("lqg", first.digest), ("mine", "1" * 16)]
    assert board.read_text().startswith(before) and "1" * 16 in board.with_name(PAGE).read_text()


def entry_like(board, name, digest="0" * 16):
    """The first one by another name."""
    return Entry({**read_leaderboard(board)[0].values, "name": name, "digest": digest})


def test_rows_that_are_entered_at_once_are_all_kept(board):
    start, names = threading.Barrier(8), [f"mine-{number}" for number in range(8)]

    def entered(name):
        mine = entry_like(board, name)
        start.wait()
        enter(board, mine, overwrite=False)

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(entered, names))
    entries = read_leaderboard(board)
    assert sorted(each.name for each in entries) == ["lqg", *names]
    assert board.with_name(PAGE).read_text() == page(entries)


def test_a_row_waits_for_who_is_at_work_there_but_not_for_ever(board, monkeypatch):
    mine = entry_like(board, "mine")
    with ThreadPoolExecutor(1) as pool:
        with held(board.parent):
            waiting = pool.submit(enter, board, mine, overwrite=False)
            time.sleep(0.2)
            assert not waiting.done()
        waiting.result(timeout=10)
    assert [each.name for each in read_leaderboard(board)] == ["lqg", "mine"]
    monkeypatch.setattr(leaderboard, "PATIENCE", 0.1)
    with held(board.parent), pytest.raises(ValueError, match="^folder = .* is in use by process [0-9]+: wait until that has ended"):
        enter(board, entry_like(board, "yours"), overwrite=False)


def interrupted(*_):
    raise KeyboardInterrupt


@pytest.mark.parametrize("last", ["write_whole", "write_csv"])
def test_an_entry_that_was_interrupted_is_entered_the_next_time(last, board, monkeypatch):
    before, mine = board.read_text(), entry_like(board, "mine")
    begun = board.with_name(f".{NAME}.01234567.part")
    begun.write_text("name,tier")
    with monkeypatch.context() as patch:
        patch.setattr(leaderboard, last, interrupted)
        with pytest.raises(KeyboardInterrupt):
            enter(board, mine, overwrite=False)
    assert board.read_text() == before
    enter(board, mine, overwrite=False)
    entries = read_leaderboard(board)
    assert [each.name for each in entries] == ["lqg", "mine"]
    assert board.with_name(PAGE).read_text() == page(entries)
    assert not list(board.parent.glob(".*"))


def test_the_digest_is_of_what_was_run_and_not_of_its_name(board, monkeypatch):
    marks = []
    monkeypatch.setattr(submission, "check_entry", lambda place, name, mark, overwrite: marks.append(mark) or 1 / 0)
    for gain, folder in ((0.0, "mine"), (0.0, "yours"), (0.02, "mine")):
        agent(Path(folder), gain)
        with pytest.raises(ZeroDivisionError):
            submit(folder, board.parent)
    assert marks[0] == marks[1] != marks[2]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--submit", "nobody"), "submit is 'nobody', but must be the folder of a trained agent"),
        (("--submit", "clairvoyant"), "submit is 'clairvoyant', but must be of tier 0, 1 or 2"),
        (("--submit", "lqg", "--tier", "1"), "tier is 1, but must be 0, which lqg has"),
        (("--submit", "mine", "--tier", "3"), "tier is 3, but must be a whole number from 0 to 2"),
        (("--submit", "told", "--tier", "0"), "tier is 0, but must be at least 2, as the agent in 'told' says of itself"),
        (("--submit", ""), "submit is '', but must be the folder of a trained agent"),
        (("--submit", "empty"), "folder = 'empty' must hold a trained agent"),
        (("--submit", "other/lqg"), "'lqg' is a controller that ships"),
        (("--submit", "mine.zip"), "submit = 'mine.zip' is not loaded: a model file can run any code"),
        (("--submit", "mine.zip", "--trust"), "submit is 'mine.zip', but must be a file that is there"),
        (("--submit", "mine", "--scenario", "delay", "--quick"), "so leave out --scenario and --quick"),
        (("--submit", "mine", "--docs", "mine/agent.json"), "mine/agent.json"),
        (("--tier", "1"), "--tier is of an entry on the leaderboard: name that with --submit"),
        (("--overwrite",), "--overwrite is of an entry on the leaderboard"),
        (
            ("--submit", "narrow"),
            "submit = 'narrow' is not entered, for it could not be measured in 1 of 1 scenarios: in nominal plant",
        ),
    ],
)
def test_what_is_no_entry_is_refused_in_one_sentence(arguments, words):
    agent(Path("mine"))
    agent(Path("told"), tier=2)
    agent(Path("other", "lqg"))
    agent(Path("narrow"), plants={"elsewhere": "0" * 64})
    Path("empty").mkdir()
    before = sorted(map(str, Path().rglob("*")))
    refused(run(*arguments), words)
    after = sorted(str(path) for path in Path().rglob("*") if path.parts[:2] != ("results", "benchmark-submit-narrow"))
    assert [path for path in after if path != "results"] == before


@pytest.mark.parametrize("seconds", ["NaN", "-5.0", "1e999", "true", '"long"'])
def test_a_training_that_took_no_time_that_could_be_is_refused_before_anything_is_run(seconds, monkeypatch):
    """The row could not be read again, nor any other of the leaderboard that it stands in."""
    about = agent(Path("mine"), seconds=0.25) / "agent.json"
    about.write_text(about.read_text().replace("0.25", seconds))
    monkeypatch.setattr(submission, "of_listed", lambda *_, **__: pytest.fail("it was run"))
    refused(run("--submit", "mine"), "agent.json': seconds is ")
    assert not Path("results").exists()


def test_a_declared_tier_is_the_entry_s():
    agent(Path("mine"))
    assert [entrant("mine", tier, False).tier for tier in (None, 0, 1, 2)] == [1, 0, 1, 2]
    agent(Path("mine"), tier=0)
    assert entrant("mine", None, False).tier == 0
    assert entrant("scheduled-lqg", None, False).tier == entrant("scheduled-lqg", 2, False).tier == 2


@pytest.mark.slow
def test_a_model_of_stable_baselines3_is_entered_if_it_is_trusted():
    PPO("MlpPolicy", beamenv.RotatingBeamEnv(**SHORT), n_steps=8, batch_size=8, seed=0, device="cpu").save("soft.zip")
    result = run("--submit", "soft.zip", "--trust", "--json", "--docs", "pages")
    assert result.exit_code == 0, result.output
    row = json.loads(result.stdout)
    assert (row["name"], row["kind"], row["training_seconds"]) == ("soft", "learned", None)
    assert [each["name"] for each in rows(Path("pages", NAME))] == ["soft"] and Path("pages", PAGE).is_file()


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda text: "", "line 1 '', but must have the columns name,tier"),
        (lambda text: "\x00", "leaderboard.csv"),
        (lambda text: text.replace("lqg,0", "lqg,7"), "line 2.tier is 7, but must be a whole number from 0 to 2"),
        (lambda text: text.replace("lqg,0", "../x,0"), "line 2.name is '../x', but must be names that files can have"),
        (lambda text: text.replace("lqg,0,fixed,1,", "lqg,0,fixed,1,nan,"), "line 2 is "),
        (lambda text: text + text.splitlines()[1] + "\n", "two rows called 'lqg'"),
    ],
)
def test_a_damaged_leaderboard_is_named_and_stays(damage, words, board):
    text = damage(board.read_text())
    board.write_text(text)
    agent(Path("mine"))
    with pytest.raises(ValueError, match="leaderboard.csv") as told:
        submit("mine", board.parent)
    assert words in str(told.value) and "\n" not in str(told.value)
    assert board.read_text() == text


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("board")
    with pytest.MonkeyPatch.context() as patch:
        for name, value in SMALL.items():
            patch.setattr(submission, name, value)
        submit("lqg", folder)
    return folder


@pytest.fixture
def board(finished, tmp_path):
    shutil.copytree(finished, tmp_path / "board")
    return tmp_path / "board" / NAME
