"""Pieces handed out to a cluster of Ray's, here of two processors: the same to the last bit, whatever happens to workers."""

import json
import os
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path

import pytest
from typer.testing import CliRunner

from beamenv import scenario
from tests.train.benchmarked import SMALL
from tests.train.brief import GRADIENT, assert_same, ignore, job, weights
from tests.train.pieces import Mortal, Waiting, halved, kill, killed_once, threads
from train.benchmark import benchmark
from train.benchmark.bench import Setting
from train.benchmark.cells import Job
from train.benchmark.runner import _files
from train.benchmark.showing.report import as_json
from train.cli.app import app
from train.controllers.sources import Trained
from train.learning.job import run
from train.learning.several import train_all
from train.shared.cluster import check_address, connected
from train.shared.threads import ONE_THREAD
from train.workers import arrival
from train.workers.node import carried_out, opened, terms
from train.workers.parcel import packed, unpacked
from train.workers.pool import hand_out
from train.workers.workers import Workers

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def ray():
    """Started once: it takes some seconds. What is asked for as "local" is this one."""
    ray = pytest.importorskip("ray", reason="Ray is not installed")
    with ExitStack() as stack:
        try:
            stack.enter_context(connected("local", 2))
        except ValueError as error:  # no ports, no shared memory
            pytest.skip(f"Ray does not start here: {error}")
        yield ray


def files(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def test_a_cluster_that_runs_answers(ray):
    check_address(ray.get_runtime_context().gcs_address)


def test_cells_measured_on_a_cluster_are_those_of_one_process_to_the_last_bit(ray, tmp_path):
    alone = benchmark(folder=tmp_path / "alone", **SMALL)
    there = benchmark(folder=tmp_path / "there", cluster="local", **SMALL)
    assert as_json(there) == as_json(alone)
    cells = files(tmp_path / "alone" / "cells")
    assert files(tmp_path / "there" / "cells") == cells and len(cells) == 6


@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
@pytest.mark.parametrize("cluster", ["local", pytest.param(None, marks=pytest.mark.slow)])
def test_a_worker_that_is_killed_costs_its_own_piece(cluster, ray, tmp_path):
    names, small = ("first", "second", "third", "fourth"), {**SMALL, "scenarios": ["nominal"]}
    unkilled = benchmark({name: Mortal(tmp_path, name) for name in names}, **small)
    begun = {name: len((tmp_path / f"{name}.count").read_text()) for name in names}
    for name in names:
        (tmp_path / f"{name}.count").unlink()
    (tmp_path / "second.deadly").touch()
    killed = benchmark({name: Mortal(tmp_path, name) for name in names}, jobs=2, cluster=cluster, **small)
    assert not (tmp_path / "second.deadly").exists()
    assert as_json(killed) == as_json(unkilled) and not killed.sentences
    again = {name: len((tmp_path / f"{name}.count").read_text()) for name in names}
    assert again["second"] > begun["second"]
    if cluster is not None:
        assert {name for name in names if again[name] != begun[name]} == {"second"}


@pytest.mark.parametrize(("together", "again"), [(False, [1, 1, 2]), (True, [1, 1, 2, 2])])
def test_what_others_were_at_is_done_again_only_where_they_died_too(together, again):
    pool, found = Waiting(together), []
    hand_out(pool, halved, [1, 2], lambda piece, result: found.append((piece, result)))
    assert sorted(pool.begun) == again
    assert sorted(found) == [(1, 1), (2, 2)]


def test_libraries_of_a_worker_have_one_thread(ray):
    found = []
    Workers(2, "local").do(threads, [0], lambda piece, result: found.append(result))
    assert ONE_THREAD.items() <= found[0].items()


@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
def test_a_piece_that_kills_whoever_takes_it_is_given_up_and_ray_says_nothing(ray, capfd, caplog):
    with pytest.raises(ChildProcessError, match="a worker process died: what was finished is kept, and the same command resumes"):
        Workers(2, "local").do(kill, [1], lambda piece, result: None)
    assert caplog.messages == 2 * ["beamenv: a worker process died: what it was at is done again."]
    time.sleep(1.0)  # so long Ray may take to say something
    assert capfd.readouterr() == ("", "")


def test_what_a_piece_raises_is_raised_as_it_was(ray):
    with pytest.raises(ValueError, match=r"^number = 3\.0 is not allowed\.$"):
        Workers(2, "local").do(halved, [3.0], lambda piece, result: None)


@pytest.mark.parametrize("workers", [Workers(), Workers(2, "local")], ids=["here", "cluster"])
def test_a_piece_that_follows_from_another_is_done_too(workers, ray):
    found = {}

    def finished(piece, result):
        found[piece] = result
        return result if result >= 1.0 else None

    workers.do(halved, [8.0, 5.0], finished)
    assert found == {8.0: 4.0, 4.0: 2.0, 2.0: 1.0, 1.0: 0.5, 5.0: 2.5, 2.5: 1.25, 1.25: 0.625}


@pytest.mark.slow
def test_a_table_of_the_thesis_made_on_a_cluster_is_the_one_made_here(ray, tmp_path):
    for name, options in {"here": ["--jobs", "1"], "there": ["--cluster", "local"]}.items():
        result = CliRunner().invoke(app, ["reproduce", "table-3.4", "figure-3.3", "--folder", str(tmp_path / name), *options])
        assert result.exit_code == 0, result.output
    here, there = files(tmp_path / "here"), files(tmp_path / "there")
    records = [
        {**json.loads(each.pop(f"{name}.json")), "seconds": 0.0} for each in (here, there) for name in ("table-3.4", "figure-3.3")
    ]
    assert records[:2] == records[2:]
    assert there == here and {"table-3.4.csv", "table-3.4.png", "report.html"} <= set(here)


def test_files_go_where_there_are_none_of_them(tmp_path):
    plant, agent = tmp_path / "plant.npz", tmp_path / "agent" / "agent.json"
    agent.parent.mkdir()
    plant.write_text("modes")
    agent.write_text("weights")
    content = {"truth": str(plant), "folder": agent.parent, "name": "plant.npz"}
    parcel = packed(content, [plant, agent])
    assert unpacked(parcel) == content  # where they are, they stay
    plant.write_text("others")
    agent.unlink()
    found = unpacked(parcel)
    assert Path(found["truth"]).read_text() == "modes" and found["truth"] != str(plant)
    assert (found["folder"] / "agent.json").read_text() == "weights"
    assert found["name"] == "plant.npz"
    assert plant.read_text() == "others"


def test_another_version_on_a_machine_is_told_in_one_sentence():
    parcel = packed((halved, 4.0))
    assert opened(carried_out(terms(), parcel)) == 2.0
    with pytest.raises(ValueError, match=r"^cluster has a machine, '.+', with numpy \S+ where .* has 1\.0: install the same"):
        opened(carried_out({**terms(), "numpy": "1.0"}, parcel))
    with pytest.raises(ValueError, match=r"with beamenv \S+ of sources \w{16} where .* has 0\.1\.0 of sources 00"):
        opened(carried_out({**terms(), "beamenv": "0.1.0 of sources 00"}, parcel))


def test_a_machine_without_the_package_is_told_in_one_sentence(monkeypatch):
    monkeypatch.setitem(sys.modules, "beamenv.train.workers.node", None)
    with pytest.raises(ValueError, match=r"^cluster has a machine, '.+', that lacks this version of beamenv \(.*\): install"):
        opened(arrival.arrived({}, b"", arrival.NOT_INSTALLED))


def test_the_first_function_needs_nothing_of_ours(ray):
    code = "import pickle, sys; sys.modules['beamenv'] = None; arrived = pickle.loads(sys.stdin.buffer.read()); "
    code += "print(pickle.loads(pickle.loads(arrived({}, b'', '{error}'))[0]))"
    ray.cloudpickle.register_pickle_by_value(arrival)
    run = subprocess.run([sys.executable, "-I", "-c", code], input=ray.cloudpickle.dumps(arrival.arrived), capture_output=True)
    assert run.stdout.startswith(b"(False, ValueError(") and b"beamenv" in run.stdout, run.stderr


@pytest.mark.parametrize("command", [["benchmark", "--folder", "made"], ["reproduce", "--folder", "made"]])
@pytest.mark.parametrize("address", ["nowhere", "127.0.0.1:1", "ray://127.0.0.1:1"])
def test_a_cluster_that_does_not_answer_is_told_before_anything_is_written(command, address, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(app, [*command, "--cluster", address])
    assert result.exit_code == 2
    assert result.output.startswith("beamenv: --cluster ") and result.output.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_without_ray_the_extra_is_named(tmp_path):
    code = "import sys; sys.modules['ray'] = None; from train.cli.command import main; main()"
    words = ["reproduce", "table-3.4", "--folder", str(tmp_path), "--cluster", "local"]
    run = subprocess.run([sys.executable, "-c", code, *words], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 1
    assert (
        run.stderr.splitlines()[-1]
        == "beamenv: the Python package 'ray' is missing; install it with pip install 'beamenv[cluster]'."
    )


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
def test_trainings_on_a_cluster_are_those_made_one_by_one_though_a_worker_is_killed(ray, tmp_path, monkeypatch):
    monkeypatch.setattr("train.learning.several.trained_on", killed_once)
    trainings = {tmp_path / str(seed): job(GRADIENT, seed=seed, updates=4) for seed in (0, 1)}
    (tmp_path / "deadly").touch()
    heard = []
    train_all(trainings, Workers(2, "local"), lambda home, progress: heard.append((home.name, progress.updates)), stretch=0.0)
    assert not (tmp_path / "deadly").exists()
    assert sorted(heard) == [(str(seed), update) for seed in (0, 1) for update in range(1, 5)]
    for home, training in trainings.items():
        run(training, tmp_path / "alone" / home.name, ignore)
        assert_same(weights(home), weights(tmp_path / "alone" / home.name))


def test_the_files_of_a_scenario_and_an_agent_go_with_their_cells(tmp_path):
    (tmp_path / "gust.csv").write_text("1.0\n2.0\n3.0\n")
    agent = tmp_path / "agent"
    agent.mkdir()
    for name in ("agent.json", "weights.npz"):
        (agent / name).write_bytes(name.encode())
    gust = {"position": 1.0, "course": "series", "series": str(tmp_path / "gust.csv"), "rate": 100.0}
    cell = Job(Setting("gust", scenario({"loads": [gust]}), 2), "mine", "", Trained(agent))
    parcel, before = packed([cell], _files([cell])), cell.source.fingerprint()
    for path in (tmp_path / "gust.csv", agent / "agent.json", agent / "weights.npz"):
        path.unlink()
    (there,) = unpacked(parcel)
    assert Path(there.setting.scenario.loads[0].series).read_text() == "1.0\n2.0\n3.0\n"
    assert there.source.fingerprint() == before
