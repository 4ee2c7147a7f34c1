import ast
import json
import re
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest
import yaml

import beamenv

ROOT = Path(__file__).resolve().parents[1]
WINGS = ("beamenv", "baselines", "train")
HEAVY_MODULES = {"torch", "matplotlib", "control", "scipy.signal"}
VERSION = re.search(r'^version = "(.+)"$', (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.MULTILINE).group(1)

IMPORT_AND_TELL = """
import json, sys, time
start = time.process_time()
import beamenv
print(json.dumps([time.process_time() - start, sorted(sys.modules)]))
"""


def import_beamenv_afresh():
    run = subprocess.run([sys.executable, "-c", IMPORT_AND_TELL], cwd=ROOT, capture_output=True, text=True, check=True)
    seconds, modules = json.loads(run.stdout)
    return seconds, set(modules)


def test_import_loads_no_heavy_package():
    _, modules = import_beamenv_afresh()
    assert not HEAVY_MODULES & modules


def test_import_takes_less_than_half_a_second():
    # Of the processor, which others on a loaded machine take no part of; one quick import is proof.
    times = (import_beamenv_afresh()[0] for _ in range(5))
    assert any(seconds < 0.5 for seconds in times)


@pytest.mark.parametrize("wing", WINGS)
def test_wing_is_marked_as_typed(wing):
    assert (ROOT / wing / "py.typed").is_file()


def test_package_states_the_version_of_the_project():
    assert beamenv.__version__ == VERSION


def test_installed_metadata_state_the_version_of_the_project():
    try:
        assert metadata.version("beamenv") == VERSION
    except metadata.PackageNotFoundError:
        pytest.skip("beamenv is not installed in this interpreter")


def test_citation_cites_the_software_and_the_thesis():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    (thesis,) = citation["references"]
    assert citation["cff-version"] == "1.2.0"
    assert str(citation["version"]) == VERSION
    assert citation["license"] == "MIT"
    assert citation["authors"] and citation["title"] and citation["message"]
    assert thesis["type"] == "thesis"
    assert thesis["authors"] == [{"family-names": "Vadiraja", "given-names": "D. N."}]
    assert thesis["year"] == 2008
    assert thesis["institution"]["name"] == "Indian Institute of Technology Guwahati"


def test_command_without_typer_says_how_to_install_it():
    hide_typer_and_torch = "import sys; sys.modules.update(typer=None, torch=None); from train.cli.command import main; main()"
    run = subprocess.run([sys.executable, "-c", hide_typer_and_torch, "--help"], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 1
    assert run.stderr.count("\n") == 1
    assert "pip install 'beamenv[cli]'" in run.stderr


WITH_TRAIN_ALONE = ("torch", "stable_baselines3", "sb3_contrib", "tensorboard", "plotly", "jinja2", "joblib", "cloudpickle", "dash")


WITHOUT_TRAINING = (
    ["frequencies", "--json"],
    ["place", "--sensors", "1", "--method", "grid", "--picture", "p.png"],
    ["evaluate", "none", "--episodes", "2", "--json"],
    ["record", "none", "--episodes", "1", "--folder", "sets"],
)


def test_what_needs_no_training_runs_with_the_extra_of_the_command_line_alone(tmp_path):
    code = f"""
import sys
sys.modules.update(dict.fromkeys({WITH_TRAIN_ALONE}))
sys.path.insert(0, {str(ROOT)!r})
from beamenv.train.cli.app import app
for words in {WITHOUT_TRAINING}:
    app(words, standalone_mode=False)
"""
    run = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "p.png").is_file()


@pytest.mark.parametrize(
    ("package", "extra", "words"),
    [
        ("torch", "train", ["train", "ppo"]),
        ("minari", "record", ["record", "none"]),
        ("ray", "cluster", ["tune", "gradient", "--updates", "1", "--trials", "2"]),
        pytest.param("ray.tune", "cluster", ["tune", "gradient", "--updates", "1", "--trials", "2"], marks=pytest.mark.slow),
        ("ray", "cluster", ["train", "gradient", "--updates", "1", "--cluster", "local"]),
        ("ray", "cluster", ["benchmark", "--folder", "made", "--cluster", "local"]),
    ],
)
def test_a_command_without_its_extra_says_how_to_install_it(tmp_path, package, extra, words):
    code = f"import sys; sys.modules[{package!r}] = None; sys.path.insert(0, {str(ROOT)!r}); "
    code += "from beamenv.train.cli.command import main; main()"
    run = subprocess.run([sys.executable, "-c", code, *words], cwd=tmp_path, capture_output=True, text=True)
    assert (run.returncode, run.stderr.count("\n")) == (1, 1)
    assert f"'{package.partition('.')[0]}' is missing; install it with pip install 'beamenv[{extra}]'" in run.stderr
    assert list(tmp_path.iterdir()) == []


# Imports run one way: configuration → structure → patches → plant → environment; baselines know plants, never environments;
# training knows everything and nobody knows training. Lazy and type-only imports count: they are arrows too.

ENVIRONMENT = {"beamenv.envs", "beamenv.rendering"}
CONFIGURATION, STRUCTURE, PATCHES, PLANT = (f"beamenv.{room}" for room in ("configuration", "structure", "patches", "plant"))


def dotted_name(path):
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def own_imports(path):
    """Names imported from the three wings, each ``from a import b`` as ``a.b``."""
    package = dotted_name(path) if path.name == "__init__.py" else dotted_name(path).rpartition(".")[0]
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            parents = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            source = ".".join([*parents, *([node.module] if node.module else [])])
            names.update(f"{source}.{alias.name}" for alias in node.names)
    return {name for name in names if name.split(".")[0] in WINGS}


def lies_in(name, packages):
    return any(name == package or name.startswith(package + ".") for package in packages)


def arrows(module):
    """(importing file, imported name) for each import inside a module or package of the project."""
    place = ROOT.joinpath(*module.split("."))
    paths = sorted(place.rglob("*.py")) or [place.with_suffix(".py")]
    return [(dotted_name(path), name) for path in paths for name in sorted(own_imports(path))]


@pytest.mark.parametrize(
    ("module", "may_import"),
    [
        (CONFIGURATION, {CONFIGURATION}),
        (STRUCTURE, {CONFIGURATION, STRUCTURE}),
        (PATCHES, {CONFIGURATION, STRUCTURE, PATCHES}),
        (PLANT, {CONFIGURATION, STRUCTURE, PATCHES, PLANT}),
        ("beamenv", {"beamenv"}),
        ("baselines", {"beamenv", "baselines"}),
    ],
)
def test_imports_run_one_way(module, may_import):
    assert [arrow for arrow in arrows(module) if not lies_in(arrow[1], may_import)] == []


def test_baselines_never_know_environments():
    assert [arrow for arrow in arrows("baselines") if lies_in(arrow[1], ENVIRONMENT)] == []


ROOMS_OF_TRAIN = (
    {"shared"},
    {"workers"},
    {"controllers", "figures", "speed"},
    {"probing", "tools"},
    {"datasets", "export", "identification", "learning", "page", "placement", "reproduce"},
    {"benchmark", "comparison", "explore", "rllib", "tuning"},
    {"cli"},
)
"""Floor by floor: a room imports rooms below it."""


def room(name):
    return name.split(".")[1]


def test_rooms_of_training_import_rooms_below_them():
    floors = {name: floor for floor, rooms in enumerate(ROOMS_OF_TRAIN) for name in rooms}
    assert set(floors) == {path.parent.name for path in (ROOT / "train").glob("*/__init__.py")}
    inside = [(path, name) for path, name in arrows("train") if name.startswith("train.") and room(path + ".") != room(name)]
    assert len(inside) > 100
    assert [arrow for arrow in inside if floors[room(arrow[1])] >= floors[room(arrow[0])]] == []


def test_only_the_command_line_prints():
    speaking = {
        dotted_name(path)
        for path in (ROOT / "train").rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if (isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in {"rich", "typer"})
        or (isinstance(node, ast.Name) and node.id == "print")
    }
    assert "train.cli.options" in speaking
    assert {name for name in speaking if room(name) != "cli"} == set()
