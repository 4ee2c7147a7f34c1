"""Every file, module and test that README and the pages name is there."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
WINGS = ("beamenv", "baselines", "train")
TREES = (*WINGS, "tests", "docs", "examples")
PAGES = sorted([ROOT / "README.md", ROOT / "CHANGELOG.md", *(ROOT / "docs").rglob("*.md")])

FENCE = re.compile(r"^```.*?^```$", flags=re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`([^`\n]+)`")
PATH = re.compile(rf"(?:{'|'.join(TREES)})/[\w./-]*\w[/\w]*|[\w-]+(?:/[\w.-]+)+\.(?:py|md|toml|yml)")
DOTTED = re.compile(rf"(?:{'|'.join(WINGS)})(?:\.(?!py$)[A-Za-z_]\w*)+")
MODULE = rf"(?:{'|'.join(WINGS)})[\w.]*"
IMPORT = re.compile(rf"^(?:from ({MODULE}) import (\w+(?:, \w+)*)|import ({MODULE}))$", flags=re.MULTILINE)
MEMBERS = re.compile(r"^::: (\S+)\n(?: +[^\n]*\n)*? +members: \[([^\]]+)\]", re.MULTILINE)
TEST = re.compile(r"test_\w+")

TO_BE_WRITTEN = {"beamenv/scenarios/named/gusty.toml", "train/controllers/named/half_lqg.py"}
"""Files that the reader is told to write: only their folders are there."""
FORMER = "CHANGELOG.md"
"""The page that names what has moved away: of its tables' rows only the last column is checked."""


def spans(page):
    """What stands between single backticks outside code blocks; links' targets and mkdocstrings' directives too."""
    text = page.read_text(encoding="utf-8")
    if page.name == FORMER:
        text = "\n".join(line.rstrip(" |").rpartition("|")[2] if line.startswith("|") else line for line in text.splitlines())
    prose = FENCE.sub("", text)
    return CODE.findall(prose) + re.findall(r"^::: (\S+)$", prose, flags=re.MULTILINE)


def paths(page):
    return {span for span in spans(page) if PATH.fullmatch(span) and not span.endswith("-v0")}  # an environment's id is no path


def links(page):
    """Targets of relative links."""
    targets = re.findall(r"\]\(([^)#\s]+)[^)]*\)", FENCE.sub("", page.read_text(encoding="utf-8")))
    return {target for target in targets if not target.startswith("http")}


def names(page):
    """Dotted names in the prose, and those that code blocks import."""
    found = {span.partition("(")[0] for span in spans(page) if DOTTED.fullmatch(span.partition("(")[0])}
    for module, members in MEMBERS.findall(page.read_text(encoding="utf-8")):
        found |= {f"{module}.{name}" for name in members.split(", ")}
    for module, imported, whole in IMPORT.findall(page.read_text(encoding="utf-8")):
        found |= {whole} if whole else {f"{module}.{name}" for name in imported.split(", ")}
    return found


def path_is_there(path):
    return (ROOT / path).exists() or (path in TO_BE_WRITTEN and (ROOT / path).parent.is_dir())


def name_is_there(name):
    """Whether the parts lead through folders to a module, and from there to what it defines, imports or offers."""
    place, parts = ROOT, re.sub(r"^beamenv\.(?=(baselines|train)\b)", "", name).split(".")
    while parts and (place / parts[0]).is_dir():
        place /= parts.pop(0)
    if parts and (place / f"{parts[0]}.py").is_file():
        body = tree(place / f"{parts.pop(0)}.py").body
    elif (place / "__init__.py").is_file():
        body = tree(place / "__init__.py").body
    else:
        return False
    module = body
    for part in parts:
        found = [node for node in body if part in defined_by(node)]
        if not found:
            return False
        body = [*getattr(found[0], "body", []), *inherited(found[0], module)]
    return True


def inherited(node, module):
    """What a class has of those of its bases that its module imports from here."""
    homes = {each.asname or each.name: node.module for node in module if isinstance(node, ast.ImportFrom) for each in node.names}
    bases = [base.id for base in getattr(node, "bases", []) if isinstance(base, ast.Name)]
    files = [(name, ROOT / f"{homes[name].replace('.', '/')}.py") for name in bases if name in homes]
    there = [(name, tree(file).body) for name, file in files if file.is_file()]
    return [each for name, body in there for found in body if name in defined_by(found) for each in getattr(found, "body", [])]


def tree(file):
    return ast.parse(file.read_text(encoding="utf-8"))


def defined_by(node):
    if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
        return {node.name}
    if isinstance(node, (ast.Import, ast.ImportFrom)):
        return {alias.asname or alias.name for alias in node.names}
    if isinstance(node, (ast.Assign, ast.AnnAssign)):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        return {target.id for target in targets if isinstance(target, ast.Name)} | offered(node)
    return set()


def offered(node):
    """The strings of ``__all__``."""
    return {each.value for each in ast.walk(node) if isinstance(each, ast.Constant)} if "__all__" in ast.unparse(node) else set()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_file_and_module_that_a_page_names_is_there(page):
    assert [path for path in sorted(paths(page)) if not path_is_there(path)] == []
    assert [target for target in sorted(links(page)) if not (page.parent / target).exists()] == []
    assert [name for name in sorted(names(page)) if not name_is_there(name)] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_test_that_a_page_names_is_there(page):
    named = {span for span in spans(page) if TEST.fullmatch(span)}
    if named:
        written = "\n".join(file.read_text(encoding="utf-8") for file in (ROOT / "tests").rglob("test_*.py"))
        assert [name for name in sorted(named) if f"def {name}(" not in written] == []


def test_every_module_that_a_docstring_names_is_there():
    named = {
        (str(file.relative_to(ROOT)), span)
        for wing in WINGS
        for file in (ROOT / wing).rglob("*.py")
        for span in re.findall(r"``([\w.]+)``", file.read_text(encoding="utf-8"))
        if DOTTED.fullmatch(span)
    }
    assert len(named) > 10
    assert [(file, name) for file, name in sorted(named) if not name_is_there(name)] == []


def test_the_pages_name_enough_for_this_to_mean_something():
    assert sum(len(paths(page)) for page in PAGES) > 20
    assert sum(len(names(page)) for page in PAGES) > 60


@pytest.mark.parametrize(
    ("there", "wrong"),
    [
        ("beamenv.structure.RotatingBeam", "beamenv.structure.RotatingBlade"),
        ("beamenv.structure.modes.Modes.families", "beamenv.structure.modes.Modes.family"),
        ("baselines.evaluate", "baselines.evaluation.evaluator"),
        ("train.controllers.shipped.load_shipped", "train.shipped.load_shipped"),
        ("beamenv.train.controllers.shipped.load_shipped", "beamenv.train.shipped.load_shipped"),
    ],
)
def test_a_name_that_leads_nowhere_is_found(there, wrong):
    assert name_is_there(there)
    assert not name_is_there(wrong)


def test_a_path_that_leads_nowhere_is_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        "`beamenv/structure/beam.py`, `beamenv/structure/blade.py`, `other/place.toml`, `a / b`\n```\n`docs/x.md`\n```\n"
    )
    assert sorted(paths(page)) == ["beamenv/structure/beam.py", "beamenv/structure/blade.py", "other/place.toml"]
    assert [path for path in sorted(paths(page)) if not path_is_there(path)] == ["beamenv/structure/blade.py", "other/place.toml"]
