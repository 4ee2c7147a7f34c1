"""Trained agents in a benchmark: their runs, and the blades they are for."""

import gymnasium

import beamenv
from beamenv.plant.fingerprint import fingerprint
from tests.train.benchmarked import IDLE, SMALL
from train.benchmark import benchmark
from train.benchmark.listed import agents
from train.benchmark.targets import findings
from train.controllers.policy_files import save_policy


def design_fingerprint(scenario):
    return fingerprint(gymnasium.make(beamenv.ENV_ID, scenario=scenario).unwrapped.design_plant)


def test_training_runs_are_pooled_and_specialists_stay_at_home(tmp_path):
    for run in ("generalist/0", "generalist/1", "nominal/0"):
        save_policy(IDLE, tmp_path / "ppo" / run, {"plants": {name: design_fingerprint(name) for name in SMALL["scenarios"]}})
    assert [each.name for each in agents(tmp_path)] == ["ppo-generalist", "ppo-specialist"]
    chosen = {**SMALL, "controllers": ["ppo-generalist", "ppo-specialist"]}
    table = benchmark(trained=tmp_path, **chosen)
    assert {(row.scenario, row.controller): row.runs for row in table.rows if row.kind == "learned"} == {
        ("nominal", "ppo-generalist"): 2,
        ("nominal", "ppo-specialist"): 1,
        ("spillover", "ppo-generalist"): 2,
    }
    sentences = [each.sentence for each in findings(table)]
    assert "is ahead of every classical controller in 0 of 2 single fault scenarios, behind in " in sentences[0]
    within = "in 2 of 2 scenarios of a single fault (+0.0 % to +0.0 %)."  # of no control, the best law in so short an episode
    assert sentences[-1].startswith("ppo-generalist: J within 3 % of the best classical controller")
    assert sentences[-1].endswith(within)
    (tmp_path / "ppo" / "generalist" / "1" / "weights.npz").write_bytes(b"")
    row = benchmark(trained=tmp_path, **chosen).row("nominal", "ppo-generalist")
    assert row.runs == 1
    assert row.sentences[0] == "1 of 2 runs could not be measured:"


def test_an_agent_for_another_blade_is_told_in_one_sentence(tmp_path):
    save_policy(IDLE, tmp_path / "ppo" / "generalist" / "0", {"plants": {"elsewhere": "0" * 64}})
    row = benchmark(trained=tmp_path, **{**SMALL, "controllers": ["ppo-generalist"]}).row("nominal", "ppo-generalist")
    assert "is none of those the agent" in row.sentences[0]
    assert not row.measured
