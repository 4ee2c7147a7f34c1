"""The benchmark in several processes: what they import, what travels to them, and how they end."""

import json
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from train.benchmark import benchmark

ROOT = Path(__file__).resolve().parents[2]
HEAVY = ("torch", "stable_baselines3", "sb3_contrib", "plotly", "matplotlib", "pygame", "rich", "typer", "jinja2")
SETTING = '{"scenarios": ["nominal"], "controllers": [], "seeds": 2, "jobs": 2, "environment": {"duration": 0.02}}'

IN_A_SCRIPT = f"""
import json, os, sys
import numpy as np
from threadpoolctl import threadpool_info
from train.benchmark import benchmark

class Still:
    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        return np.zeros((len(observation), 4)), state

class Telling:
    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        heavy = [name for name in {HEAVY!r} if name in sys.modules]
        raise ValueError(json.dumps([os.getppid(), heavy, [pool["num_threads"] for pool in threadpool_info()]]))

table = benchmark({{"still": Still(), "telling": Telling()}}, **json.loads('{SETTING}'))
told = json.loads(table.row("nominal", "telling").sentences[0])
print(json.dumps([os.getpid(), *told, table.row("nominal", "still").estimates["relative_cost"].value]))
"""

THAT_DIES = f"""
import json, os, signal, sys
import numpy as np
from train.benchmark import benchmark

class Deadly:
    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        os.kill(os.getpid(), signal.SIGKILL)

try:
    benchmark({{"deadly": Deadly()}}, **json.loads('{SETTING}'))
except ChildProcessError as error:
    print(error)
"""

THAT_HANGS = f"""
import json, os, time
from train.benchmark import benchmark

class Endless:
    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        with open(NOTE, "w") as file:
            file.write(str(os.getpid()))
        time.sleep(60.0)

benchmark({{"endless": Endless()}}, **json.loads('{SETTING}'))
"""


def script(text, *arguments):
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    return subprocess.run(
        [sys.executable, "-W", "error", "-c", text, *arguments], env=environment, capture_output=True, text=True, timeout=300
    )


def test_a_class_of_a_script_is_measured_in_workers_that_import_nothing_heavy_and_take_one_thread():
    run = script(IN_A_SCRIPT)
    assert run.returncode == 0, run.stderr
    process, parent, heavy, threads, cost = json.loads(run.stdout)
    assert parent == process
    assert heavy == []
    assert threads and set(threads) == {1}
    assert cost == 1.0
    assert run.stderr == ""


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
def test_a_worker_that_dies_is_told_in_one_sentence():
    run = script(THAT_DIES)
    assert run.stdout == "a worker process died: what was finished is kept, and the same command resumes.\n", run.stderr


def alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def wait_until(condition, seconds=120.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.1)


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
def test_workers_end_with_the_process_that_started_them(tmp_path):
    note = tmp_path / "process"
    text = f"NOTE = {str(note)!r}\n{THAT_HANGS}"
    with subprocess.Popen([sys.executable, "-c", text], env={**os.environ, "PYTHONPATH": str(ROOT)}) as parent:
        try:
            wait_until(lambda: note.exists() and note.read_text())
        finally:
            parent.kill()
    wait_until(lambda: not alive(int(note.read_text())), 20.0)


class Locked:
    """Holds what no other process can have."""

    def __init__(self):
        self.lock = threading.Lock()

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        return np.zeros((len(observation), 4)), state


def test_what_cannot_travel_is_refused_before_anything_is_measured():
    with pytest.raises(ValueError, match="controller 'mine' cannot be sent to another process: take jobs=1"):
        benchmark({"mine": Locked()}, **json.loads(SETTING))
