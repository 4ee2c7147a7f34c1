"""``beamenv record``: what it says, and what an end at whatever instant leaves."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

pytest.importorskip("minari")

from train.cli.app import app  # noqa: E402 - of what may be missing

ROOT = Path(__file__).resolve().parents[2]
MAIN = "from train.cli.command import main; main()"


@pytest.fixture
def command(tmp_path, monkeypatch):
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path / "sets"))
    (tmp_path / "mine.toml").write_text('model = "thesis"\nmodes = 3\n[beam]\nterms = 4\n')
    return lambda *words: CliRunner().invoke(app, ["record", "--blade", str(tmp_path / "mine.toml"), *words])


def test_the_command_says_where_the_data_set_is_what_it_is_and_how_it_loads(command, tmp_path):
    result = command("velocity", "--episodes", "2", "--scenario", "white")
    assert result.exit_code == 0, result.output
    written, told, loads = result.stdout.splitlines()
    assert written == f"written to {tmp_path / 'sets/beamenv/velocity-white-v0/data'}: 2 episodes, 2000 steps"
    assert "velocity on 2 episodes of the scenario white" in told and "tier 0, told the nominal plant" in told
    assert loads == "minari.load_dataset('beamenv/velocity-white-v0') loads it"


def test_machines_are_told_the_same(command, tmp_path):
    result = command("none", "--episodes", "2", "--seed", "7", "--folder", str(tmp_path / "here"), "--name", "idle-v3", "--json")
    told = json.loads(result.stdout)
    assert told["dataset_id"] == "idle-v3" and told["folder"] == str(tmp_path / "here/idle-v3/data")
    assert (told["episodes"], told["seeds"], told["tier"], told["cost"]["unit"]) == (2, [7, 8], 0, "J s")


def test_what_is_there_is_kept_unless_it_is_to_be_replaced(command):
    words = ("none", "--episodes", "1", "--name", "mine-v0")
    assert command(*words).exit_code == 0
    again = command(*words)
    assert again.exit_code == 2 and again.stderr.count("\n") == 1
    assert "name = 'mine-v0' is a data set already" in again.stderr
    assert command(*words, "--overwrite").exit_code == 0


def test_a_test_seed_is_refused(command, tmp_path):
    result = command("none", "--seed", "1000000")
    assert result.exit_code == 2 and result.stderr.startswith(
        "beamenv: --seed is 1000000, but must be at most 999900 for 100 episodes"
    )
    assert not (tmp_path / "sets").exists()


@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_an_end_in_the_middle_leaves_no_data_set(tmp_path, number):
    words = ("record", "lqg", "--episodes", "100000", "--folder", str(tmp_path))
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen([sys.executable, "-c", MAIN, *words], env=environment, **pipes) as process:
        try:
            while not (begun := list(tmp_path.glob("beamenv/.*.part/data/main_data.hdf5"))) or begun[0].stat().st_size < 1000:
                assert process.poll() is None
                time.sleep(0.01)
            process.send_signal(number)
            _, said = process.communicate(timeout=60)
        finally:
            process.kill()
    if number != signal.SIGKILL:
        assert (process.returncode, said) == (128 + number, "beamenv: interrupted: nothing is kept.\n")
        assert not list(tmp_path.iterdir())
    else:
        assert [each.name[0] for each in (tmp_path / "beamenv").iterdir()] == ["."]  # hidden, until the next recording of the name
