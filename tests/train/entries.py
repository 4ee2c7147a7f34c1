"""Entries of the leaderboard as small as can be, which tests share."""

import csv
import json
from pathlib import Path

import numpy as np
from typer.testing import CliRunner

from beamenv.plant.fingerprint import fingerprint
from beamenv.task import resolve_task
from train.benchmark.leaderboard import NAME
from train.cli.app import app
from train.controllers.policies import HistoryPolicy
from train.controllers.policy_files import save_policy

SHORT = {"duration": 0.02}


SMALL = {"SCENARIOS": ("nominal",), "SEEDS": 2, "ENVIRONMENT": json.dumps(SHORT)}
"""One scenario, two episodes of a moment."""


def agent(folder, gain=0.0, **about):
    """A policy of one layer that says of itself what an agent's file says."""
    weights = {"weight0": np.full((4, 8), gain, np.float32), "bias0": np.zeros(4, np.float32)}
    policy = HistoryPolicy(
        "mine", weights, {"input_gain": 1.0, "held": 1}, np.full(4, -0.5, np.float32), np.full(4, 0.5, np.float32)
    )
    folder.mkdir(parents=True, exist_ok=True)
    save_policy(policy, folder, {"plants": {"nominal": fingerprint(resolve_task().design_plant)}, **about})
    return folder


def run(*arguments):
    return CliRunner().invoke(app, ["benchmark", "--jobs", "1", *map(str, arguments)])


def rows(path=None):
    with (path or Path("results", NAME)).open(newline="") as file:
        return list(csv.DictReader(file))


def refused(result, words):
    assert result.exit_code == 2, result.output
    assert result.stdout == "" and words in result.stderr.splitlines()[-1]
    assert all("━" in line for line in result.stderr.splitlines()[:-1])  # the bar, where something was measured
