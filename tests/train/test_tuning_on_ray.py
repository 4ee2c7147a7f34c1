"""Trials on Ray: the same to the last bit as in one process, killed or not, and not a word of Ray's."""

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest
from threadpoolctl import threadpool_limits

pytest.importorskip("ray")

from tests.train import brief
from train.tuning.space import space_of
from train.tuning.trial import looks, rungs
from train.tuning.tuning import Tuning, tune

pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("default"),
    pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's"),
]

ROOT = Path(__file__).resolve().parents[2]
RECIPE = """
agent = "gradient"
title = "Brief"
updates = 40
[settings]
episodes = 8
window = 20
[settings.actor_settings]
units = 6
"""
TRIALS = 5


def tuning():
    return Tuning("mine", brief.GRADIENT, space_of(brief.GRADIENT), "nominal", 0, TRIALS, brief.SHORT)


def ignore(records):
    pass


def without_seconds(records):
    return [replace(each, looks=tuple(replace(look, seconds=0.0) for look in each.looks)) for each in records]


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """One trial at a time."""
    return tune(tuning(), tmp_path_factory.mktemp("alone"), ignore, side_by_side=1)


def test_workers_find_what_this_process_finds(alone, tmp_path):
    ended = [each.ended for each in alone.records]
    assert ended[0] == "finished"  # whatever others do: they are compared with it
    assert "stopped" in ended
    for record in alone.records:
        with threadpool_limits(1):  # as workers have it
            own = list(looks(tuning().job(record.trial), rungs(6), tmp_path / str(record.trial)))[: len(record.looks)]
        assert [(each.updates, each.cost, each.apart) for each in own] == [(e.updates, e.cost, e.apart) for e in record.looks]


def test_an_interrupted_search_ends_as_one_that_was_not(alone, tmp_path):
    def report(records):
        if sum(len(each.looks) for each in records) == 5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tune(tuning(), tmp_path, report, side_by_side=1)
    resumed = tune(tuning(), tmp_path, ignore, side_by_side=1)
    assert without_seconds(resumed.records) == without_seconds(alone.records)
    assert resumed.recipe == alone.recipe


def own_workers():
    """Processes of Ray's that run a trial for this one."""
    found = []
    for path in Path("/proc").glob("[0-9]*"):
        try:
            name, above = (path / "cmdline").read_bytes(), path
            while above.name not in ("0", "1", str(os.getpid())):
                above = path.parent / (above / "stat").read_text().rpartition(")")[2].split()[1]
        except OSError:
            continue
        if name.startswith(b"ray::Arm") and above.name == str(os.getpid()):
            found.append(int(path.name))
    return found


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes are looked up in /proc")
def test_a_worker_that_is_killed_costs_no_trial_and_no_word(alone, tmp_path, capfd):
    killed = []

    def report(records):
        if sum(len(each.looks) for each in records) == 2 and not killed:
            killed.extend(own_workers())
            for worker in killed:
                os.kill(worker, signal.SIGKILL)

    tuned = tune(tuning(), tmp_path, report, side_by_side=1)
    assert killed
    assert capfd.readouterr() == ("", "")
    assert without_seconds(tuned.records) == without_seconds(alone.records)


def command(folder, *options):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    words = ["tune", "mine.toml", "--trials", str(TRIALS), "--folder", "made", *options]
    main = "from train.cli.command import main; main()"
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen([sys.executable, "-c", main, *words], cwd=folder, env=environment, start_new_session=True, **pipes)


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT, signal.SIGTERM], ids=lambda number: number.name)
def test_the_command_is_killed_and_resumes_and_says_only_its_own(tmp_path, number):
    (tmp_path / "mine.toml").write_text(RECIPE)
    with command(tmp_path, "--jobs", "2") as process:
        end = time.monotonic() + 120.0
        while not list(tmp_path.glob("made/trials/*.json")) and process.poll() is None and time.monotonic() < end:
            time.sleep(0.05)
        (os.killpg if number == signal.SIGINT else os.kill)(process.pid, number)
        out, err = process.communicate(timeout=60)
    assert process.returncode in (-signal.SIGKILL, 130, 143)
    assert out == ""
    if number != signal.SIGKILL:
        assert err == "beamenv: interrupted: what was finished is kept, and the same command resumes.\n"
    kept = {path: json.loads(path.read_text())["looks"] for path in tmp_path.glob("made/trials/*.json")}
    assert kept
    with command(tmp_path, "--jobs", "2", "--json") as process:
        out, err = process.communicate(timeout=240)
    assert (process.returncode, err) == (0, "")
    content = json.loads(out)
    assert (tmp_path / content["path"]).is_file()
    for path, before in kept.items():
        assert content["trials"][int(path.stem)]["looks"][: len(before)] == before
