"""RL Baselines3 Zoo trains with the settings that ship, in one process and in several, and enjoys what it has trained."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("rl_zoo3")

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("default")]

SETTINGS = Path(__file__).parents[2] / "train" / "learning" / "zoo" / "ppo.yml"


@pytest.mark.parametrize("vectorised", ["dummy", "subproc"])
def test_it_trains_and_enjoys(vectorised, tmp_path):
    common = ["--algo", "ppo", "--env", "beamenv/RotatingBeam-v0", "--gym-packages", "beamenv"]
    settings = ["--conf-file", str(SETTINGS), "--vec-env", vectorised, "-params", "n_envs:2", "n_steps:256"]
    train = [*common, "-n", "600", "-f", "logs", *settings]
    enjoy = [*common, "-n", "50", "-f", "logs", "--no-render"]
    environment = {**os.environ, "PYTHONPATH": str(SETTINGS.parents[3])}
    for module, words in (("rl_zoo3.train", train), ("rl_zoo3.enjoy", enjoy)):
        run = subprocess.run([sys.executable, "-m", module, *words], cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert run.returncode == 0, run.stdout + run.stderr
