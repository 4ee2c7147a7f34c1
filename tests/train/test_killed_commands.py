"""Commands ended at whatever instant, by Ctrl-C, by a signal to end or killed: files are whole, and what follows is the same."""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from train.benchmark.leaderboard import NAME, PAGE, Entry, enter, page, read_leaderboard
from train.learning.checkpoint import NAME as CHECKPOINT

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")

ROOT = Path(__file__).resolve().parents[2]
MAIN = "from train.cli.command import main; main()"
BRIEF = 'agent = "{}"\ntitle = "Brief"\nupdates = {}\n[settings]\n{}'
GRADIENT = BRIEF.format("gradient", 30, "episodes = 8\nwindow = 20\n[actor_settings]\nunits = 6\n".replace("[", "[settings."))
PPO = BRIEF.format("ppo", 12, "blades = 8\nhistory = 3\nrollout = 16\nbatch = 32\nunits = 8\n")
SHORT = "s.SCENARIOS, s.SEEDS, s.ENVIRONMENT = ('nominal', 'delay'), 2, '{\"duration\": 0.02}'"
SUBMISSION = f"from train.benchmark import submission as s; {SHORT}; {MAIN}"
"""What every entry is put through is short."""
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)


def command(*arguments, main=MAIN):
    """A command in a session of its own, on one thread."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen([sys.executable, "-c", main, *map(str, arguments)], env=environment, start_new_session=True, **pipes)


def finished(*arguments, main=MAIN):
    """What a command prints that is left alone."""
    with command(*arguments, main=main) as process:
        out, err = process.communicate(timeout=300)
    assert process.returncode == 0, err
    return out


def ended(number, instant, *arguments, ready=lambda: True, main=MAIN):
    """The status of a command that meets a signal so many seconds after it is ready; none of its processes stays."""
    with command(*arguments, main=main) as process:
        while not ready() and process.poll() is None:
            time.sleep(0.01)
        time.sleep(instant)
        if process.poll() is None:
            (os.killpg if number == signal.SIGINT else os.kill)(process.pid, number)  # a terminal tells the whole group of Ctrl-C
        process.communicate(timeout=60)
    wait_for_the_end_of_group(process.pid)
    assert process.returncode in (0, -number, 128 + number)
    return process.returncode


def wait_for_the_end_of_group(group, seconds=20.0):
    end = time.monotonic() + seconds
    while any(_group(each) == group for each in Path("/proc").glob("[0-9]*")) if Path("/proc/self/stat").exists() else False:
        assert time.monotonic() < end, "a process is left"
        time.sleep(0.1)


def _group(process):
    try:
        fields = (process / "stat").read_text().rpartition(")")[2].split()
    except OSError:
        return None
    return None if fields[0] == "Z" else int(fields[2])


def assert_whole(folder):
    """Every file that has its final name can be read to its end."""
    for path in folder.rglob("*"):
        if path.suffix == ".json":
            json.loads(path.read_text())
        elif path.suffix == ".npz":
            with np.load(path, allow_pickle=False) as arrays:
                assert all(np.isfinite(arrays[name]).all() for name in arrays.files)
        elif path.suffix == ".png":
            assert path.read_bytes().endswith(b"IEND\xaeB`\x82")
        elif path.suffix == ".html":
            assert path.read_text().rstrip().endswith("</html>")
    if (folder / "agent.json").exists():
        assert (folder / "weights.npz").exists()


def weights(folder):
    with np.load(folder / "weights.npz", allow_pickle=False) as arrays:
        return {name: arrays[name].tolist() for name in arrays.files}


def train_of(recipe, path):
    path.write_text(recipe)
    return lambda folder: ("train", "mine", "--recipe", path, "--folder", folder, *resumed(folder))


def resumed(folder):
    return ("--resume",) if (folder / CHECKPOINT).exists() else ()


def events(folder):
    """How often a training has begun to write its curves."""
    return len(list(folder.glob("tensorboard/*")))


@pytest.mark.slow
def test_a_training_that_is_killed_goes_on_to_the_same_weights(tmp_path):
    arguments = train_of(GRADIENT, tmp_path / "brief.toml")
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    finished(*arguments(whole))  # on as many threads as the others: sums depend on them
    ended(signal.SIGKILL, 0.1, *arguments(broken), ready=lambda: events(broken) > 0)
    assert_whole(broken)
    finished(*arguments(broken))
    assert weights(broken) == weights(whole)
    assert not [path for path in broken.iterdir() if path.name.startswith(".")]


def tables(folder):
    return {str(path.relative_to(folder)): path.read_text() for path in sorted(folder.rglob("*.csv"))}


def cells(folder):
    return tables(folder) | {str(path.relative_to(folder)): path.read_text() for path in sorted(folder.glob("cells/*/*.json"))}


def commands(tmp_path):
    """By name: arguments for a folder, and what must be the same in the end."""
    choice = ("--scenario", "nominal", "--scenario", "delay", "--controller", "lqr", "--episodes", "2")
    return {
        "train-gradient": (train_of(GRADIENT, tmp_path / "gradient.toml"), weights),
        "train-ppo": (train_of(PPO, tmp_path / "ppo.toml"), weights),
        "compare": (lambda folder: ("compare", "--folder", folder, "--minutes", "0", "--episodes", "2"), tables),
        "benchmark": (lambda folder: ("benchmark", *choice, "--jobs", "2", "--folder", folder), cells),
        "reproduce": (lambda folder: ("reproduce", "table-3.4", "figure-3.3", "figure-3.2", "--folder", folder), tables),
        "place": (
            lambda folder: ("place", "--actuators", "2", "--method", "sqp", "--picture", folder / "placement.png"),
            lambda folder: (folder / "placement.png").read_bytes(),
        ),
    }


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_benchmark_on_a_cluster_that_is_ended_goes_on_here_to_the_same_result(number, tmp_path):
    pytest.importorskip("ray", reason="Ray is not installed")
    arguments, result = commands(tmp_path)["benchmark"]
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    finished(*arguments(whole))
    ended(number, 0.1, *arguments(broken), "--cluster", "local", ready=lambda: any(broken.glob("cells/*/*.json")))
    assert_whole(broken)
    finished(*arguments(broken))
    assert result(broken) == result(whole)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["train-gradient", "train-ppo", "compare", "benchmark", "reproduce", "place"])
def test_a_command_ended_at_any_instant_goes_on_to_the_same_result(name, tmp_path):
    arguments, result = commands(tmp_path)[name]
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    start = time.monotonic()
    finished(*arguments(whole))
    lasted, generator = time.monotonic() - start, random.Random(name)
    for number in SIGNALS * 3:
        broken.mkdir(exist_ok=True)
        ended(number, generator.uniform(0.1, 1.0) * lasted, *arguments(broken))
        assert_whole(broken)
    finished(*arguments(broken))
    assert result(broken) == result(whole)
    assert not list(broken.rglob(".*"))


def submission(entry, board, jobs=2):
    return "benchmark", "--submit", entry, "--docs", board, "--folder", board / entry, "--jobs", str(jobs)


def undated(entry):
    return {name: value for name, value in entry.values.items() if name != "date"}


@pytest.mark.slow
def test_a_submission_ended_at_any_instant_leaves_the_leaderboard_whole_and_is_entered_the_next_time(tmp_path):
    whole, board = tmp_path / "whole", tmp_path / "board"
    start = time.monotonic()
    finished(*submission("lqg", whole), main=SUBMISSION)
    lasted, generator = time.monotonic() - start, random.Random(0)
    (row,) = read_leaderboard(whole / NAME)
    earlier = Entry({**row.values, "name": "earlier", "digest": "0" * 16})

    def anew():
        shutil.rmtree(board, ignore_errors=True)
        enter(board / NAME, earlier, overwrite=False)

    def shown():
        return (board / PAGE).read_text() != page([earlier])

    anew()
    for number, instant, ready in (
        *((each, generator.uniform(0.1, 1.0) * lasted, lambda: True) for each in SIGNALS * 2),
        *((each, generator.uniform(0.0, 0.003), shown) for each in SIGNALS),
    ):
        ended(number, instant, *submission("lqg", board), ready=ready, main=SUBMISSION)
        entries = read_leaderboard(board / NAME)
        assert [undated(each) for each in entries] in ([undated(earlier)], [undated(earlier), undated(row)])
        assert (board / PAGE).read_text() in (page(entries), page([earlier, row]))
        assert_whole(board / "lqg")
        if len(entries) == 2:
            anew()
    finished(*submission("lqg", board), main=SUBMISSION)
    entries = read_leaderboard(board / NAME)
    assert [undated(each) for each in entries] == [undated(earlier), undated(row)]
    assert (board / PAGE).read_text() == page(entries)
    assert cells(board / "lqg") == cells(whole / "lqg")
    assert not list(board.rglob(".*"))


@pytest.mark.slow
def test_two_submissions_at_once_are_both_entered(tmp_path):
    names = ("lqg", "informed-lqg")
    processes = [command(*submission(name, tmp_path / "board", jobs=1), main=SUBMISSION) for name in names]
    for process in processes:
        with process:
            err = process.communicate(timeout=300)[1]
        assert process.returncode == 0, err
    entries = read_leaderboard(tmp_path / "board" / NAME)
    assert {each.name for each in entries} == set(names)
    assert (tmp_path / "board" / PAGE).read_text() == page(entries)
