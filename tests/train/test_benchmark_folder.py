"""The folder of a benchmark: whose it is, what may become a file's name in it, and files that are damaged."""

import csv
import hashlib
import json
import shutil

import numpy as np
import pytest
from typer.testing import CliRunner

import beamenv
from beamenv.configuration import FileName, checked
from train.benchmark import benchmark
from train.cli.app import app
from train.cli.benchmark import default_folder
from train.cli.quick import QUICK_SEEDS
from train.shared.files import in_a_cell, write_csv

SMALL = {"scenarios": ["nominal"], "controllers": ["lqg-load"], "seeds": 2, "environment": {"duration": 0.02}}


def contents(folder):
    """Of every file but those of the cells' time."""
    return {path.relative_to(folder): hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("benchmark")
    benchmark(folder=folder, **SMALL)
    return folder


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"seeds": 3}, r"seeds \[1000000, 1000001\]"),
        ({"environment": {"duration": 0.03}}, 'environment {"duration": 0.02}'),
        ({"environment": {**SMALL["environment"], "speed": 150.0}}, "environment"),
        ({"scenarios": ["white"]}, "scenarios nominal"),
        ({"controllers": ["velocity"]}, "controllers lqg-load"),
        ({"controllers": []}, "controllers lqg-load"),
    ],
)
def test_a_benchmark_of_other_settings_is_not_replaced(finished, change, words):
    before = contents(finished)
    with pytest.raises(
        ValueError, match=f"^folder = .* holds another benchmark, with {words}.*: name another folder, or empty this"
    ):
        benchmark(folder=finished, **{**SMALL, **change})
    assert contents(finished) == before


def test_a_benchmark_that_contains_the_one_in_its_folder_goes_on_with_its_cells(finished):
    cells = [finished / "cells" / "nominal" / f"{name}.json" for name in ("none", "lqg", "lqg-load")]
    before, measured = [path.stat().st_mtime_ns for path in cells], []
    more = {**SMALL, "scenarios": ["nominal", "white"], "controllers": ["lqg-load", "velocity"]}
    table = benchmark(folder=finished, progress=lambda done, total, cell: measured.append((cell.scenario, cell.controller)), **more)
    assert [path.stat().st_mtime_ns for path in cells] == before
    assert set(measured) == {("nominal", "velocity"), *(("white", name) for name in ("none", "lqg", "lqg-load", "velocity"))}
    assert len(table.rows) == 8
    with pytest.raises(
        ValueError, match="holds another benchmark, with scenarios white; controllers velocity: name another folder"
    ):
        benchmark(folder=finished, **SMALL)


def test_a_scenario_of_the_same_name_and_other_content_is_another_one(tmp_path):
    path = tmp_path / "gusty.toml"
    path.write_text("[rotor]\nturbulence = 10.0\n")
    mine = {**SMALL, "scenarios": [str(path)], "controllers": []}
    benchmark(folder=tmp_path / "out", **mine)
    path.write_text("[rotor]\nturbulence = 20.0\n")
    with pytest.raises(ValueError, match="holds another benchmark, with scenarios gusty"):
        benchmark(folder=tmp_path / "out", **mine)


@pytest.mark.parametrize("name", ["cells", "table.csv", "report.html"])
def test_what_no_benchmark_made_is_not_overwritten(name, tmp_path):
    (tmp_path / name).write_text("mine")
    with pytest.raises(ValueError, match=f"^folder = .* holds {name}, which no benchmark there tells of: name another folder"):
        benchmark(folder=tmp_path, **SMALL)
    assert (tmp_path / name).read_text() == "mine" and len(list(tmp_path.iterdir())) == 1


def test_a_benchmark_from_before_configurations_were_written_is_known_by_its_table(plain, tmp_path):
    shutil.copytree(plain, tmp_path, dirs_exist_ok=True)
    (tmp_path / "configuration.json").unlink()
    with pytest.raises(ValueError, match="holds another benchmark, with seeds"):
        benchmark(folder=tmp_path, **{**SMALL, "controllers": [], "seeds": 3})
    benchmark(folder=tmp_path, **{**SMALL, "controllers": []})
    assert (tmp_path / "configuration.json").is_file()


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plain")
    benchmark(folder=folder, **{**SMALL, "controllers": []})
    return folder


DAMAGE = {
    "cut": lambda text: text[: len(text) // 2],
    "empty": lambda text: "",
    "bytes": lambda text: "\x00\x01",
    "list": lambda text: "[1, 2]",
    "number": lambda text: "3",
    "nothing": lambda text: "null",
    "other": lambda text: '{"colour": "red"}',
    "deep": lambda text: "[" * 100_000,
}


@pytest.mark.parametrize("damage", DAMAGE)
@pytest.mark.parametrize("name", ["cells/nominal/lqg.json", "configuration.json"])
def test_a_damaged_file_is_named_in_one_sentence(name, damage, plain, tmp_path):
    shutil.copytree(plain, tmp_path, dirs_exist_ok=True)
    path = tmp_path / name
    path.write_text(DAMAGE[damage](path.read_text()))
    with pytest.raises(ValueError, match=name) as told:
        benchmark(folder=tmp_path, **{**SMALL, "controllers": []})
    assert "\n" not in str(told.value) and len(str(told.value)) < 500


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"title": 3}, "cell.title is 3, but must be a string"),
        ({"series": [1.0]}, "cell.series is .1.0., but must be a mapping"),
        ({"series": {"cost": [1.0, 2.0]}}, "cell.series.uncontrolled is None, but must be a list of 2 numbers"),
        ({"cost": "x"}, "cell.series.cost is 'x', but must be a list of 2 numbers"),
        ({"cost": [1.0]}, "cell.series.cost is .1.0., but must be a list of 2 numbers"),
        ({"cost": [1.0, "2"]}, "cell.series.cost is .1.0, '2'., but must be a list of 2 numbers"),
    ],
)
def test_a_cell_of_the_wrong_kind_is_named_with_its_file(change, words, plain, tmp_path):
    shutil.copytree(plain, tmp_path, dirs_exist_ok=True)
    path = tmp_path / "cells" / "nominal" / "lqg.json"
    content = json.loads(path.read_text())
    content = {**content, "series": {**content["series"], **change}} if "cost" in change else {**content, **change}
    path.write_text(json.dumps(content))
    with pytest.raises(ValueError, match=f"^file .*lqg.json.: {words}"):
        benchmark(folder=tmp_path, **{**SMALL, "controllers": []})


def test_each_choice_of_the_command_has_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    small = ("benchmark", "--controller", "none", "--jobs", "1", "--json")
    for arguments in (("--episodes", "2", "--scenario", "white"), ("--episodes", "3", "--scenario", "white")):
        result = CliRunner().invoke(app, [*small, *arguments])
        assert result.exit_code == 0, result.stderr
    homes = sorted(path.name for path in (tmp_path / "results").iterdir())
    assert homes == ["benchmark-white-none-2", "benchmark-white-none-3"]
    assert [json.loads((tmp_path / "results" / home / "benchmark.json").read_text())["rows"][0]["seeds"] for home in homes] == [
        2,
        3,
    ]
    refused = CliRunner().invoke(app, [*small, "--episodes", "2", "--scenario", "nominal", "--folder", f"results/{homes[0]}"])
    assert refused.exit_code == 2
    assert refused.stderr.startswith("beamenv: --folder = ") and len(refused.stderr.splitlines()) == 1


def test_the_folders_of_the_command_differ_from_the_full_benchmark_s():
    assert default_folder((), (), 128, ()).as_posix() == "results/benchmark"
    assert default_folder(("all",), (), 128, ()).as_posix() == "results/benchmark"
    assert default_folder(("delay",), (), 128, ()).as_posix() == "results/benchmark-delay"
    assert default_folder(("../my/gusty.toml",), (), 16, ()).as_posix() == "results/benchmark-gusty-16"
    quick = [default_folder(names, (), seeds, (), quick=True).name for names in ((), ("all",)) for seeds in (QUICK_SEEDS, 128)]
    assert quick == ["benchmark-quick", "benchmark-quick-128", "benchmark-quick-all", "benchmark-quick-all-128"]
    long = [default_folder(tuple("abcdefghij" * 3), (last,), 128, ()) for last in ("x", "y")]
    assert long[0] != long[1] and all(len(each.name) < 100 for each in long)
    assert default_folder(("../../evil",), (), 128, ()).parent.as_posix() == "results"


NAMES = [
    "",
    " ",
    ".",
    "..",
    "a/b",
    "../../x",
    "/etc/x",
    "a\\b",
    "C:x",
    "a\nb",
    "a\x00b",
    "-rf",
    ".hidden",
    "=1+1",
    "x.",
    "x ",
    "nul",
    "COM1.txt",
]


@pytest.mark.parametrize("name", [*NAMES, "x" * 101, "a*b", "<b>", "a|b", 'a"b', "\u202ex"])
def test_one_rule_says_which_names_become_files(name):
    with pytest.raises(ValueError, match="must be names that files can have"):
        checked("name", name, FileName())


@pytest.mark.parametrize("name", ["lqg", "half LQG", "größer", "v1.2", "_x", "lqg-load", "控制", "x" * 100])
def test_names_in_any_language_are_allowed(name):
    assert checked("name", name, FileName()) == name


@pytest.mark.parametrize("name", NAMES)
def test_no_name_leads_out_of_the_folder(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match="^own is .*, but must be names that files can have"):
        benchmark({name: np.zeros_like}, folder=tmp_path / "in", **SMALL)
    (tmp_path / "mine.toml").write_text('agent = "gradient"\ntitle = "Brief"\nupdates = 1\n[settings]\nepisodes = 8\nwindow = 20\n')
    refused = CliRunner().invoke(app, ["train", "--recipe", "mine.toml", "--", name])
    assert refused.exit_code == 2 and "agent is " in refused.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["mine.toml"]


def test_two_controllers_never_share_a_file(tmp_path):
    with pytest.raises(ValueError, match="^own gives two cells one file, 'cells.nominal.lqg.json' and 'cells.nominal.LQG.json'"):
        benchmark({"LQG": np.zeros_like}, folder=tmp_path / "in", **SMALL)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("progress", [3, "bar", [], {}])
def test_progress_is_called_or_refused_before_anything_is_measured(progress, tmp_path):
    with pytest.raises(
        ValueError, match="^progress is .*, but must be None, or a function of cells done, their number, and the cell"
    ):
        benchmark(progress=progress, folder=tmp_path / "in", **SMALL)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("text", ["=HYPERLINK(1)", "+1", "-2+3", "@sum", "\t=1", "\r=1", " =1"])
def test_no_text_of_a_table_is_a_formula(text, tmp_path):
    write_csv(tmp_path / "table.csv", [{"name": text, "cost": -1.5, "runs": 3, "none": None}])
    with (tmp_path / "table.csv").open(newline="") as file:
        row = next(csv.DictReader(file))
    assert row["name"].startswith("'") and row["name"].lstrip("' ") == text.strip()
    assert (row["cost"], row["runs"], row["none"]) == ("-1.5", "3", "")


def test_text_of_a_table_is_on_one_line_and_otherwise_as_it_stands(tmp_path):
    assert in_a_cell('two\nlines; "a", b|c') == 'two lines; "a", b|c'
    write_csv(tmp_path / "table.csv", [{"name": 'a,"b"\nc|d'}])
    assert len((tmp_path / "table.csv").read_text().splitlines()) == 2


class Odd:
    """Is called what no table should take for anything else."""

    name = "=cmd|x\n[/red] *b* `c` <i>"

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        return np.zeros((len(observation), 4)), state


def test_a_controller_s_odd_title_stays_text_in_every_table(tmp_path, capsys):
    from baselines import evaluate
    from train.cli.evaluations import show_compared
    from train.comparison.table import write_tables

    evaluation = evaluate(Odd(), beamenv.ENV_ID, range(2))
    write_tables(tmp_path, [evaluation])
    text = (tmp_path / "table.md").read_text().splitlines()
    assert text[2].startswith(r"| =cmd\|x [/red] \*b* \`c\` &lt;i> |")
    assert text[2].replace(r"\|", "").count("|") == text[0].count("|")
    with (tmp_path / "table.csv").open(newline="") as file:
        assert next(csv.DictReader(file))["controller"] == "'=cmd|x [/red] *b* `c` <i>"
    show_compared([evaluation])
    assert "[/red]" in capsys.readouterr().out
    benchmark({"odd": Odd()}, folder=tmp_path / "out", **SMALL)
    with (tmp_path / "out" / "table.csv").open(newline="") as file:
        assert "'=cmd|x [/red] *b* `c` <i>" in [row["title"] for row in csv.DictReader(file)]
