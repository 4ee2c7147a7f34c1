import errno
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits
from typer.testing import CliRunner

from train.cli.app import app
from train.figures.figure import Curve, Panel
from train.reproduce.catalogue import chosen
from train.reproduce.judging.study import Outcome, Part, Statement, Study
from train.reproduce.judging.verdicts import Holds, Verdict
from train.reproduce.report import html_page, markdown_page
from train.reproduce.runner import load, run, source_fingerprint
from train.reproduce.thesis import Model
from train.workers.workers import Workers


def counted(name="figure-3.2", fails=False):
    calls = []

    def compute(model):
        calls.append(model)
        if fails:
            raise ZeroDivisionError("no such blade")
        x = np.linspace(0.0, 1.0, 5)
        return Outcome({"fact": [True]}, [Panel("one", "x (m)", "y (m)", [Curve(x, x, "a"), Curve(x, 2 * x, "b", "dotted")])])

    study = Study(name, "a title", "a configuration", (Statement("fact", "It is so", Holds()),), compute)
    return study, calls


def test_what_is_finished_is_not_done_again(tmp_path):
    study, calls = counted()
    first = run([study], tmp_path)
    again = run([study], tmp_path)
    assert len(calls) == 1 and again == first
    run([study], tmp_path, fresh=True)
    assert len(calls) == 2


def test_another_model_is_not_taken_for_the_finished_one(tmp_path):
    study, calls = counted()
    run([study], tmp_path)
    run([study], tmp_path, model=Model(speed=150.0))
    assert len(calls) == 2
    assert source_fingerprint(Model()) != source_fingerprint(Model(speed=150.0))


def test_a_lost_picture_is_made_again(tmp_path):
    study, calls = counted()
    run([study], tmp_path)
    (tmp_path / "figure-3.2.png").unlink()
    assert load(tmp_path, "figure-3.2") is None
    run([study], tmp_path)
    assert len(calls) == 2


def test_a_failing_study_is_reported_and_does_not_stop_the_others(tmp_path):
    broken, _ = counted("figure-3.2", fails=True)
    good, _ = counted("figure-3.3")
    records = run([broken, good], tmp_path)
    assert records[0].error == "ZeroDivisionError: no such blade" and not records[1].error
    assert not (tmp_path / "figure-3.2.json").exists() and (tmp_path / "figure-3.3.png").exists()
    page = markdown_page([replace(records[0])])
    assert "This study failed: ZeroDivisionError: no such blade" in page and "Failed: figure-3.2." in page


def doubled(number, log):
    with open(log, "a") as file:
        file.write(f"{number}\n")
    return 2 * number


def of_parts(name, numbers, log, function=doubled):
    def outcome(model, results):
        x = np.array(list(results.values()), dtype=float)
        return Outcome({"fact": [True]}, [Panel("one", "x (m)", "y (m)", [Curve(x, x, "a")])])

    statements = (Statement("fact", "It is so", Holds()),)
    return Study(name, "a title", "", statements, outcome, lambda model: {n: Part(function, (n, log)) for n in numbers})


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_part_of_several_studies_is_found_once(jobs, tmp_path):
    log = str(tmp_path / "log")
    one, other = of_parts("figure-3.2", (1, 2), log), of_parts("figure-3.3", (2, 3), log)
    records = run([one, counted("figure-3.4")[0], other], tmp_path, workers=Workers(jobs))
    assert [record.name for record in records] == ["figure-3.2", "figure-3.4", "figure-3.3"]
    assert not any(record.error for record in records)
    assert sorted(Path(log).read_text().split()) == ["1", "2", "3"]
    assert [row.split(",")[3] for row in (tmp_path / "figure-3.3.csv").read_text().splitlines()[1:]] == ["4", "6"]


def test_a_part_that_fails_fails_the_studies_it_belongs_to_and_no_other(tmp_path):
    log = str(tmp_path / "log")
    broken = of_parts("figure-3.2", (1,), log, lambda number, log: 1 / 0)
    records = run([broken, of_parts("figure-3.3", (1,), log)], tmp_path)
    assert [record.error for record in records] == ["ZeroDivisionError: division by zero", ""]


def added(first, second, log):
    with open(log, "a") as file:
        file.write(f"{first} + {second}\n")
    return first + second


def on_parts(name, log, function=doubled):
    """A study of one part that rests on two others."""
    study = of_parts(name, (), log)
    return replace(study, parts=lambda model: {"sum": Part(added, (Part(function, (1, log)), Part(function, (2, log)), log))})


@pytest.mark.parametrize("jobs", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_a_part_that_rests_on_others_is_given_what_they_came_to(jobs, tmp_path):
    log = str(tmp_path / "log")
    run([on_parts("figure-3.2", log), of_parts("figure-3.3", (2,), log)], tmp_path, workers=Workers(jobs))
    assert sorted(Path(log).read_text().splitlines()) == ["1", "2", "2 + 4"]
    assert [row.split(",")[3] for row in (tmp_path / "figure-3.2.csv").read_text().splitlines()[1:]] == ["6"]
    assert on_parts("figure-3.2", log).parts(Model())["sum"].result() == 6


def test_what_rests_on_a_part_that_fails_fails_as_that_did(tmp_path):
    log = str(tmp_path / "log")
    records = run([on_parts("figure-3.2", log, lambda number, log: 1 / 0), of_parts("figure-3.3", (1,), log)], tmp_path)
    assert [record.error for record in records] == ["ZeroDivisionError: division by zero", ""]


def threads(number, log):
    return max(pool["num_threads"] for pool in threadpool_info())


@pytest.mark.parametrize("jobs", [None, 1, 2])
def test_linear_algebra_has_one_thread_whoever_works(jobs, tmp_path):
    studies = [of_parts(name, (number,), "", threads) for number, name in enumerate(("figure-3.2", "figure-3.3"))]
    with threadpool_limits(2):
        run(studies, tmp_path, workers=Workers(jobs))
    for study in studies:
        assert [row.split(",")[3] for row in (tmp_path / f"{study.name}.csv").read_text().splitlines()[1:]] == ["1"]


def test_an_interrupted_run_keeps_what_it_finished(tmp_path):
    first, calls = counted("figure-3.2")
    second, _ = counted("figure-3.3")

    def stop(record):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run([first, second], tmp_path, finished=stop)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        *("figure-3.2-dark.png", "figure-3.2.csv", "figure-3.2.json", "figure-3.2.png")
    ]
    run([first, second], tmp_path)
    assert len(calls) == 1


def test_a_table_leaves_a_csv_a_picture_and_a_page_that_needs_nothing_else(tmp_path):
    records = run(chosen(["table-3.4"]), tmp_path)
    lines = (tmp_path / "table-3.4.csv").read_text().splitlines()
    assert len(lines) == 16 and lines[1].startswith('"c/h = 10, ω1",119.59')
    assert (tmp_path / "table-3.4.png").read_bytes().startswith(b"\x89PNG")
    page = html_page(records, tmp_path)
    assert "data:image/png;base64," in page and 'src="data' in page and "http" not in page
    assert "119.59" in page and Verdict.REPRODUCED.value in page


def test_records_survive_their_file(tmp_path):
    record = run(chosen(["table-3.4"]), tmp_path)[0]
    assert load(tmp_path, "table-3.4", record.fingerprint) == record
    assert json.loads((tmp_path / "table-3.4.json").read_text())["judgements"]["thesis"]["verdict"] == "reproduced"


def test_command_writes_the_page_and_the_documentation(tmp_path):
    result = CliRunner().invoke(
        app, ["reproduce", "table-3.4", "figure-3.3", "--folder", str(tmp_path / "out"), "--docs", str(tmp_path / "docs")]
    )
    assert result.exit_code == 0, result.output
    index, page = ((tmp_path / "docs" / name).read_text() for name in ("thesis.md", "thesis-chapter-3.md"))
    assert "](figures/figure-3.3.png)" in page and all(
        (tmp_path / "docs" / "figures" / f"figure-3.3{end}.png").exists() for end in ("", "-dark")
    )
    assert "not run" in index and "Chapter 6: " not in index and not (tmp_path / "docs" / "thesis-chapter-6.md").exists()
    assert (tmp_path / "out" / "report.html").exists() and (tmp_path / "out" / "report.md").exists()
    assert "resumed" not in result.stderr
    again = CliRunner().invoke(app, ["reproduce", "table-3.4", "--folder", str(tmp_path / "out"), "--json"])
    assert again.stderr.splitlines()[0] == "beamenv: resumed: 1 of 1 are kept from an earlier run."
    (study,) = json.loads(again.stdout)["studies"]
    assert study["name"] == "table-3.4" and study["in_nature"]["thesis"] == "reproduced" and study["error"] is None


def test_command_lists_the_known_names_for_an_unknown_one(tmp_path):
    result = CliRunner().invoke(app, ["reproduce", "table-9", "--folder", str(tmp_path)])
    assert result.exit_code == 2
    assert "table-9" in result.output and "figure-5.17" in result.output


@pytest.mark.parametrize(
    "content", ["", "{", "[]", "{}", '{"fingerprint": "%s"}', '{"fingerprint": "%s", "judgements": 3, "name": ""}']
)
def test_a_damaged_record_is_told_with_its_name_and_run_again_when_asked(content, tmp_path):
    study, calls = counted()
    (whole,) = run([study], tmp_path)
    path = tmp_path / "figure-3.2.json"
    path.write_text(content.replace("%s", whole.fingerprint))
    with pytest.raises(ValueError, match=r"file '.*figure-3.2.json' (cannot be read|must hold the record of a study)"):
        run([study], tmp_path)
    run([study], tmp_path, fresh=True)
    assert len(calls) == 2
    assert load(tmp_path, "figure-3.2", whole.fingerprint) is not None


@pytest.mark.parametrize("arguments", [("--folder", "note"), ("--docs", "note"), ("--folder", "note/deeper")])
def test_an_output_that_cannot_be_written_is_told_before_anything_is_computed(arguments, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "note").write_text("kept")
    result = CliRunner().invoke(app, ["reproduce", "table-3.4", *arguments])
    assert result.exit_code == 2
    assert "must be a folder" in result.output
    assert [path.name for path in tmp_path.iterdir()] == ["note"]


def test_a_disk_that_fills_up_leaves_no_part_of_a_file(tmp_path, monkeypatch):
    study, _ = counted()
    run([study], tmp_path)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("beamenv.configuration.writing.os.replace", full)
    with pytest.raises(OSError, match="No space left"):
        run([study], tmp_path, fresh=True)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_ctrl_c_writes_the_page_of_what_is_finished_and_says_how_to_go_on(tmp_path, monkeypatch):
    def interrupted(model):
        raise KeyboardInterrupt

    (first,), (second,) = chosen(["table-3.4"]), chosen(["figure-3.3"])
    monkeypatch.setattr("train.cli.reproduce.chosen", lambda names: (first, replace(second, outcome=interrupted)))
    result = CliRunner().invoke(app, ["reproduce", "--folder", str(tmp_path), "--jobs", "1"])
    assert result.exit_code == 130
    assert "beamenv: interrupted: what was finished is kept, and the same command resumes." in result.output
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["report.html", "report.md", *(f"table-3.4{end}" for end in ("-dark.png", ".csv", ".json", ".png"))]
