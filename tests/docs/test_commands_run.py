"""Every command of the pages runs, in the order of its page, with work made small where it would take minutes."""

import importlib.util
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from tests.docs.written import ROOT, blocks, commands, name_of, pages

pytest.importorskip("typer")
pytestmark = pytest.mark.slow

LEFT_AS_THEY_ARE = {"README.md", "agents.md", "libraries.md"}
"""Pages whose Python blocks the commands do not need, and which take long."""
SMALLER = {
    "train": {"--minutes": None, "--updates": "1", "--jobs": "1", "--looks": "0"},
    "tune": {"--trials": "2", "--updates": "2", "--jobs": "1"},
    "evaluate": {"--episodes": "2"},
    "record": {"--episodes": "2"},
    "compare": {"--minutes": "0", "--episodes": "2"},
    "benchmark": {"--episodes": "2", "--jobs": "1", "--scenario": "nominal", "--controller": "lqg"},
    "reproduce": {"--jobs": "1"},
}
"""By command: options that are put in the place of what the page has, or added; None takes an option away. Clusters, which only the
reader has, are left out."""
BEGUN = {"--quick", "--submit", "speed", "generalist"}
"""What takes minutes however small: it runs up to where the work begins, a generalist's training with two scenarios of fourteen."""


class Reached(Exception):
    """The work begins."""


def begun(*given, **named):
    raise Reached


def smaller(words):
    """The command with less work, and whether it is left where its work begins."""
    command, *rest = words
    if BEGUN & set(words):
        return words, True
    changes = dict(SMALLER.get(command, {}))
    kept, place = [], 0
    while place < len(rest):
        word = rest[place]
        if word == "--cluster" or word in changes:
            if command == "benchmark" and word in ("--scenario", "--controller"):
                kept += rest[place : place + 2]
                changes.pop(word, None)
            place += 2
        else:
            kept.append(word)
            place += 1
    if command == "reproduce" and not [word for word in kept if not word.startswith("-")]:
        kept.append("table-3.4")
    return [command, *kept, *(part for name, value in changes.items() if value is not None for part in (name, value))], False


def shipped_runs(name):
    """The folder of an agent that ships, its runs in it."""
    return next((ROOT / "train" / "controllers" / "trained").glob(f"{name}*/*"))


def measured(file, names):
    """A made-up measurement with these columns: a second-order answer to steps of the voltages."""
    time, random = 0.001 * np.arange(4000), np.random.default_rng(0)
    inputs = [name for name in names if name[0] in "ud"]
    voltages = random.choice([-50.0, 50.0], (len(inputs), len(time) // 8)).repeat(8, axis=1)
    answer = np.convolve(np.exp(-8 * time[:600]) * np.sin(120 * time[:600]), voltages.sum(0))[: len(time)]
    columns = {"time": time, **dict(zip(inputs, voltages, strict=True))}
    for name in names:
        if name not in columns:
            columns[name] = 1e-6 * (answer + 0.01 * np.abs(answer).max() * random.normal(size=len(time)))
    heads = ",".join(name if name in inputs or name == "time" else f"{name} [A]" for name in columns)
    np.savetxt(file, np.column_stack(list(columns.values())), delimiter=",", header=heads, comments="")


def prepare(page):
    """What a reader has who comes to a page: the examples, a measurement, an agent."""
    for name in ("examples", "tests"):
        os.symlink(ROOT / name, name)
    if page.name in ("identification.md", "cli.md"):
        measured("data.csv", ["u1", "y1"])
        measured("bench.csv", ["drive", "gauge", "laser"])
    if page.name == "export.md":
        shutil.copytree(shipped_runs("gradient"), "mine")


def tables(page):
    """TOML blocks whose first line says which file they are, as ``# warm.toml: …`` does."""
    for _, _, block in blocks(page, "toml"):
        if named := re.match(r"# (\w+\.toml):", block):
            Path(named[1]).write_text(block, encoding="utf-8")


def own_blocks(page, name):
    """The file that a Python block of another page writes, as the reader has it who comes from there."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    return re.search(rf'Path\("{re.escape(name)}"\)\.write_text\("""\\?\n(.*?)"""\)', text, re.DOTALL)[1]


def with_commands():
    return [pytest.param(page, id=name_of(page)) for page in pages() if any(commands(text) for _, _, text in blocks(page, "sh"))]


@pytest.mark.parametrize("page", with_commands())
def test_commands_run_in_the_order_of_their_page(page, tmp_path, monkeypatch):
    from typer.testing import CliRunner

    from train.cli.app import app

    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path / "minari"))  # else data sets go into the home of whoever tests
    prepare(page)
    tables(page)
    if page.name == "scenarios.md":
        Path("graded.toml").write_text(own_blocks("own-beam.md", "graded.toml"), encoding="utf-8")
    namespace = {"__name__": page.stem}
    for line, language, text in blocks(page, "python", "sh"):
        if language == "python":
            if page.name not in LEFT_AS_THEY_ARE:
                exec(compile("\n" * (line - 1) + text, str(page), "exec"), namespace)
            continue
        for program, *words in commands(text):
            if program != "beamenv":
                other(program, words)
                continue
            words, only_begun = smaller(words)
            with monkeypatch.context() as patch:
                if only_begun:
                    patch.setattr("train.benchmark.campaign._cells", begun)
                    patch.setattr("train.cli.speed.measured", begun)
                    patch.setattr("train.learning.job.follow", begun)
                    patch.setattr("train.learning.job.NAMES", ("nominal", "delay"))
                    patch.setattr("train.learning.through_plant.gradient.compositions", lambda task, count, seed: [])
                result = CliRunner().invoke(app, words)
            if not (only_begun and isinstance(result.exception, Reached)):
                assert result.exit_code == 0, (words, result.output[-2000:], result.exception)
            if only_begun and words[0] == "train" and "--folder" in words:  # what it would have made, for the commands below
                shutil.copytree(shipped_runs("gradient"), words[words.index("--folder") + 1], dirs_exist_ok=True)


def other(program, words):
    """Commands of other programs: make is asked what it would do, git clones, Python's modules are there."""
    environment = {**os.environ, "REPOSITORY": str(ROOT)}
    if program == "make":
        done = subprocess.run(["make", "-n", "-C", str(ROOT), *words], capture_output=True, text=True, env=environment)
        assert done.returncode == 0, done.stderr
    elif program == "git" and words[0] == "clone":
        words = [os.path.expandvars(word).replace("$REPOSITORY", str(ROOT)) for word in words]
        done = subprocess.run(["git", *words], capture_output=True, text=True, env=environment)
        assert done.returncode == 0, done.stderr
    elif program == "cd":
        os.chdir(words[0])
    elif program == "python" and words[0] == "-m":
        assert importlib.util.find_spec(words[1]) is not None
    else:
        assert program in ("pip", "python", "tensorboard"), program  # what pip is asked for the other test reads


def test_a_command_that_a_page_has_wrong_is_found(tmp_path, monkeypatch):
    from typer.testing import CliRunner

    from train.cli.app import app

    monkeypatch.chdir(tmp_path)
    words, only_begun = smaller(["evaluate", "nobody"])
    assert not only_begun and words == ["evaluate", "nobody", "--episodes", "2"]
    assert CliRunner().invoke(app, words).exit_code == 2


def test_work_is_made_smaller_and_nothing_else_is_changed():
    assert smaller(["train", "ppo", "--minutes", "2", "--cluster", "ray://x", "--seed", "1"])[0] == [
        *("train", "ppo", "--seed", "1", "--updates", "1", "--jobs", "1", "--looks", "0")
    ]
    assert smaller(["benchmark", "--scenario", "delay"])[0][:3] == ["benchmark", "--scenario", "delay"]
    assert smaller(["benchmark", "--quick"]) == (["benchmark", "--quick"], True)
    assert smaller(["reproduce", "--jobs", "4"])[0] == ["reproduce", "table-3.4", "--jobs", "1"]
    assert smaller(["frequencies", "--preset", "thesis"]) == (["frequencies", "--preset", "thesis"], False)
