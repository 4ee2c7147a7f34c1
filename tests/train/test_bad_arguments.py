"""Whatever is no folder, task, plant or comparison is refused in one sentence by everything that takes one."""

from pathlib import Path

import numpy as np
import pytest

from baselines.evaluation.metrics import cost_without_control, measure, settling_band
from beamenv.task import resolve_task
from train.comparison.compare import Comparison, compare
from train.controllers.choice import chosen, chosen_runs
from train.controllers.models import load_model
from train.controllers.named import named
from train.controllers.policy_files import load_policy
from train.controllers.runs import best_run, runs_in
from train.controllers.shipped import find_shipped, load_shipped, shipped

OBJECTS = (3, [], {}, object(), True, float("nan"), np.zeros(3))
TASK = resolve_task()
NOTHING = Comparison({"duration": 0.02}, {}, 2)

DOORS = {
    "chosen": lambda bad: chosen(bad, TASK, "nominal"),
    "chosen_runs": lambda bad: chosen_runs(bad, TASK, "nominal"),
    "chosen, task": lambda bad: chosen("lqg", bad, "nominal"),
    "named": named,
    "named, task": lambda bad: named("lqg").build_for(bad),
    "find_shipped": lambda bad: find_shipped(bad, "nominal"),
    "find_shipped, scenario": lambda bad: find_shipped("residual", bad),
    "load_shipped, plant": lambda bad: load_shipped("residual", "generalist", None, bad),
    "shipped": shipped,
    "load_policy": load_policy,
    "load_model": load_model,
    "runs_in": runs_in,
    "best_run": best_run,
    "compare": lambda bad: compare(bad, Path("nowhere")),
    "compare, folder": lambda bad: compare(NOTHING, bad),
    "compare, listener": lambda bad: compare(NOTHING, Path("nowhere"), bad),
    "measure": lambda bad: measure(bad, np.zeros(2)),
    "settling_band": settling_band,
    "cost_without_control": cost_without_control,
}


@pytest.mark.parametrize("door", DOORS)
def test_what_is_no_such_thing_is_refused_in_one_sentence(door, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for bad in OBJECTS:
        with pytest.raises(ValueError) as told:  # noqa: PT011 - the sentence is each door's own
            DOORS[door](bad)
        assert type(told.value).__name__ in ("ValueError", "Refused")
        assert "\n" not in str(told.value) and 10 < len(str(told.value)) < 700
    assert not list(tmp_path.iterdir())
