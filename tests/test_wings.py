"""What a user is shown works in scripts called as they like, and beside packages called as they like."""

import json
import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import baselines
import train.benchmark
from beamenv.wings import WINGS

pytestmark = pytest.mark.slow  # `make quick-clients` runs them, with the wheel and the clients

ROOT = Path(__file__).resolve().parents[1]
SHOWN = sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").glob("*.py")])
IMPORT = re.compile(r"^(?:from|import) (\w[\w.]*)[^\n]*$", flags=re.MULTILINE)

PUBLIC = ("beamenv", "beamenv.baselines", "beamenv.baselines.placement", "beamenv.structure", "beamenv.train.benchmark")

USES_EVERYTHING = """
import gymnasium
for name in {public}:
    module = __import__(name, fromlist=["__all__"])
    assert all(getattr(module, each) is not None for each in module.__all__), name
env = gymnasium.make("beamenv/RotatingBeam-v0", duration=0.01)
law = beamenv.baselines.no_control(env.unwrapped.design_plant)
assert beamenv.baselines.evaluate(law, env, seeds=range(2)).relative_cost.value == 1.0
assert isinstance(law, beamenv.baselines.Law)
"""

NEEDS = {"beamenv.train.rllib": "tree"}
"""Rooms that import a library of others which is installed apart, and what tells that it is here."""

IN_PROCESSES = """
from beamenv.train.benchmark import benchmark
if __name__ == "__main__":
    table = benchmark({"mine": lambda readings: 0.0 * readings}, scenarios=["nominal"], controllers=["lqr"], seeds=4, jobs=2)
    assert table.row("nominal", "mine").estimates
"""


def shown_imports():
    """Every line with which README, the pages and the examples import something of ours."""
    lines = {each[0] for page in SHOWN for each in IMPORT.finditer(page.read_text(encoding="utf-8"))}
    return sorted(line for line in lines if line.split()[1].partition(".")[0] in ("beamenv", *WINGS) and not line.endswith("("))


def script_of_a_user(name, folder, further=""):
    """A script that imports all that is shown and can be had here, and itself is called ``name``."""
    own = [line for line in shown_imports() if all(find_spec(needed) for room, needed in NEEDS.items() if f" {room} " in line)]
    text = "\n".join([*own, USES_EVERYTHING.format(public=PUBLIC), further])
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def run(command, folder, **environment):
    done = subprocess.run(command, cwd=folder, env={**os.environ, **environment}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_what_is_shown_has_the_long_names():
    lines = shown_imports()
    assert len(lines) > 20
    assert [line for line in lines if line.split()[1].partition(".")[0] in WINGS] == []


def test_short_and_long_names_are_one_module():
    import beamenv.baselines.laws.lqg
    import beamenv.train.benchmark
    import beamenv.train.controllers.shipped as long
    import train.controllers.shipped as short

    assert beamenv.baselines is baselines
    assert beamenv.train.benchmark is train.benchmark
    assert beamenv.baselines.laws is baselines.laws
    assert short is long
    assert short.__spec__.name == "train.controllers.shipped"


@pytest.mark.parametrize("name", ["train.py", "baselines.py"])
def test_a_script_may_be_called_as_a_wing(name, tmp_path):
    script = script_of_a_user(name, tmp_path)
    run([sys.executable, script], tmp_path, PYTHONPATH=str(ROOT), OMP_NUM_THREADS="1")


def test_another_package_of_that_name_is_left_alone(tmp_path):
    (tmp_path / "baselines").mkdir()
    (tmp_path / "baselines" / "__init__.py").write_text("their_own = 1\n")
    (tmp_path / "train.py").write_text("raise SystemExit('a script was run as a module')\n")
    code = "import beamenv.train.page, beamenv.baselines, baselines; print(baselines.their_own, beamenv.baselines.lqg)"
    told = run([sys.executable, "-c", code], tmp_path, PYTHONPATH=f"{tmp_path}:{ROOT}")
    assert told.startswith("1 <function lqg")


def test_the_wings_are_attributes_of_the_package(tmp_path):
    code = "import beamenv; print(beamenv.baselines.lqg.__name__, beamenv.train.__name__)"
    assert run([sys.executable, "-c", code], tmp_path, PYTHONPATH=str(ROOT)) == "lqg train\n"


def test_a_module_of_a_wing_runs_by_its_long_name(tmp_path):
    code = "import runpy; print(sorted(runpy.run_module('beamenv.train.shared.threads')))"
    for folder in (tmp_path, ROOT):
        assert "ONE_THREAD" in run([sys.executable, "-c", code], folder, PYTHONPATH=str(ROOT))
    (tmp_path / "train.py").touch()
    assert "ONE_THREAD" in run([sys.executable, "-c", code], tmp_path, PYTHONPATH=f"{tmp_path}:{ROOT}")


def test_what_is_in_no_wing_is_not_found(tmp_path):
    with pytest.raises(ModuleNotFoundError, match="train.nonsense"):
        __import__("beamenv.train.nonsense")


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """The interpreter of an environment into which the wheel was installed; what beamenv needs it has from here."""
    folder = tmp_path_factory.mktemp("wheel")
    run([sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", folder, ROOT], folder)
    run([sys.executable, "-m", "venv", folder / "venv"], folder)
    python = folder / "venv" / "bin" / "python"
    site = Path(run([python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"], folder).strip())
    (site / "borrowed.pth").write_text("".join(f"{path}\n" for path in sys.path if path.endswith("site-packages")))
    run([python, "-m", "pip", "install", "-q", "--no-deps", "--force-reinstall", *folder.glob("*.whl")], folder)
    assert run([python, "-c", "import beamenv; print(beamenv.__file__)"], folder).strip() == str(site / "beamenv" / "__init__.py")
    return python


OTHERS = {"nobody": "", "another distribution": "their_own = 1\n"}


@pytest.mark.slow
@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("name", ["train.py", "baselines.py", "mine.py"])
def test_everything_shown_works_from_the_wheel(installed, name, other, tmp_path):
    site = next((installed.parents[1] / "lib").glob("python*")) / "site-packages" / "baselines"
    if OTHERS[other]:
        site.mkdir(exist_ok=True)
        (site / "__init__.py").write_text(OTHERS[other])
    try:
        run([installed, script_of_a_user(name, tmp_path, IN_PROCESSES)], tmp_path)
        command = [installed.with_name("beamenv"), "evaluate", "none", "--episodes", "2", "--json"]
        assert json.loads(run(command, tmp_path, PYTHONPATH=str(tmp_path)))["controller"] == "none"
    finally:
        shutil.rmtree(site, ignore_errors=True)


@pytest.mark.slow
def test_short_names_are_there_in_the_wheel_where_nobody_else_has_them(installed, tmp_path):
    code = "from baselines import lqg, evaluate; import train.benchmark, beamenv.baselines; assert beamenv.baselines.lqg is lqg"
    run([installed, "-c", code], tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("example", [path.name for path in SHOWN if path.name[:3] in ("01_", "02_")])
def test_examples_run_from_the_wheel_under_the_names_of_the_wings(installed, example, tmp_path):
    (tmp_path / "train.py").write_bytes((ROOT / "examples" / example).read_bytes())
    run([installed, tmp_path / "train.py"], tmp_path)
